// Resource variables to the descriptors of their bindings (Vulkan 1.3.239, Shader Resource Interface: "Shader Resource
// and Descriptor Type Correspondence").
#include <algorithm>

#include "spirv/front/functions.h"

namespace vitrine::spirv::front {
namespace {

using spv::Decoration;
using spv::StorageClass;

constexpr VkDescriptorType kNone = VK_DESCRIPTOR_TYPE_MAX_ENUM;

/// A kind of resource variable, and the descriptor types that it may stand for.
struct ResourceKind {
  const char* name;
  VkDescriptorType types[3];
};

constexpr ResourceKind kUniformBuffer = {"uniform buffer",
                                         {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC,
                                          VK_DESCRIPTOR_TYPE_INLINE_UNIFORM_BLOCK}};
constexpr ResourceKind kStorageBuffer = {
    "storage buffer", {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER_DYNAMIC, kNone}};
constexpr ResourceKind kSampler = {"sampler",
                                   {VK_DESCRIPTOR_TYPE_SAMPLER, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, kNone}};
constexpr ResourceKind kCombined = {"combined image sampler",
                                    {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, kNone, kNone}};
constexpr ResourceKind kSampledImage = {
    "sampled image", {VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, kNone}};
constexpr ResourceKind kStorageImage = {"storage image", {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, kNone, kNone}};
constexpr ResourceKind kInputAttachment = {"input attachment", {VK_DESCRIPTOR_TYPE_INPUT_ATTACHMENT, kNone, kNone}};
constexpr ResourceKind kUniformTexels = {"uniform texel buffer",
                                         {VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, kNone, kNone}};
constexpr ResourceKind kStorageTexels = {"storage texel buffer",
                                         {VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER, kNone, kNone}};

const char* descriptor_type_name(VkDescriptorType type) {
  switch (type) {
    case VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC:
      return "dynamic uniform buffer";
    case VK_DESCRIPTOR_TYPE_STORAGE_BUFFER_DYNAMIC:
      return "dynamic storage buffer";
    case VK_DESCRIPTOR_TYPE_INLINE_UNIFORM_BLOCK:
      return "inline uniform block";
    default:
      break;
  }
  for (const ResourceKind& kind : {kUniformBuffer, kStorageBuffer, kSampler, kCombined, kSampledImage, kStorageImage,
                                   kInputAttachment, kUniformTexels, kStorageTexels})
    if (kind.types[0] == type) return kind.name;
  return "descriptor of an unknown type";
}

const ResourceKind& image_kind(const Translator& t, const Type& image) {
  constexpr std::uint32_t kSampledOperand = 6, kStorage = 2;
  if (image.dim == spv::Dim::SubpassData) return kInputAttachment;
  const bool storage = t.module.def(image.id).operand(kSampledOperand) == kStorage;
  if (image.dim == spv::Dim::Buffer) return storage ? kStorageTexels : kUniformTexels;
  return storage ? kStorageImage : kSampledImage;
}

const ResourceKind& resource_kind(const Translator& t, const Inst& variable) {
  const Type& pointer = t.module.type(variable.result_type);
  const Type* type = &t.module.type(pointer.element);
  if (type->kind == Type::Kind::kArray || type->kind == Type::Kind::kRuntimeArray) type = &t.module.type(type->element);
  if (pointer.storage == StorageClass::StorageBuffer) return kStorageBuffer;
  if (pointer.storage == StorageClass::Uniform)
    return t.module.decoration(type->id, Decoration::BufferBlock) != nullptr ? kStorageBuffer : kUniformBuffer;
  switch (type->kind) {
    case Type::Kind::kSampler:
      return kSampler;
    case Type::Kind::kSampledImage: {  // of a buffer: how glslang declares a uniform texel buffer
      const Type& image = t.module.type(type->element);
      return image.dim == spv::Dim::Buffer ? image_kind(t, image) : kCombined;
    }
    case Type::Kind::kImage:
      return image_kind(t, *type);
    default:
      fail(variable, "is not a resource that is supported");
  }
}

std::uint32_t decoration_value(const Module& module, std::uint32_t id, Decoration kind) {
  const DecorationRow* row = module.decoration(id, kind);
  return row == nullptr ? 0 : row->value;
}

bool fits(const ResourceKind& kind, VkDescriptorType type) {
  return type == VK_DESCRIPTOR_TYPE_MUTABLE_EXT ||
         std::find(std::begin(kind.types), std::end(kind.types), type) != std::end(kind.types);
}

}  // namespace

bool is_storage_buffer(const Translator& t, const Inst& variable) {
  return &resource_kind(t, variable) == &kStorageBuffer;
}

Binding find_binding(const Translator& t, const Inst& variable) {
  const std::uint32_t set = decoration_value(t.module, variable.result, Decoration::DescriptorSet);
  const std::uint32_t number = decoration_value(t.module, variable.result, Decoration::Binding);
  const ResourceKind& kind = resource_kind(t, variable);
  const std::string where = "descriptor set " + std::to_string(set) + ", binding " + std::to_string(number);
  if (set < t.options.sets.size()) {
    for (const BindingInfo& row : t.options.sets[set].bindings) {
      if (row.binding != number) continue;
      if (!fits(kind, row.type))
        fail(variable, where + " is a " + kind.name + " in the shader, but a " + descriptor_type_name(row.type) +
                           " in the pipeline layout");
      return {row.set, row.first_slot, row.count, row.immutable_samplers};
    }
  }
  fail(variable, where + " (a " + kind.name + " in the shader) is not in the pipeline layout");
}

}  // namespace vitrine::spirv::front
