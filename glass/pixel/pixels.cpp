// See pixels.h.
#include "glass/pixel/pixels.h"

#include <algorithm>
#include <iterator>
#include <tuple>

namespace vitrine::glass::pixel {
namespace {

/// Of a texel: the newest.
constexpr std::size_t kMostEvents = 4096;
/// Of a draw, that a primitive's fate is told of.
constexpr std::size_t kMostInstances = 256;
/// Of a process.
constexpr std::size_t kMostTexels = 1 << 20;

/// The aspect that is watched where nobody says which.
VkImageAspectFlags first_aspect(const texel::FormatDesc& format) {
  if (format.has_depth()) return VK_IMAGE_ASPECT_DEPTH_BIT;
  if (format.has_stencil()) return VK_IMAGE_ASPECT_STENCIL_BIT;
  return format.plane_count > 1 ? VK_IMAGE_ASPECT_PLANE_0_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
}

bool has_aspect(const texel::FormatDesc& format, VkImageAspectFlags aspect) {
  if (format.is_depth_stencil()) return (format.aspects & aspect) == aspect;
  if (format.plane_count <= 1) return aspect == VK_IMAGE_ASPECT_COLOR_BIT;
  for (std::uint32_t i = 0; i < format.plane_count; ++i)
    if (aspect == static_cast<VkImageAspectFlags>(VK_IMAGE_ASPECT_PLANE_0_BIT << i)) return true;
  return false;
}

bool names(const Request& request, const Image& image) {
  if (request.image == "*") return true;
  if (request.image == "swapchain") return image.in_swapchain;
  if (!image.name.empty() && request.image == image.name) return true;
  return request.image.starts_with('#') && request.image.substr(1) == std::to_string(image.number);
}

}  // namespace

Address address_of(const spirv::ObservedCommand& command) {
  Address address;
  address.submission = command.submission;
  address.command = command.command;
  address.command_name = command.name;
  address.labels = command.labels;
  address.pipeline =
      command.pipeline.empty() ? "pipeline " + std::to_string(command.pipeline_number) : command.pipeline;
  return address;
}

void Pixels::image_made(const void* key, const ImagePlace& place, bool in_swapchain) {
  const std::lock_guard lock(mutex_);
  auto image = std::make_unique<Image>();
  image->number = ++image_count_;
  image->place = place;
  image->in_swapchain = in_swapchain;
  notes_[image->number] = {{}, in_swapchain, place.layout->desc};
  match(*image);
  images_[key] = std::move(image);
}

void Pixels::image_named(const void* key, std::string_view name) {
  const std::lock_guard lock(mutex_);
  const auto at = images_.find(key);
  if (at == images_.end()) return;
  at->second->name = name;
  notes_[at->second->number].name = name;
  match(*at->second);
}

void Pixels::image_gone(const void* key) {
  const std::lock_guard lock(mutex_);
  const auto at = images_.find(key);
  if (at == images_.end()) return;
  for (Texel* texel : at->second->texels) {
    if (texel->address != nullptr) by_address_.erase(texel->address);
    texel->address = nullptr;
    texel->image = nullptr;
  }
  images_.erase(at);
}

/// Watches what the requests name of an image.
void Pixels::match(Image& image) {
  for (const Request& request : requests_)
    if (names(request, image)) watch(image, request);
}

void Pixels::watch(Image& image, const Request& request) {
  const texel::ImageLayout& layout = *image.place.layout;
  const texel::FormatDesc& whole = texel::format_desc(layout.desc.format);
  const VkImageAspectFlags aspect = request.aspect != 0 ? request.aspect : first_aspect(whole);
  if (!has_aspect(whole, aspect) || request.level >= layout.desc.levels || request.layer >= layout.desc.layers) return;
  const texel::PlaneLayout& plane =
      layout.plane[texel::plane_of_aspect(layout, static_cast<VkImageAspectFlagBits>(aspect))];
  const texel::Extent& extent = plane.level[request.level].extent;
  if (request.slice >= extent.depth) return;
  const auto samples = std::max(layout.desc.samples, 1u);
  TexelId id{image.number, aspect, request.level, request.layer, request.slice, 0, 0, 0};
  const std::int64_t x1 = std::min<std::int64_t>(request.x1, std::int64_t{extent.width} - 1);
  const std::int64_t y1 = std::min<std::int64_t>(request.y1, std::int64_t{extent.height} - 1);
  for (std::int64_t y = request.y0; y <= y1; ++y)
    for (std::int64_t x = request.x0; x <= x1; ++x)
      for (std::uint32_t s = request.sample.value_or(0); s <= request.sample.value_or(samples - 1) && s < samples;
           ++s) {
        id.x = static_cast<std::uint32_t>(x), id.y = static_cast<std::uint32_t>(y), id.sample = s;
        if (texels_.size() >= kMostTexels || !image.watched.insert(id).second) continue;
        auto texel = std::make_unique<Texel>();
        texel->id = id;
        texel->format = &texel::format_desc(plane.format);
        texel->image = &image;
        image.texels.push_back(texel.get());
        texels_.push_back(std::move(texel));
      }
}

/// Finds the address of a texel whose image has memory.
void Pixels::place(Texel& texel) {
  if (texel.address != nullptr || texel.image == nullptr || *texel.image->place.memory == nullptr) return;
  texel.address = address_of(texel.image->place, texel.id);
  texel.value.size = texel.format->block_bytes;  // memory begins as zeros
  by_address_[texel.address] = &texel;
}

template <class F>
void Pixels::for_each_placed(F&& f) {
  for (const auto& texel : texels_) {
    place(*texel);
    if (texel->address != nullptr) f(*texel);
  }
}

std::vector<Texel*> Pixels::texels_of(const void* key) {
  if (stopped()) return {};
  const std::lock_guard lock(mutex_);
  const auto at = images_.find(key);
  if (at == images_.end() || *at->second->place.memory == nullptr) return {};
  for (Texel* texel : at->second->texels) place(*texel);
  return at->second->texels;
}

std::vector<Texel*> Pixels::texels() {
  std::vector<Texel*> all;
  if (stopped()) return all;
  const std::lock_guard lock(mutex_);
  for_each_placed([&](Texel& texel) { all.push_back(&texel); });
  return all;
}

void Pixels::append(Texel& texel, Event event) {
  event.frame = frame_;
  if (texel.events.size() >= kMostEvents) {
    texel.events.pop_front();
    ++texel.dropped;
  }
  texel.events.push_back(std::move(event));
}

void Pixels::add(Texel& texel, Event event) {
  event.before = texel.value;
  event.after = texel.value = texel.read();
  const std::lock_guard lock(mutex_);
  append(texel, std::move(event));
}

void Pixels::add_unchanged(Texel& texel, Event event) {
  event.before = event.after = texel.value;
  const std::lock_guard lock(mutex_);
  append(texel, std::move(event));
}

/// Whether the texel still holds what the last event left; if not, that is an event.
void Pixels::check(Texel& texel, const char* text) {
  const Value now = texel.read();
  if (now == texel.value) return;
  Event event;
  event.kind = EventKind::kUnknown;
  event.text = text;
  event.before = texel.value;
  event.after = texel.value = now;
  append(texel, std::move(event));
}

void Pixels::submission_begins(std::uint64_t submission) {
  if (limits_.last_submission != 0 && submission > limits_.last_submission) stopped_ = true;
  submission_ = submission;
  if (stopped()) return;
  const std::lock_guard lock(mutex_);
  for_each_placed([&](Texel& t) { check(t, "changed between submissions: by the host, or through other memory"); });
}

void Pixels::submission_ends() {
  if (stopped()) return;
  const std::lock_guard lock(mutex_);
  for (const auto& texel : texels_)
    if (texel->address != nullptr) check(*texel, "changed by a command of this submission that is not followed");
}

void Pixels::presented(const void* key) {
  if (stopped()) return;
  for (Texel* texel : texels_of(key)) {
    Event event;
    event.kind = EventKind::kPresent;
    event.address.submission = submission_;
    event.text = "presented";
    add(*texel, std::move(event));
  }
  const std::lock_guard lock(mutex_);
  if (limits_.last_frame != 0 && frame_ >= limits_.last_frame) stopped_ = true;
  ++frame_;
}

void Pixels::add(std::vector<Pending> pending) {
  if (pending.empty()) return;
  const std::lock_guard lock(mutex_);
  std::ranges::move(pending, std::back_inserter(pending_));
}

void Pixels::commands_done(const void* owner) {
  const std::lock_guard lock(mutex_);
  const auto mine =
      std::stable_partition(pending_.begin(), pending_.end(), [&](const Pending& p) { return p.owner != owner; });
  std::stable_sort(mine, pending_.end(), [](const Pending& a, const Pending& b) {
    const auto key = [](const Pending& p) { return std::tie(p.event.address.submission, p.event.address.command); };
    return key(a) != key(b) ? key(a) < key(b) : a.order < b.order;
  });
  std::map<Texel*, Event*> last;
  for (auto p = mine; p != pending_.end(); ++p) {
    if (p->stored) p->event.before = p->texel->value;
    append(*p->texel, std::move(p->event));
    if (p->stored)
      last[p->texel] = &p->texel->events.back();
    else
      last.erase(p->texel);
  }
  pending_.erase(mine, pending_.end());
  for (const auto& [texel, event] : last) event->after = texel->value = texel->read();
}

void Pixels::add_primitive(const spirv::ObservedCommand& command, std::optional<std::uint32_t> instance,
                           std::size_t fate) {
  const std::lock_guard lock(mutex_);
  PrimitiveNote& note = primitives_[{command.submission, command.command, fate}];
  if (note.count++ == 0) note.address = address_of(command);
  if (instance) note.instances.insert(*instance);
  if (note.instances.size() <= kMostInstances) return;
  // Which ones are kept does not depend on the order in which they come.
  note.instances.erase(std::prev(note.instances.end()));
  note.more = true;
}

Texel* Pixels::find(const std::byte* address) const {
  const std::lock_guard lock(mutex_);
  const auto at = by_address_.find(address);
  return at == by_address_.end() ? nullptr : at->second;
}

TexelId Pixels::locate(const std::byte* address) const {
  const std::lock_guard lock(mutex_);
  for (const auto& [key, image] : images_) {
    if (*image->place.memory == nullptr) continue;
    if (const auto id = id_at(image->place, address)) {
      TexelId found = *id;
      found.image = image->number;
      return found;
    }
  }
  return {};
}

Source Pixels::source_at(const std::byte* address, const texel::FormatDesc& format, float weight) const {
  Source source{locate(address), &format, {}, weight};
  source.value.size = format.block_bytes;
  std::copy_n(address, source.value.size, source.value.bytes.begin());
  return source;
}

}  // namespace vitrine::glass::pixel
