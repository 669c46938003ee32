// Which loops are unrolled (nir_opt_loop_unroll.c, nir_loop_analyze.c).
#include "tests/spirv/rewrite/pass_case.h"

namespace vitrine::spirv::test {
namespace {

constexpr PassCase kUnrollsCountedLoops[] = {
    {"two iterations", R"(
Loop params %i %s init 0, %a -> %n
  If IGe(%i, 2)
    Break %s
  Else
    Yield
  Yield IAdd(%i, 1), FMul(%s, %b)
Continuing %k %l
  Yield %k, %l
StoreOutput %n
)",
     R"(
%0 = Mov %a
%1 = FMul %0, %b
%2 = Mov %1
%3 = FMul %2, %b
%4 = Mov %3
%5 = Mov %4
StoreOutput %5
)"},
    {"a number of iterations that is not literal", R"(
Loop params %i %s init 0, %a -> %n
  If IGe(%i, %c)
    Break %s
  Else
    Yield
  Yield IAdd(%i, 1), FMul(%s, %b)
Continuing %k %l
  Yield %k, %l
StoreOutput %n
)"},
    {"33 iterations", R"(
Loop params %i %s init 0, %a -> %n
  If IGe(%i, 33)
    Break %s
  Else
    Yield
  Yield IAdd(%i, 1), FMul(%s, %b)
Continuing %k %l
  Yield %k, %l
StoreOutput %n
)"},
};

TEST(OptLoopUnroll, UnrollsCountedLoops) { check_step("opt_loop_unroll", kUnrollsCountedLoops); }

}  // namespace
}  // namespace vitrine::spirv::test
