// The primitives of a chunk as setup appends them.
#pragma once

#include <algorithm>
#include <cstdint>
#include <new>

#include "raster/arena.h"
#include "raster/primitive.h"

namespace vitrine::raster {

/// Primitives of one chunk, in order, where the back end will read them.
class PrimitiveList {
 public:
  /// Empty, in `arena`.
  void begin(Arena& arena) {
    arena_ = &arena;
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
};

}  // namespace vitrine::raster
