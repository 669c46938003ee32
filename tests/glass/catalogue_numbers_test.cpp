// Planted faults of operations: operands for which they are undefined, the first NaN or infinity.
#include "tests/glass/catalogue.h"

namespace vitrine::glass::test {
namespace {

constexpr Planted kPlanted[] = {
    {"unsigned_division", "division-by-zero", "", "v[i] = 100u / v[i];", "v[i] = 100u / (v[i] + 1u);"},
    {"unsigned_remainder", "division-by-zero", "", "v[i] = 100u % v[i];", "v[i] = 100u % (v[i] + 1u);"},
    {"signed_division", "division-by-zero", "", "v[i] = uint(100 / int(v[i]));", "v[i] = uint(100 / (int(v[i]) - 9));"},
    {"signed_remainder", "division-by-zero", "", "v[i] = uint(100 % int(v[i]));",
     "v[i] = uint(100 % (int(v[i]) + 1));"},
    {"smallest_number_divided", "division-by-zero", "", "v[i] = uint(int(v[i] + 0x80000000u) / (int(v[i]) - 1));",
     "v[i] = uint(int(v[i] + 0x80000000u) / (int(v[i]) + 1));"},
    {"division_of_vectors", "division-by-zero", "",
     "@uvec2 q = uvec2(100u, 7u) / uvec2(v[i], v[i] + 1u);\nv[i] = q.x + q.y;",
     "uvec2 q = uvec2(100u, 7u) / uvec2(v[i] + 2u, v[i] + 1u);\nv[i] = q.x + q.y;"},
    {"division_in_a_loop", "division-by-zero", "",
     "uint s = 0u;\nfor (uint k = 0u; k < v[44] - 40u; ++k)\n@s += v[i] / (3u - k);\nv[i] = s;",
     "uint s = 0u;\nfor (uint k = 0u; k < v[44] - 40u; ++k)\ns += v[i] / (4u - k);\nv[i] = s;"},
    {"division_in_an_unrolled_loop", "division-by-zero", "",
     "uint s = 0u;\nfor (uint k = 0u; k < 4u; ++k)\n@s += v[i] / (v[3] - k);\nv[i] = s;",
     "uint s = 0u;\nfor (uint k = 0u; k < 3u; ++k)\ns += v[i] / (v[3] - k);\nv[i] = s;"},
    {"division_in_a_branch", "division-by-zero", "", "if (v[i] < 3u) {\nv[i] += 0u;\n@v[i] = 9u / v[i];\n}",
     "if (v[i] > 3u) {\nv[i] += 0u;\nv[i] = 9u / v[i];\n}"},
    {"division_in_a_function", "division-by-zero",
     "uint f(uint x) {\nuint y = x + 2u;\n@return 10u / x + (y - x - 2u);\n}", "v[i] = f(v[i]);",
     "v[i] = f(v[i] + 1u);"},
    {"shift_left", "shift-too-far", "", "v[i] = 1u << (v[i] + 30u);", "v[i] = 1u << (v[i] + 20u);"},
    {"shift_right", "shift-too-far", "", "v[i] = 0x80000000u >> (v[i] * 8u);", "v[i] = 0x80000000u >> (v[i] * 4u);"},
    {"signed_shift_right", "shift-too-far", "", "v[i] = uint(int(v[i]) >> int(v[i] + 28u));",
     "v[i] = uint(int(v[i]) >> int(v[i] + 20u));"},
    {"extracted_field", "bit-field-out-of-range", "", "v[i] = bitfieldExtract(v[i], 30, int(v[i]));",
     "v[i] = bitfieldExtract(v[i], 20, int(v[i]));", Where::kGlsl},
    {"inserted_field", "bit-field-out-of-range", "", "v[i] = bitfieldInsert(v[i], 7u, int(v[i]) * 5, 3);",
     "v[i] = bitfieldInsert(v[i], 7u, int(v[i]) * 4, 3);", Where::kGlsl},
    {"negative_to_unsigned", "conversion-out-of-range", "", "v[i] = uint(float(v[i]) - 2.5);",
     "v[i] = uint(float(v[i]) - 0.5);"},
    {"large_to_signed", "conversion-out-of-range", "", "v[i] = uint(int(float(v[i]) * 1e9));",
     "v[i] = uint(int(float(v[i]) * 1e8));"},
    {"large_to_unsigned", "conversion-out-of-range", "", "v[i] = uint(float(v[i]) * 1e9);",
     "v[i] = uint(float(v[i]) * 5e8);"},
    {"square_root", "undefined-math", "", "v[i] = bits(sqrt(float(v[i]) - 1.0));", "v[i] = bits(sqrt(float(v[i])));"},
    {"inverse_square_root", "undefined-math", "", "v[i] = bits(inversesqrt(float(v[i])));",
     "v[i] = bits(inversesqrt(float(v[i]) + 1.0));"},
    {"logarithm", "undefined-math", "", "v[i] = bits(log(float(v[i])));", "v[i] = bits(log(float(v[i]) + 1.0));"},
    {"binary_logarithm", "undefined-math", "", "v[i] = bits(log2(float(v[i])));",
     "v[i] = bits(log2(float(v[i]) + 1.0));"},
    {"arc_sine", "undefined-math", "", "v[i] = bits(asin(float(v[i]) / 3.0));",
     "v[i] = bits(asin(float(v[i]) / 8.0));"},
    {"arc_cosine", "undefined-math", "", "v[i] = bits(acos(float(v[i]) / 3.0));",
     "v[i] = bits(acos(float(v[i]) / 8.0));"},
    {"power", "undefined-math", "", "v[i] = bits(pow(float(v[i]) - 2.0, 3.0));",
     "v[i] = bits(pow(float(v[i]) + 2.0, 3.0));"},
    {"power_of_zero", "undefined-math", "", "v[i] = bits(pow(float(v[i]), float(v[i]) - 1.0));",
     "v[i] = bits(pow(float(v[i]), float(v[i]) + 1.0));"},
    {"clamp_of_integers", "undefined-math", "", "v[i] = clamp(3u, v[i], 5u);", "v[i] = clamp(3u, v[i], 8u);"},
    {"clamp_of_numbers", "undefined-math", "", "v[i] = bits(clamp(float(v[i + 8u]), float(v[i]), 5.0));",
     "v[i] = bits(clamp(float(v[i + 8u]), float(v[i]), 8.0));"},
    {"smoothstep", "undefined-math", "", "v[i] = bits(smoothstep(float(v[i]), 6.0, 1.0));",
     "v[i] = bits(smoothstep(float(v[i]), 8.0, 1.0));"},
    {"remainder_of_numbers", "undefined-math", "", "v[i] = bits(fmod(5.0, float(v[i])));",
     "v[i] = bits(fmod(5.0, float(v[i]) + 1.0));"},
    {"reciprocal_of_zero", "infinity", "", "v[i] = bits(1.0 / float(v[i]));",
     "v[i] = bits(1.0 / (float(v[i]) + 1.0));"},
    {"exponential", "infinity", "", "v[i] = bits(exp(float(v[i]) * 20.0));", "v[i] = bits(exp(float(v[i]) * 10.0));"},
    {"product", "infinity", "", "v[i] = bits(float(v[i]) * 1e37 * float(v[i + 16u]));",
     "v[i] = bits(float(v[i]) * 1e36 * float(v[i + 16u]));"},
    {"zero_by_zero", "not-a-number", "", "float x = float(v[i]);\n@v[i] = bits(x / (x * 2.0) + 1.0);",
     "float x = float(v[i]) + 1.0;\nv[i] = bits(x / (x * 2.0) + 1.0);"},
    {"normalize_of_zero", "not-a-number", "", "@vec3 n = normalize(vec3(v[i], v[i], v[i]));\nv[i] = bits(n.x + n.y);",
     "vec3 n = normalize(vec3(v[i] + 1u, v[i], v[i]));\nv[i] = bits(n.x + n.y);"},
    {"root_of_a_negative_number", "not-a-number", "", "v[i] = bits(sqrt(float(v[i]) - 1.0) + 1.0);",
     "v[i] = bits(sqrt(float(v[i])) + 1.0);"},
};

class CatalogueNumbers : public Catalogue {};

TEST_P(CatalogueNumbers, FaultIsFoundAloneOnItsLine) { expect_found(*GetParam().planted, *GetParam().variant); }

TEST_P(CatalogueNumbers, TwinIsSilent) { expect_silence(*GetParam().planted, *GetParam().variant); }

INSTANTIATE_TEST_SUITE_P(Catalogue, CatalogueNumbers, testing::ValuesIn(cases_of(kPlanted)), name_of);

TEST(CatalogueNumbersCount, IsNotLess) {
  EXPECT_GE(faults_in(kPlanted), 200u);
  EXPECT_EQ(unchanged_by_optimizer(kPlanted), 0u);
}

}  // namespace
}  // namespace vitrine::glass::test
