// What nothing needs, and what all lanes share.
#include "tests/spirv/lower/lower_case.h"

namespace vitrine::spirv::test {
namespace {

constexpr LowerCase kDeadCode[] = {
    {"a load that nobody reads", R"(
%x = LoadStorage 0, %a [0 0 1]
StoreOutput %a
)",
     R"(
registers 1, masks 0, uniform words 0 (0 constants)
code:
    0  end
)"},
    {"a loop parameter that only feeds itself", R"(
Loop params %i %s init 0, 1.0 -> %n
  If IGe(%i, %a)
    Break %i
  Else
    Yield
  Yield IAdd(%i, 1), FMul(%s, %b)
Continuing %k %l
  Yield %k, %l
StoreOutput %n
)",
     R"(
registers 2, masks 4, uniform words 3 (2 constants)
code:
    0  move           u2 u0
    1  clear          m0
    2  IGe            m2 u2 r0
    3  leave_begin    m3 m2 -> 6
    4  move.active    r1 u2
    5  break_if       m0 m3 -> 7
    6  IAdd           u2 u2 u1
    7  loop           m0 -> 2
    8  end
)"},
};

TEST(Analyze, DeadCode) { check_lowered(kDeadCode); }

constexpr LowerCase kWaveUniform[] = {
    {"a counter that all lanes share is a word, and its loop a jump", R"(
Loop params %i %s init 0, 1.0 -> %n
  If IGe(%i, LoadPush(0))
    Break %s
  Else
    Yield
  Yield IAdd(%i, 1), FMul(%s, %a)
Continuing %k %l
  Yield %k, %l
StoreOutput %n
)",
     R"(
registers 3, masks 1, uniform words 5 (3 constants)
preamble:
    0  load_push      u0 ( u3 ) set 0 slot 0
    1  end
code:
    0  move           u4 u0
    1  move           r1 u1
    2  unless         u4 u3 -> 5
    3  move           r2 r1
    4  break.uniform  -> 8
    5  IAdd           u4 u4 u2
    6  FMul           r1 r1 r0
    7  loop.uniform   -> 2
    8  end
)"},
    {"what lanes leave with separately is a register", R"(
Loop params %i init 0 -> %n
  If IGe(%i, %a)
    Break %i
  Else
    Yield
  Yield IAdd(%i, 1)
Continuing %k
  Yield %k
StoreOutput %n
)",
     R"(
registers 2, masks 4, uniform words 3 (2 constants)
code:
    0  move           u2 u0
    1  clear          m0
    2  IGe            m2 u2 r0
    3  leave_begin    m3 m2 -> 6
    4  move.active    r1 u2
    5  break_if       m0 m3 -> 7
    6  IAdd           u2 u2 u1
    7  loop           m0 -> 2
    8  end
)"},
};

TEST(Analyze, WaveUniform) { check_lowered(kWaveUniform); }

}  // namespace
}  // namespace vitrine::spirv::test
