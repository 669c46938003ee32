// Random texel buffers: every format, parts of buffers, texels beyond them, in several stages.
#include "cases/api/random_transfer.h"
#include "cases/common/storage_format.h"
#include "cases/common/work_items.h"
#include "harness/case.h"
#include "texel/format.h"

namespace vitrine::cts {
namespace {

constexpr uint32_t kWork = 1024;

/// Formats of which the reference has these buffer features, of the core and plain.
std::vector<VkFormat> buffer_formats(VkFormatFeatureFlags features) {
  std::vector<VkFormat> result;
  for (int number = 1; number <= VK_FORMAT_E5B9G9R9_UFLOAT_PACK32; ++number) {
    const auto format = static_cast<VkFormat>(number);
    const VkFormatProperties properties = gpus().reference.format_properties(format);
    if ((properties.bufferFeatures & features) == features && texel::format_desc(format).plain)
      result.push_back(format);
  }
  return result;
}

std::string prefix_of(VkFormat format) {
  const texel::FormatDesc& desc = texel::format_desc(format);
  return !desc.is_integer() ? "" : desc.kind == texel::Kind::kSint ? "i" : "u";
}

struct View {
  Buffer buffer;
  uint32_t texels;
  VkBufferView handle;
};

/// Some texels of a larger buffer of random bytes.
View random_view(Run& run, VkFormat format, VkBufferUsageFlags usage) {
  Random& random = run.random;
  const uint32_t size = texel::format_desc(format).block_bytes;
  View view{run.buffer(32768, usage), 1 + random.below(1000), VK_NULL_HANDLE};
  for (VkDeviceSize i = 0; i < view.buffer.size; ++i)
    view.buffer.data[i] = static_cast<unsigned char>(random.bits() >> 24);
  VkBufferViewCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO};
  info.buffer = view.buffer.handle;
  info.format = format;
  info.offset = VkDeviceSize{random.below(200)} * 48;
  info.range = VkDeviceSize{view.texels} * size;
  CTS_VK(vkCreateBufferView(run.device, &info, nullptr, &view.handle));
  run.own(view.handle, vkDestroyBufferView);
  return view;
}

/// Mostly inside of the view.
Buffer random_places(Run& run, const View& view) {
  std::vector<int32_t> places(kWork);
  const auto n = static_cast<int32_t>(view.texels);
  for (int32_t& place : places)
    place = run.random.chance(0.9f) ? run.random.between(0, n - 1) : run.random.between(-4, n + 40);
  return run.buffer_of(places);
}

void out(Run& run, const char* name, const Buffer& buffer, const std::string& prefix) {
  Output& output = run.out(name, buffer, prefix.empty() ? VK_FORMAT_R32G32B32A32_SFLOAT : VK_FORMAT_R32G32B32A32_UINT);
  output.nan_bits_free = output.may_be_blank = true;
}

/// Fetches of formats in turn.
CTS_RANDOM("texture", "random_texel_buffer", 90) {
  const std::vector<VkFormat> formats = buffer_formats(VK_FORMAT_FEATURE_UNIFORM_TEXEL_BUFFER_BIT);
  const VkFormat format = formats[run.index % formats.size()];
  const std::string prefix = prefix_of(format);
  const View view = random_view(run, format, VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT);
  const Buffer places = random_places(run, view), results = run.buffer(VkDeviceSize{16} * (kWork + 1));
  const std::string code = "layout(binding = 0) uniform " + prefix +
                           "samplerBuffer t;\nlayout(std430, binding = 1) readonly buffer W { int w[]; };\n"
                           "layout(std430, binding = 2) writeonly buffer R { " +
                           prefix +
                           "vec4 r[]; };\nvoid work(int i) {\n  r[i] = texelFetch(t, w[i]);\n  if (i == 0) r[" +
                           std::to_string(kWork) + "] = " + prefix + "vec4(textureSize(t));\n}\n";
  const WorkStage stage = random_work_stage(run);
  run.note("code", std::string(texel::format_desc(format).name) + " " + name_of(stage) + code);
  const Resources res = run.resources({{0, VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, {}, {}, {view.handle}},
                                       storage_buffer(1, places),
                                       storage_buffer(2, results)});
  run_work_items(run, stage, res, code, kWork);
  out(run, "results", results, prefix);
}

std::vector<VkFormat> storable_formats() {
  std::vector<VkFormat> result;
  for (const VkFormat format : storage_formats(VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT)) {
    const VkFormatProperties properties = gpus().reference.format_properties(format);
    if (properties.bufferFeatures & VK_FORMAT_FEATURE_STORAGE_TEXEL_BUFFER_BIT) result.push_back(format);
  }
  return result;
}

/// Loads of one buffer stored to another of the same kind of numbers.
CTS_RANDOM("image", "random_texel_buffer", 60) {
  Random& random = run.random;
  const std::vector<VkFormat> formats = storable_formats();
  const VkFormat from_format = formats[run.index % formats.size()];
  const std::string prefix = prefix_of(from_format);
  std::vector<VkFormat> targets;
  for (const VkFormat format : formats)
    if (prefix_of(format) == prefix) targets.push_back(format);
  const VkFormat to_format = random.pick(targets);
  const View from = random_view(run, from_format, VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT),
             to = random_view(run, to_format, VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT);
  const Buffer places = random_places(run, from), results = run.buffer(VkDeviceSize{16} * (kWork + 1));
  const auto declaration = [&](uint32_t binding, VkFormat format, const char* name) {
    return "layout(binding = " + std::to_string(binding) + ", " + image_layout(format) + ") uniform " + prefix +
           "imageBuffer " + name + ";\n";
  };
  const std::string code = declaration(0, from_format, "a") + declaration(1, to_format, "b") +
                           "layout(std430, binding = 2) readonly buffer W { int w[]; };\n"
                           "layout(std430, binding = 3) writeonly buffer R { " +
                           prefix + "vec4 r[]; };\nvoid work(int i) {\n  " + prefix +
                           "vec4 v = imageLoad(a, w[i]);\n  r[i] = v;\n  imageStore(b, i - 3, v" +
                           random.pick({"", ".wzyx", " * 3"}) + ");\n  if (i == 0) r[" + std::to_string(kWork) +
                           "] = " + prefix + "vec4(imageSize(a), imageSize(b), 0, 0);\n}\n";
  const WorkStage stage = random_work_stage(run);
  run.note("code", name_of(stage) + code);
  const Resources res = run.resources({{0, VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER, {}, {}, {from.handle}},
                                       {1, VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER, {}, {}, {to.handle}},
                                       storage_buffer(2, places),
                                       storage_buffer(3, results)});
  run_work_items(run, stage, res, code, kWork);
  out(run, "results", results, prefix);
  run.out("stored", to.buffer, to_format).nan_bits_free = true;
}

/// Atomics of texels that several work items share.
CTS_RANDOM("image", "random_texel_buffer_atomics", 20) {
  Random& random = run.random;
  const bool is_signed = random.chance(0.5f);
  const View view =
      random_view(run, is_signed ? VK_FORMAT_R32_SINT : VK_FORMAT_R32_UINT, VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT);
  const Buffer places = random_places(run, view);
  const std::string type = is_signed ? "int" : "uint";
  const std::string code =
      "layout(binding = 0, r32" + std::string(is_signed ? "i" : "ui") + ") uniform " + (is_signed ? "i" : "u") +
      "imageBuffer a;\nlayout(std430, binding = 1) readonly buffer W { int w[]; };\n"
      "void work(int i) { imageAtomic" +
      random.pick({"Add", "Min", "Max", "And", "Or", "Xor"}) + "(a, w[i], " + type + "(w[i] * i * 12345)); }\n";
  const WorkStage stage = random_work_stage(run);
  run.note("code", name_of(stage) + code);
  const Resources res =
      run.resources({{0, VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER, {}, {}, {view.handle}}, storage_buffer(1, places)});
  run_work_items(run, stage, res, code, kWork);
  run.out("texels", view.buffer);
}

}  // namespace
}  // namespace vitrine::cts
