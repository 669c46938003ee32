// Conversions on a CPU without AVX-512 (X86ISelLowering.cpp). CTest runs this with VITRINE_REFERENCE_CPU=avx2, too.
#include "base/reference_cpu.h"
#include "tests/spirv/rewrite/pass_case.h"

namespace vitrine::spirv::test {
namespace {

constexpr PassCase kConvertsInSteps[] = {
    {"a float to an unsigned integer", R"(
StoreOutput IAdd(F2U(%a), 1)
)",
     R"(
%0 = F2I %a
%1 = FAdd %a, -2147483648.0
%2 = F2I %1
%3 = IShr %0, 31
%4 = And %2, %3
%5 = Or %0, %4
%6 = IAdd %5, 1
StoreOutput %6
)"},
    {"of which only the store wants to know", R"(
StoreStorage 0, 0, F2U(%a) [0 0 1] {1}
)",
     R"(
%0:2 = LFromF %a
StoreStorage 0, 0, %0.xx [0 0 1] {1 0}
)"},
    {"a float to a signed integer", R"(
StoreOutput IAdd(F2I(%a), 1)
)"},
};

TEST(LowerWithoutAvx512, ConvertsInSteps) {
  if (!base::reference_lacks_avx512()) GTEST_SKIP() << "needs VITRINE_REFERENCE_CPU=avx2";
  check_step("lower_without_avx512", kConvertsInSteps);
}

TEST(LowerWithoutAvx512, DoesNothingWithIt) {
  if (base::reference_lacks_avx512()) GTEST_SKIP() << "VITRINE_REFERENCE_CPU=avx2";
  for (const PassCase& row : kConvertsInSteps) check_step("lower_without_avx512", {{{row.why, row.in}}});
}

}  // namespace
}  // namespace vitrine::spirv::test
