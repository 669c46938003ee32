// Rows of the rule tables, one by one, where rewrite_test.cpp has them in the whole order (nir_search.c).
#include "tests/spirv/rewrite/pass_case.h"

namespace vitrine::spirv::test {
namespace {

constexpr PassCase kMainRules[] = {
    {"x + 0", R"(
StoreOutput FAdd(%a, 0.0)
)",
     R"(
StoreOutput %a
)"},
    {"a b + a c", R"(
StoreOutput FAdd(FMul(%a, %b), FMul(%a, %c))
)",
     R"(
%0 = FAdd %b, %c
%1 = FMul %a, %0
StoreOutput %1
)"},
    {"a b + b c: the factor stands elsewhere", R"(
StoreOutput FAdd(FMul(%a, %b), FMul(%b, %c))
)",
     R"(
%0 = FAdd %a, %c
%1 = FMul %b, %0
StoreOutput %1
)"},
    {"exact operations keep inexact rules away", R"(
StoreOutput FAdd!(FMul(%a, %b), FMul(%a, %c))
)"},
    {"though somebody else reads a product", R"(
%x = FMul %a, %b
StoreOutput FAdd(%x, FMul(%a, %c))
StoreOutput %x [1]
)",
     R"(
%0 = FMul %a, %b
%1 = FAdd %b, %c
%2 = FMul %a, %1
StoreOutput %2
StoreOutput %0 [1]
)"},
    {"-(-x)", R"(
StoreOutput FNeg(FNeg(%a))
)",
     R"(
StoreOutput %a
)"},
    {"x < y, negated", R"(
StoreOutput Select(NotB(ILt(%a, %b)), %a, %b)
)",
     R"(
%0:1b = ILt %a, %b
%1 = Select %0, %b, %a
StoreOutput %1
)"},
    {"x + y", R"(
StoreOutput FAdd(%a, %b)
)"},
};

TEST(OptAlgebraic, MainRules) { check_step("opt_algebraic", kMainRules); }

constexpr PassCase kLateRules[] = {
    {"a comparison of a sum with zero", R"(
StoreOutput Select(FLt(FAdd(%a, %b), 0.0), %a, %b)
)",
     R"(
%0 = FNeg %b
%1:1b = FLt %a, %0
%2 = Select %1, %a, %b
StoreOutput %2
)"},
    {"x + y", R"(
StoreOutput FAdd(%a, %b)
)"},
};

TEST(OptAlgebraic, LateRules) { check_step("opt_algebraic_late", kLateRules); }

constexpr PassCase kLowerOperations[] = {
    {"a remainder", R"(
StoreOutput FMod(%a, %b)
)",
     R"(
StoreOutput FSub(%a, FMul(%b, FFloor(FDiv(%a, %b))))
)"},
    {"x + y", R"(
StoreOutput FAdd(%a, %b)
)"},
};

TEST(OptAlgebraic, LowerOperations) { check_step("lower_operations", kLowerOperations); }

}  // namespace
}  // namespace vitrine::spirv::test
