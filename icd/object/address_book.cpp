// Looking up objects by address. Look-ups are as rare as findings, so they go through all objects.
#include "icd/object/address_book.h"

namespace vitrine::icd {

void AddressBook::add(const void* first, std::uint64_t bytes, ObjectRef object) noexcept {
  const std::lock_guard lock(mutex_);
  try {
    entries_[object.handle] = {reinterpret_cast<std::uintptr_t>(first), bytes, object.type};
  } catch (const std::bad_alloc&) {
    // One name less in findings.
  }
}

void AddressBook::remove(ObjectRef object) noexcept {
  const std::lock_guard lock(mutex_);
  entries_.erase(object.handle);
}

ObjectRef AddressBook::find(const void* first, std::uint64_t bytes) const {
  const auto begin = reinterpret_cast<std::uintptr_t>(first);
  const std::lock_guard lock(mutex_);
  ObjectRef best;
  std::uint64_t best_bytes = UINT64_MAX;
  for (const auto& [handle, entry] : entries_) {
    const bool inside = begin >= entry.first && bytes <= entry.bytes && begin - entry.first <= entry.bytes - bytes;
    if (!inside || entry.bytes >= best_bytes) continue;
    best = {entry.type, handle};
    best_bytes = entry.bytes;
  }
  return best;
}

}  // namespace vitrine::icd
