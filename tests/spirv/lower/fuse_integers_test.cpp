// Superinstructions of integers.
#include "tests/spirv/lower/lower_case.h"

namespace vitrine::spirv::test {
namespace {

constexpr LowerCase kFused[] = {
    {"a rotation to the left", R"(
StoreOutput Or(Shl(%a, 7), UShr(%a, 25))
)",
     R"(
registers 1, masks 0, uniform words 1 (1 constants)
code:
    0  RotR           r0 r0 u0
    1  end
)"},
    {"shifts that do not add up", R"(
StoreOutput Or(Shl(%a, 7), UShr(%a, 24))
)",
     R"(
registers 2, masks 0, uniform words 2 (2 constants)
code:
    0  Shl            r1 r0 u0
    1  UShr           r0 r0 u1
    2  Or             r0 r0 r1
    3  end
)"},
    {"of two values", R"(
StoreOutput Or(Shl(%a, 7), UShr(%b, 25))
)",
     R"(
registers 2, masks 0, uniform words 2 (2 constants)
code:
    0  Shl            r0 r0 u0
    1  UShr           r1 r1 u1
    2  Or             r0 r1 r0
    3  end
)"},
    {"a rotation of a difference", R"(
StoreOutput IAdd(Shl(Xor(%a, %b), 7), UShr(Xor(%a, %b), 25))
)",
     R"(
registers 2, masks 0, uniform words 1 (1 constants)
code:
    0  RotRXor        r0 r0 r1 u0
    1  end
)"},
    {"three rotations",
     R"(
StoreOutput Xor(Xor(Or(UShr(%a, 6), Shl(%a, 26)), Or(UShr(%a, 11), Shl(%a, 21))), UShr(%a, 3))
)",
     R"(
registers 2, masks 0, uniform words 3 (3 constants)
code:
    0  RotR           r1 r0 u0
    1  XorRotR        r1 r1 r0 u1
    2  XorShr         r0 r1 r0 u2
    3  end
)"},
    {"a value and its shifted self", R"(
%x = FMul %a, %b
StoreOutput Xor(%x, UShr(%x, 15))
)",
     R"(
registers 2, masks 0, uniform words 1 (1 constants)
code:
    0  FMul           r0 r0 r1
    1  XorShr         r0 r0 r0 u0
    2  end
)"},
    {"by a value", R"(
StoreOutput Xor(%a, UShr(%a, %b))
)",
     R"(
registers 2, masks 0, uniform words 0 (0 constants)
code:
    0  UShr           r1 r0 r1
    1  Xor            r0 r1 r0
    2  end
)"},
    {"bits chosen by a third value", R"(
StoreOutput Xor(And(%a, %b), And(%c, Not(%a)))
)",
     R"(
registers 3, masks 0, uniform words 0 (0 constants)
code:
    0  BitSelect      r0 r0 r1 r2
    1  end
)"},
    {"the same in other words", R"(
StoreOutput Xor(%c, And(Xor(%c, %b), %a))
)",
     R"(
registers 3, masks 0, uniform words 0 (0 constants)
code:
    0  BitSelect      r0 r2 r1 r0
    1  end
)"},
    {"bits on which two agree", R"(
StoreOutput Xor(Xor(And(%a, %b), And(%c, %a)), And(%b, %c))
)",
     R"(
registers 3, masks 0, uniform words 0 (0 constants)
code:
    0  Majority       r0 r0 r1 r2
    1  end
)"},
    {"the same in other words", R"(
StoreOutput Or(And(%a, Or(%b, %c)), And(%c, %b))
)",
     R"(
registers 3, masks 0, uniform words 0 (0 constants)
code:
    0  Majority       r0 r0 r1 r2
    1  end
)"},
    {"which not", R"(
StoreOutput Xor(And(%a, Or(%b, %c)), And(%c, %b))
)",
     R"(
registers 4, masks 0, uniform words 0 (0 constants)
code:
    0  Or             r3 r1 r2
    1  And            r0 r3 r0
    2  And            r1 r1 r2
    3  Xor            r0 r1 r0
    4  end
)"},
    {"sums", R"(
StoreOutput IAdd(IAdd(IAdd(%a, %b), IMul(%c, %d)), Shl(%e, 2))
)",
     R"(
registers 5, masks 0, uniform words 1 (1 constants)
code:
    0  IAdd           r0 r0 r1
    1  IMulAdd        r0 r2 r3 r0
    2  IAddShl        r0 r0 r4 u0
    3  end
)"},
    {"a product that is read twice", R"(
%p = IMul %a, %b
StoreOutput Xor(IAdd(%p, %c), %p)
)",
     R"(
registers 3, masks 0, uniform words 0 (0 constants)
code:
    0  IMul           r0 r0 r1
    1  IAdd           r1 r0 r2
    2  Xor            r0 r1 r0
    3  end
)"},
};

TEST(FuseIntegers, Operations) { check_lowered(kFused); }

}  // namespace
}  // namespace vitrine::spirv::test
