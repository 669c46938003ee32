// See primitive_instances.h.
#include "raster/primitive_instances.h"

#include <algorithm>
#include <functional>
#include <iterator>

#include "raster/primitive.h"

namespace vitrine::raster {
namespace {

constexpr std::less<const Primitive*> kBefore;

}  // namespace

void PrimitiveInstances::add(const Primitive* first, std::uint32_t count, const std::vector<InstanceMark>& marks) {
  if (count == 0) return;
  const Primitive* const end = first + count;
  const std::lock_guard lock(mutex_);
  std::erase_if(chunks_,
                [&](const ChunkMarks& chunk) { return kBefore(chunk.first, end) && kBefore(first, chunk.end); });
  const auto at = std::ranges::upper_bound(chunks_, first, kBefore, &ChunkMarks::first);
  chunks_.insert(at, {first, end, marks});
}

std::optional<std::uint32_t> PrimitiveInstances::instance_of(const Primitive* primitive) const {
  if (!several_ && first_instance_ == 0) return std::nullopt;
  const std::lock_guard lock(mutex_);
  const auto behind = std::ranges::upper_bound(chunks_, primitive, kBefore, &ChunkMarks::first);
  if (behind == chunks_.begin() || !kBefore(primitive, std::prev(behind)->end)) return std::nullopt;
  const ChunkMarks& chunk = *std::prev(behind);
  const auto number = static_cast<std::uint32_t>(primitive - chunk.first);
  const auto mark = std::ranges::upper_bound(chunk.marks, number, std::less<>(), &InstanceMark::first);
  if (mark == chunk.marks.begin()) return std::nullopt;
  return index_of(std::prev(mark)->instance);
}

}  // namespace vitrine::raster
