// Equal bits, fewer instructions.
#include "tests/spirv/rewrite/pass_case.h"

namespace vitrine::spirv::test {
namespace {

constexpr PassCase kSpells[] = {
    {"a + -b", R"(
StoreOutput FAdd(%a, FNeg(%b))
)",
     R"(
%0 = FSub %a, %b
StoreOutput %0
)"},
    {"-a + b", R"(
StoreOutput IAdd(INeg(%a), %b)
)",
     R"(
%0 = ISub %b, %a
StoreOutput %0
)"},
    {"(a >> b) & 15", R"(
StoreOutput And(UShr(%a, %b), 15)
)",
     R"(
%0 = BfeU %a, %b, 4
StoreOutput %0
)"},
    {"(a >> b) & 5", R"(
StoreOutput And(UShr(%a, %b), 5)
)"},
    {"a + b", R"(
StoreOutput FAdd(%a, %b)
)"},
};

TEST(ChooseSpelling, Spells) { check_step("choose_spelling", kSpells); }

}  // namespace
}  // namespace vitrine::spirv::test
