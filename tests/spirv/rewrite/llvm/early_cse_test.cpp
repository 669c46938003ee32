// Equal scalar code (EarlyCSE.cpp).
#include "tests/spirv/rewrite/pass_case.h"

namespace vitrine::spirv::test {
namespace {

constexpr PassCase kMergesEqualCode[] = {
    {"literals are equal by their bits", R"(
%v:2 = Const 1.0 2.0
%x = FAdd %a, %v.y
%y = FAdd %a, 2.0
StoreOutput FSub(%x, %y)
)",
     R"(
%0:2 = Const 0x3f800000 0x40000000
%1 = FAdd %a, %0.y
%2 = FSub %1, %1
StoreOutput %2
)"},
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
    {"other literals", R"(
%v:2 = Const 1.0 2.0
%x = FAdd %a, %v.x
%y = FAdd %a, 2.0
StoreOutput FSub(%x, %y)
)"},
};

TEST(EarlyCse, MergesEqualCode) { check_step("early_cse", kMergesEqualCode); }

}  // namespace
}  // namespace vitrine::spirv::test
