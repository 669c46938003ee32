// Selections with a literal side (DAGCombiner.cpp, foldSelectWithIdentityConstant).
#include "tests/spirv/rewrite/pass_case.h"

namespace vitrine::spirv::test {
namespace {

constexpr PassCase kOperationsMoveIntoSelections[] = {
    {"x * (c ? y : 1)", R"(
StoreOutput FMul(%a, Select(FLt(%b, %c), %d, 1.0))
)",
     R"(
%0:1b = FLt %b, %c
%1 = FMul %a, %d
%2 = Select %0, %1, %a
StoreOutput %2
)"},
    {"x + (c ? y : -0)", R"(
StoreOutput FAdd(%a, Select(FLt(%b, %c), %d, -0.0))
)",
     R"(
%0:1b = FLt %b, %c
%1 = FAdd %a, %d
%2 = Select %0, %1, %a
StoreOutput %2
)"},
    {"the selection has another reader", R"(
%s = Select FLt(%b, %c), %d, 1.0
StoreOutput FMul(%a, %s)
StoreOutput %s [1]
)"},
    {"x * (c ? y : z)", R"(
StoreOutput FMul(%a, Select(FLt(%b, %c), %d, %e))
)"},
};

TEST(FoldSelectWithIdentity, OperationsMoveIntoSelections) {
  check_step("fold_select_with_identity", kOperationsMoveIntoSelections);
}

}  // namespace
}  // namespace vitrine::spirv::test
