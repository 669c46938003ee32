// Descriptor sets of a reflected module, filled with random numbers.
#include "cases/modules/resources.h"

#include <algorithm>

namespace vitrine::cts {
namespace {

using spv::Op;
using Type = Reflection::Type;

constexpr uint32_t kRuntime = 64;     ///< elements of runtime arrays in buffers
constexpr uint32_t kDescriptors = 4;  ///< of runtime arrays of descriptors
constexpr uint32_t kMostBytes = 1u << 24;

bool is_integer(const Reflection& r, const Type& image) { return r.type(image.operands[0]).op == Op::OpTypeInt; }
bool is_signed(const Reflection& r, const Type& image) { return r.type(image.operands[0]).operands[1] != 0; }

VkFormat storage_format(const Reflection& r, const Type& image) {
  using F = spv::ImageFormat;
  switch (static_cast<F>(image.operands[6])) {
    case F::Rgba32f:
      return VK_FORMAT_R32G32B32A32_SFLOAT;
    case F::Rgba16f:
      return VK_FORMAT_R16G16B16A16_SFLOAT;
    case F::R32f:
      return VK_FORMAT_R32_SFLOAT;
    case F::Rgba8:
      return VK_FORMAT_R8G8B8A8_UNORM;
    case F::Rg32f:
      return VK_FORMAT_R32G32_SFLOAT;
    case F::Rg16f:
      return VK_FORMAT_R16G16_SFLOAT;
    case F::R11fG11fB10f:
      return VK_FORMAT_B10G11R11_UFLOAT_PACK32;
    case F::R16f:
      return VK_FORMAT_R16_SFLOAT;
    case F::R8:
      return VK_FORMAT_R8_UNORM;
    case F::Rg8:
      return VK_FORMAT_R8G8_UNORM;
    case F::Rgba32ui:
      return VK_FORMAT_R32G32B32A32_UINT;
    case F::R32ui:
      return VK_FORMAT_R32_UINT;
    case F::R32i:
      return VK_FORMAT_R32_SINT;
    case F::Rg32ui:
      return VK_FORMAT_R32G32_UINT;
    case F::Rgba8ui:
      return VK_FORMAT_R8G8B8A8_UINT;
    case F::R8ui:
      return VK_FORMAT_R8_UINT;
    case F::R16ui:
      return VK_FORMAT_R16_UINT;
    case F::Unknown:
      if (!is_integer(r, image)) return VK_FORMAT_R32G32B32A32_SFLOAT;
      return is_signed(r, image) ? VK_FORMAT_R32G32B32A32_SINT : VK_FORMAT_R32_UINT;
    default:
      throw Unsupported("storage format");
  }
}

/// HLSL does not say of an image whether it is compared: then all are where something is.
bool is_depth(const Reflection& r, const Type& image) {
  bool told = false;
  for (const auto& [id, type] : r.types) told |= type.op == Op::OpTypeImage && type.operands[2] == 1;
  return told ? image.operands[2] == 1 : r.compares_depth;
}

VkFormat sampled_format(const Reflection& r, const Type& image) {
  if (is_integer(r, image)) return is_signed(r, image) ? VK_FORMAT_R32G32B32A32_SINT : VK_FORMAT_R32G32B32A32_UINT;
  return is_depth(r, image) ? VK_FORMAT_D32_SFLOAT : VK_FORMAT_R8G8B8A8_UNORM;
}

Image make_image(Run& run, const Reflection& r, const Type& image, uint32_t scale) {
  const auto dim = static_cast<spv::Dim>(image.operands[1]);
  const bool arrayed = image.operands[3] != 0, multisampled = image.operands[4] != 0;
  const bool storage = image.operands[5] == 2 && dim != spv::Dim::SubpassData;
  ImageSpec spec;
  spec.format = storage ? storage_format(r, image) : sampled_format(r, image);
  spec.usage = storage ? VK_IMAGE_USAGE_STORAGE_BIT : VK_IMAGE_USAGE_SAMPLED_BIT;
  if (dim == spv::Dim::SubpassData) spec.usage |= VK_IMAGE_USAGE_INPUT_ATTACHMENT_BIT;
  if (dim == spv::Dim::Dim1D) {
    spec.view = arrayed ? VK_IMAGE_VIEW_TYPE_1D_ARRAY : VK_IMAGE_VIEW_TYPE_1D;
    spec.extent = {64, 1, 1};
  } else if (dim == spv::Dim::Dim3D) {
    spec.view = VK_IMAGE_VIEW_TYPE_3D;
    spec.extent = {16, 16, 16};
  } else if (dim == spv::Dim::Cube) {
    spec.view = arrayed ? VK_IMAGE_VIEW_TYPE_CUBE_ARRAY : VK_IMAGE_VIEW_TYPE_CUBE;
    spec.layers = arrayed ? 12 : 6;
    spec.flags = VK_IMAGE_CREATE_CUBE_COMPATIBLE_BIT;
  } else if (arrayed) {
    spec.view = VK_IMAGE_VIEW_TYPE_2D_ARRAY;
    spec.layers = 4;
  }
  if (storage && dim == spv::Dim::Dim2D && !multisampled) {
    spec.extent.width *= scale;
    spec.extent.height *= scale;
  }
  if (multisampled) {
    if (spec.format == VK_FORMAT_D32_SFLOAT) spec.format = VK_FORMAT_R8G8B8A8_UNORM;
    spec.samples = VK_SAMPLE_COUNT_4_BIT;
    spec.usage |= VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
  } else if (!storage && dim != spv::Dim::SubpassData && dim != spv::Dim::Dim1D) {
    spec.levels = dim == spv::Dim::Dim3D ? 4 : 6;
  }
  const Image result = run.image(spec);
  if (!multisampled) run.fill_random(result);
  if (multisampled && !storage) {
    const VkClearColorValue color{{0.25f, 0.5f, 0.75f, 1.0f}};
    const VkImageSubresourceRange range = result.range();
    run.once([&](VkCommandBuffer cmd) {
      vkCmdClearColorImage(cmd, result.handle, VK_IMAGE_LAYOUT_GENERAL, &color, 1, &range);
    });
  }
  return result;
}

bool has_cubes(const Reflection& r) {
  return std::any_of(r.types.begin(), r.types.end(), [](const auto& row) {
    return row.second.op == Op::OpTypeImage && static_cast<spv::Dim>(row.second.operands[1]) == spv::Dim::Cube;
  });
}

VkSampler make_sampler(Run& run, const Reflection& r, bool compares) {
  VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
  info.magFilter = info.minFilter = has_cubes(r) ? VK_FILTER_NEAREST : VK_FILTER_LINEAR;  // deviation cube-corners
  info.mipmapMode = VK_SAMPLER_MIPMAP_MODE_LINEAR;
  info.maxLod = 16;
  info.compareEnable = compares;
  info.compareOp = VK_COMPARE_OP_LESS_OR_EQUAL;
  return run.sampler(info);
}

/// `type`: of one descriptor.
void add_descriptor(Run& run, const Reflection& r, const Reflection::Variable& v, uint32_t type, Binding& binding,
                    Bound& bound) {
  const Type& t = r.type(type);
  const std::string name = std::to_string(v.id) + "_" + std::to_string(binding.buffers.size() + binding.images.size());
  if (v.storage != spv::StorageClass::UniformConstant) {
    const bool storage =
        v.storage == spv::StorageClass::StorageBuffer || r.decoration(type, spv::Decoration::BufferBlock).has_value();
    const uint32_t bytes = std::max(16u, (r.size(type, kRuntime) + 15u) & ~15u);
    if (bytes > kMostBytes) throw Unsupported("large buffer");
    std::vector<unsigned char> data(bytes);
    r.fill(run.random, type, data, kRuntime);
    const Buffer buffer = run.buffer_of(data);
    binding.type = storage ? VK_DESCRIPTOR_TYPE_STORAGE_BUFFER : VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    binding.buffers.push_back({buffer.handle, 0, VK_WHOLE_SIZE});
    if (storage && !r.decoration(v.id, spv::Decoration::NonWritable)) bound.buffers.emplace_back(name, buffer);
    return;
  }
  if (t.op == Op::OpTypeSampler) {
    binding.type = VK_DESCRIPTOR_TYPE_SAMPLER;
    binding.images.push_back({make_sampler(run, r, r.compares_depth), VK_NULL_HANDLE, VK_IMAGE_LAYOUT_UNDEFINED});
    return;
  }
  if (t.op != Op::OpTypeImage && t.op != Op::OpTypeSampledImage) throw Unsupported("kind of descriptor");
  const Type& image = t.op == Op::OpTypeImage ? t : r.type(t.operands[0]);
  const auto dim = static_cast<spv::Dim>(image.operands[1]);
  const bool storage = image.operands[5] == 2;
  if (dim == spv::Dim::Buffer) {
    binding.type = storage ? VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER : VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER;
    const Buffer buffer =
        run.buffer(kRuntime * 16, VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT);
    for (uint32_t i = 0; i < kRuntime * 4; i++) buffer.as<float>()[i] = run.random.real(0, 1);
    VkBufferViewCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO};
    info.buffer = buffer.handle;
    info.format = storage                ? storage_format(r, image)
                  : is_integer(r, image) ? VK_FORMAT_R32_UINT
                                         : VK_FORMAT_R32G32B32A32_SFLOAT;
    info.range = VK_WHOLE_SIZE;
    VkBufferView view;
    CTS_VK(vkCreateBufferView(run.device, &info, nullptr, &view));
    binding.views.push_back(run.own(view, vkDestroyBufferView));
    if (storage) bound.buffers.emplace_back(name, buffer);
    return;
  }
  const Image made = make_image(run, r, image, bound.image_scale);
  const VkSampler sampler = t.op == Op::OpTypeSampledImage ? make_sampler(run, r, is_depth(r, image)) : VK_NULL_HANDLE;
  binding.images.push_back({sampler, made.view, VK_IMAGE_LAYOUT_GENERAL});
  binding.type = t.op == Op::OpTypeSampledImage ? VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER
                 : dim == spv::Dim::SubpassData ? VK_DESCRIPTOR_TYPE_INPUT_ATTACHMENT
                 : storage                      ? VK_DESCRIPTOR_TYPE_STORAGE_IMAGE
                                                : VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE;
  if (storage && dim != spv::Dim::SubpassData) bound.images.emplace_back(name, made);
}

/// An image and a sampler of the same binding, which a compiler of HLSL gives, are a combined image sampler.
void combine(Run& run, const Reflection& r, const Reflection::Variable& v, std::vector<Binding>& set, uint32_t number) {
  for (Binding& binding : set) {
    if (binding.binding != number) continue;
    const bool sampler = r.type(v.pointee).op == Op::OpTypeSampler;
    if (binding.images.size() != 1 || (binding.type != VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE && !sampler) ||
        (sampler && binding.type != VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE))
      throw Unsupported("aliased descriptors");
    binding.type = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    binding.images[0].sampler = make_sampler(run, r, r.compares_depth);
  }
}

}  // namespace

void Bound::bind(VkCommandBuffer cmd, VkPipelineBindPoint point) const {
  for (const auto& [number, set] : sets) vkCmdBindDescriptorSets(cmd, point, layout, number, 1, &set, 0, nullptr);
  if (!push.empty())
    vkCmdPushConstants(cmd, layout, VK_SHADER_STAGE_ALL, 0, static_cast<uint32_t>(push.size()), push.data());
}

void Bound::out(Run& run) const {
  for (const auto& [name, buffer] : buffers) run.out(name, buffer, VK_FORMAT_R32_SFLOAT);
  for (const auto& [name, image] : images) run.out(name, image);
}

Bound bind_everything(Run& run, const Reflection& r, uint32_t image_scale) {
  Bound bound;
  bound.image_scale = image_scale;
  std::map<uint32_t, std::vector<Binding>> sets;
  std::set<std::pair<uint32_t, uint32_t>> seen;
  for (const Reflection::Variable& v : r.variables) {
    if (v.storage == spv::StorageClass::PushConstant) {
      bound.push.resize((r.size(v.pointee, 1) + 3u) & ~3u);
      r.fill(run.random, v.pointee, bound.push, 1);
    }
    const auto number = r.decoration(v.id, spv::Decoration::Binding);
    if (!number || !r.used.contains(v.id)) continue;
    const uint32_t set = r.decoration(v.id, spv::Decoration::DescriptorSet).value_or(0);
    if (!seen.insert({set, *number}).second) {
      combine(run, r, v, sets[set], *number);
      continue;
    }
    Binding binding{};
    binding.binding = *number;
    const Type& t = r.type(v.pointee);
    const bool array = t.op == Op::OpTypeArray || t.op == Op::OpTypeRuntimeArray;
    for (uint32_t i = 0; i < (array ? r.length(t, kDescriptors) : 1); i++)
      add_descriptor(run, r, v, array ? t.operands[0] : v.pointee, binding, bound);
    sets[set].push_back(binding);
  }
  std::vector<VkDescriptorSetLayout> layouts;
  VkDescriptorSetLayoutCreateInfo empty{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
  for (uint32_t set = 0; !sets.empty() && set <= sets.rbegin()->first; set++) {
    if (const auto found = sets.find(set); found != sets.end()) {
      const Resources made = run.resources(found->second);
      bound.sets.emplace_back(set, made.set);
      layouts.push_back(made.set_layout);
    } else {
      VkDescriptorSetLayout layout;
      CTS_VK(vkCreateDescriptorSetLayout(run.device, &empty, nullptr, &layout));
      layouts.push_back(run.own(layout, vkDestroyDescriptorSetLayout));
    }
  }
  const VkPushConstantRange range{VK_SHADER_STAGE_ALL, 0, static_cast<uint32_t>(bound.push.size())};
  VkPipelineLayoutCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
  info.setLayoutCount = static_cast<uint32_t>(layouts.size());
  info.pSetLayouts = layouts.data();
  info.pushConstantRangeCount = bound.push.empty() ? 0 : 1;
  info.pPushConstantRanges = &range;
  CTS_VK(vkCreatePipelineLayout(run.device, &info, nullptr, &bound.layout));
  run.own(bound.layout, vkDestroyPipelineLayout);
  return bound;
}

}  // namespace vitrine::cts
