// Multiplications with additions, and the order of arithmetic.
#include "tests/spirv/lower/lower_case.h"

namespace vitrine::spirv::test {
namespace {

constexpr LowerCase kMultiplyAdd[] = {
    {"a product that one sum reads", R"(
StoreOutput FAdd(FMul(%a, %b), %c)
)",
     R"(
registers 3, masks 0, uniform words 0 (0 constants)
code:
    0  FMulAdd        r0 r0 r1 r2
    1  end
)"},
    {"a product that is subtracted", R"(
StoreOutput FSub(%c, FMul(%a, %b))
)",
     R"(
registers 3, masks 0, uniform words 0 (0 constants)
code:
    0  FNMulAdd       r0 r1 r2 r0
    1  end
)"},
    {"a product that two sums read", R"(
%p = FMul %a, %b
StoreOutput FMul(FAdd(%p, %c), FAdd(%p, %d))
)",
     R"(
registers 4, masks 0, uniform words 0 (0 constants)
code:
    0  FMul           r0 r0 r1
    1  FAdd           r1 r0 r2
    2  FAdd           r0 r0 r3
    3  FMul           r0 r1 r0
    4  end
)"},
};

TEST(Schedule, MultiplyAdd) { check_lowered(kMultiplyAdd); }

constexpr LowerCase kChains[] = {
    {"values are used right after they are computed", R"(
%x = FMul %a, %b
%y = FMul %c, %d
%u = FSqrt %x
%v = FSqrt %y
StoreOutput FMul(%u, %v)
)",
     R"(
registers 4, masks 0, uniform words 0 (0 constants)
code:
    0  FMul           r0 r0 r1
    1  FSqrt          r0 r0
    2  FMul           r1 r2 r3
    3  FSqrt          r1 r1
    4  FMul           r0 r0 r1
    5  end
)"},
};

TEST(Schedule, Chains) { check_lowered(kChains); }

}  // namespace
}  // namespace vitrine::spirv::test
