// Listed deviations of what queries count (deviations.md).
#include "cases/deviations/deviation.h"
#include "harness/case.h"
#include "harness/graphics.h"

namespace vitrine::cts {
namespace {

/// Judges one 32-bit counter.
DeviationCheck counts(uint32_t device, uint32_t reference) {
  return [=](const std::vector<Output>& ours, const std::vector<Output>& theirs) -> std::string {
    uint32_t values[2];
    std::memcpy(&values[0], ours.back().bytes.data(), 4);
    std::memcpy(&values[1], theirs.back().bytes.data(), 4);
    if (values[0] != device) return "the device counts " + std::to_string(values[0]);
    return values[1] == reference ? "" : "the reference counts " + std::to_string(values[1]);
  };
}

/// Draws with both pipelines in one query.
void count(Run& run, VkQueryPool pool, VkQueryControlFlags flags, const Target& target,
           const std::vector<VkPipeline>& pipelines, uint32_t vertices, const Buffer* indices = nullptr) {
  const Buffer result = run.buffer(4, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
  run.once([&](VkCommandBuffer cmd) {
    vkCmdResetQueryPool(cmd, pool, 0, 1);
    target.begin(cmd);
    vkCmdBeginQuery(cmd, pool, 0, flags);
    for (const VkPipeline pipeline : pipelines) {
      bind_pipeline(cmd, pipeline);
      if (indices) {
        vkCmdBindIndexBuffer(cmd, indices->handle, 0, VK_INDEX_TYPE_UINT16);
        vkCmdDrawIndexed(cmd, vertices, 1, 0, 0, 0);
      } else {
        vkCmdDraw(cmd, vertices, 1, 0, 0);
      }
    }
    vkCmdEndQuery(cmd, pool, 0);
    vkCmdEndRenderPass(cmd);
    vkCmdCopyQueryPoolResults(cmd, pool, 0, 1, result.handle, 0, 0, VK_QUERY_RESULT_WAIT_BIT);
  });
  run.out("count", result);
}

const char kWhite[] = "layout(location = 0) out vec4 result;\nvoid main() { result = vec4(1.0); }\n";

/// Two triangles, one of them behind rasterizer discard.
const AddCase kDiscarded("clipping", "deviation.discarded_invocations", "discarded-clipping-invocations", counts(2, 0),
                         [](Run& run) {
                           run.require(run.gpu.features.pipelineStatisticsQuery, "pipelineStatisticsQuery");
                           const Target target = make_target(run, {});
                           std::vector<VkPipeline> pipelines;
                           for (const VkBool32 discard : {VK_FALSE, VK_TRUE}) {
                             GraphicsSpec spec;
                             spec.vertex = kFullScreenVertex;
                             if (!discard) spec.fragment = kWhite;
                             spec.raster.rasterizerDiscardEnable = discard;
                             pipelines.push_back(make_pipeline(run, spec, target));
                           }
                           count(run,
                                 make_query_pool(run, VK_QUERY_TYPE_PIPELINE_STATISTICS, 1,
                                                 VK_QUERY_PIPELINE_STATISTIC_CLIPPING_INVOCATIONS_BIT),
                                 0, target, pipelines, 3);
                         });

/// One strip that the reference works on in parts.
const AddCase kStrip("draw", "deviation.long_strip_vertices", "long-strip-vertices", counts(1530, 1533), [](Run& run) {
  run.require(run.gpu.features.pipelineStatisticsQuery, "pipelineStatisticsQuery");
  const Target target = make_target(run, {});
  const Buffer indices = run.buffer_of(std::vector<uint16_t>(1530, 1));
  GraphicsSpec spec;
  spec.vertex = kFullScreenVertex;
  spec.fragment = kWhite;
  spec.assembly.topology = VK_PRIMITIVE_TOPOLOGY_LINE_STRIP_WITH_ADJACENCY;
  count(run,
        make_query_pool(run, VK_QUERY_TYPE_PIPELINE_STATISTICS, 1,
                        VK_QUERY_PIPELINE_STATISTIC_INPUT_ASSEMBLY_VERTICES_BIT),
        0, target, {make_pipeline(run, spec, target)}, 1530, &indices);
});

/// Half of the fragments are discarded behind early tests.
const AddCase kEarly("pipeline", "deviation.early_sample_counting", "early-sample-counting", counts(64 * 64, 32 * 64),
                     [](Run& run) {
                       const Target target = make_target(run, {});
                       GraphicsSpec spec;
                       spec.vertex = kFullScreenVertex;
                       spec.fragment =
                           "layout(early_fragment_tests) in;\nlayout(location = 0) out vec4 result;\nvoid main() {\n"
                           "  if (gl_FragCoord.x < 32.0) discard;\n  result = vec4(1.0);\n}\n";
                       count(run, make_query_pool(run, VK_QUERY_TYPE_OCCLUSION, 1), VK_QUERY_CONTROL_PRECISE_BIT,
                             target, {make_pipeline(run, spec, target)}, 3);
                     });

/// A line of 41 pixels with four samples each.
const AddCase kLine("rasterization", "deviation.one_sample_line_count", "one-sample-line-masks", counts(4 * 41, 41),
                    [](Run& run) {
                      run.require(run.gpu.extension_features.bresenhamLines, "bresenhamLines");
                      TargetSpec target_spec;
                      target_spec.samples = VK_SAMPLE_COUNT_4_BIT;
                      const Target target = make_target(run, target_spec);
                      VkPipelineRasterizationLineStateCreateInfoEXT line{
                          VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_LINE_STATE_CREATE_INFO_EXT};
                      line.lineRasterizationMode = VK_LINE_RASTERIZATION_MODE_BRESENHAM_EXT;
                      GraphicsSpec spec;
                      spec.vertex =
                          "void main() { gl_Position = vec4((gl_VertexIndex == 0 ? 10.5 : 51.5) / 32.0 - 1.0, "
                          "20.5 / 32.0 - 1.0, 0.0, 1.0); }\n";
                      spec.fragment = kWhite;
                      spec.assembly.topology = VK_PRIMITIVE_TOPOLOGY_LINE_LIST;
                      spec.raster.pNext = &line;
                      count(run, make_query_pool(run, VK_QUERY_TYPE_OCCLUSION, 1), VK_QUERY_CONTROL_PRECISE_BIT, target,
                            {make_pipeline(run, spec, target)}, 2);
                    });

}  // namespace
}  // namespace vitrine::cts
