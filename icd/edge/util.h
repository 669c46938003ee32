// The pNext iterator and the count-then-fill helper: one each, used by every entry point.
#pragma once

#include <algorithm>
#include <cstdint>

#include "icd/structure_types.h"

namespace vitrine::icd {

/// Range over a pNext chain: for (const VkBaseInStructure& item : in_chain(info->pNext)).
template <class Base>
class Chain {
 public:
  struct Iterator {
    Base* item;
    Base& operator*() const { return *item; }
    Iterator& operator++() {
      item = const_cast<Base*>(reinterpret_cast<const Base*>(item->pNext));
      return *this;
    }
    bool operator!=(const Iterator& other) const { return item != other.item; }
  };

  explicit Chain(Base* first) : first_(first) {}
  Iterator begin() const { return {first_}; }
  Iterator end() const { return {nullptr}; }

 private:
  Base* first_;
};

inline Chain<const VkBaseInStructure> in_chain(const void* first) {
  return Chain<const VkBaseInStructure>(static_cast<const VkBaseInStructure*>(first));
}
inline Chain<VkBaseOutStructure> out_chain(void* first) {
  return Chain<VkBaseOutStructure>(static_cast<VkBaseOutStructure*>(first));
}

/// The first structure of type T in a chain, or null.
template <class T>
const T* find_in_chain(const void* chain) {
  static_assert(kStructureTypeOf<T> != VK_STRUCTURE_TYPE_MAX_ENUM);
  for (const VkBaseInStructure& item : in_chain(chain)) {
    if (item.sType == kStructureTypeOf<T>) return reinterpret_cast<const T*>(&item);
  }
  return nullptr;
}

template <class T>
T* find_in_out_chain(void* chain) {
  return const_cast<T*>(find_in_chain<T>(chain));
}

/// A structure with its sType set and the rest zero.
template <class T>
T make_struct(void* next = nullptr) {
  static_assert(kStructureTypeOf<T> != VK_STRUCTURE_TYPE_MAX_ENUM);
  T result{};
  result.sType = kStructureTypeOf<T>;
  result.pNext = next;
  return result;
}

/// Vulkan's count-then-fill protocol: with a null array only counts, else fills up to *count elements. next() gives the
/// slot of one more element, or null when there is none to fill; result() sets *count.
template <class T>
class OutArray {
 public:
  OutArray(std::uint32_t* count, T* data) : count_(count), data_(data), capacity_(data ? *count : 0) {}

  T* next() {
    const std::uint32_t index = wanted_++;
    return data_ && index < capacity_ ? data_ + index : nullptr;
  }
  void push(const T& value) {
    if (T* slot = next()) *slot = value;
  }
  VkResult result() {
    *count_ = data_ ? std::min(wanted_, capacity_) : wanted_;
    return data_ && wanted_ > capacity_ ? VK_INCOMPLETE : VK_SUCCESS;
  }

 private:
  std::uint32_t* count_;
  T* data_;
  std::uint32_t capacity_;
  std::uint32_t wanted_ = 0;
};

}  // namespace vitrine::icd
