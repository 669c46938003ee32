// Which branches become selections (nir_opt_peephole_select.c).
#include "tests/spirv/rewrite/pass_case.h"

namespace vitrine::spirv::test {
namespace {

constexpr PassCase kFlattensSmallBranches[] = {
    {"one operation on each side", R"(
If FLt(%a, %b) -> %r
  Yield FAdd(%a, 1.0)
Else
  Yield FMul(%b, 2.0)
StoreOutput %r
)",
     R"(
%0:1b = FLt %a, %b
%1 = FAdd %a, 1.0
%2 = FMul %b, 2.0
%3 = Select %0, %1, %2
StoreOutput %3
)"},
    {"eight operations", R"(
If FLt(%a, %b) -> %r
  Yield FAdd(FAdd(FAdd(FAdd(FAdd(FAdd(FAdd(FAdd(%a, %b), %b), %b), %b), %b), %b), %b), %b)
Else
  Yield %a
StoreOutput %r
)",
     R"(
%0:1b = FLt %a, %b
%1 = FAdd %a, %b
%2 = FAdd %1, %b
%3 = FAdd %2, %b
%4 = FAdd %3, %b
%5 = FAdd %4, %b
%6 = FAdd %5, %b
%7 = FAdd %6, %b
%8 = FAdd %7, %b
%9 = Select %0, %8, %a
StoreOutput %9
)"},
    {"nine operations", R"(
If FLt(%a, %b) -> %r
  Yield FAdd(FAdd(FAdd(FAdd(FAdd(FAdd(FAdd(FAdd(FAdd(%a, %b), %b), %b), %b), %b), %b), %b), %b), %b)
Else
  Yield %a
StoreOutput %r
)"},
    {"negations count nothing", R"(
If FLt(%a, %b) -> %r
  Yield FNeg(FAdd(FAdd(FAdd(FAdd(FAdd(FAdd(FAdd(FAdd(FNeg(%a), %b), %b), %b), %b), %b), %b), %b), %b))
Else
  Yield %a
StoreOutput %r
)",
     R"(
%0:1b = FLt %a, %b
%1 = FNeg %a
%2 = FAdd %1, %b
%3 = FAdd %2, %b
%4 = FAdd %3, %b
%5 = FAdd %4, %b
%6 = FAdd %5, %b
%7 = FAdd %6, %b
%8 = FAdd %7, %b
%9 = FAdd %8, %b
%10 = FNeg %9
%11 = Select %0, %10, %a
StoreOutput %11
)"},
    {"the inner branch lets the outer one follow", R"(
If FLt(%a, %b) -> %r
  If FLt(%a, 0.0) -> %s
    Yield 1.0
  Else
    Yield 2.0
  Yield %s
Else
  Yield %a
StoreOutput %r
)",
     R"(
%0:1b = FLt %a, %b
%1:1b = FLt %a, 0
%2 = Select %1, 1.0, 2.0
%3 = Select %0, %2, %a
StoreOutput %3
)"},
    {"a branch in a branch, both with one side only, is a branch on both", R"(
If FLt(%a, %b)
  If FLt(%a, 0.0)
    StoreStorage 0, 0, %a [0 0 1] {1}
    Yield
  Else
    Yield
  Yield
Else
  Yield
)",
     R"(
%0:1b = FLt %a, %b
%1:1b = FLt %a, 0
%2:1b = AndB %1, %0
If %2
  StoreStorage 0, 0, %a [0 0 1] {1 0}
  Yield
Else
  Yield
)"},
    {"a store must stay conditional", R"(
If FLt(%a, %b)
  StoreStorage 0, 0, %a [0 0 1] {1}
  Yield
Else
  Yield
)"},
    {"so must a load", R"(
If FLt(%a, %b) -> %r
  %x = LoadStorage 0, 0 [0 0 1]
  Yield %x
Else
  Yield %a
StoreOutput %r
)"},
};

TEST(OptPeepholeSelect, FlattensSmallBranches) { check_step("opt_peephole_select", kFlattensSmallBranches); }

}  // namespace
}  // namespace vitrine::spirv::test
