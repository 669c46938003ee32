// Barriers that not all invocations of a workgroup reach: reported, never waited for.
#include <cstdlib>

#include "tests/spirv/front/glsl.h"

namespace vitrine::spirv::test {
namespace {

const int log_is_set = setenv("VITRINE_LOG", "error", 1);

/// What a dispatch of two workgroups says on stderr.
std::string run_and_listen(const std::string& body) {
  static_cast<void>(log_is_set);
  const auto stage = VK_SHADER_STAGE_COMPUTE_BIT;
  const auto shader = compile(compile_glsl(stage,
                                           "layout(local_size_x = 200) in;\n"
                                           "layout(set = 0, binding = 0) buffer B { uint v[]; };\nshared uint s;\n"
                                           "void main() {\n  uint i = gl_LocalInvocationIndex;\n" +
                                               body + "  v[i] = s;\n}\n"),
                              options_for(stage));
  EXPECT_TRUE(shader) << shader.message();
  if (!shader) return {};
  std::vector<std::uint32_t> values(256);
  Descriptor descriptor;
  descriptor.data = reinterpret_cast<std::byte*>(values.data());
  descriptor.size = values.size() * 4;
  ResourceTable table;
  table.set[0] = &descriptor;
  table.set_size[0] = 1;
  Fault fault;
  const BoundShader bound(*shader.value(), table, fault);
  const std::uint32_t base[3] = {0, 0, 0}, groups[3] = {2, 1, 1};
  testing::internal::CaptureStderr();
  dispatch(bound, base, groups);
  const std::string said = testing::internal::GetCapturedStderr();
  EXPECT_FALSE(fault.raised);
  return said;
}

TEST(Barrier, MetByAllSaysNothing) {
  EXPECT_EQ(run_and_listen("if (i == 0u) s = 5u;\n  barrier();\n  for (int k = 0; k < 3; k++) barrier();\n"), "");
}

TEST(Barrier, WhereSomeHaveReturned) {
  EXPECT_NE(run_and_listen("if (v[i] == 0u && i > 70u) return;\n  barrier();\n").find("barrier"), std::string::npos);
}

TEST(Barrier, InOneBranch) {
  EXPECT_NE(run_and_listen("if (i < 64u) barrier();\n").find("not reached by all"), std::string::npos);
  EXPECT_NE(run_and_listen("if ((i & 1u) == 0u) barrier();\n").find("not reached by all"), std::string::npos);
}

TEST(Barrier, DifferentOnes) {
  EXPECT_NE(run_and_listen("if (i < 64u) { s = 3u; barrier(); } else { barrier(); s = 2u; }\n").find("barrier"),
            std::string::npos);
}

}  // namespace
}  // namespace vitrine::spirv::test
