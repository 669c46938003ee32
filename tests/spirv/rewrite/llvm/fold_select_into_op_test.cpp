// Operations on one side of a branch (InstCombineSelect.cpp, foldSelectIntoOp).
#include "tests/spirv/rewrite/pass_case.h"

namespace vitrine::spirv::test {
namespace {

constexpr PassCase kSharedSelections[] = {
    {"two products with one factor", R"(
If FLt(%a, %b) -> %r %s
  StoreStorage 0, 0, %a [0 0 1] {1}
  Yield FMul(%c, %e), FMul(%d, %e)
Else
  Yield %c, %d
StoreOutput FAdd(%r, %s)
)",
     R"(
%0:1b = FLt %a, %b
If %0 -> %1 %2
  StoreStorage 0, 0, %a [0 0 1] {1 0}
  %3 = FMul %c, %e
  %4 = FMul %d, %e
  Yield %3, %4
Else
  %5 = FMul %c, 1.0
  %6 = FMul %d, 1.0
  Yield %5, %6
%7 = FAdd %1, %2
StoreOutput %7
)"},
    {"two products with two factors", R"(
If FLt(%a, %b) -> %r %s
  StoreStorage 0, 0, %a [0 0 1] {1}
  Yield FMul(%c, %e), FMul(%d, %f)
Else
  Yield %c, %d
StoreOutput FAdd(%r, %s)
)"},
};

TEST(FoldSelectIntoOp, SharedSelections) { check_step("fold_select_into_op", kSharedSelections); }

}  // namespace
}  // namespace vitrine::spirv::test
