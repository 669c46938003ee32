// What is said of a wave that does not end.
#include "spirv/exec/wave_memory.h"
#include "tests/spirv/front/glsl.h"

namespace vitrine::spirv::test {
namespace {

TEST(Fault, NamesTheLoopAndTheCallsThatLeadThere) {
  const char glsl[] = R"(layout(local_size_x = 8) in;
layout(set = 0, binding = 0) buffer B { uint v[]; } b;
uint spin(uint x) {
  while (x != 1u)
    x = x * 3u + b.v[x];
  return x;
}
void main() {
  uint i = gl_GlobalInvocationID.x;
  b.v[i] = spin(i);
}
)";
  for (const DebugInfo debug : {DebugInfo::kLines, DebugInfo::kNonSemantic}) {
    auto shader =
        compile(compile_glsl(VK_SHADER_STAGE_COMPUTE_BIT, glsl, debug), options_for(VK_SHADER_STAGE_COMPUTE_BIT));
    ASSERT_TRUE(shader) << shader.message();
    const ResourceTable nothing;  // all loads give 0
    Fault fault;
    const BoundShader bound(*shader.value(), nothing, fault);
    exec::WaveMemory memory;
    Wave wave;
    memory.bind(bound, wave);
    wave.active = wave.live = wave.launched = 0xf0;
    wave.budget = 100;
    execute(wave, shader.value()->program().code.data());
    ASSERT_EQ(wave.status, Wave::Status::kFault);
    const std::string place = exec::place_of(wave);
    EXPECT_EQ(place.substr(0, place.find(" (SPIR-V")), " near shader.glsl:5 in spin, called at shader.glsl:11 in main");
  }
}

}  // namespace
}  // namespace vitrine::spirv::test
