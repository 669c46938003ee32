// Branches that leave (nir_opt_if.c: opt_if_loop_terminator, opt_if_loop_last_continue).
#include "tests/spirv/rewrite/pass_case.h"

namespace vitrine::spirv::test {
namespace {

constexpr PassCase kMovesCodeBehindBranchesThatLeave[] = {
    {"what stays need not be conditional", R"(
Loop params %i init 0 -> %n
  If IGe(%i, 4) -> %r
    Break %i
  Else
    StoreStorage 0, %i, %a [0 0 1] {1}
    Yield IAdd(%i, 1)
  Yield %r
Continuing %k
  Yield %k
StoreOutput %n
)",
     R"(
Loop params %0 init 0 -> %1
  %2:1b = IGe %0, 4
  If %2
    Break %0
  Else
    Yield
  StoreStorage 0, %0, %a [0 0 1] {1 0}
  %3 = IAdd %0, 1
  Yield %3
Continuing %4
  Yield %4
StoreOutput %1
)"},
    {"what follows a continue moves into the other side", R"(
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
)",
     R"(
Loop params %0 init 0 -> %1
  %2:1b = IGe %0, 4
  If %2
    Break %0
  Else
    Yield
  %3:1b = FLt %a, %b
  If %3 -> %4
    %5 = IAdd %0, 2
    Continue %5
  Else
    StoreStorage 0, %0, %a [0 0 1] {1 0}
    %6 = IAdd %0, 1
    Yield %6
  Yield %4
Continuing %7
  Yield %7
StoreOutput %1
)"},
    {"nothing leaves", R"(
If FLt(%a, %b)
  StoreStorage 0, 0, %a [0 0 1] {1}
  Yield
Else
  StoreStorage 0, 0, %b [0 0 1] {1}
  Yield
)"},
};

TEST(OptIf, MovesCodeBehindBranchesThatLeave) { check_step("opt_if", kMovesCodeBehindBranchesThatLeave); }

}  // namespace
}  // namespace vitrine::spirv::test
