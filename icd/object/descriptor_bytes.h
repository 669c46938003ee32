// Descriptors as bytes that applications keep in buffers of their own (VK_EXT_descriptor_buffer): what
// vkGetDescriptorEXT writes, and what draws and dispatches make a set of.
//
// The bytes may come from anywhere, a shader included: buffers are addresses whose memory is looked up, views and
// samplers are names that are looked up, and what is not there is a null descriptor. All zeros are one, too.
#pragma once

#include <mutex>

#include "icd/object/descriptors.h"
#include "icd/object/image.h"

namespace vitrine::icd {

/// Bytes of a descriptor: a multiple of kDescriptorByteAlignment. 0 for types that descriptor buffers do not have, and
/// for inline uniform blocks, which lie there as they are.
std::uint32_t descriptor_bytes(VkDescriptorType type);
inline constexpr std::uint32_t kDescriptorByteAlignment = 8;

/// Objects of one type that descriptors name. Any thread.
template <class T>
class NamedObjects {
 public:
  explicit NamedObjects(const HostMemory& m) : entries_(m), free_(m) {}

  /// The object's name, given to it unless it has one: not 0, below 2^56, and not soon another's. Throws
  /// std::bad_alloc.
  std::uint64_t name_of(T& object) {
    const std::lock_guard lock(mutex_);
    if (object.described) return object.described;
    free_.reserve(entries_.size() + 1);  // forget() can not fail
    if (free_.empty()) {
      entries_.push_back({});
      free_.push_back(static_cast<std::uint32_t>(entries_.size() - 1));
    }
    const std::uint32_t place = free_.back();
    free_.pop_back();
    entries_[place].object = &object;
    return object.described = std::uint64_t{entries_[place].generation} << kPlaceBits | (place + 1);
  }

  /// The object goes.
  void forget(const T& object) noexcept {
    const std::lock_guard lock(mutex_);
    if (object.described == 0) return;
    const std::uint32_t place = place_of(object.described);
    entries_[place] = {nullptr, (entries_[place].generation + 1) & kGenerationMask};
    free_.push_back(place);
    ++forgotten_;
  }

  /// How many have gone.
  std::uint64_t forgotten() const {
    const std::lock_guard lock(mutex_);
    return forgotten_;
  }

  /// Looks up names; none comes or goes meanwhile.
  class Reader {
   public:
    explicit Reader(const NamedObjects& objects) : objects_(objects), lock_(objects.mutex_) {}
    /// Null: there is none of that name.
    const T* find(std::uint64_t name) const {
      const std::uint32_t place = place_of(name);
      return place < objects_.entries_.size() && objects_.entries_[place].generation == name >> kPlaceBits
                 ? objects_.entries_[place].object
                 : nullptr;
    }

   private:
    const NamedObjects& objects_;
    std::lock_guard<std::mutex> lock_;
  };

 private:
  static constexpr unsigned kPlaceBits = 32;
  static constexpr std::uint32_t kGenerationMask = 0xffffff;
  static std::uint32_t place_of(std::uint64_t name) { return static_cast<std::uint32_t>(name) - 1; }

  struct Entry {
    const T* object = nullptr;
    std::uint32_t generation = 0;  ///< how many had this place before
  };

  mutable std::mutex mutex_;
  Vector<Entry> entries_;
  Vector<std::uint32_t> free_;
  std::uint64_t forgotten_ = 0;
};

/// The views and samplers of a device that descriptors in buffers name.
struct DescribedObjects {
  explicit DescribedObjects(const HostMemory& m) : views(m), samplers(m) {}

  NamedObjects<ImageView> views;
  NamedObjects<Sampler> samplers;

  std::uint64_t forgotten() const { return views.forgotten() + samplers.forgotten(); }
};

/// Writes a descriptor: descriptor_bytes(info.type) of them, at most `size`. Throws std::bad_alloc.
void write_descriptor_bytes(DescribedObjects& objects, const VkDescriptorGetInfoEXT& info, std::size_t size, void* out);

/// A set that is read from bytes.
struct DescriptorBytes {
  const std::byte* first = nullptr;
  std::uint64_t size = 0;  ///< of memory from there on; what lies behind it is null
};

/// Fills slots [first, end) of `set` as its shape says; immutable samplers are the shape's. `texels`: one for each slot
/// of the set, for descriptors of texel buffers to point to; null where the shape has none.
void read_descriptor_bytes(const DescribedObjects& objects, DescriptorBytes bytes, DescriptorSet& set,
                           texel::BufferTexelView* texels, std::uint32_t first, std::uint32_t end);

/// Whether descriptors of the shape may be of texel buffers.
bool may_have_texel_buffers(const SetShape& shape);

}  // namespace vitrine::icd
