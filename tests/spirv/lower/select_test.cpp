// Operands and outputs that need registers.
#include "tests/spirv/lower/lower_case.h"

namespace vitrine::spirv::test {
namespace {

constexpr LowerCase kOutputs[] = {
    {"a constant", R"(
StoreOutput 1.0
)",
     R"(
registers 1, masks 0, uniform words 1 (1 constants)
code:
    0  end
)"},
    {"an input", R"(
StoreOutput %a
)",
     R"(
registers 1, masks 0, uniform words 0 (0 constants)
code:
    0  end
)"},
    {"one that some lanes do not store is zero there", R"(
If FLt(%a, %b)
  StoreOutput %b
  StoreStorage 0, 0, %a [0 0 1] {1}
  Yield
Else
  Yield
)",
     R"(
registers 3, masks 2, uniform words 1 (1 constants)
code:
    0  move           r2 u0
    1  FLt            m0 r0 r1
    2  if             m1 m0 -> 5
    3  move.active    r2 r1
    4  store_storage  u0 ( r0 ) set 0 slot 0
    5  else           m1 -> 6
    6  endif          m1
    7  end
)"},
};

TEST(Select, Outputs) { check_lowered(kOutputs); }

constexpr LowerCase kOperands[] = {
    {"a word that is stored to memory", R"(
StoreStorage 0, %a, 7 [0 0 1] {1}
)",
     R"(
registers 2, masks 0, uniform words 2 (2 constants)
code:
    0  store_storage  r0 ( r1 ) set 0 slot 0
    1  end
)"},
};

TEST(Select, Operands) { check_lowered(kOperands); }

}  // namespace
}  // namespace vitrine::spirv::test
