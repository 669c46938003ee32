// What a branch knows of its condition (nir_opt_if.c, opt_if_safe_cf_list).
#include "tests/spirv/rewrite/pass_case.h"

namespace vitrine::spirv::test {
namespace {

constexpr PassCase kKnowsTheCondition[] = {
    {"the condition itself on both sides", R"(
%c = FLt %a, %b
If %c -> %r
  Yield Select(%c, 1.0, %a)
Else
  Yield Select(%c, 2.0, %b)
StoreOutput %r
)",
     R"(
%0:1b = FLt %a, %b
If %0 -> %1
  %2 = Select true, 1.0, %a
  Yield %2
Else
  %3 = Select false, 2.0, %b
  Yield %3
StoreOutput %1
)"},
    {"behind a branch of which one side leaves", R"(
Loop params %i init 0 -> %n
  %c = IGe %i, 4
  If %c
    Break %i
  Else
    Yield
  Yield Select(%c, 7, IAdd(%i, 1))
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
  %3 = IAdd %0, 1
  %4 = Select false, 7, %3
  Yield %4
Continuing %5
  Yield %5
StoreOutput %1
)"},
    {"an operation on it that is read inside", R"(
%c = FLt %a, %b
%d = NotB %c
If %c -> %r
  Yield Select(%d, 1.0, %a)
Else
  Yield %b
StoreOutput %r
)",
     R"(
%0:1b = FLt %a, %b
If %0 -> %1
  %2:1b = NotB true
  %3 = Select %2, 1.0, %a
  Yield %3
Else
  Yield %b
StoreOutput %1
)"},
    {"a number that equals a literal there", R"(
If IEq(%a, 3) -> %r
  Yield IAdd(%a, %b)
Else
  Yield IMul(%a, %b)
StoreOutput %r
)",
     R"(
%0:1b = IEq %a, 3
If %0 -> %1
  %2 = IAdd 3, %b
  Yield %2
Else
  %3 = IMul %a, %b
  Yield %3
StoreOutput %1
)"},
    {"a number that differs from a literal on the other side", R"(
If INe(%a, 3) -> %r
  Yield IAdd(%a, %b)
Else
  Yield IMul(%a, %b)
StoreOutput %r
)",
     R"(
%0:1b = INe %a, 3
If %0 -> %1
  %2 = IAdd %a, %b
  Yield %2
Else
  %3 = IMul 3, %b
  Yield %3
StoreOutput %1
)"},
    {"floats that equal a literal may be a zero of the other sign", R"(
If FEq(%a, 3.0) -> %r
  Yield FAdd(%a, %b)
Else
  Yield FMul(%a, %b)
StoreOutput %r
)"},
    {"behind a branch of which both sides go on", R"(
%c = FLt %a, %b
If %c -> %r
  Yield 1.0
Else
  Yield 2.0
StoreOutput Select(%c, %r, %a)
)"},
};

TEST(OptIfSafe, KnowsTheCondition) { check_step("opt_if_safe", kKnowsTheCondition); }

}  // namespace
}  // namespace vitrine::spirv::test
