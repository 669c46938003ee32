// Minima and maxima of numbers (lp_bld_nir.c, lp_bld_arit.c).
#include "tests/spirv/rewrite/pass_case.h"

namespace vitrine::spirv::test {
namespace {

constexpr PassCase kNumbersNeedNoTest[] = {
    {"a literal behind", R"(
StoreOutput FMin(%a, 1.0)
)",
     R"(
%0 = FMinPlain %a, 1.0
StoreOutput %0
)"},
    {"a literal in front changes places", R"(
StoreOutput FMax(1.0, %a)
)",
     R"(
%0 = FMaxPlain %a, 1.0
StoreOutput %0
)"},
    {"a number by its operation", R"(
StoreOutput FMin(%a, I2F(%b))
)",
     R"(
%0 = I2F %b
%1 = FMinPlain %a, %0
StoreOutput %1
)"},
    {"nothing is known", R"(
StoreOutput FMin(%a, %b)
)"},
};

TEST(ChooseMinMax, NumbersNeedNoTest) { check_step("choose_min_max", kNumbersNeedNoTest); }

}  // namespace
}  // namespace vitrine::spirv::test
