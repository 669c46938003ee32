// Doubles, which the reference has as one value each.
#include "tests/spirv/rewrite/pass_case.h"

namespace vitrine::spirv::test {
namespace {

constexpr PassCase kMergeDoubles[] = {
    {"two pairs of the same words", R"(
%x:2 = Vec %a, %b
%y:2 = Vec %a, %b
%s:2 = FAdd@64 %x, %y
StoreStorage 0, 0, %s [0 0 1] {3}
)",
     R"(
%0:2 = Vec %a, %b
%1:2 = FAdd@64 %0, %0
StoreStorage 0, 0, %1 [0 0 1] {3 0}
)"},
    {"two pairs of different words", R"(
%x:2 = Vec %a, %b
%y:2 = Vec %b, %a
%s:2 = FAdd@64 %x, %y
StoreStorage 0, 0, %s [0 0 1] {3}
)"},
};

TEST(Doubles, MergeDoubles) { check_step("merge_doubles", kMergeDoubles); }

constexpr PassCase kJoinDoubles[] = {
    {"both words selected by one condition", R"(
%c = FLt %a, %b
%l = Select %c, %a, %d
%h = Select %c, %b, %e
%x:2 = Vec %l, %h
%s:2 = FAdd@64 %x, %x
StoreStorage 0, 0, %s [0 0 1] {3}
)",
     R"(
%0:1b = FLt %a, %b
%1:2 = Vec %a, %b
%2:2 = Vec %d, %e
%3:2 = Select@64 %0.xx, %1, %2
%4:2 = FAdd@64 %3, %3
StoreStorage 0, 0, %4 [0 0 1] {3 0}
)"},
    {"by two conditions", R"(
%l = Select FLt(%a, %b), %a, %d
%h = Select FLt(%b, %a), %b, %e
%x:2 = Vec %l, %h
%s:2 = FAdd@64 %x, %x
StoreStorage 0, 0, %s [0 0 1] {3}
)"},
};

TEST(Doubles, JoinDoubles) { check_step("join_doubles", kJoinDoubles); }

}  // namespace
}  // namespace vitrine::spirv::test
