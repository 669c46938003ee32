// Which instructions are one (nir_opt_cse.c, nir_instr_set.c).
#include "tests/spirv/rewrite/pass_case.h"

namespace vitrine::spirv::test {
namespace {

constexpr PassCase kMergesEqualInstructions[] = {
    {"the same operation on the same values", R"(
%x = FAdd %a, %b
%y = FAdd %a, %b
StoreOutput FSub(%x, %y)
)",
     R"(
%0 = FAdd %a, %b
%1 = FSub %0, %0
StoreOutput %1
)"},
    {"operands of a sum in another order", R"(
%x = FAdd %a, %b
%y = FAdd %b, %a
StoreOutput FSub(%x, %y)
)",
     R"(
%0 = FAdd %a, %b
%1 = FSub %0, %0
StoreOutput %1
)"},
    {"one in a branch, and one before it", R"(
%x = FMul %a, %b
If FLt(%a, %x) -> %r
  Yield FAdd(FMul(%a, %b), 1.0)
Else
  Yield %x
StoreOutput %r
)",
     R"(
%0 = FMul %a, %b
%1:1b = FLt %a, %0
If %1 -> %2
  %3 = FAdd %0, 1.0
  Yield %3
Else
  Yield %0
StoreOutput %2
)"},
    {"an exact one and an inexact one", R"(
%x = FAdd %a, %b
%y = FAdd! %a, %b
StoreOutput FSub(%x, %y)
)",
     R"(
%0 = FAdd! %a, %b
%1 = FSub %0, %0
StoreOutput %1
)"},
    {"loads of a push constant", R"(
%x = LoadPush 4
%y = LoadPush 4
StoreOutput FSub(%x, %y)
)",
     R"(
%0 = LoadPush 4
%1 = FSub %0, %0
StoreOutput %1
)"},
    {"neither side of a branch is before the other", R"(
If FLt(%a, %b) -> %r
  Yield FAdd(FMul(%a, %b), 1.0)
Else
  Yield FMul(%a, %b)
StoreOutput %r
)"},
    {"the operands of a difference in another order", R"(
%x = FSub %a, %b
%y = FSub %b, %a
StoreOutput FAdd(%x, %y)
)"},
    {"an atomic operation happens each time", R"(
%z = Const 0
%one = Const 1
%x = AtomicStorage %z, %z, %one [0 0 1]
%y = AtomicStorage %z, %z, %one [0 0 1]
StoreOutput IAdd(%x, %y)
)"},
};

TEST(OptCse, MergesEqualInstructions) { check_step("opt_cse", kMergesEqualInstructions); }

constexpr PassCase kButPushConstants[] = {
    {"other loads", R"(
%x = LoadUniform 0, 4 [0 0 1]
%y = LoadUniform 0, 4 [0 0 1]
StoreOutput FSub(%x, %y)
)",
     R"(
%0 = LoadUniform 0, 4 [0 0 1]
%1 = FSub %0, %0
StoreOutput %1
)"},
    {"loads of a push constant, which are variables in the rounds", R"(
%o = Const 4
%x = LoadPush %o
%y = LoadPush %o
StoreOutput FSub(%x, %y)
)"},
};

TEST(OptCse, ButPushConstants) { check_step("opt_cse_but_push", kButPushConstants); }

}  // namespace
}  // namespace vitrine::spirv::test
