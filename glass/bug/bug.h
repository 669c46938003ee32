// One draw or dispatch with all that it needs, as plain values: what a bug file holds (docs/glass/bugfile.md). Objects
// name each other by their numbers in these lists. Made by icd/, which captures; used by the program that replays, by
// `vitrine reduce` and `vitrine export`.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "raster/draw.h"
#include "texel/sampler.h"

namespace vitrine::glass::bug {

inline constexpr std::uint32_t kNone = UINT32_MAX;  ///< no object

/// Bytes that several things may share; null: none.
using Bytes = std::vector<std::byte>;
using Blob = std::shared_ptr<const Bytes>;
inline std::size_t size_of(const Blob& blob) { return blob ? blob->size() : 0; }

/// A stage as the application gave it.
struct Stage {
  VkShaderStageFlagBits stage = VK_SHADER_STAGE_COMPUTE_BIT;
  std::string entry_point;
  std::uint32_t subgroup_size = 0;  ///< required; 0: none is
  std::vector<VkSpecializationMapEntry> constants;
  Blob constant_data;
  Blob words;  ///< SPIR-V
};

/// Bytes of memory before the command and behind it.
struct Piece {
  std::uint64_t offset = 0;
  bool unwritten = false;  ///< nothing had written to it, as a tool knew; `before` is zeros
  Blob before;
  Blob after;  ///< null: the same
};

/// Memory that buffers share: buffers that overlap lie in one.
struct Memory {
  std::uint64_t size = 0;
  std::uint64_t address = 0;  ///< of its first byte, as the device knew it
  std::vector<Piece> pieces;  ///< ascending, apart from each other; what lies between them is zero
};

struct Buffer {
  std::string name;
  std::uint64_t size = 0;
  VkBufferUsageFlags usage = 0;
  std::uint32_t memory = kNone;
  std::uint64_t offset = 0;
  bool gone = false;  ///< it was destroyed before the command
};

/// Texels of some layers of one level and aspect, packed as vkCmdCopyImageToBuffer packs them; sample after sample.
struct Texels {
  VkImageAspectFlagBits aspect = VK_IMAGE_ASPECT_COLOR_BIT;
  std::uint32_t level = 0, layer = 0, layers = 1;
  bool unwritten = false;  ///< as of pieces
  Blob before;
  Blob after;    ///< null: the same
  Blob written;  ///< a byte a block: 0, nothing had written it; null: all are alike
};

struct Image {
  std::string name;
  VkImageCreateFlags flags = 0;
  VkImageUsageFlags usage = 0;
  VkImageType type = VK_IMAGE_TYPE_2D;
  VkFormat format = VK_FORMAT_UNDEFINED;
  VkImageTiling tiling = VK_IMAGE_TILING_OPTIMAL;
  texel::Extent extent;
  std::uint32_t levels = 1, layers = 1, samples = 1;
  std::vector<Texels> texels;
};

struct View {
  std::string name;
  std::uint32_t image = kNone;
  VkImageViewType type = VK_IMAGE_VIEW_TYPE_2D;
  VkFormat format = VK_FORMAT_UNDEFINED;
  VkImageUsageFlags usage = 0;
  std::array<std::uint8_t, 4> swizzle{0, 1, 2, 3};  ///< as texel::ImageView::swizzle
  VkImageSubresourceRange range{};
};

struct BufferView {
  std::string name;
  std::uint32_t buffer = kNone;
  VkFormat format = VK_FORMAT_UNDEFINED;
  std::uint64_t offset = 0, range = 0;
};

struct Sampler {
  std::string name;
  texel::Sampler state;
};

struct Binding {
  std::uint32_t binding = 0;
  VkDescriptorType type = VK_DESCRIPTOR_TYPE_SAMPLER;
  VkShaderStageFlags stages = 0;
  std::uint32_t count = 0;  ///< bytes of an inline uniform block
  VkDescriptorBindingFlags flags = 0;
  std::vector<std::uint32_t> samplers;  ///< immutable ones; empty: none are
  std::vector<VkDescriptorType> types;  ///< that descriptors of a mutable binding may take on; of others none
};

struct SetLayout {
  bool used = true;  ///< false: the pipeline layout has no such set
  std::vector<Binding> bindings;
};

/// What is bound at one element of a binding; those that are not listed were never written, or null.
struct Descriptor {
  std::uint32_t set = 0, binding = 0, element = 0;
  std::uint32_t buffer = kNone, view = kNone, texels = kNone, sampler = kNone;
  std::uint64_t offset = 0, range = 0;  ///< of the buffer, dynamic offsets applied
  Blob bytes;                           ///< of an inline uniform block
  bool gone = false;                    ///< what it names was destroyed before the command; nothing else is known of it
  VkDescriptorType type = VK_DESCRIPTOR_TYPE_MUTABLE_EXT;  ///< that it has taken on in a mutable binding
};
/// What it is where it is bound.
inline VkDescriptorType type_of(const Descriptor& d, const Binding& binding) {
  return binding.type == VK_DESCRIPTOR_TYPE_MUTABLE_EXT ? d.type : binding.type;
}

/// What a descriptor of a type points to.
enum class ResourceKind : std::uint8_t { kBuffer, kImage, kTexels, kSampler, kBytes };
constexpr ResourceKind kind_of(VkDescriptorType type) {
  switch (type) {
    case VK_DESCRIPTOR_TYPE_SAMPLER:
      return ResourceKind::kSampler;
    case VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER:
    case VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER:
      return ResourceKind::kTexels;
    case VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER:
    case VK_DESCRIPTOR_TYPE_STORAGE_BUFFER:
    case VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC:
    case VK_DESCRIPTOR_TYPE_STORAGE_BUFFER_DYNAMIC:
      return ResourceKind::kBuffer;
    case VK_DESCRIPTOR_TYPE_INLINE_UNIFORM_BLOCK:
      return ResourceKind::kBytes;
    default:
      return ResourceKind::kImage;
  }
}
constexpr bool is_dynamic(VkDescriptorType type) {
  return type == VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC || type == VK_DESCRIPTOR_TYPE_STORAGE_BUFFER_DYNAMIC;
}
/// Whether it has what its type needs.
inline bool is_complete(const Descriptor& d, VkDescriptorType type) {
  if (d.gone) return true;
  switch (kind_of(type)) {
    case ResourceKind::kBuffer:
      return d.buffer != kNone;
    case ResourceKind::kImage:
      return d.view != kNone;
    case ResourceKind::kTexels:
      return d.texels != kNone;
    case ResourceKind::kSampler:
      return d.sampler != kNone;
    case ResourceKind::kBytes:
      return d.bytes != nullptr;
  }
  return false;
}

/// A buffer that vertices or indices come from, or go to.
struct Stream {
  std::uint32_t binding = 0;
  std::uint32_t buffer = kNone;  ///< none: nothing is bound
  std::uint64_t offset = 0, size = 0;
  std::uint32_t stride = 0, divisor = 1;
  bool per_instance = false;
};

/// What draws go to.
struct Rendering {
  std::vector<std::uint32_t> colors;  ///< views; kNone: unused
  std::uint32_t depth = kNone, stencil = kNone;
  std::uint32_t rate = kNone;   ///< the fragment shading rate attachment
  VkExtent2D rate_texel{1, 1};  ///< pixels for which a texel of it stands
  VkRect2D area{};
  std::uint32_t layers = 1, view_mask = 0;
};

struct Draw {
  std::uint32_t count = 0, first = 0;
  std::int32_t vertex_offset = 0;
};

/// The command itself: a dispatch if the pipeline has a compute stage, else draws.
struct Command {
  std::array<std::uint32_t, 3> base{}, groups{};
  std::vector<Draw> draws;
  std::uint32_t instances = 1, first_instance = 0;
  bool indexed = false;
  VkIndexType index_type = VK_INDEX_TYPE_UINT16;
  Stream indices;
  // Arguments in a buffer
  std::uint32_t arguments = kNone;  ///< none: they are above
  std::uint64_t arguments_offset = 0;
  std::uint32_t count_buffer = kNone;
  std::uint64_t count_offset = 0;
  std::uint32_t draw_count = 0, stride = 0;
};

/// What a tool found, in words, or why the device was lost.
struct Found {
  std::string rule, message, place;
  std::string function;  ///< that the place is in
};

struct Bug {
  std::string device;  ///< that it was captured on
  std::string command_name, pipeline;
  std::uint64_t submission = 0;
  std::uint32_t command_number = 0;
  std::vector<std::string> labels;
  bool null_descriptors = false, robust_access2 = false;
  bool lost = false;  ///< the command lost the device: nothing is known of what is behind it
  std::vector<Found> findings;
  std::vector<std::string> notes;  ///< what is not as it was

  std::vector<Stage> stages;
  std::vector<Memory> memories;
  std::vector<Buffer> buffers;
  std::vector<Image> images;
  std::vector<View> views;
  std::vector<BufferView> buffer_views;
  std::vector<Sampler> samplers;
  std::vector<SetLayout> sets;
  std::vector<VkPushConstantRange> push_ranges;
  Blob push_constants;
  std::uint64_t pushed = 0;  ///< words of them that were set, a bit each
  std::vector<Descriptor> descriptors;
  std::vector<std::uint32_t> addressed;  ///< buffers that shaders reach through device addresses: they keep them
  raster::State state;                   ///< of draws; dynamic state is in it
  std::vector<Stream> streams;
  std::vector<Stream> feedback;  ///< what transform feedback writes to, from where it stands; empty: it is not active
  Rendering rendering;
  Command command;

  bool dispatches() const { return stages.size() == 1 && stages[0].stage == VK_SHADER_STAGE_COMPUTE_BIT; }
};

}  // namespace vitrine::glass::bug
