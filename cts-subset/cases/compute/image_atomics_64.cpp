// Images and texel buffers of 64-bit integers (VK_EXT_shader_image_atomic_int64), which the reference does not have.
// Atomics act on a storage buffer of the same texels there; loads and stores on images of two words.
#include "cases/common/work_items.h"
#include "harness/case.h"
#include "harness/run.h"

namespace vitrine::cts {
namespace {

struct Dimension {
  const char* name;  ///< of GLSL's image type, without its prefix
  VkImageViewType view;
  VkExtent3D extent;
  uint32_t layers;
  const char* place;  ///< of texel i: outside of the image for those that are negative
};

constexpr uint32_t kTexels = 64;
constexpr VkImageViewType kNoView = VK_IMAGE_VIEW_TYPE_MAX_ENUM;
constexpr Dimension kDimensions[] = {
    {"1D", VK_IMAGE_VIEW_TYPE_1D, {64, 1, 1}, 1, "(i)"},
    {"2D", VK_IMAGE_VIEW_TYPE_2D, {8, 8, 1}, 1, "ivec2((i) & 7, (i) >> 3)"},
    {"3D", VK_IMAGE_VIEW_TYPE_3D, {4, 4, 4}, 1, "ivec3((i) & 3, (i) >> 2 & 3, (i) >> 4)"},
    {"1DArray", VK_IMAGE_VIEW_TYPE_1D_ARRAY, {16, 1, 1}, 4, "ivec2((i) & 15, (i) >> 4)"},
    {"2DArray", VK_IMAGE_VIEW_TYPE_2D_ARRAY, {4, 4, 1}, 4, "ivec3((i) & 3, (i) >> 2 & 3, (i) >> 4)"},
    {"Cube", VK_IMAGE_VIEW_TYPE_CUBE, {4, 4, 1}, 6, "ivec3((i) & 3, (i) >> 2 & 3, (i) >> 4)"},
    {"CubeArray", VK_IMAGE_VIEW_TYPE_CUBE_ARRAY, {4, 4, 1}, 12, "ivec3((i) & 3, (i) >> 2 & 3, (i) >> 4)"},
    {"Buffer", kNoView, {64, 1, 1}, 1, "(i)"},
};

uint32_t texels_of(const Dimension& d) { return d.extent.width * d.extent.height * d.extent.depth * d.layers; }

std::vector<uint32_t> random_words(Run& run, uint32_t count) {
  std::vector<uint32_t> words(count);
  for (uint32_t& word : words) word = run.random.chance(0.2f) ? run.random.below(3) : run.random.bits();
  return words;
}

VkFormat format_of(bool is_signed) { return is_signed ? VK_FORMAT_R64_SINT : VK_FORMAT_R64_UINT; }

/// An image of two words a texel, which a view of 64-bit texels may show.
Image make_image(Run& run, const Dimension& dimension) {
  ImageSpec spec;
  spec.format = VK_FORMAT_R32G32_UINT;
  spec.usage = VK_IMAGE_USAGE_STORAGE_BIT;
  spec.extent = dimension.extent;
  spec.layers = dimension.layers;
  spec.view = dimension.view;
  spec.flags = VK_IMAGE_CREATE_MUTABLE_FORMAT_BIT;
  if (spec.layers % 6 == 0) spec.flags |= VK_IMAGE_CREATE_CUBE_COMPATIBLE_BIT;
  return run.image(spec);
}

std::span<const unsigned char> bytes_of(const std::vector<uint32_t>& words) {
  return {reinterpret_cast<const unsigned char*>(words.data()), words.size() * sizeof(uint32_t)};
}

/// Of a buffer: a view of 64-bit or of two times 32-bit texels.
VkBufferView texel_view(Run& run, const Buffer& buffer, VkFormat format) {
  VkBufferViewCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO};
  info.buffer = buffer.handle;
  info.format = format;
  info.range = buffer.size;
  VkBufferView view;
  CTS_VK(vkCreateBufferView(run.device, &info, nullptr, &view));
  return run.own(view, vkDestroyBufferView);
}

/// The texels as a descriptor, with what brings them back.
struct Texels {
  Binding binding;
  std::function<std::vector<unsigned char>()> read;
};

Texels texels_in_buffer(Run& run, const std::vector<uint32_t>& words, VkFormat format) {
  const Buffer buffer = run.buffer_of(words);
  Texels result{storage_buffer(0, buffer), [=] { return std::vector(buffer.data, buffer.data + buffer.size); }};
  if (format == VK_FORMAT_UNDEFINED) return result;
  const Buffer texels = run.buffer(buffer.size, VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT);
  std::memcpy(texels.data, buffer.data, buffer.size);
  return {{0, VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER, {}, {}, {texel_view(run, texels, format)}},
          [=] { return std::vector(texels.data, texels.data + texels.size); }};
}

Texels texels_in_image(Run& run, const Dimension& dimension, const std::vector<uint32_t>& words, VkFormat format) {
  if (dimension.view == kNoView) return texels_in_buffer(run, words, format);
  const Image image = make_image(run, dimension);
  run.upload(image, 0, bytes_of(words));
  const VkImageView view = run.image_view(image, dimension.view, format, image.range());
  return {{0, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, {}, {{VK_NULL_HANDLE, view, VK_IMAGE_LAYOUT_GENERAL}}, {}},
          [&run, image] { return run.download(image, 0); }};
}

constexpr const char* kExtensions =
    "#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require\n"
    "#extension GL_EXT_shader_atomic_int64 : require\n";

/// `has`: on images of 64-bit integers; else the same on an array.
std::string atomic_code(const Dimension& dimension, bool is_signed, const std::string& operation, bool has) {
  const std::string type = is_signed ? "int64_t" : "uint64_t", prefix = is_signed ? "i64" : "u64";
  const bool compares = operation == "CompSwap", commutes = !compares && operation != "Exchange";
  const std::string operands = compares ? "old, x" : "x";
  std::string code = std::string("#version 450\n") + kExtensions;
  if (has) {
    code += "#extension GL_EXT_shader_image_int64 : require\n#define T " + type + "\nlayout(binding = 0, r64" +
            (is_signed ? "i" : "ui") + ") uniform " + prefix + "image" + dimension.name + " t;\n#define PLACE(i) " +
            dimension.place + "\n#define LOAD(i) imageLoad(t, PLACE(i)).x\n#define ACT(i) imageAtomic" + operation +
            "(t, PLACE(i), " + operands + ")\n";
  } else {
    code += "#define T " + type + "\nlayout(std430, binding = 0) buffer I { T t[]; };\n#define LOAD(i) t[i]\n" +
            "#define ACT(i) ((i) >= 0 ? atomic" + operation + "(t[max(i, 0)], " + operands + ") : T(0))\n";
  }
  code +=
      "layout(local_size_x = 64) in;\n"
      "layout(std430, binding = 1) readonly buffer A { T a[]; };\n"
      "layout(std430, binding = 2) writeonly buffer R { T r[]; };\n"
      "void main() {\n  int i = int(gl_LocalInvocationIndex);\n  T old = a[(i + 1) & 63], x = a[i];\n";
  if (compares) code += "  if ((i & 1) != 0) old = LOAD(i);\n";
  code += "  r[i] = ACT(i);\n";
  if (commutes) code += "  memoryBarrier(); barrier();\n  i = i * 7 % 5 - 1;\n  ACT(i);\n";
  return code + "}\n";
}

void image_atomic(Run& run, const Dimension& dimension, bool is_signed, const std::string& operation) {
  run.require(run.gpu.extension_features.shaderBufferInt64Atomics, "64-bit atomics");
  const bool has = run.gpu.extension_features.shaderImageInt64Atomics;
  const std::vector<uint32_t> words = random_words(run, 2 * texels_of(dimension));
  const Texels texels = has ? texels_in_image(run, dimension, words, format_of(is_signed))
                            : texels_in_buffer(run, words, VK_FORMAT_UNDEFINED);
  const std::string code = atomic_code(dimension, is_signed, operation, has);
  run.note("shader", code);
  const Buffer in = run.buffer_of(random_words(run, 2 * kTexels)), out = run.buffer(in.size);
  const Resources res = run.resources({texels.binding, storage_buffer(1, in), storage_buffer(2, out)});
  run.dispatch(res, run.compute(res.layout, run.shader(VK_SHADER_STAGE_COMPUTE_BIT, code)), 1);
  run.out("texels", run.buffer_of(texels.read()));
  run.out("old", out);
}

const bool kAtomics = [] {
  for (const Dimension& dimension : kDimensions)
    for (const bool is_signed : {false, true})
      for (const char* operation : {"Add", "Min", "Max", "And", "Or", "Xor", "Exchange", "CompSwap"}) {
        if (dimension.view != VK_IMAGE_VIEW_TYPE_2D && is_signed != (operation[0] == 'M')) continue;
        AddCase("compute",
                std::string("image_atomics_64.") + dimension.name + (is_signed ? ".int." : ".uint.") + operation,
                [=](Run& run) { image_atomic(run, dimension, is_signed, operation); });
      }
  return true;
}();

/// Loads and stores, in some stage, of texels that may lie outside; the same on two words where `has` is false.
std::string access_code(const Dimension& dimension, bool is_signed, bool declared, bool has) {
  const std::string type = is_signed ? "i64vec4" : "u64vec4";
  const std::string format = !declared ? "" : has ? is_signed ? ", r64i" : ", r64ui" : ", rg32ui";
  const std::string image = (has ? is_signed ? "i64image" : "u64image" : "uimage") + std::string(dimension.name);
  std::string code = kExtensions;
  if (has) code += "#extension GL_EXT_shader_image_int64 : require\n";
  if (!declared) code += "#extension GL_EXT_shader_image_load_formatted : require\n";
  code += "#define PLACE(i) " + std::string(dimension.place) + "\nlayout(binding = 0" + format + ") uniform " + image +
          " t;\nlayout(std430, binding = 1) readonly buffer W { ivec2 w[]; };\n"
          "layout(std430, binding = 2) writeonly buffer R { " +
          type + " r[]; };\nvoid work(int i) {\n";
  if (has)
    code += "  " + type + " v = imageLoad(t, PLACE(w[i].x));\n  imageStore(t, PLACE(w[i].y), v + " + type +
            "(7, 1, 2, 3));\n";
  else
    code += "  uvec4 u = imageLoad(t, PLACE(w[i].x));\n  " + type + " v = " + type + "(" +
            (is_signed ? "packInt2x32(ivec2(u.xy))" : "packUint2x32(u.xy)") +
            ", 0, 0, u.w);\n  u.xy = " + (is_signed ? "uvec2(unpackInt2x32(v.x + 7))" : "unpackUint2x32(v.x + 7ul)") +
            ";\n  imageStore(t, PLACE(w[i].y), u);\n";
  return code + "  r[i] = v;\n}\n";
}

/// Each invocation has a texel to load in the first half, and one to store in the second.
CTS_RANDOM("image", "random_wide_texels", 64) {
  const bool has = run.gpu.extension_features.shaderImageInt64Atomics;
  const Dimension& dimension = kDimensions[run.index % std::size(kDimensions)];
  const bool is_signed = run.random.chance(0.5f);
  const bool declared = run.random.chance(0.5f) || !run.gpu.features.shaderStorageImageReadWithoutFormat;
  const auto half = static_cast<int32_t>(texels_of(dimension) / 2);
  const std::vector<uint32_t> words = random_words(run, static_cast<uint32_t>(half) * 4);
  const Texels texels = texels_in_image(run, dimension, words, has ? format_of(is_signed) : VK_FORMAT_R32G32_UINT);
  std::vector<int32_t> places;
  for (int32_t i = 0; i < half; ++i)
    for (const int32_t first : {0, half})
      places.push_back(run.random.chance(0.8f) ? first + (first == 0 ? run.random.between(0, half - 1) : i)
                                               : run.random.pick({-1, -5, 100000}));
  const std::string code = access_code(dimension, is_signed, declared, has);
  const WorkStage stage = random_work_stage(run);
  run.note("code", name_of(stage) + code);
  const Buffer results = run.buffer(VkDeviceSize{32} * static_cast<uint32_t>(half));
  const Resources res =
      run.resources({texels.binding, storage_buffer(1, run.buffer_of(places)), storage_buffer(2, results)});
  run_work_items(run, stage, res, code, static_cast<uint32_t>(half));
  run.out("texels", run.buffer_of(texels.read()));
  run.out("loaded", results);
}

}  // namespace
}  // namespace vitrine::cts
