// The primitives of a chunk as setup appends them.
#pragma once

#include <algorithm>
#include <cstdint>
#include <new>
#include <vector>

#include "raster/arena.h"
#include "raster/primitive.h"
#include "raster/primitive_instances.h"

namespace vitrine::raster {

/// Primitives of one chunk, in order, where the back end will read them.
class PrimitiveList {
 public:
  /// Empty, in `arena`. `marks`: whether it is written down which instances its primitives are of.
  void begin(Arena& arena, bool marks = false) {
    arena_ = &arena;
    has_marks_ = marks;
    marks_.clear();
    first_ = nullptr;
    size_ = room_ = 0;
  }
  /// Room for `more` primitives.
  void reserve(std::uint32_t more) {
    if (room_ - size_ < more) grow(size_ + more);
  }
  /// A primitive to be filled in; later ones may move it.
  Primitive& append() {
    if (size_ == room_) grow(std::max<std::uint32_t>(64, 2 * size_));
    return *new (first_ + size_++) Primitive(Primitive::Unset());
  }
  /// Gives room that is left back to the arena, if nothing was taken from it since. Nothing is appended any more.
  void end() {
    if (room_ != 0 && arena_->used() == used_) arena_->trim(first_, size_);
  }
  bool has_marks() const { return has_marks_; }
  /// What is appended from here on is of an instance.
  void mark(std::uint32_t instance) {
    if (!has_marks_ || (!marks_.empty() && marks_.back().instance == instance)) return;
    if (!marks_.empty() && marks_.back().first == size_) marks_.pop_back();
    marks_.push_back({size_, instance});
  }
  const std::vector<InstanceMark>& marks() const { return marks_; }
  std::uint32_t size() const { return size_; }
  const Primitive* data() const { return first_; }
  const Primitive& operator[](std::uint32_t i) const { return first_[i]; }
  Primitive& operator[](std::uint32_t i) { return first_[i]; }

 private:
  void grow(std::uint32_t room) {
    Primitive* grown = arena_->take<Primitive>(room);
    used_ = arena_->used();
    std::copy_n(first_, size_, grown);
    first_ = grown;
    room_ = room;
  }

  Arena* arena_ = nullptr;
  Primitive* first_ = nullptr;
  std::uint32_t size_ = 0, room_ = 0;
  std::size_t used_ = 0;  ///< of the arena, with the room
  bool has_marks_ = false;
  std::vector<InstanceMark> marks_;
};

}  // namespace vitrine::raster
