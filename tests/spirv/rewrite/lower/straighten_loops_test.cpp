// Loops in the form that the rewrites keep (spirv/rewrite/graph/loops.h).
#include "tests/spirv/rewrite/pass_case.h"

namespace vitrine::spirv::test {
namespace {

constexpr PassCase kPassWhatGoesRound[] = {
    {"the continue construct decides what the next iteration gets", R"(
Loop params %i %s init 0, %a -> %n
  If IGe(%i, 4)
    Break %s
  Else
    Yield
  If FLt(%s, %b)
    Continue IAdd(%i, 2)
  Else
    Yield
  Yield IAdd(%i, 1)
Continuing %k
  Yield %k, %a
StoreOutput %n
)",
     R"(
Loop params %0 %1 init 0, %a -> %2
  %3:1b = IGe %0, 4
  If %3
    Break %1
  Else
    Yield
  %4:1b = FLt %1, %b
  If %4
    %5 = IAdd %0, 2
    Continue %5, %a
  Else
    Yield
  %6 = IAdd %0, 1
  Yield %6, %a
Continuing %7 %8
  Yield %7, %8
StoreOutput %2
)"},
};

TEST(StraightenLoops, PassWhatGoesRound) { check_step("straighten_loops", kPassWhatGoesRound); }

}  // namespace
}  // namespace vitrine::spirv::test
