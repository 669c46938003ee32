// Mixes (nir_lower_flrp.c): those of 32 and 64 bits in the beginning, those of halves where the rounds end.
#include "tests/spirv/rewrite/pass_case.h"

namespace vitrine::spirv::test {
namespace {

constexpr PassCase kTakesMixesApart[] = {
    {"x (1 - a) + y a", R"(
StoreOutput FLrp(%a, %b, %c)
)",
     R"(
%0 = FNeg %c
%1 = FAdd 1.0, %0
%2 = FMul %a, %1
%3 = FMul %b, %c
%4 = FAdd %2, %3
StoreOutput %4
)"},
    {"between literals of similar sizes, x + a (y - x)", R"(
StoreOutput FLrp(0.5, 1000.0, %c)
)",
     R"(
%0 = FNeg 0.5
%1 = FAdd 1000.0, %0
%2 = FMul %c, %1
%3 = FAdd 0.5, %2
StoreOutput %3
)"},
    {"between literals of sizes too different", R"(
StoreOutput FLrp(0.5, 3000.0, %c)
)",
     R"(
%0 = FNeg %c
%1 = FAdd 1.0, %0
%2 = FMul 0.5, %1
%3 = FMul 3000.0, %c
%4 = FAdd %2, %3
StoreOutput %4
)"},
    {"precise between literals", R"(
StoreOutput FLrp!(0.5, 3.0, %c)
)",
     R"(
%0 = FNeg! %c
%1 = FAdd! 1.0, %0
%2 = FMul! 0.5, %1
%3 = FMul! 3.0, %c
%4 = FAdd! %2, %3
StoreOutput %4
)"},
    {"from 1, (1 - a) + y a", R"(
StoreOutput FLrp(1.0, %b, %c)
)",
     R"(
%0 = FMul %b, %c
%1 = FNeg %c
%2 = FAdd 1.0, %1
%3 = FAdd %2, %0
StoreOutput %3
)"},
    {"from -1, (-1 + a) + y a", R"(
StoreOutput FLrp(-1.0, %b, %c)
)",
     R"(
%0 = FMul %b, %c
%1 = FAdd -1.0, %c
%2 = FAdd %1, %0
StoreOutput %2
)"},
    {"of a vector from 1 in one component only", R"(
%x:2 = Const 1.0 2.0
%v:2 = Vec %a, %b
%m:2 = FLrp %x, %v, %v
StoreOutput %m.y
)",
     R"(
%0:2 = Const 1.0 2.0
%1:2 = Vec %a, %b
%2:2 = FNeg %1
%3:2 = FAdd 1.0.xx, %2
%4:2 = FMul %0, %3
%5:2 = FMul %1, %1
%6:2 = FAdd %4, %5
StoreOutput %6.y
)"},
    {"of doubles between literals, whose sizes may differ more", R"(
%x:2 = Const 0 0x3fe00000
%y:2 = Const 0 0x40a77000
%w:2 = Vec %a, %b
%m:2 = FLrp@64 %x, %y, %w
StoreStorage 0, 0, %m [0 0 1] {3}
)",
     R"(
%0:2 = Const 0 0x3fe00000
%1:2 = Const 0 0x40a77000
%2:2 = Vec %a, %b
%3:2 = FNeg@64 %0
%4:2 = FAdd@64 %1, %3
%5:2 = FMul@64 %2, %4
%6:2 = FAdd@64 %0, %5
StoreStorage 0, 0, %6 [0 0 1] {3}
)"},
    {"a half", R"(
StoreOutput FLrp@16(%a, %b, %c)
)"},
};

TEST(LowerFlrp, TakesMixesApartButForHalves) { check_step("lower_flrp_but_half", kTakesMixesApart); }

constexpr PassCase kTakesMixesOfHalvesApart[] = {
    {"x (1 - a) + y a", R"(
StoreOutput FLrp@16(%a, %b, %c)
)",
     R"(
%0 = FNeg@16 %c
%1 = FAdd@16 15360, %0
%2 = FMul@16 %a, %1
%3 = FMul@16 %b, %c
%4 = FAdd@16 %2, %3
StoreOutput %4
)"},
    {"between literals of any sizes, x + a (y - x)", R"(
StoreOutput FLrp@16(1, 31743, %c)
)",
     R"(
%0 = FNeg@16 1
%1 = FAdd@16 31743, %0
%2 = FMul@16 %c, %1
%3 = FAdd@16 1, %2
StoreOutput %3
)"},
    {"between 0 and another literal", R"(
StoreOutput FLrp@16(0, 16384, %c)
)",
     R"(
%0 = FNeg@16 %c
%1 = FAdd@16 15360, %0
%2 = FMul@16 0, %1
%3 = FMul@16 16384, %c
%4 = FAdd@16 %2, %3
StoreOutput %4
)"},
    {"from 1 as from any other number", R"(
StoreOutput FLrp@16(15360, %b, %c)
)",
     R"(
%0 = FNeg@16 %c
%1 = FAdd@16 15360, %0
%2 = FMul@16 15360, %1
%3 = FMul@16 %b, %c
%4 = FAdd@16 %2, %3
StoreOutput %4
)"},
    {"a plane", R"(
StoreOutput FFused(%a, %b, %c)
)"},
};

TEST(LowerFlrp, TakesMixesOfHalvesApart) { check_step("lower_flrp", kTakesMixesOfHalvesApart); }

}  // namespace
}  // namespace vitrine::spirv::test
