// Values as scalars: folding, equal expressions, what is the same for the whole draw.
#include "tests/spirv/lower/lower_case.h"

namespace vitrine::spirv::test {
namespace {

constexpr LowerCase kValues[] = {
    {"operations on constants", R"(
StoreOutput FAdd(%a, FMul(2.0, 3.0))
)",
     R"(
registers 1, masks 0, uniform words 1 (1 constants)
code:
    0  FAdd           r0 r0 u0
    1  end
)"},
    {"quotients by powers of two are products", R"(
StoreOutput FAdd(FDiv(%a, 16777216.0), FDiv(%b, 3.0))
)",
     R"(
registers 2, masks 0, uniform words 2 (2 constants)
code:
    0  FDiv           r1 r1 u0
    1  FMulAdd        r0 r0 u1 r1
    2  end
)"},
    {"equal expressions are one", R"(
%x = FAdd %a, %b
%y = FAdd %a, %b
StoreOutput FMul(%x, %y)
)",
     R"(
registers 2, masks 0, uniform words 0 (0 constants)
code:
    0  FAdd           r0 r0 r1
    1  FMul           r0 r0 r0
    2  end
)"},
    {"sums of integers in another order are equal, products of floats are not", R"(
%x = IAdd %a, %b
%y = IAdd %b, %a
StoreOutput IMul(%x, %y)
%u = FMul %a, %b
%v = FMul %b, %a
StoreOutput FSub(%u, %v) [1]
)",
     R"(
registers 4, masks 0, uniform words 0 (0 constants)
code:
    0  IAdd           r2 r0 r1
    1  IMul           r2 r2 r2
    2  FMul           r3 r0 r1
    3  FNMulAdd       r0 r1 r0 r3
    4  end
)"},
    {"what is the same for the draw goes to the preamble", R"(
StoreOutput FMul(%a, FAdd(LoadPush(0), 1.0))
)",
     R"(
registers 1, masks 0, uniform words 4 (2 constants)
preamble:
    0  load_push      u0 ( u2 ) set 0 slot 0
    1  FAdd           u3 u2 u1
    2  end
code:
    0  FMul           r0 r0 u3
    1  end
)"},
    {"a vector is its components", R"(
%v:2 = LoadPush 0
%s:2 = FMul %v, %a
StoreOutput FAdd(%s.x, %s.y)
)",
     R"(
registers 2, masks 0, uniform words 3 (1 constants)
preamble:
    0  load_push      u0 ( u1 u2 ) set 0 slot 0
    1  end
code:
    0  FMul           r1 u1 r0
    1  FMulAdd        r0 u2 r0 r1
    2  end
)"},
};

TEST(Scalarize, Values) { check_lowered(kValues); }

}  // namespace
}  // namespace vitrine::spirv::test
