// What ties loads to their place: volatile accesses and memory barriers. Counted in the program, as no single run can
// tell.
#include <cstring>

#include "spirv/program.h"
#include "tests/spirv/front/glsl.h"

namespace vitrine::spirv::test {
namespace {

/// Loads from storage buffers in a program of two reads of the same word.
std::size_t loads(const std::string& qualifier, const std::string& between, VkShaderStageFlagBits stage) {
  const std::string local = stage == VK_SHADER_STAGE_COMPUTE_BIT ? "layout(local_size_x = 64) in;\n" : "";
  const std::string source = local + "layout(set = 0, binding = 0) " + qualifier +
                             " buffer A { uint a[]; };\n"
                             "layout(set = 0, binding = 1) writeonly buffer R { uint r[]; };\n"
                             "void main() {\n  uint first = a[0];\n  " +
                             between + "\n  uint second = a[0];\n  r[7] = first * 3u + second * 5u;\n}\n";
  const auto shader = compile(compile_glsl(stage, source), options_for(stage));
  EXPECT_TRUE(shader) << shader.message();
  if (!shader) return 0;
  std::size_t words = 0;
  for (const auto* list : {&shader.value()->program().notes, &shader.value()->program().preamble_notes})
    for (const InstructionNote& note : *list) words += std::strcmp(note.name, "load_storage") == 0;
  return words;
}

TEST(MemoryOrder, PlainLoadsMerge) {
  EXPECT_EQ(loads("readonly", "", VK_SHADER_STAGE_COMPUTE_BIT), 1u);
  EXPECT_EQ(loads("", "", VK_SHADER_STAGE_VERTEX_BIT), 1u);
}

TEST(MemoryOrder, VolatileLoadsStay) {
  EXPECT_EQ(loads("volatile", "", VK_SHADER_STAGE_COMPUTE_BIT), 2u);
  EXPECT_EQ(loads("volatile", "", VK_SHADER_STAGE_VERTEX_BIT), 2u);
}

TEST(MemoryOrder, LoadsStayBehindBarriers) {
  EXPECT_EQ(loads("coherent", "memoryBarrierBuffer();", VK_SHADER_STAGE_VERTEX_BIT), 2u);
  EXPECT_EQ(loads("coherent", "memoryBarrier();", VK_SHADER_STAGE_COMPUTE_BIT), 2u);
  EXPECT_EQ(loads("coherent", "barrier();", VK_SHADER_STAGE_COMPUTE_BIT), 2u);
}

}  // namespace
}  // namespace vitrine::spirv::test
