// Small branches as selections.
#include "tests/spirv/lower/lower_case.h"

namespace vitrine::spirv::test {
namespace {

constexpr LowerCase kBranches[] = {
    {"a small one without effects", R"(
If FLt(%a, %b) -> %r
  Yield FAdd(%a, 1.0)
Else
  Yield %b
StoreOutput %r
)",
     R"(
registers 2, masks 1, uniform words 1 (1 constants)
code:
    0  FLt            m0 r0 r1
    1  FAdd           r0 r0 u0
    2  Select         r0 m0 r0 r1
    3  end
)"},
    {"one that stores", R"(
If FLt(%a, %b)
  StoreStorage 0, 0, %a [0 0 1] {1}
  Yield
Else
  Yield
StoreOutput %a
)",
     R"(
registers 2, masks 2, uniform words 1 (1 constants)
code:
    0  FLt            m0 r0 r1
    1  if             m1 m0 -> 3
    2  store_storage  u0 ( r0 ) set 0 slot 0
    3  else           m1 -> 4
    4  endif          m1
    5  end
)"},
    {"on a constant", R"(
If true -> %r
  Yield FAdd(%a, 1.0)
Else
  Yield %b
StoreOutput %r
)",
     R"(
registers 1, masks 0, uniform words 1 (1 constants)
code:
    0  FAdd           r0 r0 u0
    1  end
)"},
};

TEST(ScalarizeControl, Branches) { check_lowered(kBranches); }

}  // namespace
}  // namespace vitrine::spirv::test
