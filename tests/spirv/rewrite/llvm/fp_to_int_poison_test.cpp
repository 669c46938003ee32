// Integers of what is no number (ConstantFolding.cpp, InstructionSimplify.cpp).
#include "tests/spirv/rewrite/pass_case.h"

namespace vitrine::spirv::test {
namespace {

constexpr PassCase kSinesOfNoNumbers[] = {
    {"the integer of a sine", R"(
StoreOutput F2I(FSin(%a))
)",
     R"(
%0 = FSin %a
%1 = FMinPlain %0, 1.0
%2 = F2I %1
StoreOutput %2
)"},
    {"of a cosine times a literal", R"(
StoreOutput F2U(FMul(FCos(%a), 100.0))
)",
     R"(
%0 = FCos %a
%1 = FMinPlain %0, 1.0
%2 = FMul %1, 100.0
%3 = F2U %2
StoreOutput %3
)"},
    {"of a sine times what is not literal", R"(
StoreOutput F2I(FMul(FSin(%a), %b))
)"},
    {"of a sine that somebody else reads", R"(
%x = FSin %a
StoreOutput F2I(%x)
StoreOutput %x [1]
)"},
};

TEST(FoldFpToIntPoison, SinesOfNoNumbers) { check_step("fold_fp_to_int_poison", kSinesOfNoNumbers); }

}  // namespace
}  // namespace vitrine::spirv::test
