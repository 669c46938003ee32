// Local arrays of constants become tables of the program; what decides it, and what is left as it is.
#include "tests/spirv/lower/lower_case.h"

namespace vitrine::spirv::test {
namespace {

constexpr LowerCase kTables[] = {
    {"an element by lane", R"(
Arrays 2
StoreArray 0, 1.5 [0 0]
StoreArray 1, 2.5 [0 0]
StoreOutput LoadArray(%a) [0 0]
)",
     R"(
registers 2, masks 0, uniform words 0 (0 constants)
code:
    0  load_table     r1 r0 ( ) set 0 slot 0
    1  end
)"},
    {"an element for all lanes", R"(
Arrays 2
StoreArray 0, 1.5 [0 0]
StoreArray 0, 2.5 [0 1]
StoreOutput LoadArray(LoadPush(0)) [0 0]
)",
     R"(
registers 1, masks 0, uniform words 3 (1 constants)
preamble:
    0  load_push      u0 ( u1 ) set 0 slot 0
    1  end
code:
    0  load_table     u2 u1 ( ) set 0 slot 0
    1  move           r0 u2
    2  end
)"},
    {"an element that nobody sets", R"(
Arrays 2
StoreArray 0, 1.5 [0 0]
StoreOutput LoadArray(%a) [0 0]
)",
     R"(
registers 3, masks 0, uniform words 2 (2 constants)
code:
    0  clear_arrays
    1  store_array    u0 r2 ( ) set 0 slot 0
    2  load_array     r1 r0 ( ) set 0 slot 0
    3  end
)"},
    {"two values for an element", R"(
Arrays 1
StoreArray 0, 1.5 [0 0]
StoreArray 0, 2.5 [0 0]
StoreOutput LoadArray(%a) [0 0]
)",
     R"(
registers 4, masks 0, uniform words 3 (3 constants)
code:
    0  clear_arrays
    1  store_array    u0 r2 ( ) set 0 slot 0
    2  store_array    u0 r3 ( ) set 0 slot 0
    3  load_array     r1 r0 ( ) set 0 slot 0
    4  end
)"},
    {"a load before a store", R"(
Arrays 1
%v = LoadArray %a [0 0]
StoreArray 0, 1.5 [0 0]
StoreOutput FAdd(%v, LoadArray(%a) [0 0])
)",
     R"(
registers 4, masks 0, uniform words 2 (2 constants)
code:
    0  clear_arrays
    1  load_array     r1 r0 ( ) set 0 slot 0
    2  store_array    u0 r3 ( ) set 0 slot 0
    3  load_array     r2 r0 ( ) set 0 slot 0
    4  FAdd           r0 r1 r2
    5  end
)"},
    {"a value that is no constant", R"(
Arrays 1
StoreArray 0, %b [0 0]
StoreOutput LoadArray(%a) [0 0]
)",
     R"(
registers 2, masks 0, uniform words 1 (1 constants)
code:
    0  clear_arrays
    1  store_array    u0 r0 ( ) set 0 slot 0
    2  load_array     r0 r1 ( ) set 0 slot 0
    3  end
)"},
    {"what a branch sets holds in it alone", R"(
Arrays 1 1
StoreArray 0, 1.5 [0 0]
If ILt(%a, 3) -> %r
  StoreArray 0, 2.5 [1 0]
  Yield LoadArray(%a) [0 0]
Else
  Yield 0.5
StoreOutput FAdd(%r, LoadArray(%b) [1 0])
)",
     R"(
registers 4, masks 2, uniform words 4 (4 constants)
code:
    0  clear_arrays
    1  ILt            m0 r0 u0
    2  if             m1 m0 -> 5
    3  store_array    u1 r3 ( ) set 0 slot 0
    4  load_table     r2 r0 ( ) set 0 slot 0
    5  else           m1 -> 7
    6  move.active    r2 u3
    7  endif          m1
    8  load_array     r0 r1 ( ) set 0 slot 0
    9  FAdd           r0 r2 r0
   10  end
)"},
};

TEST(Tables, OfConstantArrays) { check_lowered(kTables); }

}  // namespace
}  // namespace vitrine::spirv::test
