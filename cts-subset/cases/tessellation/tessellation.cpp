// Tessellation: every domain, spacing and winding, point mode, levels out of range, what control and evaluation shaders
// read and write, geometry shaders behind them.
#include <limits>

#include "harness/case.h"
#include "harness/graphics.h"

namespace vitrine::cts {
namespace {

constexpr const char* kDomains[] = {"triangles", "quads", "isolines"};
constexpr const char* kSpacings[] = {"equal_spacing", "fractional_odd_spacing", "fractional_even_spacing"};

const char kVertex[] = R"(
layout(location = 0) in vec4 position;
layout(location = 1) in vec4 color;
layout(location = 0) out vec4 passed;
void main() {
  passed = color;
  gl_Position = position;
  gl_PointSize = 1.0 + color.y * 4.0;
})";

/// Passes control points on; levels come from a buffer of six per patch.
const char kControl[] = R"(
layout(vertices = 4) out;
layout(location = 0) in vec4 passed[];
layout(location = 0) out vec4 color[];
layout(set = 0, binding = 0) readonly buffer Levels { float level[]; };
void main() {
  gl_out[gl_InvocationID].gl_Position = gl_in[gl_InvocationID].gl_Position;
  gl_out[gl_InvocationID].gl_PointSize = gl_in[gl_InvocationID].gl_PointSize;
  color[gl_InvocationID] = passed[gl_InvocationID];
  if (gl_InvocationID == 0) {
    for (int i = 0; i < 4; ++i) gl_TessLevelOuter[i] = level[gl_PrimitiveID * 6 + i];
    for (int i = 0; i < 2; ++i) gl_TessLevelInner[i] = level[gl_PrimitiveID * 6 + 4 + i];
  }
})";

/// Positions by the domain's coordinates over four control points.
std::string evaluation(const std::string& layout, bool point_size = false) {
  return "layout(" + layout + R"() in;
layout(location = 0) in vec4 color[];
layout(location = 0) out vec4 passed;
void main() {
  vec3 at = gl_TessCoord;
  vec4 top = mix(gl_in[0].gl_Position, gl_in[1].gl_Position, at.x);
  vec4 bottom = mix(gl_in[3].gl_Position, gl_in[2].gl_Position, at.x);
  gl_Position = mix(top, bottom, at.y);
)" + (point_size ? "  gl_PointSize = gl_in[2].gl_PointSize * (0.5 + at.x);\n" : "") +
         R"(  passed = vec4(at, 1.0) * 0.7 + 0.3 * mix(color[0], color[2], at.x * at.y);
})";
}

struct Patches {
  std::vector<float> vertices, levels;
  uint32_t count = 0;
};

/// A grid of patches of four control points, each with levels of its own.
Patches make_patches(Random& random, uint32_t columns, uint32_t rows, float most, bool extreme) {
  Patches patches;
  for (uint32_t y = 0; y < rows; ++y) {
    for (uint32_t x = 0; x < columns; ++x, ++patches.count) {
      for (const uint32_t corner : {0u, 1u, 3u, 2u}) {
        const auto place = [&](uint32_t cell, uint32_t side, uint32_t cells) {
          const float at = (static_cast<float>(cell) + (side ? 0.92f : 0.08f)) / static_cast<float>(cells);
          return at * 2.0f - 1.0f + random.real(-0.03f, 0.03f);
        };
        const float w = random.chance(0.5f) ? 1.0f : random.real(0.7f, 1.5f);
        const float px = place(x, corner & 1, columns), py = place(y, corner >> 1, rows);
        for (const float v : {px * w, py * w, random.unit() * w, w}) patches.vertices.push_back(v);
        for (int c = 0; c < 4; ++c) patches.vertices.push_back(random.unit());
      }
      for (int i = 0; i < 6; ++i) {
        float level = random.chance(0.3f) ? static_cast<float>(1 + random.below(5)) : random.real(1.0f, most);
        if (extreme && random.chance(0.1f))
          level = random.pick({0.0f, -1.0f, 0.5f, 1.0f, 63.5f, 64.0f, 100.0f, std::numeric_limits<float>::infinity(),
                               std::numeric_limits<float>::quiet_NaN()});
        patches.levels.push_back(level);
      }
    }
  }
  return patches;
}

GraphicsSpec base_spec(Run& run) {
  run.require(run.gpu.features.tessellationShader, "tessellation");
  run.require(run.gpu.features.vertexPipelineStoresAndAtomics, "storage buffers in vertex stages");
  GraphicsSpec spec;
  spec.vertex = kVertex;
  spec.control = kControl;
  spec.fragment = kColorFragment;
  spec.floats({4, 4});
  spec.assembly.topology = VK_PRIMITIVE_TOPOLOGY_PATCH_LIST;
  spec.tessellation.patchControlPoints = 4;
  return spec;
}

/// `record` draws with everything bound.
void draw_with(Run& run, const Target& target, GraphicsSpec& spec, const Patches& patches,
               const std::function<void(VkCommandBuffer)>& record) {
  const Buffer levels = run.buffer_of(patches.levels);
  const Resources resources = run.resources({storage_buffer(0, levels)});
  spec.layout = resources.layout;
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  const Buffer vertices = run.buffer_of(patches.vertices);
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    resources.bind(cmd);
    bind_vertices(cmd, vertices);
    record(cmd);
    vkCmdEndRenderPass(cmd);
  });
  out_target(run, target);
}

void draw(Run& run, const Target& target, GraphicsSpec& spec, const Patches& patches, uint32_t instances = 1) {
  draw_with(run, target, spec, patches, [&](VkCommandBuffer cmd) {
    vkCmdDraw(cmd, static_cast<uint32_t>(patches.vertices.size() / 8), instances, 0, 0);
  });
}

TargetSpec large() {
  TargetSpec spec;
  spec.width = 160;
  spec.height = 144;
  return spec;
}

void draw_domain(Run& run, const std::string& layout, bool wireframe) {
  const Target target = make_target(run, large());
  GraphicsSpec spec = base_spec(run);
  spec.evaluation = evaluation(layout);
  if (wireframe) spec.raster.polygonMode = VK_POLYGON_MODE_LINE;
  const Patches patches = make_patches(run.random, 3, 3, 12.0f, false);
  draw(run, target, spec, patches);
}

const bool kRegistered = [] {
  for (const char* domain : kDomains)
    for (const char* spacing : kSpacings)
      for (const char* order : {"cw", "ccw", "point_mode"}) {
        const std::string layout = std::string(domain) + ", " + spacing + ", " + order;
        const std::string name = std::string(domain) + "." + spacing + "." + order;
        if (order == std::string("point_mode")) {
          AddCase("tessellation", name, [=](Run& run) {
            run.require(run.gpu.features.shaderTessellationAndGeometryPointSize, "point sizes of evaluation shaders");
            const Target target = make_target(run, large());
            GraphicsSpec spec = base_spec(run);
            spec.evaluation = evaluation(layout, true);
            draw(run, target, spec, make_patches(run.random, 3, 3, 9.0f, false));
          });
        } else if (domain != std::string("isolines")) {
          AddCase("tessellation", name, [=](Run& run) { draw_domain(run, layout, order == std::string("cw")); });
        } else if (order == std::string("cw")) {
          AddCase("tessellation", std::string(domain) + "." + spacing,
                  [=](Run& run) { draw_domain(run, layout, false); });
        }
      }
  return true;
}();

CTS_CASE("tessellation", "winding_and_domain_origin") {
  const Target target = make_target(run, large());
  for (const VkTessellationDomainOrigin origin :
       {VK_TESSELLATION_DOMAIN_ORIGIN_UPPER_LEFT, VK_TESSELLATION_DOMAIN_ORIGIN_LOWER_LEFT}) {
    for (const char* order : {"cw", "ccw"}) {
      GraphicsSpec spec = base_spec(run);
      VkPipelineTessellationDomainOriginStateCreateInfo state{
          VK_STRUCTURE_TYPE_PIPELINE_TESSELLATION_DOMAIN_ORIGIN_STATE_CREATE_INFO};
      state.domainOrigin = origin;
      spec.tessellation.pNext = &state;
      spec.evaluation = evaluation(std::string("quads, equal_spacing, ") + order);
      spec.raster.cullMode = VK_CULL_MODE_BACK_BIT;
      spec.fragment = R"(
layout(location = 0) in vec4 passed;
layout(location = 0) out vec4 result;
void main() { result = gl_FrontFacing ? passed : passed.zyxw * 0.5; })";
      draw(run, target, spec, make_patches(run.random, 2, 2, 6.0f, false));
      run.may_be_blank();
    }
  }
}

CTS_CASE("tessellation", "extreme_levels") {
  for (const char* domain : kDomains) {
    const Target target = make_target(run, large());
    GraphicsSpec spec = base_spec(run);
    spec.evaluation =
        evaluation(std::string(domain) + ", " +
                   run.random.pick({"equal_spacing", "fractional_odd_spacing", "fractional_even_spacing"}) + ", cw");
    draw(run, target, spec, make_patches(run.random, 5, 5, 9.0f, true));
  }
}

/// Everything that control shaders can do: patch outputs, outputs of other invocations behind a barrier, a smaller and
/// a larger patch, arrays, levels read back.
CTS_CASE("tessellation", "control_outputs") {
  const Target target = make_target(run, large());
  GraphicsSpec spec = base_spec(run);
  spec.tessellation.patchControlPoints = 5;
  spec.control = R"(
layout(vertices = 7) out;
layout(location = 0) in vec4 passed[];
layout(location = 0) out vec4 color[];
layout(location = 1) out Extra { float scale[3]; mat2 turn; } extra[];
layout(location = 6) patch out vec4 shared_color;
layout(location = 7) patch out float sums[2];
layout(set = 0, binding = 0) readonly buffer Levels { float level[]; };
void main() {
  int from = gl_InvocationID % gl_PatchVerticesIn;
  gl_out[gl_InvocationID].gl_Position = gl_in[from].gl_Position + vec4(0.02 * float(gl_InvocationID), 0.0, 0.0, 0.0);
  color[gl_InvocationID] = passed[from];
  for (int i = 0; i < 3; ++i) extra[gl_InvocationID].scale[i] = passed[from][i];
  extra[gl_InvocationID].turn = mat2(1.0, 0.1 * float(gl_InvocationID), -0.1, 1.0);
  barrier();
  float sum = 0.0;
  for (int i = 0; i < 7; ++i) sum += color[i].x;
  color[gl_InvocationID].w = sum * 0.1;
  if (gl_InvocationID == 2) shared_color = passed[gl_PatchVerticesIn - 1];
  if (gl_InvocationID < 2) sums[gl_InvocationID] = gl_out[6 - gl_InvocationID].gl_Position.x;
  barrier();
  if (gl_InvocationID == 3) {
    gl_TessLevelOuter[0] = 2.0 + color[0].w;
    gl_TessLevelOuter[1] = 3.5;
    gl_TessLevelOuter[2] = 2.0 + sums[0];
    gl_TessLevelInner[0] = gl_TessLevelOuter[1] + 1.0;
  }
})";
  spec.evaluation = R"(
layout(triangles, fractional_odd_spacing, ccw) in;
layout(location = 0) in vec4 color[];
layout(location = 1) in Extra { float scale[3]; mat2 turn; } extra[];
layout(location = 6) patch in vec4 shared_color;
layout(location = 7) patch in float sums[2];
layout(location = 0) out vec4 passed;
void main() {
  vec4 p = vec4(0.0);
  vec4 c = vec4(0.0);
  for (int i = 0; i < gl_PatchVerticesIn; ++i) {
    float weight = i < 3 ? gl_TessCoord[i] : 0.0;
    p += gl_in[i].gl_Position * weight;
    c += color[i] * weight;
  }
  p.xy = extra[int(gl_TessCoord.x * 6.9)].turn * p.xy;
  gl_Position = p;
  passed = c * 0.4 + shared_color * 0.3 + vec4(sums[0], sums[1], gl_TessLevelInner[0] * 0.1, extra[1].scale[2]) * 0.3 +
           vec4(0.01 * float(gl_PrimitiveID), gl_TessLevelOuter[1] * 0.02, 0.0, 0.0);
})";
  Patches patches = make_patches(run.random, 5, 3, 6.0f, false);
  draw(run, target, spec, patches, 2);
}

/// Outputs of the patch as members of a block.
CTS_CASE("tessellation", "patch_block") {
  const Target target = make_target(run, large());
  GraphicsSpec spec = base_spec(run);
  spec.control = R"(
layout(vertices = 4) out;
layout(location = 0) in vec4 passed[];
layout(location = 0) out vec4 color[];
layout(location = 1) patch out Shared { vec4 tint; float scale[2]; } whole;
layout(set = 0, binding = 0) readonly buffer Levels { float level[]; };
void main() {
  gl_out[gl_InvocationID].gl_Position = gl_in[gl_InvocationID].gl_Position;
  color[gl_InvocationID] = passed[gl_InvocationID];
  if (gl_InvocationID == 1) {
    whole.tint = passed[2].wzyx;
    whole.scale[0] = passed[0].x;
    whole.scale[1] = passed[3].y;
    for (int i = 0; i < 4; ++i) gl_TessLevelOuter[i] = level[gl_PrimitiveID * 6 + i];
    for (int i = 0; i < 2; ++i) gl_TessLevelInner[i] = level[gl_PrimitiveID * 6 + 4 + i];
  }
})";
  spec.evaluation = R"(
layout(quads, equal_spacing, ccw) in;
layout(location = 0) in vec4 color[];
layout(location = 1) patch in Shared { vec4 tint; float scale[2]; } whole;
layout(location = 0) out vec4 passed;
void main() {
  vec2 at = gl_TessCoord.xy;
  vec4 top = mix(gl_in[0].gl_Position, gl_in[1].gl_Position, at.x);
  vec4 bottom = mix(gl_in[3].gl_Position, gl_in[2].gl_Position, at.x);
  gl_Position = mix(top, bottom, at.y);
  passed = mix(color[0] * whole.scale[0], color[2] * whole.scale[1], at.x) * 0.5 + whole.tint * 0.5;
})";
  Patches patches = make_patches(run.random, 4, 3, 6.0f, false);
  draw(run, target, spec, patches, 2);
}

/// A restart ends a list of patches; what is left of a patch is dropped.
CTS_CASE("tessellation", "patch_restart") {
  run.require(run.gpu.extension_features.primitiveTopologyPatchListRestart, "primitiveTopologyPatchListRestart");
  const Target target = make_target(run, large());
  GraphicsSpec spec = base_spec(run);
  spec.evaluation = evaluation("quads, equal_spacing, ccw");
  spec.assembly.primitiveRestartEnable = VK_TRUE;
  Patches patches = make_patches(run.random, 4, 3, 6.0f, false);
  // The same for all: deviations.md, patch-numbers.
  for (size_t l = 6; l < patches.levels.size(); ++l) patches.levels[l] = patches.levels[l - 6];
  std::vector<uint16_t> order;
  for (uint16_t i = 0; i < patches.vertices.size() / 8; ++i) {
    if (i % 11 == 7 || i % 16 == 8) order.push_back(0xffff);
    order.push_back(i);
  }
  const Buffer levels = run.buffer_of(patches.levels);
  const Resources resources = run.resources({storage_buffer(0, levels)});
  spec.layout = resources.layout;
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  const Buffer vertices = run.buffer_of(patches.vertices), indices = run.buffer_of(order);
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    resources.bind(cmd);
    bind_vertices(cmd, vertices);
    vkCmdBindIndexBuffer(cmd, indices.handle, 0, VK_INDEX_TYPE_UINT16);
    vkCmdDrawIndexed(cmd, static_cast<uint32_t>(order.size()), 1, 0, 0, 0);
    vkCmdEndRenderPass(cmd);
  });
  out_target(run, target);
}

CTS_CASE("tessellation", "one_control_point") {
  const Target target = make_target(run, large());
  GraphicsSpec spec = base_spec(run);
  spec.tessellation.patchControlPoints = 1;
  spec.control = R"(
layout(vertices = 1) out;
layout(location = 0) in vec4 passed[];
layout(location = 0) out vec4 color[];
void main() {
  gl_out[gl_InvocationID].gl_Position = gl_in[0].gl_Position;
  color[gl_InvocationID] = passed[0];
  gl_TessLevelOuter = float[4](1.0 + passed[0].x * 7.0, 2.0, 3.0, 1.0 + passed[0].y * 5.0);
  gl_TessLevelInner = float[2](passed[0].z * 9.0, 4.0);
})";
  spec.evaluation = R"(
layout(quads, fractional_even_spacing, cw) in;
layout(location = 0) in vec4 color[];
layout(location = 0) out vec4 passed;
void main() {
  gl_Position = gl_in[0].gl_Position + vec4(gl_TessCoord.xy * 0.3 - 0.15, 0.0, 0.0);
  passed = color[0] * 0.6 + vec4(gl_TessCoord, 1.0) * 0.4;
})";
  draw(run, target, spec, make_patches(run.random, 5, 4, 6.0f, false));
}

CTS_CASE("tessellation", "geometry_behind") {
  run.require(run.gpu.features.geometryShader, "geometry shaders");
  for (const char* domain : kDomains) {
    const Target target = make_target(run, large());
    GraphicsSpec spec = base_spec(run);
    spec.evaluation = evaluation(std::string(domain) + ", equal_spacing, cw");
    const bool lines = domain == std::string("isolines");
    spec.geometry = std::string("layout(") + (lines ? "lines" : "triangles") + R"() in;
layout(triangle_strip, max_vertices = 3) out;
layout(location = 0) in vec4 passed[];
layout(location = 0) out vec4 color;
void main() {
  for (int i = 0; i < 3; ++i) {
    int v = i % )" + (lines ? "2" : "3") +
                    R"(;
    gl_Position = gl_in[v].gl_Position + vec4(i == 2 ? 0.03 : 0.0, i == 1 ? 0.02 : 0.0, 0.0, 0.0);
    color = passed[v] * 0.8 + 0.05 * vec4(float(gl_PrimitiveIDIn % 4));
    EmitVertex();
  }
})";
    draw(run, target, spec, make_patches(run.random, 3, 3, 7.0f, false));
  }
}

/// gl_PrimitiveID of every stage behind the tessellator, over several chunks and instances.
CTS_CASE("tessellation", "primitive_ids") {
  run.require(run.gpu.features.geometryShader, "geometry shaders");
  const Target target = make_target(run, large());
  GraphicsSpec spec = base_spec(run);
  spec.evaluation = R"(
layout(triangles, equal_spacing, cw) in;
layout(location = 0) in vec4 color[];
layout(location = 0) out vec4 passed;
void main() {
  gl_Position = vec4(0.0);
  for (int i = 0; i < 3; ++i) gl_Position += gl_in[i].gl_Position * gl_TessCoord[i];
  passed = vec4(float(gl_PrimitiveID) * 0.02, color[0].yz, 1.0);
})";
  spec.geometry = R"(
layout(triangles) in;
layout(triangle_strip, max_vertices = 3) out;
layout(location = 0) in vec4 passed[];
layout(location = 0) out vec4 color;
void main() {
  for (int i = 0; i < 3; ++i) {
    gl_Position = gl_in[i].gl_Position;
    color = passed[i];
    gl_PrimitiveID = gl_PrimitiveIDIn;
    EmitVertex();
  }
})";
  spec.fragment = R"(
layout(location = 0) in vec4 passed;
layout(location = 0) out vec4 result;
void main() { result = vec4(passed.xy, float(gl_PrimitiveID % 256) / 255.0, float(gl_PrimitiveID / 256) / 255.0); })";
  draw(run, target, spec, make_patches(run.random, 12, 12, 4.0f, true), 2);
}

/// Patch size and domain origin as commands.
CTS_CASE("tessellation", "dynamic_state") {
  run.require(run.gpu.extension_features.extendedDynamicState2PatchControlPoints, "dynamic patch size");
  run.require(run.gpu.extension_features.extendedDynamicState3TessellationDomainOrigin, "dynamic domain origin");
  const Target target = make_target(run, large());
  GraphicsSpec spec = base_spec(run);
  spec.evaluation = evaluation("quads, equal_spacing, cw");
  spec.fragment = R"(
layout(location = 0) in vec4 passed;
layout(location = 0) out vec4 result;
void main() { result = gl_FrontFacing ? passed : passed.zyxw * 0.5; })";
  spec.dynamic = {VK_DYNAMIC_STATE_PATCH_CONTROL_POINTS_EXT, VK_DYNAMIC_STATE_TESSELLATION_DOMAIN_ORIGIN_EXT};
  draw_with(run, target, spec, make_patches(run.random, 4, 4, 6.0f, false), [&](VkCommandBuffer cmd) {
    for (const uint32_t points : {4u, 8u}) {
      CTS_COMMAND(run.gpu, CmdSetPatchControlPointsEXT)(cmd, points);
      CTS_COMMAND(run.gpu, CmdSetTessellationDomainOriginEXT)
      (cmd, points == 4 ? VK_TESSELLATION_DOMAIN_ORIGIN_LOWER_LEFT : VK_TESSELLATION_DOMAIN_ORIGIN_UPPER_LEFT);
      vkCmdDraw(cmd, 32, 1, points * 4, 0);
    }
  });
}

/// A height map and push constants in every stage; the geometry shader samples without an explicit level.
CTS_CASE("tessellation", "resources_in_every_stage") {
  run.require(run.gpu.features.geometryShader, "geometry shaders");
  const Target target = make_target(run, large());
  GraphicsSpec spec = base_spec(run);
  ImageSpec image;
  image.extent = {32, 32, 1};
  image.levels = 4;
  image.usage = VK_IMAGE_USAGE_SAMPLED_BIT;
  const Image heights = run.image(image);
  run.fill_random(heights);
  const std::vector<float> scales = {0.4f, 0.3f, 0.2f, 0.9f};
  const Buffer uniforms = run.buffer_of(scales);
  const Resources resources =
      run.resources({sampled(0, heights, run.sampler(VK_FILTER_LINEAR)), uniform_buffer(1, uniforms)}, 16);
  spec.layout = resources.layout;
  const std::string shared = R"(
layout(set = 0, binding = 0) uniform sampler2D heights;
layout(set = 0, binding = 1) uniform Scales { vec4 scale; };
layout(push_constant) uniform Push { vec4 push; };
)";
  spec.control = shared + R"(
layout(vertices = 4) out;
layout(location = 0) in vec4 passed[];
layout(location = 0) out vec4 color[];
void main() {
  gl_out[gl_InvocationID].gl_Position = gl_in[gl_InvocationID].gl_Position;
  color[gl_InvocationID] = passed[gl_InvocationID] * scale.w;
  float level = 2.0 + 4.0 * textureLod(heights, passed[0].xy, 1.0).x + push.x;
  gl_TessLevelOuter = float[4](level, 3.0, level, 3.0);
  gl_TessLevelInner = float[2](level, 3.0);
})";
  spec.evaluation = shared + R"(
layout(quads, fractional_odd_spacing, cw) in;
layout(location = 0) in vec4 color[];
layout(location = 0) out vec4 passed;
void main() {
  vec4 top = mix(gl_in[0].gl_Position, gl_in[1].gl_Position, gl_TessCoord.x);
  vec4 bottom = mix(gl_in[3].gl_Position, gl_in[2].gl_Position, gl_TessCoord.x);
  gl_Position = mix(top, bottom, gl_TessCoord.y);
  gl_Position.y += textureLod(heights, gl_TessCoord.xy, push.y * 2.0).y * scale.x * 0.2;
  passed = mix(color[0], color[2], gl_TessCoord.x);
})";
  spec.geometry = shared + R"(
layout(triangles) in;
layout(triangle_strip, max_vertices = 3) out;
layout(location = 0) in vec4 passed[];
layout(location = 0) out vec4 color;
void main() {
  vec4 texel = texture(heights, gl_in[0].gl_Position.xy * 0.5 + 0.5);
  for (int i = 0; i < 3; ++i) {
    gl_Position = gl_in[i].gl_Position;
    color = passed[i] * push.z + texel * scale.y;
    EmitVertex();
  }
})";
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  const Patches patches = make_patches(run.random, 3, 3, 4.0f, false);
  const Buffer vertices = run.buffer_of(patches.vertices);
  const float push[4] = {0.5f, 0.6f, 0.7f, 1.0f};
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    resources.bind(cmd);
    vkCmdPushConstants(cmd, resources.layout, VK_SHADER_STAGE_ALL, 0, 16, push);
    bind_vertices(cmd, vertices);
    vkCmdDraw(cmd, patches.count * 4, 1, 0, 0);
    vkCmdEndRenderPass(cmd);
  });
  out_target(run, target);
}

/// Doubles between all stages take two words a component.
CTS_CASE("tessellation", "doubles") {
  run.require(run.gpu.features.shaderFloat64, "doubles");
  const Target target = make_target(run, large());
  GraphicsSpec spec = base_spec(run);
  spec.vertex = R"(
layout(location = 0) in vec4 position;
layout(location = 1) in vec4 color;
layout(location = 0) out dvec3 wide;
layout(location = 2) out double narrow;
void main() {
  wide = dvec3(color.xyz) / 3.0lf;
  narrow = double(color.w) * 0.7lf;
  gl_Position = position;
})";
  spec.control = R"(
layout(vertices = 4) out;
layout(location = 0) in dvec3 wide[];
layout(location = 2) in double narrow[];
layout(location = 0) out dvec3 control_wide[];
layout(location = 2) patch out dvec4 control_patch;
void main() {
  gl_out[gl_InvocationID].gl_Position = gl_in[gl_InvocationID].gl_Position;
  control_wide[gl_InvocationID] = wide[3 - gl_InvocationID];
  if (gl_InvocationID == 1) control_patch = dvec4(narrow[0], narrow[1], narrow[2], narrow[3]);
  gl_TessLevelOuter = float[4](3.0, 2.0, 3.0, 2.0);
  gl_TessLevelInner = float[2](3.0, 2.0);
})";
  spec.evaluation = R"(
layout(quads, equal_spacing, cw) in;
layout(location = 0) in dvec3 control_wide[];
layout(location = 2) patch in dvec4 control_patch;
layout(location = 0) out vec4 passed;
void main() {
  vec4 top = mix(gl_in[0].gl_Position, gl_in[1].gl_Position, gl_TessCoord.x);
  vec4 bottom = mix(gl_in[3].gl_Position, gl_in[2].gl_Position, gl_TessCoord.x);
  gl_Position = mix(top, bottom, gl_TessCoord.y);
  passed = vec4(control_wide[0] * 2.0lf + control_wide[2], 1.0) * 0.7 + vec4(control_patch) * 0.3;
})";
  draw(run, target, spec, make_patches(run.random, 4, 3, 6.0f, false));
}

CTS_CASE("tessellation", "pipeline_statistics") {
  run.require(run.gpu.features.pipelineStatisticsQuery, "pipeline statistics");
  const Target target = make_target(run, large());
  GraphicsSpec spec = base_spec(run);
  spec.evaluation = evaluation("quads, equal_spacing, cw");
  const Patches patches = make_patches(run.random, 3, 3, 7.0f, false);
  const Buffer levels = run.buffer_of(patches.levels);
  const Resources resources = run.resources({storage_buffer(0, levels)});
  spec.layout = resources.layout;
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  constexpr VkQueryPipelineStatisticFlags kStatistics =
      VK_QUERY_PIPELINE_STATISTIC_INPUT_ASSEMBLY_VERTICES_BIT |
      VK_QUERY_PIPELINE_STATISTIC_INPUT_ASSEMBLY_PRIMITIVES_BIT | VK_QUERY_PIPELINE_STATISTIC_CLIPPING_INVOCATIONS_BIT |
      VK_QUERY_PIPELINE_STATISTIC_TESSELLATION_CONTROL_SHADER_PATCHES_BIT |
      VK_QUERY_PIPELINE_STATISTIC_TESSELLATION_EVALUATION_SHADER_INVOCATIONS_BIT;
  const VkQueryPool pool = make_query_pool(run, VK_QUERY_TYPE_PIPELINE_STATISTICS, 1, kStatistics);
  const Buffer vertices = run.buffer_of(patches.vertices);
  const Buffer counts = run.buffer(5 * 4, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
  run.once([&](VkCommandBuffer cmd) {
    vkCmdResetQueryPool(cmd, pool, 0, 1);
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    resources.bind(cmd);
    bind_vertices(cmd, vertices);
    vkCmdBeginQuery(cmd, pool, 0, 0);
    vkCmdDraw(cmd, patches.count * 4, 1, 0, 0);
    vkCmdEndQuery(cmd, pool, 0);
    vkCmdEndRenderPass(cmd);
    vkCmdCopyQueryPoolResults(cmd, pool, 0, 1, counts.handle, 0, 0, VK_QUERY_RESULT_WAIT_BIT);
  });
  out_target(run, target);
  run.out("counts", counts);
}

CTS_RANDOM("tessellation", "random", 40) {
  Random& random = run.random;
  TargetSpec target_spec;
  target_spec.width = 32 + random.below(160);
  target_spec.height = 32 + random.below(160);
  if (random.chance(0.4f)) target_spec.depth = VK_FORMAT_D32_SFLOAT;
  GraphicsSpec spec = base_spec(run);
  const std::string domain = kDomains[random.below(3)];
  const std::string order = random.pick({", cw", ", ccw", ", cw", ", cw, point_mode"});
  const std::string layout = domain + ", " + kSpacings[random.below(3)] + order;
  const bool points = layout.find("point_mode") != std::string::npos;
  if (points) run.require(run.gpu.features.shaderTessellationAndGeometryPointSize, "point sizes of evaluation shaders");
  spec.evaluation = evaluation(layout, points);
  spec.depth.depthTestEnable = spec.depth.depthWriteEnable = VK_TRUE;
  const bool filled = domain != "isolines" && !points;
  if (filled && random.chance(0.3f)) spec.raster.polygonMode = VK_POLYGON_MODE_LINE;
  if (filled && random.chance(0.3f)) spec.raster.cullMode = VK_CULL_MODE_BACK_BIT;
  // The reference loses lines of less than a pixel when multisampled (deviations.md, multisample-short-lines).
  const bool lines = domain == "isolines" || spec.raster.polygonMode == VK_POLYGON_MODE_LINE;
  if (!lines && random.chance(0.3f)) target_spec.samples = VK_SAMPLE_COUNT_4_BIT;
  const Target target = make_target(run, target_spec);
  run.note("evaluation", spec.evaluation);
  const uint32_t instances = 1 + random.below(2);
  const bool last = random.chance(0.3f);
  const float most = random.chance(0.2f) ? 64.0f : 10.0f;
  const uint32_t rows = 1 + random.below(5);
  draw(run, target, spec, make_patches(random, 1 + random.below(5), rows, most, last), instances);
  run.may_be_blank();
}

}  // namespace
}  // namespace vitrine::cts
