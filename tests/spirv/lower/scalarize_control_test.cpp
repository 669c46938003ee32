// Small branches as selections, turns of loops.
#include "tests/spirv/lower/lower_case.h"

namespace vitrine::spirv::test {
namespace {

constexpr LowerCase kBranches[] = {
    {"a small one without effects", R"(
If FLt(%a, %b) -> %r
  Yield FAdd(%a, 1.0)
Else
  Yield %b
StoreOutput %r
)",
     R"(
registers 2, masks 1, uniform words 1 (1 constants)
code:
    0  FLt            m0 r0 r1
    1  FAdd           r0 r0 u0
    2  Select         r0 m0 r0 r1
    3  end
)"},
    {"one that stores", R"(
If FLt(%a, %b)
  StoreStorage 0, 0, %a [0 0 1] {1}
  Yield
Else
  Yield
StoreOutput %a
)",
     R"(
registers 2, masks 2, uniform words 1 (1 constants)
code:
    0  FLt            m0 r0 r1
    1  if             m1 m0 -> 3
    2  store_storage  u0 ( r0 ) set 0 slot 0
    3  else           m1 -> 4
    4  endif          m1
    5  end
)"},
    {"on a constant", R"(
If true -> %r
  Yield FAdd(%a, 1.0)
Else
  Yield %b
StoreOutput %r
)",
     R"(
registers 1, masks 0, uniform words 1 (1 constants)
code:
    0  FAdd           r0 r0 u0
    1  end
)"},
};

TEST(ScalarizeControl, Branches) { check_lowered(kBranches); }

constexpr LowerCase kTurns[] = {
    {"variables that hand their values on do so by name in turns that are written out", R"(
Loop params %i %x %y %z init 0, %a, %b, %c -> %r
  If IGe(%i, LoadPush(0))
    Break %z
  Else
    Yield
  Yield IAdd(%i, 1), IMul(%x, %z), %x, %y
Continuing %k %l %m %n
  Yield %k, %l, %m, %n
StoreOutput %r
)",
     R"(
registers 4, masks 1, uniform words 6 (2 constants)
preamble:
    0  load_push      u0 ( u2 ) set 0 slot 0
    1  end
code:
    0  move           u3 u0
    1  unless         u3 u2 -> 4
    2  move           r3 r2
    3  break.uniform  -> 17
    4  IAdd           u4 u3 u1
    5  IMul           r2 r0 r2
    6  unless         u4 u2 -> 9
    7  move           r3 r1
    8  break.uniform  -> 17
    9  IAdd           u5 u1 u4
   10  IMul           r1 r1 r2
   11  unless         u5 u2 -> 14
   12  move           r3 r0
   13  break.uniform  -> 17
   14  IAdd           u3 u1 u5
   15  IMul           r0 r0 r1
   16  loop.uniform   -> 1
   17  end
)"},
    {"but not past a literal, which would be folded as the loop may not", R"(
Loop params %i %x %y %z init 0, %a, %b, %c -> %r
  If IGe(%i, LoadPush(0))
    Break %z
  Else
    Yield
  Yield IAdd(%i, 1), FMul(%x, %z), 0.5, %y
Continuing %k %l %m %n
  Yield %k, %l, %m, %n
StoreOutput %r
)",
     R"(
registers 3, masks 1, uniform words 5 (3 constants)
preamble:
    0  load_push      u0 ( u3 ) set 0 slot 0
    1  end
code:
    0  move           u4 u0
    1  unless         u4 u3 -> 4
    2  move           r2 r1
    3  break.uniform  -> 8
    4  IAdd           u4 u4 u1
    5  move           r1 r0
    6  move           r0 u2
    7  loop.uniform   -> 1
    8  end
)"},
};

TEST(ScalarizeControl, Turns) { check_lowered(kTurns); }

}  // namespace
}  // namespace vitrine::spirv::test
