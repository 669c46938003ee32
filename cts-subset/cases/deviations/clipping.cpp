// Listed deviations of clipping.
#include "cases/deviations/deviation.h"

namespace vitrine::cts {
namespace {

const AddCase kPoint("clipping", "deviation.point_clipping", "point-clipping", case_against_control, [](Run& run) {
  run.require(run.gpu.features.largePoints, "largePoints");
  GraphicsSpec spec;
  spec.assembly.topology = VK_PRIMITIVE_TOPOLOGY_POINT_LIST;
  spec.vertex = kBigPoint;
  draw(run, "outside", {}, spec, colored({{-1.0625f, 0.25f, 0.5f, 1.0f}, {0.5f, 0.5f, 0.5f, 1.0f}}));
  draw(run, "inside_only", {}, spec, colored({{-5.0f, 0.25f, 0.5f, 1.0f}, {0.5f, 0.5f, 0.5f, 1.0f}}));
});

/// Outlines of a clipped triangle in layer 0 and in layer 1. Which of the two the reference draws astray depends on
/// what it drew before.
const AddCase kClippedLayer(
    "clipping", "deviation.clipped_polygon_layer", "clipped-polygon-layer",
    [](const std::vector<Output>& device, const std::vector<Output>& reference) -> std::string {
      /// Whether something was drawn to the layer that gl_Layer does not name.
      const auto astray = [](const std::vector<Output>& outputs) {
        bool result = false;
        for (size_t i = 0; i < 2; ++i) {
          const std::vector<unsigned char>& bytes = outputs[i].bytes;
          const size_t layer = bytes.size() / 2, first = (1 - i) * layer;
          for (size_t at = first; at < first + layer; ++at) result |= bytes[at] != bytes[first + at % 4];
        }
        return result;
      };
      if (astray(device)) return "the device draws to another layer";
      return astray(reference) ? "" : "the reference's fault does not show";
    },
    [](Run& run) {
      run.require(run.gpu.has("VK_EXT_shader_viewport_index_layer"), "VK_EXT_shader_viewport_index_layer");
      for (const char* layer : {"0", "1"}) {
        TargetSpec target;
        target.layers = 2;
        GraphicsSpec spec;
        spec.vertex = std::string("#extension GL_ARB_shader_viewport_layer_array : require\n") +
                      "layout(location = 0) in vec4 position;\nlayout(location = 1) in vec4 color;\n"
                      "layout(location = 0) out vec4 passed;\n"
                      "void main() {\n  passed = color;\n  gl_Position = position;\n  gl_Layer = " +
                      layer + ";\n}\n";
        spec.raster.polygonMode = VK_POLYGON_MODE_LINE;
        draw(run, std::string("layer_") + layer, target, spec,
             colored({{-0.9f, -0.5f, 0.5f, 1}, {1.9f, 0.1f, 0.5f, 1}, {-0.5f, 1.8f, 0.5f, 1}}));
      }
    });

/// A triangle whose corners differ so much in w that a corner made by clipping has no finite place.
const AddCase kWrapped("clipping", "deviation.wrapped_coordinates", "wrapped-coordinates", case_against_control,
                       [](Run& run) {
                         draw(run, "triangle", {}, {},
                              colored({{-0.325063586f, -1, 0.800330579f, 1},
                                       {-0.706831634f, -1, 0.754183352f, -0x1p30f},
                                       {-0.263199508f, -0.944609642f, 0.721903443f, 1e38f}}));
                         draw(run, "outside", {}, {}, colored({{2, 0, 0.5f, 1}, {3, 0, 0.5f, 1}, {3, 1, 0.5f, 1}}));
                       });

/// Triangles without area but for the rounding of their corners, and one that is clipped: in one draw, and in two.
const AddCase kNeighbour(
    "clipping", "deviation.neighbour_culling", "neighbour-culling", case_against_control, [](Run& run) {
      Random random(2);  // some show the fault, few seeds have none
      std::vector<std::array<float, 4>> corners;
      for (int i = 0; i < 500; ++i) {
        const float x = random.real(-0.9f, 0), y = random.real(-0.9f, 0);
        const float dx = random.real(0.1f, 0.9f), dy = random.real(0.1f, 0.9f);
        const float t = random.unit();
        corners.push_back({x, y, 0.5f, 1});
        corners.push_back({x + dx, y + dy, 0.5f, 1});
        corners.push_back({x + t * dx, y + t * dy, 0.5f, 1});
      }
      const auto slivers = static_cast<uint32_t>(corners.size());
      corners.insert(corners.end(), {{0.95f, 0.95f, 0.5f, 1}, {1.2f, 0.95f, 0.5f, 1}, {0.95f, 1.2f, 0.5f, 1}});
      const Buffer vertices = run.buffer_of(colored(corners));
      GraphicsSpec spec;
      spec.vertex = kColorVertex;
      spec.fragment = kColorFragment;
      spec.floats({4, 4});
      spec.raster.cullMode = VK_CULL_MODE_BACK_BIT;
      for (const bool together : {true, false}) {
        const Target target = make_target(run, {});
        const VkPipeline pipeline = make_pipeline(run, spec, target);
        run.once([&](VkCommandBuffer cmd) {
          target.begin(cmd);
          bind_pipeline(cmd, pipeline);
          bind_vertices(cmd, vertices);
          vkCmdDraw(cmd, together ? slivers + 3 : slivers, 1, 0, 0);
          if (!together) vkCmdDraw(cmd, 3, 1, slivers, 0);
          vkCmdEndRenderPass(cmd);
        });
        run.out(together ? "together" : "apart", target.colors[0]);
      }
    });

/// A clipped line along which 1/w and its products are denormal numbers.
const AddCase kDenormals(
    "clipping", "deviation.clipped_denormals", "clipped-denormals",
    [](const std::vector<Output>& device, const std::vector<Output>& reference) -> std::string {
      const auto is_clear = [](const Output& output, size_t at) {
        return std::memcmp(&output.bytes[at], output.bytes.data() + output.bytes.size() - 4, 4) == 0;
      };
      for (size_t at = 0; at < device[0].bytes.size(); at += 4)
        if (is_clear(device[0], at) != is_clear(reference[0], at)) return "the device draws other pixels";
      return different(device[0], reference[0], "the reference's fault");
    },
    [](Run& run) {
      GraphicsSpec spec;
      spec.assembly.topology = VK_PRIMITIVE_TOPOLOGY_LINE_LIST;
      std::vector<float> values =
          colored({{0.752201319f, -0.380163312f, 0x1p30f, 1e37f}, {1.1882813f, -1e37f, 0.25f, 1}});
      values[8 + 4] = 1.0f;
      draw(run, "line", {}, spec, values);
    });

}  // namespace
}  // namespace vitrine::cts
