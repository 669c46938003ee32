// Random lookups of the stages without derivatives: each invocation makes one pixel of a 64x64 target.
#include "cases/texture/lookup.h"
#include "harness/case.h"
#include "harness/graphics.h"

namespace vitrine::cts {
namespace {

enum class Stage { kVertex, kControl, kEvaluation, kGeometry, kCompute };

/// vec4 look_up(ivec2 pixel).
std::string look_up_function(Random& random, const Family& family, const RandomLookup& found) {
  const bool table_only = found.is_cube() && found.sampler.magFilter == VK_FILTER_LINEAR;
  const std::string coordinates = table_only || random.chance(0.5f)
                                      ? "texelFetch(table, pixel, 0)"
                                      : "(base + (float(pixel.x) + 0.5) * dx) + (float(pixel.y) + 0.5) * dy";
  return lookup_declarations(found, family.kind) + result_prefix(found, family.kind) +
         "vec4 look_up(ivec2 pixel) {\n"
         "  vec4 extra = texelFetch(table, pixel + ivec2(0, 64), 0);\n"
         "  vec4 gx = extra.xyzx * 0.1, gy = extra.yzxz * 0.07;\n"
         "  precise vec4 c = " +
         coordinates + ";\n  return " + lookup(random, family, found.shape) + ";\n}\n";
}

constexpr char kPlace[] = "vec4 place(ivec2 pixel) { return vec4((vec2(pixel) + 0.5) / 32.0 - 1.0, 0.0, 1.0); }\n";
constexpr char kPixelOfVertex[] = "ivec2(gl_VertexIndex & 63, gl_VertexIndex >> 6)";

/// Points, one a pixel, whose colour `stage` looks up.
GraphicsSpec point_stages(Stage stage, const std::string& function, const std::string& type) {
  GraphicsSpec spec;
  const std::string out = "layout(location = 0) flat out " + type + " passed;\n";
  const std::string in = "layout(location = 0) flat in " + type + " passed;\n";
  spec.fragment = in + "layout(location = 0) out " + type + " color;\nvoid main() { color = passed; }\n";
  const std::string vertex_place = "  gl_Position = place(" + std::string(kPixelOfVertex) + ");\n";
  if (stage == Stage::kVertex) {
    spec.assembly.topology = VK_PRIMITIVE_TOPOLOGY_POINT_LIST;
    spec.vertex = function + kPlace + out + "void main() {\n" + vertex_place +
                  "  gl_PointSize = 1.0;\n  passed = look_up(" + kPixelOfVertex + ");\n}\n";
    return spec;
  }
  spec.vertex = std::string(kPlace) + "layout(location = 1) flat out ivec2 pixel;\nvoid main() {\n" + vertex_place +
                "  gl_PointSize = 1.0;\n  pixel = " + kPixelOfVertex + ";\n}\n";
  if (stage == Stage::kGeometry) {
    spec.assembly.topology = VK_PRIMITIVE_TOPOLOGY_POINT_LIST;
    spec.geometry = function +
                    "layout(points) in;\nlayout(points, max_vertices = 1) out;\n"
                    "layout(location = 1) flat in ivec2 pixel[];\n" +
                    out +
                    "void main() {\n  gl_Position = gl_in[0].gl_Position;\n  gl_PointSize = 1.0;\n"
                    "  passed = look_up(pixel[0]);\n  EmitVertex();\n}\n";
    return spec;
  }
  // Patches of 32 vertices; the evaluation shader makes a point of each, out of a line of 31 segments.
  const bool control = stage == Stage::kControl;
  spec.assembly.topology = VK_PRIMITIVE_TOPOLOGY_PATCH_LIST;
  spec.tessellation.patchControlPoints = 32;
  spec.control = (control ? function : "") +
                 "layout(vertices = 32) out;\nlayout(location = 1) flat in ivec2 pixel[];\n"
                 "layout(location = 1) flat out ivec2 kept[];\n" +
                 (control ? "layout(location = 0) flat out " + type + " found[];\n" : "") +
                 "void main() {\n  kept[gl_InvocationID] = pixel[gl_InvocationID];\n" +
                 (control ? "  found[gl_InvocationID] = look_up(pixel[gl_InvocationID]);\n" : "") +
                 "  gl_TessLevelOuter = float[4](1.0, 31.0, 1.0, 1.0);\n  gl_TessLevelInner = float[2](1.0, 1.0);\n}\n";
  spec.evaluation = (control ? "" : function) + std::string(kPlace) +
                    "layout(isolines, equal_spacing, point_mode) in;\nlayout(location = 1) flat in ivec2 kept[];\n" +
                    (control ? "layout(location = 0) flat in " + type + " found[];\n" : "") + out +
                    "void main() {\n  int i = int(gl_TessCoord.x * 31.0 + 0.5);\n  gl_Position = place(kept[i]);\n"
                    "  gl_PointSize = 1.0;\n  passed = " +
                    (control ? "found[i]" : "look_up(kept[i])") + ";\n}\n";
  return spec;
}

void draw(Run& run, const GraphicsSpec& spec, const Resources& res, VkFormat format,
          const std::array<float, 12>& push) {
  TargetSpec target_spec;
  target_spec.colors = {format};
  const Target target = make_target(run, target_spec);
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    res.bind(cmd);
    vkCmdPushConstants(cmd, res.layout, VK_SHADER_STAGE_ALL, 0, sizeof push, push.data());
    vkCmdDraw(cmd, kSize * kSize, 1, 0, 0);
    vkCmdEndRenderPass(cmd);
  });
  run.out("color", target.colors[0]);
}

void random_stage(Run& run, const Family& family, Stage stage) {
  Random& random = run.random;
  run.require(run.gpu.features.geometryShader && run.gpu.features.tessellationShader, "geometry and tessellation");
  RandomLookup found = random_lookup(run, family);
  const std::string type = result_prefix(found, family.kind) + "vec4";
  const std::string function = look_up_function(random, family, found);
  run.note("lookup", found.description + function);
  const std::array<float, 12> push = random_slopes(random, found.shape, found.sampler);
  const VkFormat format = result_format(found, family.kind);
  if (stage == Stage::kCompute) {
    const Buffer results = run.buffer(VkDeviceSize{16} * kSize * kSize);
    found.bindings.push_back(storage_buffer(2, results));
    const Resources res = run.resources(found.bindings, 48);
    const VkPipeline pipeline = run.compute(
        res.layout,
        run.shader(VK_SHADER_STAGE_COMPUTE_BIT, "layout(local_size_x = 64) in;\n" + function +
                                                    "layout(std430, binding = 2) buffer R { " + type +
                                                    " r[]; };\nvoid main() {\n  int i = int(gl_GlobalInvocationID.x);\n"
                                                    "  r[i] = look_up(ivec2(i & 63, i >> 6));\n}\n"));
    run.dispatch(res, pipeline, kSize, std::as_bytes(std::span(push)));
    run.out("results", results, format);
  } else {
    const Resources res = run.resources(found.bindings, 48);
    GraphicsSpec spec = point_stages(stage, function, type);
    spec.layout = res.layout;
    draw(run, spec, res, format, push);
  }
  run.outputs.back().nan_bits_free = true;
  run.may_be_blank();
}

const std::vector<Family>& families() {
  const std::vector<Shape> all = {k1D, k1DArray, k2D, k2D, k2DArray, k3D};
  static const std::vector<Family> list = {
      {.name = "lod", .kind = Kind::kLod, .shapes = all, .count = 12},
      {.name = "base_level", .kind = Kind::kImplicit, .shapes = all, .count = 8},
      {.name = "gradients", .kind = Kind::kGrad, .shapes = {k1D, k2D, k2DArray, k3D}, .count = 6},
      {.name = "offset", .kind = Kind::kOffset, .shapes = {k1D, k2D, k2DArray, k3D}, .count = 6},
      {.name = "gather", .kind = Kind::kGather, .shapes = {k2D, k2DArray}, .count = 6},
      {.name = "fetch", .kind = Kind::kFetch, .shapes = {k1D, k1DArray, k2D, k2DArray, k3D}, .count = 8},
      {.name = "shadow", .kind = Kind::kShadow, .shapes = {k1D, k2D, k2DArray}, .count = 6},
      {.name = "cube", .kind = Kind::kLod, .shapes = {kCube, kCubeArray}, .count = 6},
      {.name = "compressed", .kind = Kind::kLod, .shapes = {k2D, k2DArray}, .count = 6, .compressed = true},
      {.name = "border", .kind = Kind::kLod, .shapes = {k1D, k2D, k2DArray, k3D}, .count = 6, .bordered = true},
      {.name = "minmax", .kind = Kind::kLod, .shapes = {k1D, k2D, k2DArray, k3D}, .count = 6, .reduced = true},
      {.name = "lacking", .kind = Kind::kLod, .shapes = {k2D, k2DArray}, .count = 6, .lacking = true},
  };
  return list;
}

const bool kRegistered = [] {
  const std::pair<Stage, const char*> stages[] = {{Stage::kVertex, "vertex"},
                                                  {Stage::kControl, "control"},
                                                  {Stage::kEvaluation, "evaluation"},
                                                  {Stage::kGeometry, "geometry"},
                                                  {Stage::kCompute, "compute"}};
  for (const auto& [stage, name] : stages)
    for (const Family& family : families()) {
      const std::string full = std::string("random_") + name + "_" + family.name;
      AddGenerator("texture", full.c_str(), family.count,
                   [&family, stage = stage](Run& run) { random_stage(run, family, stage); });
    }
  return true;
}();

}  // namespace
}  // namespace vitrine::cts
