// See captured_objects.h. Buffers and views are found in the device's book of addresses, since descriptors hold
// addresses alone.
#include "icd/replay/captured_objects.h"

#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <numeric>

#include "glass/memory_shadow.h"
#include "icd/object/address_book.h"

namespace vitrine::icd {
namespace {

using glass::bug::Blob;
using glass::bug::Bytes;
using glass::bug::kNone;

/// What sizes of buffers are multiples of in memory.
constexpr std::uintptr_t kGrain = 64;

template <class T>
const T* find_object(const Device& device, const void* first, std::uint64_t bytes) {
  const ObjectRef found = device.addresses ? device.addresses->find(first, bytes) : ObjectRef{};
  return found.handle && found.type == T::kType ? reinterpret_cast<const T*>(found.handle) : nullptr;
}

template <class T>
std::string name_of(const Device& device, const T& object) {
  return icd::name_of(device.physical_device.instance, ref(object));
}

/// A copy of these bytes, or the one that was taken of them before if they are still the same.
Blob snapshot(const std::byte* first, std::uint64_t size, Snapshots& snapshots) {
  Blob& kept = snapshots[first];
  if (!kept || kept->size() != size || std::memcmp(kept->data(), first, size) != 0)
    kept = std::make_shared<Bytes>(first, first + size);
  return kept;
}

bool is_zero(const std::byte* first, std::uint64_t size) {
  return std::all_of(first, first + size, [](std::byte b) { return b == std::byte{0}; });
}

}  // namespace

std::uint32_t CapturedObjects::add_buffer(const Buffer& buffer) {
  const auto [number, added] = numbers_.try_emplace(&buffer, static_cast<std::uint32_t>(buffers_.size()));
  if (!added) return number->second;
  buffers_.push_back({buffer.data, buffer.size});
  bug_.buffers.push_back({name_of(device_, buffer), buffer.size, buffer.usage, 0, 0, false});
  return number->second;
}

void CapturedObjects::add_gone(const std::byte* first, std::uint64_t bytes, const std::string& name) {
  bug_.addressed.push_back(static_cast<std::uint32_t>(buffers_.size()));
  buffers_.push_back({const_cast<std::byte*>(first), bytes});
  bug_.buffers.push_back({name, bytes, VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT, 0, 0, true});
}

void CapturedObjects::add_addressed() {
  if (!device_.addresses) return;
  for (const ObjectRef object : device_.addresses->objects(VK_OBJECT_TYPE_BUFFER)) {
    const auto& live = *reinterpret_cast<const Buffer*>(object.handle);
    if (!(live.usage & VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT) || !live.data) continue;
    bug_.addressed.push_back(buffer(live, 0, live.size));
  }
  std::set<const std::byte*> known;
  for (const AddressBook::GoneBuffer& gone : device_.addresses->gone_buffers()) {
    const auto end = touched_.upper_bound(const_cast<std::byte*>(gone.first));
    const bool covered = end != touched_.begin() && std::prev(end)->second > gone.first;
    if (!covered && known.insert(gone.first).second) add_gone(gone.first, gone.bytes, gone.name);
  }
}

CapturedObjects::Place CapturedObjects::bytes(const std::byte* first, std::uint64_t size) {
  const Buffer* found = first ? find_object<Buffer>(device_, first, size) : nullptr;
  if (!found) return {};
  const auto offset = static_cast<std::uint64_t>(first - found->data);
  return {buffer(*found, offset, size), offset};
}

std::uint32_t CapturedObjects::buffer(const Buffer& buffer, std::uint64_t offset, std::uint64_t size) {
  if (!buffer.data) return kNone;
  std::byte* first = buffer.data + std::min<std::uint64_t>(offset, buffer.size);
  std::byte* end = first + buffer.resolve_range(offset, size);
  // What overlaps or touches becomes one.
  auto at = touched_.upper_bound(end);
  while (at != touched_.begin() && std::prev(at)->second >= first) {
    at = std::prev(at);
    first = std::min(first, at->first);
    end = std::max(end, at->second);
    at = touched_.erase(at);
  }
  if (first != end) touched_[first] = end;
  return add_buffer(buffer);
}

std::uint32_t CapturedObjects::add_image(const Image& image) {
  const auto at = std::find(images_.begin(), images_.end(), &image);
  if (at != images_.end()) return static_cast<std::uint32_t>(at - images_.begin());
  const texel::ImageDesc& desc = image.desc();
  const texel::FormatDesc& format = texel::format_desc(desc.format);
  if (format.plane_count != 1 && !format.is_depth_stencil()) problem_ = "images of several planes are not kept";
  if (!image.data) problem_ = "an image has no memory";
  images_.push_back(&image);
  shown_.emplace_back();
  glass::bug::Image out;
  out.name = name_of(device_, image);
  out.flags = image.flags;
  out.usage = image.usage;
  out.type = desc.type;
  out.format = desc.format;
  // What another device shares is linear to the file: nobody else is there when it is replayed.
  out.tiling = image.tiling == VK_IMAGE_TILING_OPTIMAL ? VK_IMAGE_TILING_OPTIMAL : VK_IMAGE_TILING_LINEAR;
  out.extent = desc.extent;
  out.levels = desc.levels;
  out.layers = desc.layers;
  out.samples = desc.samples;
  bug_.images.push_back(std::move(out));
  return static_cast<std::uint32_t>(images_.size() - 1);
}

std::uint32_t CapturedObjects::view(const ImageView& view) {
  const auto [number, added] = numbers_.try_emplace(&view, static_cast<std::uint32_t>(bug_.views.size()));
  if (!added) return number->second;
  glass::bug::View out;
  out.name = name_of(device_, view);
  out.image = add_image(*view.image);
  out.type = view.type;
  out.format = view.format;
  out.usage = view.usage;
  out.swizzle = view.view.swizzle;
  out.range = view.range;
  const bool slices = view.image->desc().type == VK_IMAGE_TYPE_3D;
  for (std::uint32_t i = 0; i < view.range.levelCount; ++i) {
    const std::uint32_t first = slices ? 0 : view.range.baseArrayLayer, count = slices ? 1 : view.range.layerCount;
    const auto [layers, fresh] = shown_[out.image].try_emplace(view.range.baseMipLevel + i, first, first + count);
    layers->second = {std::min(layers->second.first, first), std::max(layers->second.second, first + count)};
  }
  bug_.views.push_back(std::move(out));
  return number->second;
}

std::uint32_t CapturedObjects::view(const texel::ImageView& texels) {
  const auto* found = find_object<ImageView>(device_, &texels, sizeof texels);
  if (found && &texels != &found->view && &texels == &found->stored())
    problem_ = "views of some slices of an image are not kept";
  return found ? view(*found) : kNone;
}

std::uint32_t CapturedObjects::texels(const texel::BufferTexelView& view) {
  const auto [number, added] = numbers_.try_emplace(&view, static_cast<std::uint32_t>(bug_.buffer_views.size()));
  if (!added) return number->second;
  const auto* found = find_object<BufferView>(device_, &view, sizeof view);
  const std::uint64_t size = view.count * view.format->block_bytes;
  const Place place = found ? bytes(view.data, size) : Place{};
  if (place.buffer == kNone) {
    numbers_.erase(number);
    return kNone;
  }
  bug_.buffer_views.push_back({name_of(device_, *found), place.buffer, view.format->format, place.offset, size});
  return number->second;
}

std::uint32_t CapturedObjects::sampler(const texel::Sampler& sampler) {
  const auto [number, added] = numbers_.try_emplace(&sampler, static_cast<std::uint32_t>(bug_.samplers.size()));
  if (!added) return number->second;
  if (sampler.conversion.enabled) problem_ = "samplers with a conversion of colours are not kept";
  const auto* found = find_object<Sampler>(device_, &sampler, sizeof sampler);
  bug_.samplers.push_back({found ? name_of(device_, *found) : std::string(), sampler});
  return number->second;
}

/// Buffers that overlap share memory; of those that keep their addresses, those of one page, as an allocation has
/// pages for itself.
void CapturedObjects::place_buffers() {
  const auto page = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
  const auto page_of = [&](const std::byte* at) { return reinterpret_cast<std::uintptr_t>(at) / page * page; };
  std::vector<std::size_t> order(buffers_.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return buffers_[a].data < buffers_[b].data; });
  const bool keeps_addresses = !bug_.addressed.empty();
  std::uintptr_t first = 0, end = 0, end_of_pages = 0;
  for (const std::size_t i : order) {
    const Placed& buffer = buffers_[i];
    const auto data = reinterpret_cast<std::uintptr_t>(buffer.data);
    if (data >= end && (!keeps_addresses || page_of(buffer.data) >= end_of_pages)) {
      first = end = keeps_addresses ? page_of(buffer.data) : data;
      bug_.memories.push_back({0, first, {}});
    }
    end = std::max(end, data + buffer.size);
    // As the replayer asks for it.
    end_of_pages = ((end + kGrain - 1) / kGrain * kGrain + kTailBytes + page - 1) / page * page;
    bug_.memories.back().size = end - first;
    bug_.buffers[i].memory = static_cast<std::uint32_t>(bug_.memories.size() - 1);
    bug_.buffers[i].offset = data - first;
  }
}

void CapturedObjects::add_piece(const Range& range, std::uint64_t begin, std::uint64_t end, bool unwritten,
                                Snapshots& snapshots) {
  if (begin == end) return;
  glass::bug::Memory& memory = bug_.memories[range.memory];
  std::byte* const first = range.first + begin;
  pieces_.push_back({first, end - begin, range.memory, memory.pieces.size()});
  memory.pieces.push_back({reinterpret_cast<std::uint64_t>(first) - memory.address, unwritten,
                           snapshot(first, end - begin, snapshots), nullptr});
}

/// What nothing has written, and is zero, is told apart: it stays unwritten where it is replayed.
void CapturedObjects::take_range(const Range& range, Snapshots& snapshots) {
  const glass::ShadowRegion* shadow = keeps_shadow_ ? glass::find_shadow(range.first) : nullptr;
  const auto address = reinterpret_cast<std::uintptr_t>(range.first);
  if (!shadow || !shadow->contains(address, range.size)) return add_piece(range, 0, range.size, false, snapshots);
  const auto written = [&](std::uint64_t at) {
    return shadow->first_unwritten(address + at, range.size - at, glass::Contents::kBytes) / 4 * 4;
  };
  const auto unwritten = [&](std::uint64_t at) {
    const std::uint64_t bytes = std::min<std::uint64_t>(4, range.size - at);
    return shadow->first_unwritten(address + at, bytes, glass::Contents::kBytes) == 0 &&
           is_zero(range.first + at, bytes);
  };
  for (std::uint64_t at = 0; at < range.size;) {
    std::uint64_t end = at;
    while (end < range.size && !unwritten(end)) end += std::max<std::uint64_t>(4, written(end));
    end = std::min(end, range.size);
    add_piece(range, at, end, false, snapshots);
    for (at = end; end < range.size && unwritten(end);) end += 4;
    end = std::min(end, range.size);
    add_piece(range, at, end, true, snapshots);
    at = end;
  }
}

void CapturedObjects::take_before(Snapshots& snapshots) {
  place_buffers();
  for (const auto& [first, end] : touched_) {
    const auto address = reinterpret_cast<std::uint64_t>(first);
    const auto inside = [&](const glass::bug::Memory& m) {
      return address >= m.address && address - m.address < m.size;
    };
    const auto memory = std::find_if(bug_.memories.begin(), bug_.memories.end(), inside);
    Range range{first, static_cast<std::uint64_t>(end - first), 0, 0};
    // Buffers that touch are apart, though what was touched of them is one range.
    for (auto at = memory; range.size != 0 && at != bug_.memories.end(); ++at) {
      range.memory = static_cast<std::uint32_t>(at - bug_.memories.begin());
      const std::uint64_t left = at->address + at->size - reinterpret_cast<std::uint64_t>(range.first);
      Range part = range;
      part.size = std::min(range.size, left);
      take_range(part, snapshots);
      range.first += part.size;
      range.size -= part.size;
    }
  }
  for (std::uint32_t i = 0; i < images_.size(); ++i) take_image(i, snapshots);
}

void CapturedObjects::take_after() {
  for (const Range& range : pieces_) {
    glass::bug::Piece& piece = bug_.memories[range.memory].pieces[range.piece];
    if (std::memcmp(piece.before->data(), range.first, range.size) != 0)
      piece.after = std::make_shared<Bytes>(range.first, range.first + range.size);
  }
  for (std::size_t i = 0; i < images_.size(); ++i) {
    for (glass::bug::Texels& texels : bug_.images[i].texels) {
      Bytes now = packed(*images_[i], texels);
      if (now != *texels.before) texels.after = std::make_shared<Bytes>(std::move(now));
    }
  }
}

}  // namespace vitrine::icd
