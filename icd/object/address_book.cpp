// Looking up objects by address. Look-ups are as rare as findings and bindings, so they go through all objects.
#include "icd/object/address_book.h"

#include <algorithm>

namespace vitrine::icd {
namespace {

// What is remembered of objects that are gone: a frame or two of an application that makes everything anew.
constexpr std::size_t kMaxDeparted = 4096;

const char* kind_of(VkObjectType type) {
  switch (type) {
    case VK_OBJECT_TYPE_BUFFER:
      return "buffer";
    case VK_OBJECT_TYPE_BUFFER_VIEW:
      return "buffer view";
    case VK_OBJECT_TYPE_IMAGE:
      return "image";
    case VK_OBJECT_TYPE_IMAGE_VIEW:
      return "image view";
    case VK_OBJECT_TYPE_SAMPLER:
      return "sampler";
    default:
      return "memory";
  }
}

std::string called(ObjectRef object, const AddressBook::Namer& name) {
  const std::string text = name(object);
  return kind_of(object.type) + (text.empty() ? std::string() : " '" + text + "'");
}

}  // namespace

void AddressBook::add(const Place& place, ObjectRef object) noexcept {
  const std::lock_guard lock(mutex_);
  try {
    entries_[object.handle] = {place, object, ++clock_};
  } catch (const std::bad_alloc&) {
    // One name less in findings.
  }
}

bool AddressBook::depends(const Entry& entry, const Entry& gone) {
  if (entry.place.parent.handle == gone.object.handle) return true;
  const bool in_memory = gone.object.type == VK_OBJECT_TYPE_DEVICE_MEMORY && entry.place.data &&
                         entry.object.type != VK_OBJECT_TYPE_DEVICE_MEMORY;
  return in_memory && gone.has(reinterpret_cast<std::uintptr_t>(entry.place.data), 0);
}

void AddressBook::depart(const Entry& entry, std::string name, std::string text) {
  departures_.fetch_add(1, std::memory_order_relaxed);
  departed_.push_back({entry, std::move(name), std::move(text)});
  if (departed_.size() > kMaxDeparted) departed_.pop_front();
}

void AddressBook::remove(ObjectRef object, const Namer& name) noexcept {
  const std::lock_guard lock(mutex_);
  try {
    const auto at = entries_.find(object.handle);
    const Entry gone = at == entries_.end() ? Entry{{}, object, 0} : at->second;
    const bool is_memory = object.type == VK_OBJECT_TYPE_DEVICE_MEMORY;
    const std::string when =
        (is_memory ? " freed after submission " : " destroyed after submission ") + std::to_string(submission_.load());
    const std::string self = called(object, name);
    std::vector<std::uint64_t> dependent{object.handle};
    if (at != entries_.end()) depart(gone, name(object), self + "," + when);
    for (std::size_t i = 0; i < dependent.size(); ++i) {
      const Entry parent = i == 0 ? gone : entries_.at(dependent[i]);
      for (const auto& [handle, entry] : entries_) {
        if (handle == parent.object.handle || !depends(entry, parent)) continue;
        if (std::find(dependent.begin(), dependent.end(), handle) != dependent.end()) continue;
        dependent.push_back(handle);
        depart(entry, name(entry.object), called(entry.object, name) + ", whose " + self + " was" + when);
      }
    }
    for (const std::uint64_t handle : dependent) entries_.erase(handle);
  } catch (const std::bad_alloc&) {
    entries_.erase(object.handle);
  }
}

ObjectRef AddressBook::find(const void* first, std::uint64_t bytes) const {
  const auto begin = reinterpret_cast<std::uintptr_t>(first);
  const std::lock_guard lock(mutex_);
  ObjectRef best;
  std::uint64_t best_bytes = UINT64_MAX;
  for (const auto& [handle, entry] : entries_) {
    // Memory is no object that descriptors name.
    if (entry.object.type == VK_OBJECT_TYPE_DEVICE_MEMORY) continue;
    if (!entry.has(begin, bytes) || entry.place.bytes >= best_bytes) continue;
    best = entry.object;
    best_bytes = entry.place.bytes;
  }
  return best;
}

std::vector<spirv::AddressRange> AddressBook::buffers() const {
  std::vector<spirv::AddressRange> ranges;
  {
    const std::lock_guard lock(mutex_);
    for (const auto& [handle, entry] : entries_) {
      const auto first = reinterpret_cast<std::uintptr_t>(entry.place.first);
      if (entry.object.type == VK_OBJECT_TYPE_BUFFER) ranges.push_back({first, first + entry.place.bytes});
    }
  }
  std::sort(ranges.begin(), ranges.end(), [](const auto& a, const auto& b) { return a.begin < b.begin; });
  std::size_t kept = 0;
  for (std::size_t i = 1; i < ranges.size(); ++i) {
    if (ranges[i].begin <= ranges[kept].end)
      ranges[kept].end = std::max(ranges[kept].end, ranges[i].end);
    else
      ranges[++kept] = ranges[i];
  }
  ranges.resize(std::min(ranges.size(), kept + 1));
  return ranges;
}

std::vector<ObjectRef> AddressBook::objects(VkObjectType type) const {
  const std::lock_guard lock(mutex_);
  std::vector<ObjectRef> found;
  for (const auto& [handle, entry] : entries_)
    if (entry.object.type == type) found.push_back(entry.object);
  return found;
}

std::vector<AddressBook::GoneBuffer> AddressBook::gone_buffers() const {
  const std::lock_guard lock(mutex_);
  std::vector<GoneBuffer> found;
  for (auto at = departed_.rbegin(); at != departed_.rend(); ++at)
    if (at->entry.object.type == VK_OBJECT_TYPE_BUFFER)
      found.push_back({static_cast<const std::byte*>(at->entry.place.first), at->entry.place.bytes, at->name});
  return found;
}

bool AddressBook::is_alive(const void* first, std::uint64_t bytes, std::uint64_t time) const {
  const auto begin = reinterpret_cast<std::uintptr_t>(first);
  const std::lock_guard lock(mutex_);
  return std::any_of(entries_.begin(), entries_.end(), [&](const auto& row) {
    const Entry& entry = row.second;
    return entry.object.type != VK_OBJECT_TYPE_DEVICE_MEMORY && entry.serial <= time && entry.has(begin, bytes);
  });
}

std::string AddressBook::departed(const void* first, std::uint64_t bytes, std::uint64_t time) const {
  const auto begin = reinterpret_cast<std::uintptr_t>(first);
  const std::lock_guard lock(mutex_);
  const Departed* best = nullptr;
  for (auto at = departed_.rbegin(); at != departed_.rend(); ++at) {
    if (at->entry.serial > time || !at->entry.has(begin, bytes)) continue;
    // The youngest, but a buffer rather than the memory that it lay in.
    if (!best) best = &*at;
    if (at->entry.object.type == VK_OBJECT_TYPE_DEVICE_MEMORY) continue;
    best = &*at;
    break;
  }
  return best ? best->text : std::string();
}

}  // namespace vitrine::icd
