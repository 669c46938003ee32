// Local arrays that become values (nir_split_vars.c, nir_lower_vars_to_ssa.c).
#include "tests/spirv/rewrite/pass_case.h"

namespace vitrine::spirv::test {
namespace {

constexpr PassCase kArraysOfConstantElements[] = {
    {"a store and a load of one element", R"(
Arrays 2
StoreArray 1, %a
StoreOutput LoadArray(1)
)",
     R"(
%0 = Mov %a
StoreOutput %0
)"},
    {"stores on both sides of a branch", R"(
Arrays 2
StoreArray 0, %a
If FLt(%a, %b)
  StoreArray 0, %b
  Yield
Else
  Yield
StoreOutput LoadArray(0)
)",
     R"(
%0:1b = FLt %a, %b
If %0 -> %1
  Yield %b
Else
  Yield %a
%2 = Mov %1
StoreOutput %2
)"},
    {"a store in a loop", R"(
Arrays 1
StoreArray 0, %a
Loop params %i init 0
  If IGe(%i, %b)
    Break
  Else
    Yield
  StoreArray 0, FAdd(LoadArray(0), 1.0)
  Yield IAdd(%i, 1)
Continuing %k
  Yield %k
StoreOutput LoadArray(0)
)",
     R"(
Loop params %0 %1 init 0, %a
  %2:1b = IGe %0, %b
  If %2
    Break
  Else
    Yield
  %3 = Mov %1
  %4 = FAdd %3, 1.0
  %5 = IAdd %0, 1
  Yield %5, %4
Continuing %6 %7
  Yield %6, %7
%8 = Mov %1
StoreOutput %8
)"},
    {"an element that is not literal", R"(
Arrays 2
StoreArray %b, %a
StoreOutput LoadArray(1)
)"},
};

TEST(LowerVarsToSsa, ArraysOfConstantElements) { check_step("lower_vars_to_ssa", kArraysOfConstantElements); }

}  // namespace
}  // namespace vitrine::spirv::test
