// What runs from the second iteration on becomes the continue construct.
#include "tests/spirv/rewrite/pass_case.h"

namespace vitrine::spirv::test {
namespace {

constexpr PassCase kBranchOnTheFirstIteration[] = {
    {"the increment at the top of the body", R"(
Loop params %i %first:1b init 0, true -> %n
  If %first -> %j
    Yield %i
  Else
    Yield IAdd(%i, 1)
  If IGe(%j, 4)
    Break %j
  Else
    Yield
  StoreStorage 0, %j, %a [0 0 1] {1}
  Yield %j, false
Continuing %k %l:1b
  Yield %k, %l
StoreOutput %n
)",
     R"(
Loop params %0 %1:1b %2 init 0, true, 0 -> %3
  %4:1b = IGe %2, 4
  If %4
    Break %2
  Else
    Yield
  StoreStorage 0, %2, %a [0 0 1] {1 0}
  Yield %2, false
Continuing %5 %6:1b
  %7 = IAdd %5, 1
  Yield %5, %6, %7
StoreOutput %3
)"},
    {"a branch on something else", R"(
Loop params %i init 0 -> %n
  If FLt(%a, %b) -> %j
    Yield %i
  Else
    Yield IAdd(%i, 1)
  If IGe(%j, 4)
    Break %j
  Else
    Yield
  StoreStorage 0, %j, %a [0 0 1] {1}
  Yield %j
Continuing %k
  Yield %k
StoreOutput %n
)"},
};

TEST(CloseContinues, BranchOnTheFirstIteration) { check_step("close_continues", kBranchOnTheFirstIteration); }

}  // namespace
}  // namespace vitrine::spirv::test
