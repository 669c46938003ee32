// Rows of memory instructions.
#include "tests/spirv/lower/lower_case.h"

namespace vitrine::spirv::test {
namespace {

constexpr LowerCase kMemory[] = {
    {"a load at an address of the draw's", R"(
StoreOutput FMul(%a, LoadUniform(0, 16) [0 2 1])
)",
     R"(
registers 1, masks 0, uniform words 3 (2 constants)
preamble:
    0  load_uniform   u1 ( u2 ) set 0 slot 2
    1  end
code:
    0  FMul           r0 r0 u2
    1  end
)"},
    {"a vector at a register's address", R"(
%v:3 = LoadUniform 0, %a [0 2 1 32]
StoreOutput FAdd(FAdd(%v.x, %v.y), %v.z)
)",
     R"(
registers 4, masks 0, uniform words 1 (1 constants)
code:
    0  load_uniform   r0 ( r1 r2 r3 ) set 0 slot 2 +32
    1  FAdd           r0 r1 r2
    2  FAdd           r0 r0 r3
    3  end
)"},
    {"components that are stored", R"(
%v:2 = Vec %a, %b
StoreStorage 0, %a, %v [0 1 1] {2}
)",
     R"(
registers 2, masks 0, uniform words 1 (1 constants)
code:
    0  store_storage  r0 ( r1 ) set 0 slot 1
    1  end
)"},
};

TEST(EmitMemory, Memory) { check_lowered(kMemory); }

}  // namespace
}  // namespace vitrine::spirv::test
