// Arithmetic on parameters of loops (nir_opt_if.c: opt_split_alu_of_phi, opt_simplify_bcsel_of_phi).
#include "spirv/rewrite/nir/opt_if.h"
#include "tests/spirv/rewrite/pass_case.h"

namespace vitrine::spirv::test {
namespace {

constexpr PassCase kSplitAluOfPhi[] = {
    {"a sum that is literal in front of the loop", R"(
%three = Const 3
Loop params %i init 0 -> %n
  %j = IAdd %i, %three
  If IGe(%j, 9)
    Break %j
  Else
    Yield
  StoreStorage 0, %j, %a [0 0 1] {1}
  Yield IAdd(%i, 1)
Continuing %k
  Yield %k
StoreOutput %n
)",
     R"(
%0 = IAdd 0, 3
Loop params %1 %2 init 0, %0 -> %3
  %4:1b = IGe %2, 9
  If %4
    Break %2
  Else
    Yield
  StoreStorage 0, %2, %a [0 0 1] {1 0}
  %5 = IAdd %1, 1
  %6 = IAdd %5, 3
  Yield %5, %6
Continuing %7 %8
  Yield %7, %8
StoreOutput %3
)"},
    {"the first value is not literal", R"(
%three = Const 3
Loop params %i init %b -> %n
  %j = IAdd %i, %three
  If IGe(%j, 9)
    Break %j
  Else
    Yield
  StoreStorage 0, %j, %a [0 0 1] {1}
  Yield IAdd(%i, 1)
Continuing %k
  Yield %k
StoreOutput %n
)"},
};

TEST(OptIfPhi, SplitAluOfPhi) { check_step(each_loop(rewriting::opt_split_alu_of_phi), kSplitAluOfPhi); }

constexpr PassCase kSimplifyBcselOfPhi[] = {
    {"the first iteration takes one value, all others the other", R"(
Loop params %first:1b %x %y init true, %a, %b -> %n
  %s = Select %first, %x, %y
  If FLt(%s, 9.0)
    Yield
  Else
    Break %s
  %t = FMul %s, 2.0
  Yield false, %x, %t
Continuing %k:1b %l %m
  Yield %k, %l, %m
StoreOutput %n
)",
     R"(
Loop params %0 init %a -> %1
  %2:1b = FLt %0, 9.0
  If %2
    Yield
  Else
    Break %0
  %3 = FMul %0, 2.0
  Yield %3
Continuing %4
  Yield %4
StoreOutput %1
)"},
    {"every iteration takes the same", R"(
Loop params %first:1b %x %y init true, %a, %b -> %n
  %s = Select %first, %x, %y
  If FLt(%s, 9.0)
    Yield
  Else
    Break %s
  %t = FMul %s, 2.0
  Yield true, %t, %t
Continuing %k:1b %l %m
  Yield %k, %l, %m
StoreOutput %n
)"},
};

TEST(OptIfPhi, SimplifyBcselOfPhi) { check_step(each_loop(rewriting::opt_simplify_bcsel_of_phi), kSimplifyBcselOfPhi); }

}  // namespace
}  // namespace vitrine::spirv::test
