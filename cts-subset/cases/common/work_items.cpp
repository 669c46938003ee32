// Work items in compute shaders, vertices without a rasterizer, and fragments.
#include "cases/common/work_items.h"

#include "harness/graphics.h"

namespace vitrine::cts {

WorkStage random_work_stage(Run& run) {
  run.require(run.gpu.features.vertexPipelineStoresAndAtomics && run.gpu.features.fragmentStoresAndAtomics,
              "stores of vertices and fragments");
  return run.random.pick({WorkStage::kCompute, WorkStage::kCompute, WorkStage::kVertex, WorkStage::kFragment});
}

const char* name_of(WorkStage stage) {
  return stage == WorkStage::kCompute ? "compute\n" : stage == WorkStage::kVertex ? "vertex\n" : "fragment\n";
}

void run_work_items(Run& run, WorkStage stage, const Resources& resources, const std::string& code, uint32_t count) {
  const std::string limit = "if (i < " + std::to_string(count) + ") work(i);";
  if (stage == WorkStage::kCompute) {
    const VkPipeline pipeline = run.compute(
        resources.layout, run.shader(VK_SHADER_STAGE_COMPUTE_BIT,
                                     "layout(local_size_x = 64) in;\n" + code +
                                         "void main() { int i = int(gl_GlobalInvocationID.x); " + limit + " }\n"));
    return run.dispatch(resources, pipeline, (count + 63) / 64);
  }
  const Target target = make_target(run, {});
  GraphicsSpec spec;
  spec.layout = resources.layout;
  if (stage == WorkStage::kVertex) {
    spec.assembly.topology = VK_PRIMITIVE_TOPOLOGY_POINT_LIST;
    spec.raster.rasterizerDiscardEnable = VK_TRUE;
    spec.vertex = code +
                  "void main() {\n  gl_Position = vec4(0.0);\n  gl_PointSize = 1.0;\n  int i = gl_VertexIndex; " +
                  limit + "\n}\n";
  } else {
    spec.vertex = kFullScreenVertex;
    spec.fragment = code +
                    "layout(location = 0) out vec4 color;\nvoid main() {\n  color = vec4(1.0);\n"
                    "  int i = int(gl_FragCoord.y) * 64 + int(gl_FragCoord.x); " +
                    limit + "\n}\n";
  }
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  draw_once(run, target, pipeline, &resources, stage == WorkStage::kVertex ? count : 3);
}

}  // namespace vitrine::cts
