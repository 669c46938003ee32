// What is removed because nobody reads it (nir_opt_dce.c).
#include "tests/spirv/rewrite/pass_case.h"

namespace vitrine::spirv::test {
namespace {

constexpr PassCase kRemovesWhatNobodyReads[] = {
    {"a chain of values", R"(
%x = FAdd %a, %b
%y = FMul %x, %x
StoreOutput %a
)",
     R"(
StoreOutput %a
)"},
    {"a result of a branch, and what is yielded for it", R"(
If FLt(%a, %b) -> %r %s
  Yield FAdd(%a, %b), 1.0
Else
  Yield %a, %b
StoreOutput %s
)",
     R"(
%0:1b = FLt %a, %b
If %0 -> %1
  Yield 1.0
Else
  Yield %b
StoreOutput %1
)"},
    {"a branch without results and effects", R"(
If FLt(%a, %b)
  %x = FAdd %a, %b
  Yield
Else
  Yield
StoreOutput %a
)",
     R"(
StoreOutput %a
)"},
    {"a parameter that only feeds itself", R"(
Loop params %i %s init 0, 1.0 -> %n
  If IGe(%i, 4)
    Break %i
  Else
    Yield
  Yield IAdd(%i, 1), FMul(%s, %a)
Continuing %k %l
  Yield %k, %l
StoreOutput %n
)",
     R"(
Loop params %0 init 0 -> %1
  %2:1b = IGe %0, 4
  If %2
    Break %0
  Else
    Yield
  %3 = IAdd %0, 1
  Yield %3
Continuing %4
  Yield %4
StoreOutput %1
)"},
    {"an atomic operation has an effect", R"(
%old = AtomicStorage 0, 0, 1 [0 0 1]
StoreOutput %a
)"},
    {"a store in a branch", R"(
If FLt(%a, %b)
  StoreStorage 0, 0, %a [0 0 1] {1}
  Yield
Else
  Yield
)"},
};

TEST(OptDce, RemovesWhatNobodyReads) { check_step("opt_dce", kRemovesWhatNobodyReads, Dead::kCompared); }

}  // namespace
}  // namespace vitrine::spirv::test
