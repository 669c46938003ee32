// Loads that share an address.
#include "tests/spirv/lower/lower_case.h"

namespace vitrine::spirv::test {
namespace {

constexpr LowerCase kLoads[] = {
    {"constants become part of the address", R"(
StoreOutput LoadStorage(0, IAdd(%a, 16)) [0 0 1]
)",
     R"(
registers 2, masks 0, uniform words 1 (1 constants)
code:
    0  load_storage   r0 ( r1 ) set 0 slot 0 +16
    1  end
)"},
    {"neighbouring words are one load", R"(
%x = LoadStorage 0, %a [0 0 1]
%y = LoadStorage 0, %a [0 0 1 4]
StoreOutput FAdd(%x, %y)
)",
     R"(
registers 3, masks 0, uniform words 1 (1 constants)
code:
    0  load_storage   r0 ( r1 r2 ) set 0 slot 0
    1  FAdd           r0 r1 r2
    2  end
)"},
    {"not across a store", R"(
%x = LoadStorage 0, %a [0 0 1]
StoreStorage 0, %b, %x [0 1 1] {1}
%y = LoadStorage 0, %a [0 0 1 4]
StoreOutput FAdd(%x, %y)
)",
     R"(
registers 3, masks 0, uniform words 1 (1 constants)
code:
    0  load_storage   r0 ( r2 ) set 0 slot 0
    1  store_storage  r1 ( r2 ) set 0 slot 1
    2  load_storage   r0 ( r1 ) set 0 slot 0 +4
    3  FAdd           r0 r2 r1
    4  end
)"},
    {"not from another slot", R"(
%x = LoadStorage 0, %a [0 0 1]
%y = LoadStorage 0, %a [0 1 1 4]
StoreOutput FAdd(%x, %y)
)",
     R"(
registers 3, masks 0, uniform words 1 (1 constants)
code:
    0  load_storage   r0 ( r1 ) set 0 slot 0
    1  load_storage   r0 ( r2 ) set 0 slot 1 +4
    2  FAdd           r0 r1 r2
    3  end
)"},
};

TEST(CombineLoads, Loads) { check_lowered(kLoads); }

}  // namespace
}  // namespace vitrine::spirv::test
