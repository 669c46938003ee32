// Comparisons of converted floats (nir_opt_algebraic.py).
#include "tests/spirv/rewrite/pass_case.h"

namespace vitrine::spirv::test {
namespace {

constexpr PassCase kCompareWhatWasConverted[] = {
    {"doubles that were floats", R"(
%x:2 = DFromF %a
%y:2 = DFromF %b
%c:1b = FLt@64 %x, %y
StoreOutput Select(%c, %a, %b)
)",
     R"(
%0:1b = FLt %a, %b
%1 = Select %0, %a, %b
StoreOutput %1
)"},
    {"floats that were halves", R"(
StoreOutput Select(FLt(Half2F(%a), Half2F(%b)), %a, %b)
)",
     R"(
%0:1b = FLt@16 %a, %b
%1 = Select %0, %a, %b
StoreOutput %1
)"},
    {"one of them was not", R"(
StoreOutput Select(FLt(Half2F(%a), %b), %a, %b)
)"},
};

TEST(NarrowComparisons, CompareWhatWasConverted) { check_step("narrow_comparisons", kCompareWhatWasConverted); }

}  // namespace
}  // namespace vitrine::spirv::test
