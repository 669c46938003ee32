// Joins of one value (nir_opt_remove_phis.c).
#include "tests/spirv/rewrite/pass_case.h"

namespace vitrine::spirv::test {
namespace {

constexpr PassCase kJoinsOfOneValueAreIt[] = {
    {"both sides of a branch", R"(
If FLt(%a, %b) -> %r
  StoreStorage 0, 0, %a [0 0 1] {1}
  Yield %a
Else
  Yield %a
StoreOutput %r
)",
     R"(
%0:1b = FLt %a, %b
If %0
  StoreStorage 0, 0, %a [0 0 1] {1 0}
  Yield
Else
  Yield
StoreOutput %a
)"},
    {"a parameter that is handed on", R"(
Loop params %i %s init 0, %a -> %n %m
  If IGe(%i, 4)
    Break %i, %s
  Else
    Yield
  Yield IAdd(%i, 1), %s
Continuing %k %l
  Yield %k, %l
StoreOutput FAdd(%n, %m)
)",
     R"(
Loop params %0 init 0
  %1:1b = IGe %0, 4
  If %1
    Break
  Else
    Yield
  %2 = IAdd %0, 1
  Yield %2
Continuing %3
  Yield %3
%4 = FAdd %0, %a
StoreOutput %4
)"},
    {"what the other side leaves alone", R"(
Loop params %i init 0 -> %n
  If IGe(%i, 4) -> %r
    Break %i
  Else
    Yield %a
  Yield IAdd(%i, %r)
Continuing %k
  Yield %k
StoreOutput %n
)",
     R"(
Loop params %0 init 0
  %1:1b = IGe %0, 4
  If %1
    Break
  Else
    Yield
  %2 = IAdd %0, %a
  Yield %2
Continuing %3
  Yield %3
StoreOutput %0
)"},
    {"different values", R"(
If FLt(%a, %b) -> %r
  StoreStorage 0, 0, %a [0 0 1] {1}
  Yield %a
Else
  Yield %b
StoreOutput %r
)"},
};

TEST(OptRemovePhis, JoinsOfOneValueAreIt) { check_step("opt_remove_phis", kJoinsOfOneValueAreIt); }

}  // namespace
}  // namespace vitrine::spirv::test
