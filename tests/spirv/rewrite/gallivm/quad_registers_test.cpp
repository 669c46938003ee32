// What lanes hold that wait while others of their quad run (nir_from_ssa.c, lp_bld_nir_soa.c).
#include "tests/spirv/rewrite/pass_case.h"

namespace vitrine::spirv::test {
namespace {

constexpr PassCase kReadsRegisters[] = {
    {"a join in a branch", R"(
If FLt(%a, 1.0) -> %r
  If FLt(%b, 1.0) -> %j
    Yield FMul(%c, %c)
  Else
    Yield FAdd(%c, 1.0)
  Yield FDdx(%j)
Else
  Yield 0.0
StoreOutput %r
)",
     R"(
Arrays 1
%0:1b = FLt %a, 1.0
If %0 -> %1
  %2:1b = FLt %b, 1.0
  If %2
    %3 = FMul %c, %c
    StoreArray 0, %3
    Yield
  Else
    %4 = FAdd %c, 1.0
    StoreArray 0, %4
    Yield
  %5 = LoadArray 0
  %6 = FDdx %5
  Yield %6
Else
  Yield 0
StoreOutput %1
)"},
    {"a loop that lanes leave one by one", R"(
Loop params %x init %a -> %n
  %d = FDdx %x
  If FLt(%d, %b)
    Break %d
  Else
    Yield
  Yield FAdd(%x, %c)
Continuing %next
  Yield %next
StoreOutput %n
)",
     R"(
Arrays 1
StoreArray 0, %a
Loop params %0 init %a -> %1
  %2 = LoadArray 0
  %3 = FDdx %2
  %4:1b = FLt %3, %b
  If %4
    Break %3
  Else
    Yield
  %5 = FAdd %0, %c
  StoreArray 0, %5
  Yield %5
Continuing %6
  Yield %6
StoreOutput %1
)"},
    {"a value that is computed in all lanes", R"(
If FLt(%a, 1.0) -> %r
  Yield FDdx(FMul(%b, %b))
Else
  Yield 0.0
StoreOutput %r
)"},
    {"outside of branches", R"(
If FLt(%a, 1.0) -> %r
  Yield FMul(%b, %b)
Else
  Yield %c
StoreOutput FDdx(%r)
)"},
};

TEST(QuadRegisters, ReadsRegisters) { check_step("quad_registers", kReadsRegisters); }

}  // namespace
}  // namespace vitrine::spirv::test
