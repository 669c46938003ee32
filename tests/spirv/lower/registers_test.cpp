// Values that share registers.
#include "tests/spirv/lower/lower_case.h"

namespace vitrine::spirv::test {
namespace {

constexpr LowerCase kAllocation[] = {
    {"a register is free after its last use", R"(
StoreOutput FSqrt(FMul(FAdd(%a, %b), %c))
)",
     R"(
registers 3, masks 0, uniform words 0 (0 constants)
code:
    0  FAdd           r0 r0 r1
    1  FMul           r0 r0 r2
    2  FSqrt          r0 r0
    3  end
)"},
    {"both values of a branch and its result have one", R"(
If FLt(%a, %b) -> %r
  StoreStorage 0, 0, %a [0 0 1] {1}
  Yield FAdd(%c, 1.0)
Else
  Yield FAdd(%c, 2.0)
StoreOutput %r
)",
     R"(
registers 3, masks 2, uniform words 3 (3 constants)
code:
    0  FLt            m0 r0 r1
    1  if             m1 m0 -> 4
    2  store_storage  u0 ( r0 ) set 0 slot 0
    3  FAdd           r0 r2 u1
    4  else           m1 -> 7
    5  FAdd           r1 r2 u2
    6  move.active    r0 r1
    7  endif          m1
    8  end
)"},
    {"a value that a loop reads lives until its end", R"(
Loop params %i init 0 -> %n
  If IGe(%i, %a)
    Break %i
  Else
    Yield
  StoreStorage 0, %i, %b [0 0 1] {1}
  Yield IAdd(%i, 1)
Continuing %k
  Yield %k
StoreOutput FAdd(%n, %n)
)",
     R"(
registers 3, masks 4, uniform words 3 (2 constants)
code:
    0  move           u2 u0
    1  clear          m0
    2  IGe            m2 u2 r0
    3  leave_begin    m3 m2 -> 6
    4  move.active    r2 u2
    5  break_if       m0 m3 -> 8
    6  store_storage  u2 ( r1 ) set 0 slot 0
    7  IAdd           u2 u2 u1
    8  loop           m0 -> 2
    9  FAdd           r0 r2 r2
   10  end
)"},
};

TEST(Registers, Allocation) { check_lowered(kAllocation); }

}  // namespace
}  // namespace vitrine::spirv::test
