// Branches on literals, code that never runs, loops without effect (nir_opt_dead_cf.c).
#include "tests/spirv/rewrite/pass_case.h"

namespace vitrine::spirv::test {
namespace {

constexpr PassCase kRemovesControlFlow[] = {
    {"a branch on true", R"(
If true -> %r
  Yield FAdd(%a, 1.0)
Else
  Yield %b
StoreOutput %r
)",
     R"(
%0 = FAdd %a, 1.0
StoreOutput %0
)"},
    {"a branch on false", R"(
If false -> %r
  Yield FAdd(%a, 1.0)
Else
  Yield %b
StoreOutput %r
)",
     R"(
StoreOutput %b
)"},
    {"what follows a side that leaves", R"(
Loop params %i init 0 -> %n
  If true
    Break %i
  Else
    Yield
  StoreStorage 0, 0, %a [0 0 1] {1}
  Yield IAdd(%i, 1)
Continuing %k
  Yield %k
StoreOutput %n
)",
     R"(
Loop params %0 init 0 -> %1
  Break %0
Continuing %2
  Yield %2
StoreOutput %1
)"},
    {"a loop that nobody needs", R"(
Loop params %i init 0
  If IGe(%i, 4)
    Break
  Else
    Yield
  Yield IAdd(%i, 1)
Continuing %k
  Yield %k
StoreOutput %a
)",
     R"(
StoreOutput %a
)"},
    {"a loop that stores", R"(
Loop params %i init 0
  If IGe(%i, 4)
    Break
  Else
    Yield
  StoreStorage 0, %i, %a [0 0 1] {1}
  Yield IAdd(%i, 1)
Continuing %k
  Yield %k
StoreOutput %a
)"},
    {"a condition that is not literal", R"(
If FLt(%a, %b) -> %r
  Yield FAdd(%a, 1.0)
Else
  Yield %b
StoreOutput %r
)"},
};

TEST(OptDeadCf, RemovesControlFlow) { check_step("opt_dead_cf", kRemovesControlFlow); }

}  // namespace
}  // namespace vitrine::spirv::test
