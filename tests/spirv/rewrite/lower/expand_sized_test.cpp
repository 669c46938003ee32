// What operations on halves and doubles consist of (lavapipe-shader-math.md 6.6).
#include "tests/spirv/rewrite/pass_case.h"

namespace vitrine::spirv::test {
namespace {

constexpr PassCase kTakesThemApart[] = {
    {"a sum of halves is rounded", R"(
StoreOutput FAdd@16(%a, %b)
)",
     R"(
%0 = Half2F %a
%1 = Half2F %b
%2 = FAdd %0, %1
%3 = F2Half %2
StoreOutput %3
)"},
    {"a comparison of halves", R"(
%c:1b = FLt@16 %a, %b
StoreOutput Select(%c, %a, %b)
)",
     R"(
%0 = Half2F %a
%1 = Half2F %b
%2:1b = FLt %0, %1
%3 = Select %2, %a, %b
StoreOutput %3
)"},
    {"a product of doubles", R"(
%x:2 = Vec %a, %b
%s:2 = FMul@64 %x, %x
StoreStorage 0, 0, %s [0 0 1] {3}
)",
     R"(
%0:2 = Vec %a, %b
%1:2 = DMul %0.xx, %0.yy, %0.xx, %0.yy
StoreStorage 0, 0, %1 [0 0 1] {3 0}
)"},
    {"the sine of a half is the library's", R"(
StoreOutput FSin@16(%a)
)",
     R"(
%0 = Half2F %a
%1 = HSin %0
%2 = Vec %1
%3 = F2Half %2
StoreOutput %3
)"},
    {"floats", R"(
StoreOutput FAdd(%a, %b)
)"},
};

TEST(ExpandSized, TakesThemApart) { check_step("expand_sized", kTakesThemApart); }

}  // namespace
}  // namespace vitrine::spirv::test
