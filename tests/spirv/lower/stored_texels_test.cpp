// Stores to images: components that the declared format lacks are not computed.
#include <gtest/gtest.h>

#include "spirv/program.h"
#include "tests/spirv/front/glsl.h"

namespace vitrine::spirv::test {
namespace {

/// The program of a shader that stores different functions of a number in the four components.
std::string program_of(const std::string& image) {
  const std::string text =
      "layout(local_size_x = 64) in; layout(set = 0, binding = 0) buffer B { float v[]; } b;"
      "layout(set = 0, binding = 1" +
      image +
      " i; void main() { float x = b.v[gl_LocalInvocationIndex];"
      "imageStore(i, ivec2(gl_LocalInvocationID.xy), vec4(sqrt(x), floor(x), ceil(x), trunc(x))); }";
  const auto compiled =
      compile(compile_glsl(VK_SHADER_STAGE_COMPUTE_BIT, text), options_for(VK_SHADER_STAGE_COMPUTE_BIT));
  return compiled ? disassemble(compiled.value()->program()) : compiled.message();
}

std::size_t operations_of(const std::string& program) {
  std::size_t count = 0;
  for (const char* name : {"FSqrt", "FFloor", "FCeil", "FTrunc"}) count += program.find(name) != std::string::npos;
  return count;
}

TEST(StoredTexels, HaveTheComponentsOfTheDeclaredFormat) {
  struct Row {
    const char* declaration;
    std::size_t components;
  };
  for (const Row row : {Row{", r32f) uniform image2D", 1}, Row{", r8_snorm) uniform image2D", 1},
                        Row{", rg16f) uniform image2D", 2}, Row{", r11f_g11f_b10f) uniform image2D", 3},
                        Row{", rgba8) uniform image2D", 4}, Row{") writeonly uniform image2D", 4}}) {
    const std::string program = program_of(row.declaration);
    EXPECT_EQ(operations_of(program), row.components) << row.declaration << '\n' << program;
  }
}

}  // namespace
}  // namespace vitrine::spirv::test
