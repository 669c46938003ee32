// Which instances of a draw its primitives are of: a table beside them that there is only where somebody watches pixels
// of the draw.
#pragma once

#include <cstdint>
#include <mutex>
#include <optional>
#include <vector>

namespace vitrine::raster {

struct Primitive;  // raster/primitive.h

/// From a primitive of a chunk on its primitives are of an instance.
struct InstanceMark {
  std::uint32_t first = 0;     ///< number of the primitive in its chunk
  std::uint32_t instance = 0;  ///< without first_instance
};

/// Of one draw. Threads that work on its chunks add to it, those that work on its tiles look into it.
class PrimitiveInstances {
 public:
  PrimitiveInstances(std::uint32_t first_instance, bool several) : first_instance_(first_instance), several_(several) {}
  /// The primitives of a chunk, where they lie. Nothing of what lay there is looked up any more.
  void add(const Primitive* first, std::uint32_t count, const std::vector<InstanceMark>& marks);
  /// gl_InstanceIndex of an instance; nothing: the draw has no other than instance 0.
  std::optional<std::uint32_t> index_of(std::uint32_t instance) const {
    if (!several_ && first_instance_ == 0) return std::nullopt;
    return first_instance_ + instance;
  }
  /// The same of a primitive; nothing: likewise, or it is not known.
  std::optional<std::uint32_t> instance_of(const Primitive* primitive) const;

 private:
  struct ChunkMarks {
    const Primitive *first, *end;
    std::vector<InstanceMark> marks;
  };
  const std::uint32_t first_instance_;
  const bool several_;
  mutable std::mutex mutex_;
  std::vector<ChunkMarks> chunks_;  ///< by first
};

}  // namespace vitrine::raster
