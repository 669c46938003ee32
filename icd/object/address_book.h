// Objects by the memory that shaders know them by: a buffer's bytes, what descriptors point to in views and samplers;
// and what became of those that are gone. A device keeps it only where tools are on; descriptors themselves hold
// addresses alone, and addresses come again: a count of all entries ever made tells an object from its successors.
#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "icd/edge/diagnostics.h"
#include "spirv/addresses.h"

namespace vitrine::icd {

class AddressBook {
 public:
  using Namer = std::function<std::string(ObjectRef)>;

  /// Where shaders find an object: `data` is the device memory that it lies in or shows (null: none), `parent` what it
  /// was made of. Without memory the object stays unknown.
  struct Place {
    const void* first = nullptr;
    std::uint64_t bytes = 0;
    const void* data = nullptr;
    ObjectRef parent;
  };
  void add(const Place& place, ObjectRef object) noexcept;
  /// The object goes, and with it what was made of it or, if it is memory, lies in it. What is remembered of them has
  /// the names that `name` gives.
  void remove(ObjectRef object, const Namer& name) noexcept;

  /// The object that has all these bytes; of several the smallest. Without a handle: there is none.
  ObjectRef find(const void* first, std::uint64_t bytes) const;

  /// The bytes of all buffers, ascending; those that touch are one.
  std::vector<spirv::AddressRange> buffers() const;

  /// All objects of a type.
  std::vector<ObjectRef> objects(VkObjectType type) const;
  /// A buffer that is gone.
  struct GoneBuffer {
    const std::byte* first = nullptr;
    std::uint64_t bytes = 0;
    std::string name;
  };
  /// Those that are remembered, the youngest first.
  std::vector<GoneBuffer> gone_buffers() const;

  /// How many entries this process has made. What is written into a descriptor is older than that.
  static std::uint64_t clock() { return clock_.load(std::memory_order_relaxed); }
  /// Whether an object has these bytes, of those that were there at `time` of the clock.
  bool is_alive(const void* first, std::uint64_t bytes, std::uint64_t time) const;
  /// What had these bytes at `time` and is gone: "buffer 'mesh', destroyed after submission 2"; empty: nothing is
  /// known.
  std::string departed(const void* first, std::uint64_t bytes, std::uint64_t time = ~std::uint64_t{0}) const;
  /// How many objects have gone.
  std::uint64_t departures() const { return departures_.load(std::memory_order_relaxed); }

  /// A submission begins: the clock of what goes.
  void begin_submission() { ++submission_; }

 private:
  struct Entry {
    Place place;
    ObjectRef object;
    std::uint64_t serial;
    bool has(std::uintptr_t begin, std::uint64_t size) const {
      const auto first = reinterpret_cast<std::uintptr_t>(place.first);
      return begin >= first && size <= place.bytes && begin - first <= place.bytes - size;
    }
  };
  struct Departed {
    Entry entry;
    std::string name;
    std::string text;
  };

  /// Whether an entry goes with `gone`, and is not `gone` itself.
  static bool depends(const Entry& entry, const Entry& gone);
  void depart(const Entry& entry, std::string name, std::string text);

  static inline std::atomic<std::uint64_t> clock_ = 0;
  std::atomic<std::uint64_t> departures_ = 0, submission_ = 0;
  mutable std::mutex mutex_;
  std::map<std::uint64_t, Entry> entries_;  ///< by handle
  std::deque<Departed> departed_;           ///< the last ones, in their order
};

/// Enters an object in the device's book, if it keeps one.
template <class T>
void enter_address(const Device& device, const AddressBook::Place& place, const T& object) {
  if (device.addresses && place.first) device.addresses->add(place, ref(object));
}
/// Before it is destroyed.
template <class T>
void leave_address(const Device& device, const T* object) {
  if (!device.addresses || !object) return;
  device.addresses->remove(ref(*object),
                           [&](ObjectRef gone) { return name_of(device.physical_device.instance, gone); });
}

}  // namespace vitrine::icd
