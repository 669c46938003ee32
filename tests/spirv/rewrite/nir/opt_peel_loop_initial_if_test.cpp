// A branch that only the first iteration decides (nir_opt_if.c, opt_peel_loop_initial_if).
#include "spirv/rewrite/nir/opt_if.h"
#include "tests/spirv/rewrite/pass_case.h"

namespace vitrine::spirv::test {
namespace {

constexpr PassCase kPeels[] = {
    {"true at first, false later", R"(
Loop params %i %first:1b init 0, true -> %n
  If %first -> %r
    Yield FAdd(%a, 1.0)
  Else
    Yield FMul(%a, 2.0)
  StoreStorage 0, %i, %r [0 0 1] {1}
  If IGe(%i, 4)
    Break %i
  Else
    Yield
  Yield IAdd(%i, 1), false
Continuing %k %l:1b
  Yield %k, %l
StoreOutput %n
)",
     R"(
%0 = Mov 0
%1 = Mov %0
%2 = FAdd %a, 1.0
%3 = Mov %2
Loop params %4 %5 init %1, %3 -> %6
  StoreStorage 0, %4, %5 [0 0 1] {1 0}
  %7:1b = IGe %4, 4
  If %7
    Break %4
  Else
    Yield
  %8 = IAdd %4, 1
  %9 = Mov %8
  %10 = Mov %9
  %11 = FMul %a, 2.0
  %12 = Mov %11
  Yield %10, %12
Continuing %13 %14
  Yield %13, %14
StoreOutput %6
)"},
    {"always true", R"(
Loop params %i %first:1b init 0, true -> %n
  If %first -> %r
    Yield FAdd(%a, 1.0)
  Else
    Yield FMul(%a, 2.0)
  StoreStorage 0, %i, %r [0 0 1] {1}
  If IGe(%i, 4)
    Break %i
  Else
    Yield
  Yield IAdd(%i, 1), true
Continuing %k %l:1b
  Yield %k, %l
StoreOutput %n
)"},
};

TEST(OptPeelLoopInitialIf, Peels) { check_step(each_loop(rewriting::opt_peel_loop_initial_if), kPeels); }

}  // namespace
}  // namespace vitrine::spirv::test
