// Sums of several numbers become additions (lp_bld_nir.c).
#include "tests/spirv/rewrite/pass_case.h"

namespace vitrine::spirv::test {
namespace {

constexpr PassCase kSums[] = {
    {"of three, in the order of the components", R"(
%v:3 = Vec %a, %b, %c
StoreOutput FSum3!(%v)
)",
     R"(
StoreOutput FAdd!(FAdd!(%a, %b), %c)
)"},
    {"of four literals", R"(
%v:4 = Vec 1.0, 2.0, 3.0, 4.0
StoreOutput FSum4(%v)
)",
     R"(
StoreOutput 10.0
)"},
    {"within a sum of doubles", R"(
StoreOutput FAddInSum(%a, %b)
)",
     R"(
StoreOutput FAdd(%a, %b)
)"},
    {"additions", R"(
StoreOutput FAdd(FAdd(%a, %b), %c)
)"},
};

TEST(BuildSums, AddInOrder) { check_step("build_sums", kSums); }

}  // namespace
}  // namespace vitrine::spirv::test
