// Literals that only the optimiser finds (InstructionSimplify.cpp, InstCombine).
#include "tests/spirv/rewrite/pass_case.h"

namespace vitrine::spirv::test {
namespace {

constexpr PassCase kFindsLiterals[] = {
    {"a quotient of a number that is smaller than the divisor", R"(
StoreOutput UDiv(And(%a, 7), 8)
)",
     R"(
StoreOutput 0
)"},
    {"0 / x", R"(
StoreOutput IDiv(0, %a)
)",
     R"(
StoreOutput 0
)"},
    {"x == y or x != y", R"(
StoreOutput Select(OrB(FEq(%a, %b), FNeu(%a, %b)), %a, %b)
)",
     R"(
%0 = Mov %a
StoreOutput %0
)"},
    {"a comparison that known bits decide", R"(
StoreOutput Select(ULt(And(%a, 7), 8), %a, %b)
)",
     R"(
%0 = Mov %a
StoreOutput %0
)"},
    {"what follows from a literal found late", R"(
StoreOutput IAdd(%b, UDiv(And(%a, 7), 8))
)",
     R"(
%0 = Mov %b
StoreOutput %0
)"},
    {"a quotient that may be anything", R"(
StoreOutput UDiv(And(%a, 15), 8)
)"},
    {"x * 1 without a literal found late", R"(
StoreOutput FMul(%a, 1.0)
)"},
};

TEST(InstSimplify, FindsLiterals) { check_step("inst_simplify", kFindsLiterals); }

}  // namespace
}  // namespace vitrine::spirv::test
