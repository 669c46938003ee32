// Neighbouring branches and ways out of a loop (nir_opt_if.c).
#include "spirv/rewrite/nir/opt_if.h"
#include "tests/spirv/rewrite/pass_case.h"

namespace vitrine::spirv::test {
namespace {

constexpr PassCase kMerge[] = {
    {"two branches on one condition", R"(
%c = FLt %a, %b
If %c
  StoreStorage 0, 0, %a [0 0 1] {1}
  Yield
Else
  Yield
If %c -> %r
  Yield %a
Else
  StoreStorage 0, 4, %b [0 0 1] {1}
  Yield %b
StoreOutput %r
)",
     R"(
%0:1b = FLt %a, %b
If %0 -> %1
  StoreStorage 0, 0, %a [0 0 1] {1 0}
  Yield %a
Else
  StoreStorage 0, 4, %b [0 0 1] {1 0}
  Yield %b
StoreOutput %1
)"},
    {"with an instruction between them", R"(
%c = FLt %a, %b
If %c
  StoreStorage 0, 0, %a [0 0 1] {1}
  Yield
Else
  Yield
StoreStorage 0, 8, %a [0 0 1] {1}
If %c -> %r
  Yield %a
Else
  StoreStorage 0, 4, %b [0 0 1] {1}
  Yield %b
StoreOutput %r
)"},
    {"on two conditions", R"(
If FLt(%a, %b)
  StoreStorage 0, 0, %a [0 0 1] {1}
  Yield
Else
  Yield
If FLt(%b, %a)
  StoreStorage 0, 4, %a [0 0 1] {1}
  Yield
Else
  Yield
)"},
};

TEST(OptIfMerge, Merge) { check_step(each_branch(rewriting::opt_if_merge), kMerge); }

constexpr PassCase kSimplification[] = {
    {"nothing on the first side", R"(
If FLt(%a, %b)
  Yield
Else
  StoreStorage 0, 0, %a [0 0 1] {1}
  Yield
)",
     R"(
%0:1b = FLt %a, %b
%1:1b = NotB %0
If %1
  StoreStorage 0, 0, %a [0 0 1] {1 0}
  Yield
Else
  Yield
)"},
    {"something on the first side", R"(
If FLt(%a, %b)
  StoreStorage 0, 0, %a [0 0 1] {1}
  Yield
Else
  Yield
)"},
};

TEST(OptIfMerge, Simplification) { check_step(each_branch(rewriting::opt_if_simplification), kSimplification); }

constexpr PassCase kPhiIsCondition[] = {
    {"true and false", R"(
If FLt(%a, %b) -> %r:1b
  StoreStorage 0, 0, %a [0 0 1] {1}
  Yield true
Else
  Yield false
StoreOutput Select(%r, %a, %b)
)",
     R"(
%0:1b = FLt %a, %b
If %0
  StoreStorage 0, 0, %a [0 0 1] {1 0}
  Yield
Else
  Yield
%1 = Select %0, %a, %b
StoreOutput %1
)"},
    {"false and true", R"(
If FLt(%a, %b) -> %r:1b
  StoreStorage 0, 0, %a [0 0 1] {1}
  Yield false
Else
  Yield true
StoreOutput Select(%r, %a, %b)
)",
     R"(
%0:1b = FLt %a, %b
%1:1b = NotB %0
If %0
  StoreStorage 0, 0, %a [0 0 1] {1 0}
  Yield
Else
  Yield
%2 = Select %1, %a, %b
StoreOutput %2
)"},
    {"another condition", R"(
If FLt(%a, %b) -> %r:1b
  StoreStorage 0, 0, %a [0 0 1] {1}
  Yield FLt(%a, 0.0)
Else
  Yield true
StoreOutput Select(%r, %a, %b)
)"},
};

TEST(OptIfMerge, PhiIsCondition) { check_step(each_branch(rewriting::opt_if_phi_is_condition), kPhiIsCondition); }

constexpr PassCase kMergeBreaks[] = {
    {"both sides leave", R"(
Loop params %i init 0 -> %n
  If IGe(%i, 4)
    Break %i
  Else
    Break IAdd(%i, 1)
Continuing %k
  Yield %k
StoreOutput %n
)",
     R"(
Loop params %0 init 0 -> %1
  %2:1b = IGe %0, 4
  If %2 -> %3
    Yield %0
  Else
    %4 = IAdd %0, 1
    Yield %4
  Break %3
Continuing %5
  Yield %5
StoreOutput %1
)"},
    {"one side leaves, and so does what follows", R"(
Loop params %i init 0 -> %n
  If IGe(%i, 4)
    Break %i
  Else
    Yield
  StoreStorage 0, 0, %a [0 0 1] {1}
  Break IAdd(%i, 1)
Continuing %k
  Yield %k
StoreOutput %n
)",
     R"(
Loop params %0 init 0 -> %1
  %2:1b = IGe %0, 4
  If %2 -> %3
    Yield %0
  Else
    StoreStorage 0, 0, %a [0 0 1] {1 0}
    %4 = IAdd %0, 1
    Yield %4
  Break %3
Continuing %5
  Yield %5
StoreOutput %1
)"},
    {"what follows goes round", R"(
Loop params %i init 0 -> %n
  If IGe(%i, 4)
    Break %i
  Else
    Yield
  Yield IAdd(%i, 1)
Continuing %k
  Yield %k
StoreOutput %n
)"},
};

TEST(OptIfMerge, MergeBreaks) { check_step(each_branch(rewriting::opt_merge_breaks), kMergeBreaks); }

}  // namespace
}  // namespace vitrine::spirv::test
