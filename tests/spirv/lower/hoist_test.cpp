// What gives the same in every iteration runs in front of the loop.
#include "tests/spirv/lower/lower_case.h"

namespace vitrine::spirv::test {
namespace {

constexpr LowerCase kLoops[] = {
    {"a root of a value from outside", R"(
Loop params %i %s init 0, 1.0 -> %n
  If IGe(%i, LoadPush(0))
    Break %s
  Else
    Yield
  Yield IAdd(%i, 1), FAdd(%s, FSqrt(%a))
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
    0  FSqrt          r0 r0
    1  move           u4 u0
    2  move           r1 u1
    3  unless         u4 u3 -> 6
    4  move           r2 r1
    5  break.uniform  -> 9
    6  IAdd           u4 u4 u2
    7  FAdd           r1 r1 r0
    8  loop.uniform   -> 3
    9  end
)"},
    {"a load of memory that the loop writes stays", R"(
Loop params %i %s init 0, 1.0 -> %n
  If IGe(%i, LoadPush(0))
    Break %s
  Else
    Yield
  %x = LoadStorage 0, %a [0 0 1]
  StoreStorage 0, %b, %x [0 0 1] {1}
  Yield IAdd(%i, 1), FAdd(%s, %x)
Continuing %k %l
  Yield %k, %l
StoreOutput %n
)",
     R"(
registers 5, masks 1, uniform words 5 (3 constants)
preamble:
    0  load_push      u0 ( u3 ) set 0 slot 0
    1  end
code:
    0  move           u4 u0
    1  move           r2 u1
    2  unless         u4 u3 -> 5
    3  move           r3 r2
    4  break.uniform  -> 10
    5  load_storage   r0 ( r4 ) set 0 slot 0
    6  store_storage  r1 ( r4 ) set 0 slot 0
    7  IAdd           u4 u4 u2
    8  FAdd           r2 r2 r4
    9  loop.uniform   -> 2
   10  end
)"},
};

TEST(Hoist, Loops) { check_lowered(kLoops); }

}  // namespace
}  // namespace vitrine::spirv::test
