// Mixes of halves (nir_lower_flrp.c).
#include "tests/spirv/rewrite/pass_case.h"

namespace vitrine::spirv::test {
namespace {

constexpr PassCase kTakesMixesOfHalvesApart[] = {
    {"x (1 - a) + y a", R"(
StoreOutput FLrp@16(%a, %b, %c)
)",
     R"(
%0 = FMul@16 %b, %c
%1 = FNeg@16 %c
%2 = FAdd@16 15360, %1
%3 = FMul@16 %a, %2
%4 = FAdd@16 %3, %0
StoreOutput %4
)"},
    {"between literals, x + a (y - x)", R"(
StoreOutput FLrp@16(15360, 16384, %c)
)",
     R"(
%0 = FNeg@16 15360
%1 = FAdd@16 16384, %0
%2 = FMul@16 %c, %1
%3 = FAdd@16 15360, %2
StoreOutput %3
)"},
    {"a plane", R"(
StoreOutput FFused(%a, %b, %c)
)"},
};

TEST(LowerFlrp, TakesMixesOfHalvesApart) { check_step("lower_flrp", kTakesMixesOfHalvesApart); }

}  // namespace
}  // namespace vitrine::spirv::test
