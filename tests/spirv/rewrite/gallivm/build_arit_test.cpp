// The shortcuts of the building blocks of arithmetic (lp_bld_arit.c).
#include "tests/spirv/rewrite/pass_case.h"

namespace vitrine::spirv::test {
namespace {

constexpr PassCase kTakesShortcuts[] = {
    {"0 + x", R"(
StoreOutput FAdd!(0.0, %a)
)",
     R"(
StoreOutput %a
)"},
    {"x + -0", R"(
StoreOutput FAdd!(%a, -0.0)
)",
     R"(
StoreOutput %a
)"},
    {"x * 1", R"(
StoreOutput FMul!(%a, 1.0)
)",
     R"(
StoreOutput %a
)"},
    {"0 * x", R"(
StoreOutput FMul!(0.0, %a)
)",
     R"(
StoreOutput 0
)"},
    {"0 / x", R"(
StoreOutput FDiv!(0.0, %a)
)",
     R"(
StoreOutput 0
)"},
    {"x / 1", R"(
StoreOutput FDiv!(%a, 1.0)
)",
     R"(
StoreOutput %a
)"},
    {"min(x, x)", R"(
StoreOutput FMin(%a, %a)
)",
     R"(
StoreOutput %a
)"},
    {"c ? x : x", R"(
StoreOutput Select(FLt(%a, %b), %a, %a)
)",
     R"(
StoreOutput %a
)"},
    {"a sum of literals", R"(
StoreOutput FMul(FAdd(1.0, 2.0), %a)
)",
     R"(
%0 = FMul 3.0, %a
StoreOutput %0
)"},
    {"x * 2", R"(
StoreOutput FMul(%a, 2.0)
)"},
    {"what a branch yields comes out of a register", R"(
If FLt(%a, %b) -> %r
  StoreStorage 0, 0, %a [0 0 1] {1}
  Yield 0.0
Else
  Yield 0.0
StoreOutput FAdd(%r, %a)
)"},
};

TEST(BuildArit, TakesShortcuts) { check_step("build_arit", kTakesShortcuts); }

}  // namespace
}  // namespace vitrine::spirv::test
