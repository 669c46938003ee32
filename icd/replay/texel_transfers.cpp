// What transfers do to watched texels, and which texels they read for that (Vulkan 1.3.239, Copy Commands).
#include <algorithm>
#include <cmath>

#include "icd/object/image.h"
#include "icd/object/memory.h"
#include "icd/replay/texel_events.h"
#include "texel/sampler/model/cubic.h"

namespace vitrine::icd {
namespace {

using TexelEvent = glass::pixel::Event;
using glass::pixel::EventKind;
using glass::pixel::Source;
using glass::pixel::Texel;
using glass::pixel::TexelId;

/// A texel with the third coordinate that transfers count in: layers, or slices of a 3D image.
struct Place {
  std::int64_t x = 0, y = 0, z = 0;
};

Place place_of(const Image& image, const TexelId& id) {
  return {id.x, id.y, image.desc().type == VK_IMAGE_TYPE_3D ? id.slice : id.layer};
}

const texel::PlaneLayout& plane_of(const Image& image, VkImageAspectFlags aspect) {
  return image.layout.plane[texel::plane_of_aspect(image.layout, static_cast<VkImageAspectFlagBits>(aspect))];
}

const texel::FormatDesc& format_of(const Image& image, VkImageAspectFlags aspect) {
  return texel::format_desc(plane_of(image, aspect).format);
}

/// Where a texel of an image lies; null: the image does not have it.
const std::byte* address_of(const Image& image, VkImageAspectFlags aspect, std::uint32_t level, std::uint32_t sample,
                            const Place& at) {
  const texel::PlaneLayout& plane = plane_of(image, aspect);
  const texel::LevelLayout& layout = plane.level[level];
  const texel::FormatDesc& format = texel::format_desc(plane.format);
  const bool slices = image.desc().type == VK_IMAGE_TYPE_3D;
  const std::int64_t depth = slices ? layout.extent.depth : image.desc().layers;
  const std::byte* const memory =
      image.memory_of_plane(texel::plane_of_aspect(image.layout, static_cast<VkImageAspectFlagBits>(aspect)));
  if (memory == nullptr || at.x < 0 || at.y < 0 || at.z < 0 || at.x >= layout.extent.width ||
      at.y >= layout.extent.height || at.z >= depth)
    return nullptr;
  const auto number = [](std::int64_t value) { return static_cast<std::uint64_t>(value); };
  const std::uint64_t offset = plane.offset + layout.offset +
                               number(at.z) * (slices ? layout.slice_pitch : plane.layer_stride) +
                               sample * layout.sample_stride + number(at.y) / format.block_height * layout.row_pitch +
                               number(at.x) / format.block_width * format.block_bytes;
  return memory + offset;
}

/// A texel of an image as a source; image 0: the image does not have it.
Source source_of(const glass::pixel::Pixels& pixels, const Image& image, VkImageAspectFlags aspect, std::uint32_t level,
                 std::uint32_t sample, const Place& at, float weight) {
  const std::byte* const address = address_of(image, aspect, level, sample, at);
  return address ? pixels.source_at(address, format_of(image, aspect), weight) : Source{};
}

/// Whether a texel of an image lies in a level and layers that a region names.
bool in_layers(const Image& image, const VkImageSubresourceLayers& layers, const TexelId& id) {
  if (id.level != layers.mipLevel || (layers.aspectMask & id.aspect) == 0) return false;
  return image.desc().type == VK_IMAGE_TYPE_3D ||
         (id.layer >= layers.baseArrayLayer && id.layer - layers.baseArrayLayer < layers.layerCount);
}

std::int64_t first_z(const Image& image, const VkImageSubresourceLayers& layers, const VkOffset3D& offset) {
  return image.desc().type == VK_IMAGE_TYPE_3D ? offset.z : std::int64_t{layers.baseArrayLayer};
}

void add(glass::pixel::Pixels& pixels, Texel& texel, TexelEvent event, const Source& source) {
  if (source.texel.image != 0) event.sources.push_back(source);
  pixels.add(texel, std::move(event));
}

/// One region of a copy on one texel.
void note_copy(glass::pixel::Pixels& pixels, const Image& from, const Image& to, const VkImageCopy& region,
               Texel& texel, TexelEvent event) {
  const VkImageAspectFlags same = region.srcSubresource.aspectMask & texel.id.aspect;
  const VkImageAspectFlags aspect = same != 0 ? same : region.srcSubresource.aspectMask;
  if (texel.id.level != region.dstSubresource.mipLevel || (region.dstSubresource.aspectMask & texel.id.aspect) == 0)
    return;
  const texel::FormatDesc &source = format_of(from, aspect), &target = *texel.format;
  const Place at = place_of(to, texel.id);
  const std::int64_t column = at.x / target.block_width - region.dstOffset.x / target.block_width;
  const std::int64_t row = at.y / target.block_height - region.dstOffset.y / target.block_height;
  const std::int64_t slice = at.z - first_z(to, region.dstSubresource, region.dstOffset);
  const auto blocks = [](std::uint32_t texels, std::uint32_t size) { return (texels + size - 1) / size; };
  const bool inside =
      column >= 0 && row >= 0 && slice >= 0 && column < blocks(region.extent.width, source.block_width) &&
      row < blocks(region.extent.height, source.block_height) &&
      slice < std::max({region.extent.depth, region.srcSubresource.layerCount, region.dstSubresource.layerCount});
  if (!inside) return;
  const Place read{(region.srcOffset.x / source.block_width + column) * source.block_width,
                   (region.srcOffset.y / source.block_height + row) * source.block_height,
                   first_z(from, region.srcSubresource, region.srcOffset) + slice};
  add(pixels, texel, std::move(event),
      source_of(pixels, from, aspect, region.srcSubresource.mipLevel, texel.id.sample, read, 1));
}

constexpr char kCopied[] = "copied from another texel";

/// One axis of a blit: which texels, with which weights.
struct Taps {
  std::int64_t at[4] = {};
  float weight[4] = {1, 0, 0, 0};
};

/// The middle of texel `to` in texels of the source; nothing: the region does not have it.
std::optional<double> blit_coordinate(std::int64_t to, const std::int32_t (&target)[2],
                                      const std::int32_t (&source)[2]) {
  const std::int64_t low = std::min(target[0], target[1]), high = std::max(target[0], target[1]);
  if (to < low || to >= high) return std::nullopt;
  const double part = (static_cast<double>(to) + 0.5 - target[0]) / (target[1] - target[0]);
  return source[0] + part * (source[1] - source[0]);
}

Taps taps_of(double u, VkFilter filter, std::int64_t size) {
  const auto clamp = [&](double value) {
    return std::clamp<std::int64_t>(static_cast<std::int64_t>(std::floor(value)), 0, size - 1);
  };
  if (filter == VK_FILTER_NEAREST) return {{clamp(u)}, {1}};
  const double fraction = u - 0.5 - std::floor(u - 0.5);
  if (filter == VK_FILTER_CUBIC_EXT) {
    Taps taps{{clamp(u - 1.5), clamp(u - 0.5), clamp(u + 0.5), clamp(u + 1.5)}, {}};
    texel::cubic_weights(static_cast<float>(fraction), taps.weight);
    return taps;
  }
  return {{clamp(u - 0.5), clamp(u + 0.5)}, {static_cast<float>(1 - fraction), static_cast<float>(fraction)}};
}

void add_taps(const ReplayState& state, const CmdBlitImage& command, const VkImageBlit& region,
              VkImageAspectFlags aspect, const Taps (&taps)[3], TexelEvent& event) {
  for (int z = 0; z < 2; ++z)
    for (int y = 0; y < 4; ++y)
      for (int x = 0; x < 4; ++x) {
        const float weight = taps[0].weight[x] * taps[1].weight[y] * taps[2].weight[z];
        if (weight == 0) continue;
        Source source = source_of(*state.observed->pixels, *command.source, aspect, region.srcSubresource.mipLevel, 0,
                                  {taps[0].at[x], taps[1].at[y], taps[2].at[z]}, weight);
        const auto known = std::ranges::find(event.sources, source.texel, &Source::texel);
        if (known != event.sources.end())
          known->weight += weight;
        else if (source.texel.image != 0)
          event.sources.push_back(source);
      }
}

void note_blit(const ReplayState& state, const CmdBlitImage& command, const VkImageBlit& region, Texel& texel) {
  const Image &from = *command.source, &to = *command.target;
  if (!in_layers(to, region.dstSubresource, texel.id)) return;
  const Place at = place_of(to, texel.id);
  const VkOffset3D(&d)[2] = region.dstOffsets;
  const VkOffset3D(&s)[2] = region.srcOffsets;
  const auto x = blit_coordinate(at.x, {d[0].x, d[1].x}, {s[0].x, s[1].x});
  const auto y = blit_coordinate(at.y, {d[0].y, d[1].y}, {s[0].y, s[1].y});
  const bool slices = to.desc().type == VK_IMAGE_TYPE_3D, volume = from.desc().type == VK_IMAGE_TYPE_3D;
  // Layers count from the first one of their region, slices are what the offsets say.
  const std::int64_t slice = slices ? at.z : at.z - region.dstSubresource.baseArrayLayer + std::min(d[0].z, d[1].z);
  const auto z = volume ? blit_coordinate(slice, {d[0].z, d[1].z}, {s[0].z, s[1].z})
                        : std::optional(double(region.srcSubresource.baseArrayLayer) + 0.5 +
                                        double(slice - std::min(d[0].z, d[1].z)));
  if (!x || !y || !z) return;
  const texel::Extent& extent = plane_of(from, texel.id.aspect).level[region.srcSubresource.mipLevel].extent;
  const bool cubic = command.filter == VK_FILTER_CUBIC_EXT, flat = from.desc().type == VK_IMAGE_TYPE_2D;
  const VkFilter filter = cubic && !flat ? VK_FILTER_LINEAR : command.filter;
  const Taps taps[3] = {taps_of(*x, filter, extent.width), taps_of(*y, filter, extent.height),
                        taps_of(*z, volume ? filter : VK_FILTER_NEAREST, volume ? extent.depth : from.desc().layers)};
  TexelEvent event = texel_event(state, EventKind::kBlit, "blitted from other texels");
  add_taps(state, command, region, texel.id.aspect, taps, event);
  state.observed->pixels->add(texel, std::move(event));
}

void note_resolve(const ReplayState& state, const CmdResolveImage& command, const VkImageResolve& region,
                  Texel& texel) {
  const Image &from = *command.source, &to = *command.target;
  const Place at = place_of(to, texel.id);
  const std::int64_t x = at.x - region.dstOffset.x, y = at.y - region.dstOffset.y;
  const std::int64_t z = at.z - first_z(to, region.dstSubresource, region.dstOffset);
  if (!in_layers(to, region.dstSubresource, texel.id) || x < 0 || y < 0 || z < 0 || x >= region.extent.width ||
      y >= region.extent.height)
    return;
  TexelEvent event = texel_event(state, EventKind::kResolve, "resolved from the samples of another texel");
  const std::uint32_t samples = std::max(from.desc().samples, 1u);
  for (std::uint32_t s = 0; s < samples; ++s)
    event.sources.push_back(source_of(
        *state.observed->pixels, from, texel.id.aspect, region.srcSubresource.mipLevel, s,
        {region.srcOffset.x + x, region.srcOffset.y + y, first_z(from, region.srcSubresource, region.srcOffset) + z},
        1 / static_cast<float>(samples)));
  state.observed->pixels->add(texel, std::move(event));
}

/// Where a region of a buffer has texel blocks.
struct BufferBlocks {
  BufferBlocks(const VkBufferImageCopy& region, const texel::FormatDesc& format)
      : format_(format),
        columns_(
            blocks(region.bufferRowLength ? region.bufferRowLength : region.imageExtent.width, format.block_width)),
        rows_(blocks(region.bufferImageHeight ? region.bufferImageHeight : region.imageExtent.height,
                     format.block_height)),
        first_(region.bufferOffset) {}

  /// Of the block at these texels behind the region's first.
  std::uint64_t offset(std::int64_t x, std::int64_t y, std::int64_t z) const {
    const std::int64_t block = (z * rows_ + y / format_.block_height) * columns_ + x / format_.block_width;
    return first_ + static_cast<std::uint64_t>(block) * format_.block_bytes;
  }
  static std::int64_t blocks(std::int64_t texels, std::int64_t size) { return (texels + size - 1) / size; }

 private:
  const texel::FormatDesc& format_;
  std::int64_t columns_, rows_;
  std::uint64_t first_;
};

/// Where a texel's block is among what a region copies to its image, in bytes; nothing: it is not in it.
std::optional<std::uint64_t> offset_in(const VkBufferImageCopy& r, const Image& to, const Texel& texel) {
  const Place at = place_of(to, texel.id);
  const std::int64_t x = at.x - r.imageOffset.x, y = at.y - r.imageOffset.y;
  const std::int64_t z = at.z - first_z(to, r.imageSubresource, r.imageOffset);
  if (!in_layers(to, r.imageSubresource, texel.id) || x < 0 || y < 0 || z < 0 || x >= r.imageExtent.width ||
      y >= r.imageExtent.height || z >= std::max(r.imageExtent.depth, r.imageSubresource.layerCount))
    return std::nullopt;
  return BufferBlocks(r, *texel.format).offset(x, y, z);
}

void note_upload(const ReplayState& state, const CmdCopyBufferToImage& command, const VkBufferImageCopy& r,
                 Texel& texel) {
  const std::optional<std::uint64_t> place = offset_in(r, *command.target, texel);
  if (!place) return;
  const std::uint64_t offset = *place;
  std::string text = "copied from bytes at offset " + std::to_string(offset) + " of buffer ";
  const std::byte* const data = command.source->data;
  if (data) text += describe_bytes(state.device, data, command.source->size);
  TexelEvent event = texel_event(state, EventKind::kUpload, std::move(text));
  const std::uint32_t bytes = texel.format->block_bytes;
  if (data && offset + bytes <= command.source->size) {
    if (const auto staged = state.observed->pixels->staged().find(data + offset, bytes)) {
      Source source{staged->texel, staged->format, {}, 1, staged->submission, staged->command};
      source.value.size = std::min<std::uint8_t>(staged->format->block_bytes, sizeof source.value.bytes);
      std::copy_n(data + offset, source.value.size, source.value.bytes.begin());
      event.sources.push_back(source);
      event.facts.emplace_back("copied to the buffer", "at submission " + std::to_string(staged->submission) +
                                                           ", command " + std::to_string(staged->command) + " (" +
                                                           std::string(staged->name) + ")");
    }
  }
  state.observed->pixels->add(texel, std::move(event));
}

/// The rows of texel blocks that a region has copied to a buffer.
void note_download(const ReplayState& state, const CmdCopyImageToBuffer& command, const VkBufferImageCopy& r) {
  const Image& from = *command.source;
  const VkImageAspectFlags aspect = r.imageSubresource.aspectMask;
  const texel::FormatDesc& format = format_of(from, aspect);
  const ObservedReplay& now = *state.observed;
  const std::int64_t slices =
      std::max(r.imageExtent.depth,
               std::min(r.imageSubresource.layerCount, from.desc().layers - r.imageSubresource.baseArrayLayer));
  const std::uint64_t bytes =
      static_cast<std::uint64_t>(BufferBlocks::blocks(r.imageExtent.width, format.block_width)) * format.block_bytes;
  for (std::int64_t z = 0; z < slices; ++z)
    for (std::int64_t y = 0; y < r.imageExtent.height; y += format.block_height) {
      const Place at{r.imageOffset.x, r.imageOffset.y + y, first_z(from, r.imageSubresource, r.imageOffset) + z};
      const std::byte* const texel = address_of(from, aspect, r.imageSubresource.mipLevel, 0, at);
      const std::uint64_t offset = BufferBlocks(r, format).offset(0, y, z);
      if (texel == nullptr || offset + bytes > command.target->size) continue;
      const TexelId id = state.observed->pixels->locate(texel);
      if (id.image == 0) continue;
      state.observed->pixels->staged().add(command.target->data + offset, bytes,
                                           {id, &format, now.submission, now.command, now.name}, format.block_width);
    }
}

/// Calls f(texel) for the watched texels of some levels and layers.
template <class F>
void for_each_in(const ReplayState& state, const Image& image, const VkImageSubresourceRange& recorded, F&& f) {
  const std::vector<Texel*> texels = state.observed->pixels->texels_of(&image);
  if (texels.empty()) return;
  const VkImageSubresourceRange range = resolve_range(image, recorded);
  const VkImageAspectFlags planes = (range.aspectMask & VK_IMAGE_ASPECT_COLOR_BIT) && image.layout.plane_count > 1
                                        ? ~VkImageAspectFlags{0}
                                        : range.aspectMask;
  const auto inside = [](std::uint32_t at, std::uint32_t first, std::uint32_t count) {
    return at >= first && at - first < count;
  };
  for (Texel* texel : texels) {
    const TexelId& id = texel->id;
    const bool layered =
        image.desc().type == VK_IMAGE_TYPE_3D || inside(id.layer, range.baseArrayLayer, range.layerCount);
    if ((planes & id.aspect) != 0 && layered && inside(id.level, range.baseMipLevel, range.levelCount)) f(*texel);
  }
}

/// Calls f(region, texel) for all regions of a command on the watched texels of its target.
template <class Command, class F>
void for_each_region(const ReplayState& state, const Command& command, F&& f) {
  const std::vector<Texel*> texels = state.observed->pixels->texels_of(command.target);
  for (const auto& region : command.regions)
    for (Texel* texel : texels) f(region, *texel);
}

/// By the host, which called that command.
TexelEvent event_of_host(EventKind kind, const char* text, const char* command) {
  TexelEvent event;
  event.kind = kind;
  event.text = text;
  event.address.command_name = command;
  event.replaces = true;
  return event;
}

}  // namespace

void note_host_upload(const Image& to, const VkBufferImageCopy& region, const char* command) {
  glass::pixel::Pixels* const pixels = glass::pixel::pixels();
  if (!pixels) return;
  for (Texel* texel : pixels->texels_of(&to))
    if (offset_in(region, to, *texel))
      pixels->add(*texel, event_of_host(EventKind::kUpload, "copied from memory by the host", command));
}

void note_host_copy(const Image& from, const Image& to, const VkImageCopy& region, const char* command) {
  glass::pixel::Pixels* const pixels = glass::pixel::pixels();
  if (!pixels) return;
  for (Texel* texel : pixels->texels_of(&to))
    note_copy(*pixels, from, to, region, *texel,
              event_of_host(EventKind::kCopy, "copied from another texel by the host", command));
}

void note_texels(ReplayState& state, const CmdCopyImage& command) {
  for_each_region(state, command, [&](const VkImageCopy& r, Texel& t) {
    note_copy(*state.observed->pixels, *command.source, *command.target, r, t,
              texel_event(state, EventKind::kCopy, kCopied));
  });
}

void note_texels(ReplayState& state, const CmdBlitImage& command) {
  for_each_region(state, command, [&](const VkImageBlit& r, Texel& t) { note_blit(state, command, r, t); });
}

void note_texels(ReplayState& state, const CmdResolveImage& command) {
  for_each_region(state, command, [&](const VkImageResolve& r, Texel& t) { note_resolve(state, command, r, t); });
}

void note_texels(ReplayState& state, const CmdCopyBufferToImage& command) {
  for_each_region(state, command, [&](const VkBufferImageCopy& r, Texel& t) { note_upload(state, command, r, t); });
}

void note_texels(ReplayState& state, const CmdCopyImageToBuffer& command) {
  if (!command.target->data) return;
  for (const VkBufferImageCopy& region : command.regions) note_download(state, command, region);
}

void note_texels(ReplayState& state, const CmdCopyBuffer& command) {
  if (!command.source->data || !command.target->data) return;
  for (const VkBufferCopy& r : command.regions)
    state.observed->pixels->staged().copied(command.source->data + r.srcOffset, command.target->data + r.dstOffset,
                                            std::min(command.source->resolve_range(r.srcOffset, r.size),
                                                     command.target->resolve_range(r.dstOffset, r.size)));
}

void note_texels(ReplayState& state, const CmdClearColorImage& command) {
  for (const VkImageSubresourceRange& range : command.ranges)
    for_each_in(state, *command.image, range, [&](Texel& texel) {
      state.observed->pixels->add(texel, texel_event(state, EventKind::kClear, "cleared"));
    });
}

void note_texels(ReplayState& state, const CmdClearDepthStencilImage& command) {
  for (const VkImageSubresourceRange& range : command.ranges)
    for_each_in(state, *command.image, range, [&](Texel& texel) {
      state.observed->pixels->add(texel, texel_event(state, EventKind::kClear, "cleared"));
    });
}

void note_texels(ReplayState& state, const CmdDiscardImages& command) {
  for (const DiscardedImage& discarded : command.images)
    for_each_in(state, *discarded.image, discarded.range, [&](Texel& texel) {
      state.observed->pixels->add(
          texel, texel_event(state, EventKind::kUndefined, "undefined by a barrier from VK_IMAGE_LAYOUT_UNDEFINED"));
    });
}

}  // namespace vitrine::icd
