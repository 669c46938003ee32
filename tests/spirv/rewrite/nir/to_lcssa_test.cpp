// Values that leave loops (nir_to_lcssa.c).
#include "tests/spirv/rewrite/pass_case.h"

namespace vitrine::spirv::test {
namespace {

constexpr PassCase kLeaveLcssa[] = {
    {"a result that is one value at the only way out", R"(
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
Loop params %0 init 0
  %1:1b = IGe %0, %a
  If %1
    Break
  Else
    Yield
  %2 = IAdd %0, 1
  Yield %2
Continuing %3
  Yield %3
StoreOutput %0
)"},
    {"two values at two ways out", R"(
Loop params %i init 0 -> %n
  If IGe(%i, %a)
    Break %i
  Else
    Yield
  %j = IAdd %i, 1
  If IGe(%j, %b)
    Break %j
  Else
    Yield
  Yield %j
Continuing %k
  Yield %k
StoreOutput %n
)"},
};

TEST(ToLcssa, LeaveLcssa) { check_step("leave_lcssa", kLeaveLcssa); }

constexpr PassCase kConvertToLcssa[] = {
    {"a value of the loop that is read behind it", R"(
Loop params %i init 0
  If IGe(%i, %a)
    Break
  Else
    Yield
  Yield IAdd(%i, 1)
Continuing %k
  Yield %k
StoreOutput %i
)",
     R"(
Loop params %i init 0 -> %n
  If IGe(%i, %a)
    Break %i
  Else
    Yield
  Yield IAdd(%i, 1)
Continuing %k
  Yield %k
StoreOutput %n
)"},
    {"a result", R"(
Loop params %i init 0 -> %n
  If IGe(%i, %a)
    Break %i
  Else
    Yield
  Yield IAdd(%i, 1)
Continuing %k
  Yield %k
StoreOutput %n
)"},
};

TEST(ToLcssa, ConvertToLcssa) { check_step("convert_to_lcssa", kConvertToLcssa); }

}  // namespace
}  // namespace vitrine::spirv::test
