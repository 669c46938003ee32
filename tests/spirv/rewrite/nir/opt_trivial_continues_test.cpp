// Continues at the end of a loop (nir_opt_trivial_continues.c).
#include "tests/spirv/rewrite/pass_case.h"

namespace vitrine::spirv::test {
namespace {

constexpr PassCase kBecomeTheWayThere[] = {
    {"at the end of the last branch", R"(
Loop params %i init 0 -> %n
  If IGe(%i, 4)
    Break %i
  Else
    Yield
  %j = IAdd %i, 1
  If FLt(%a, %b)
    Continue IAdd(%i, 2)
  Else
    Yield
  Yield %j
Continuing %k
  Yield %k
StoreOutput %n
)",
     R"(
%0 = Mov 0
Loop params %1 init %0 -> %2
  %3:1b = IGe %1, 4
  If %3
    Break %1
  Else
    Yield
  %4 = IAdd %1, 1
  %5:1b = FLt %a, %b
  If %5 -> %6
    %7 = IAdd %1, 2
    Yield %7
  Else
    Yield %4
  %8 = Mov %6
  Yield %8
Continuing %9
  Yield %9
StoreOutput %2
)"},
    {"at the end of the body", R"(
Loop params %i init 0 -> %n
  If IGe(%i, 4)
    Break %i
  Else
    Yield
  Continue IAdd(%i, 2)
Continuing %k
  Yield %k
StoreOutput %n
)",
     R"(
%0 = Mov 0
Loop params %1 init %0 -> %2
  %3:1b = IGe %1, 4
  If %3
    Break %1
  Else
    Yield
  %4 = IAdd %1, 2
  %5 = Mov %4
  Yield %5
Continuing %6
  Yield %6
StoreOutput %2
)"},
    {"not with code behind it", R"(
Loop params %i init 0 -> %n
  If IGe(%i, 4)
    Break %i
  Else
    Yield
  If FLt(%a, %b)
    Continue IAdd(%i, 2)
  Else
    Yield
  StoreStorage 0, %i, %a [0 0 1] {1}
  Yield IAdd(%i, 1)
Continuing %k
  Yield %k
StoreOutput %n
)"},
};

TEST(OptTrivialContinues, BecomeTheWayThere) {
  check_step([](Graph& graph) { return graph.first_round = false, rewriting::opt_trivial_continues(graph); },
             kBecomeTheWayThere);
}

}  // namespace
}  // namespace vitrine::spirv::test
