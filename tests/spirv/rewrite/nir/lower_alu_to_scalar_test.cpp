// Vectors become components (nir_lower_alu_width.c).
#include "tests/spirv/rewrite/pass_case.h"

namespace vitrine::spirv::test {
namespace {

constexpr PassCase kSplitsVectors[] = {
    {"a sum of two vectors", R"(
%v:2 = LoadUniform 0, 0 [0 0 1]
%s:2 = FAdd! %v, %v.yx
StoreStorage 0, 0, %s [0 1 1] {3}
)",
     R"(
%0:2 = LoadUniform 0, 0 [0 0 1]
%1 = FAdd! %0.x, %0.y
%2 = FAdd! %0.y, %0.x
%3:2 = Vec %1, %2
StoreStorage 0, 0, %3 [0 1 1] {3 0}
)"},
    {"a scalar times a vector", R"(
%v:3 = LoadUniform 0, 0 [0 0 1]
%s:3 = FMul %v, %a
StoreStorage 0, 0, %s [0 1 1] {7}
)",
     R"(
%0:3 = LoadUniform 0, 0 [0 0 1]
%1 = FMul %0.x, %a
%2 = FMul %0.y, %a
%3 = FMul %0.z, %a
%4:3 = Vec %1, %2, %3
StoreStorage 0, 0, %4 [0 1 1] {7 0}
)"},
    {"a scalar", R"(
StoreOutput FAdd(%a, %b)
)"},
    {"a double, whose two components are one number", R"(
%v:2 = LoadUniform 0, 0 [0 0 1]
%s:2 = FAdd@64 %v, %v
StoreStorage 0, 0, %s [0 1 1] {3}
)"},
};

TEST(LowerAluToScalar, SplitsVectors) { check_step("lower_alu_to_scalar", kSplitsVectors); }

}  // namespace
}  // namespace vitrine::spirv::test
