// What reads copies, and what of them joins read (nir_opt_copy_propagate.c).
#include "tests/spirv/rewrite/pass_case.h"

namespace vitrine::spirv::test {
namespace {

constexpr PassCase kUsesReadWhatWasCopied[] = {
    {"a copy", R"(
%x = Mov %a
StoreOutput FAdd(%x, %b)
)",
     R"(
%0 = FAdd %a, %b
StoreOutput %0
)"},
    {"components of a vector are what it is made of", R"(
%v:2 = Vec %a, %b
StoreOutput FSub(%v.y, %v.x)
)",
     R"(
%0 = FSub %b, %a
StoreOutput %0
)"},
    {"a vector of the components of one value, in their order", R"(
%u:2 = LoadUniform 0, 0 [0 0 1]
%v:2 = Vec %u.x, %u.y
%w:2 = FMul %v, %v
StoreOutput FAdd(%w.x, %w.y)
)",
     R"(
%0:2 = LoadUniform 0, 0 [0 0 1]
%1:2 = FMul %0, %0
%2 = FAdd %1.x, %1.y
StoreOutput %2
)"},
    {"a join reads whole values, no component of one", R"(
%v:2 = LoadUniform 0, 0 [0 0 1]
%x = Mov %v.y
If FLt(%a, 0.0) -> %r
  Yield %x
Else
  Yield %b
StoreOutput %r
)"},
    {"a copy of a whole value, read by a join", R"(
%x = Mov %b
If FLt(%a, 0.0) -> %r
  Yield %x
Else
  Yield %a
StoreOutput %r
)",
     R"(
%0:1b = FLt %a, 0
If %0 -> %1
  Yield %b
Else
  Yield %a
StoreOutput %1
)"},
    {"no copy", R"(
StoreOutput FAdd(%a, %b)
)"},
};

TEST(CopyProp, UsesReadWhatWasCopied) { check_step("copy_prop", kUsesReadWhatWasCopied); }

constexpr PassCase kIntoJoins[] = {
    {"a join reads a component", R"(
%v:2 = LoadUniform 0, 0 [0 0 1]
%x = Mov %v.y
If FLt(%a, 0.0) -> %r
  Yield %x
Else
  Yield %b
StoreOutput %r
)",
     R"(
%0:2 = LoadUniform 0, 0 [0 0 1]
%1:1b = FLt %a, 0
If %1 -> %2
  Yield %0.yy
Else
  Yield %b
StoreOutput %2
)"},
};

TEST(CopyProp, IntoJoins) { check_step("copy_prop_into_joins", kIntoJoins); }

}  // namespace
}  // namespace vitrine::spirv::test
