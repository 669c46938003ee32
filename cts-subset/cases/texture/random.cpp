// Random lookups of fragments: textures, samplers and coordinates of every kind (lookup.cpp).
#include "cases/texture/lookup.h"
#include "harness/case.h"
#include "harness/graphics.h"

namespace vitrine::cts {
namespace {

/// Whether the reference divides the texels of an anisotropic lookup by the sizes of a neighbour's level
/// (deviations.md, anisotropic-neighbours): neighbouring quads then look up the same.
bool takes_other_levels(const Family& family, const RandomLookup& found) {
  return family.anisotropic && (found.is_cube() || family.kind != Kind::kImplicit);
}

/// Coordinates of any pixel, so that gradients may be the differences that the reference takes in their place
/// (deviations.md, anisotropic-gradients).
std::string coordinates_function(bool linear) {
  return "vec4 at(ivec2 pixel) {\n  precise vec4 c = " +
         std::string(linear ? "(base + (float(pixel.x) + 0.5) * dx) + (float(pixel.y) + 0.5) * dy"
                            : "texelFetch(table, pixel, 0)") +
         ";\n  return c;\n}\n";
}

std::string fragment_text(Random& random, const Family& family, const RandomLookup& found) {
  const bool paired = takes_other_levels(family, found);
  const bool derivatives = family.kind == Kind::kImplicit || family.kind == Kind::kBias ||
                           family.kind == Kind::kQuery || family.kind == Kind::kProj || family.kind == Kind::kOffset ||
                           family.kind == Kind::kShadow || family.anisotropic;
  // Interpolated directions could meet a cube's corner (deviations.md, cube-corners).
  const bool table_only = found.is_cube() && !family.anisotropic && found.sampler.magFilter == VK_FILTER_LINEAR;
  const bool linear = derivatives && !table_only && !family.special && random.chance(0.85f);
  const bool own_gradients = family.anisotropic && family.kind == Kind::kGrad;
  std::string text = lookup_declarations(found, family.kind) + "layout(location = 0) out " +
                     result_prefix(found, family.kind) + "vec4 color;\n";
  if (own_gradients) text += coordinates_function(linear);
  text += std::string("void main() {\n  ivec2 pixel = ivec2(gl_FragCoord.xy);\n") +
          (paired ? "  pixel.x = pixel.x >> 2 << 1 | pixel.x & 1;\n" : "") + "  vec4 extra = texelFetch(table, " +
          (paired ? "(pixel & ~1)" : "pixel") + " + ivec2(0, 64), 0);\n";
  text += own_gradients ? "  ivec2 first = pixel & ~1;\n"
                          "  precise vec4 gx = at(first + ivec2(1, 0)) - at(first);\n"
                          "  precise vec4 gy = at(first + ivec2(0, 1)) - at(first);\n"
                        : "  vec4 gx = extra.xyzx * 0.1, gy = extra.yzxz * 0.07;\n";
  text += own_gradients ? "  vec4 c = at(pixel);\n"
          : linear      ? "  precise vec4 c = (base + (float(pixel.x) + 0.5) * dx) + gl_FragCoord.y * dy;\n"
                        : "  vec4 c = texelFetch(table, pixel, 0);\n";
  return text + "  color = " + lookup(random, family, found.shape) + ";\n}\n";
}

void random_texture(Run& run, const Family& family) {
  Random& random = run.random;
  const RandomLookup found = random_lookup(run, family);
  const Resources res = run.resources(found.bindings, 48);
  TargetSpec target_spec;
  target_spec.colors = {result_format(found, family.kind)};
  const Target target = make_target(run, target_spec);
  GraphicsSpec spec;
  spec.layout = res.layout;
  spec.vertex = kFullScreenVertex;
  spec.fragment = fragment_text(random, family, found);
  run.note("fragment", found.description + spec.fragment);
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  const std::array<float, 12> push = random_slopes(random, found.shape, found.sampler);
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    res.bind(cmd);
    vkCmdPushConstants(cmd, res.layout, VK_SHADER_STAGE_ALL, 0, sizeof push, push.data());
    vkCmdDraw(cmd, 3, 1, 0, 0);
    vkCmdEndRenderPass(cmd);
  });
  run.out("color", target.colors[0]);
  run.outputs.back().nan_bits_free = true;
  run.may_be_blank();
}

const std::vector<Family>& families() {
  static const std::vector<Family> list = {
      {"random_implicit_lod", Kind::kImplicit, {k1D, k1DArray, k2D, k2D, k2D, k2DArray, k3D}, 200},
      {"random_bias", Kind::kBias, {k1D, k2D, k2D, k2DArray, k3D}, 60},
      {"random_explicit_lod", Kind::kLod, {k1D, k1DArray, k2D, k2D, k2DArray, k3D}, 120},
      {"random_gradients", Kind::kGrad, {k1D, k2D, k2D, k2DArray, k3D}, 80},
      {"random_offset", Kind::kOffset, {k1D, k2D, k2DArray, k3D}, 60},
      {"random_projection", Kind::kProj, {k1D, k2D}, 30},
      {"random_gather", Kind::kGather, {k2D, k2DArray}, 60},
      {"random_fetch", Kind::kFetch, {k1D, k1DArray, k2D, k2DArray, k3D}, 80},
      {"random_query", Kind::kQuery, {k1D, k2D, k2DArray, k3D}, 30},
      {"random_query_cube", Kind::kQuery, {kCubeArray}, 30},
      {"random_shadow", Kind::kShadow, {k1D, k2D, k2D, k2DArray}, 60},
      {"random_cube", Kind::kLod, {kCube, kCubeArray}, 60},
      {"random_cube_implicit", Kind::kImplicit, {kCube}, 40},
      {"random_compressed", Kind::kImplicit, {k2D, k2DArray}, 60, true},
      {"random_compressed_fetch", Kind::kFetch, {k2D}, 40, true},
      {"random_border", Kind::kImplicit, {k1D, k2D, k2D, k2DArray, k3D}, 60, false, false, true},
      {"random_border_lod", Kind::kLod, {k1D, k2D, k2DArray, k3D}, 40, false, false, true},
      {"random_border_gather", Kind::kGather, {k2D, k2DArray}, 30, false, false, true},
      {"random_border_compressed", Kind::kImplicit, {k2D}, 30, true, false, true},
      {"random_minmax", Kind::kImplicit, {k1D, k2D, k2D, k2DArray, k3D}, 40, false, false, false, true},
      {"random_minmax_lod", Kind::kLod, {k1D, k2D, k2DArray, k3D}, 30, false, false, false, true},
      {"random_unnormalized", Kind::kLod, {k1D, k2D}, 40, false, false, false, false, true},
      {"random_unnormalized_compressed", Kind::kLod, {k2D}, 20, true, false, false, false, true},
      {"random_cube_gather", Kind::kGather, {kCube, kCubeArray}, 30},
      {"random_compressed_lod", Kind::kLod, {k2D, k2DArray}, 30, true},
      {"random_compressed_gather", Kind::kGather, {k2D, k2DArray}, 30, true},
      {"random_compressed_cube", Kind::kLod, {kCube}, 30, true},
      {"random_anisotropic", Kind::kImplicit, {k2D}, 40, false, true},
      {"random_anisotropic_array", Kind::kImplicit, {k2DArray}, 20, false, true},
      {"random_anisotropic_compressed", Kind::kImplicit, {k2D, k2DArray}, 20, true, true},
      {"random_anisotropic_cube", Kind::kImplicit, {kCube, kCubeArray}, 40, false, true},
      {"random_anisotropic_volume", Kind::kImplicit, {k3D}, 20, false, true},
      {"random_anisotropic_lod", Kind::kLod, {k2D, k2DArray, k3D, kCube, kCubeArray}, 40, false, true},
      {"random_anisotropic_bias", Kind::kBias, {k2D, k2DArray, k3D, kCube}, 30, false, true},
      {"random_anisotropic_offset", Kind::kOffset, {k2D, k2DArray, k3D}, 20, false, true},
      {"random_anisotropic_projection", Kind::kProj, {k2D}, 10, false, true},
      {"random_anisotropic_query", Kind::kQuery, {k2D, k2DArray, k3D}, 20, false, true},
      {"random_anisotropic_gradients", Kind::kGrad, {k2D, k2DArray, k3D}, 20, false, true},
      {"random_anisotropic_line", Kind::kImplicit, {k1D, k1DArray}, 20, false, true},
      {.name = "random_anisotropic_integer",
       .kind = Kind::kImplicit,
       .shapes = {k2D, k2DArray, k3D, kCube},
       .count = 20,
       .anisotropic = true,
       .integer = true},
      {"random_anisotropic_query_cube", Kind::kQuery, {kCubeArray}, 20, false, true},
      {"random_anisotropic_border", Kind::kImplicit, {k2D, k2DArray}, 20, false, true, true},
      {"random_anisotropic_minmax", Kind::kImplicit, {k2D}, 10, false, true, false, true},
      {"random_anisotropic_compressed_cube", Kind::kLod, {kCube}, 20, true, true},
      {.name = "random_special",
       .kind = Kind::kImplicit,
       .shapes = {k1D, k1DArray, k2D, k2D, k2DArray, k3D},
       .count = 40,
       .special = true},
      {.name = "random_special_mixed",
       .kind = Kind::kImplicit,
       .shapes = {k1D, k1DArray, k2D, k2DArray},
       .count = 20,
       .special = true,
       .mixed = true},
      {.name = "random_special_bias",
       .kind = Kind::kBias,
       .shapes = {k1D, k2D, k2D, k2DArray, k3D},
       .count = 20,
       .special = true},
      {.name = "random_special_lod",
       .kind = Kind::kLod,
       .shapes = {k1D, k1DArray, k2D, k2D, k2DArray, k3D, kCube},
       .count = 30,
       .special = true},
      {.name = "random_special_gradients",
       .kind = Kind::kGrad,
       .shapes = {k1D, k2D, k2D, k2DArray, k3D},
       .count = 20,
       .special = true},
      {.name = "random_special_offset",
       .kind = Kind::kOffset,
       .shapes = {k1D, k2D, k2DArray, k3D},
       .count = 20,
       .special = true},
      {.name = "random_special_gather", .kind = Kind::kGather, .shapes = {k2D, k2DArray}, .count = 20, .special = true},
      {.name = "random_special_query",
       .kind = Kind::kQuery,
       .shapes = {k1D, k2D, k2DArray, k3D, kCubeArray},
       .count = 20,
       .special = true},
      {.name = "random_special_shadow",
       .kind = Kind::kShadow,
       .shapes = {k1D, k2D, k2D, k2DArray},
       .count = 20,
       .special = true},
      {.name = "random_special_anisotropic",
       .kind = Kind::kImplicit,
       .shapes = {k2D, k2DArray, k3D},
       .count = 20,
       .anisotropic = true,
       .special = true},
      {.name = "random_special_anisotropic_bias",
       .kind = Kind::kBias,
       .shapes = {k2D, k2DArray, k3D},
       .count = 20,
       .anisotropic = true,
       .special = true},
      {.name = "random_special_anisotropic_lod",
       .kind = Kind::kLod,
       .shapes = {k2D, k2DArray, k3D, kCube},
       .count = 20,
       .anisotropic = true,
       .special = true},
      {.name = "random_lacking", .kind = Kind::kImplicit, .shapes = {k2D, k2DArray}, .count = 60, .lacking = true},
      {.name = "random_lacking_lod",
       .kind = Kind::kLod,
       .shapes = {k2D, k2DArray, kCube},
       .count = 40,
       .lacking = true},
      {.name = "random_lacking_gather", .kind = Kind::kGather, .shapes = {k2D, k2DArray}, .count = 20, .lacking = true},
      {.name = "random_lacking_fetch", .kind = Kind::kFetch, .shapes = {k2D, k2DArray}, .count = 20, .lacking = true},
  };
  return list;
}

const bool kRegistered = [] {
  for (const Family& family : families())
    AddGenerator("texture", family.name, family.count, [&family](Run& run) { random_texture(run, family); });
  return true;
}();

}  // namespace
}  // namespace vitrine::cts
