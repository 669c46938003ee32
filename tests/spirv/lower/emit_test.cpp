// Control flow as masks and jumps.
#include "tests/spirv/lower/lower_case.h"

namespace vitrine::spirv::test {
namespace {

constexpr LowerCase kControl[] = {
    {"a branch", R"(
If FLt(%a, %b)
  StoreStorage 0, 0, %a [0 0 1] {1}
  Yield
Else
  StoreStorage 0, 4, %b [0 0 1] {1}
  Yield
StoreOutput %a
)",
     R"(
registers 2, masks 2, uniform words 2 (2 constants)
code:
    0  FLt            m0 r0 r1
    1  if             m1 m0 -> 3
    2  store_storage  u0 ( r0 ) set 0 slot 0
    3  else           m1 -> 5
    4  store_storage  u1 ( r1 ) set 0 slot 0
    5  endif          m1
    6  end
)"},
    {"a branch on what all lanes share", R"(
If INe(LoadPush(0), 0)
  StoreStorage 0, %a, %a [0 0 1] {1}
  Yield
Else
  StoreStorage 0, %b, %b [0 0 1] {1}
  Yield
StoreOutput %a
)",
     R"(
registers 2, masks 0, uniform words 3 (1 constants)
preamble:
    0  load_push      u0 ( u1 ) set 0 slot 0
    1  INe            u2 u0 u1
    2  end
code:
    0  if.uniform     u2 -> 3
    1  store_storage  r0 ( r0 ) set 0 slot 0
    2  jump           -> 4
    3  store_storage  r1 ( r1 ) set 0 slot 0
    4  end
)"},
    {"a continue", R"(
Loop params %i init 0 -> %n
  If IGe(%i, %a)
    Break %i
  Else
    Yield
  If FLt(%b, %c)
    Continue IAdd(%i, 2)
  Else
    Yield
  StoreStorage 0, %i, %b [0 0 1] {1}
  Yield IAdd(%i, 1)
Continuing %k
  Yield %k
StoreOutput %n
)",
     R"(
registers 6, masks 5, uniform words 3 (3 constants)
code:
    0  FLt            m0 r1 r2
    1  move           r2 u0
    2  clear          m1
    3  clear          m2
    4  IGe            m3 r2 r0
    5  leave_begin    m4 m3 -> 8
    6  move.active    r3 r2
    7  break_if       m1 m4 -> 17
    8  if             m3 m0 -> 11
    9  IAdd           r4 r2 u1
   10  continue       m2 -> 11
   11  else           m3 -> 12
   12  endif          m3
   13  skip_if_empty  -> 17
   14  store_storage  r2 ( r1 ) set 0 slot 0
   15  IAdd           r5 r2 u2
   16  move.active    r4 r5
   17  rejoin         m2 -> 19
   18  move           r2 r4
   19  loop           m1 -> 4
   20  end
)"},
};

TEST(Emit, Control) { check_lowered(kControl); }

}  // namespace
}  // namespace vitrine::spirv::test
