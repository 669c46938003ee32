// Barriers that not all invocations of a workgroup reach: reported, never waited for.
#include <cstdlib>

#include "tests/spirv/buffers.h"
#include "tests/spirv/front/glsl.h"

namespace vitrine::spirv::test {
namespace {

const int log_is_set = setenv("VITRINE_LOG", "error", 1);

/// What a dispatch of two workgroups says on stderr.
std::string run_and_listen(const std::string& body) {
  static_cast<void>(log_is_set);
  const auto stage = VK_SHADER_STAGE_COMPUTE_BIT;
  const Words module = compile_glsl(stage,
                                    "layout(local_size_x = 200) in;\n"
                                    "layout(set = 0, binding = 0) buffer B { uint v[]; };\nshared uint s;\n"
                                    "void main() {\n  uint i = gl_LocalInvocationIndex;\n" +
                                        body + "  v[i] = s;\n}\n");
  std::vector<std::uint32_t> values(256);
  testing::internal::CaptureStderr();
  dispatch_over(values, module, options_for(stage), 2);
  return testing::internal::GetCapturedStderr();
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
