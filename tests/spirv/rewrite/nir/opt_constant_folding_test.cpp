// Operations on constants (nir_opt_constant_folding.c).
#include "tests/spirv/rewrite/pass_case.h"

namespace vitrine::spirv::test {
namespace {

constexpr PassCase kEvaluates[] = {
    {"a sum", R"(
StoreOutput FAdd(1.5, 2.0)
)",
     R"(
StoreOutput 3.5
)"},
    {"what follows from it, in the same walk", R"(
StoreOutput FMul(FAdd(1.5, 2.0), -2.0)
)",
     R"(
StoreOutput -7.0
)"},
    {"a quotient by zero is infinite", R"(
StoreOutput FDiv(1.0, 0.0)
)",
     R"(
StoreOutput 0x7f800000
)"},
    {"integers wrap", R"(
StoreOutput IMul(65537, 65537)
)",
     R"(
StoreOutput 0x20001
)"},
    {"an unsigned division by zero is zero", R"(
StoreOutput UDiv(7, 0)
)",
     R"(
StoreOutput 0
)"},
    {"a shift takes five bits", R"(
StoreOutput Shl(1, 33)
)",
     R"(
StoreOutput 2
)"},
    {"a comparison", R"(
StoreOutput Select(FLt(1.0, 2.0), %a, %b)
)",
     R"(
%0 = Select true, %a, %b
StoreOutput %0
)"},
    {"a selection by a literal", R"(
StoreOutput Select(true, 3.0, 4.0)
)",
     R"(
StoreOutput 3.0
)"},
    {"a vector, component by component", R"(
%v:2 = Const 1.0 2.0
%s:2 = FAdd %v, %v.yx
StoreStorage 0, 0, %s [0 1 1] {3}
)",
     R"(
%0:2 = Const 0x40400000 0x40400000
StoreStorage 0, 0, %0 [0 1 1] {3 0}
)"},
    {"an operand that is not literal", R"(
StoreOutput FMul(%a, 0.0)
)"},
};

TEST(OptConstantFolding, Evaluates) { check_step("opt_constant_folding", kEvaluates); }

}  // namespace
}  // namespace vitrine::spirv::test
