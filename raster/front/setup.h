// Primitive setup (Vulkan 1.3.239, Rasterization): window-space vertices to Primitive records: facing and culling,
// depth bias, snapped corners, pixel bounds. lavapipe-rasterization.md 2, 3.1, 3.3, 5.1, 6, 7.
#pragma once

#include <algorithm>
#include <cstdint>
#include <new>

#include "raster/arena.h"
#include "raster/primitive.h"

namespace vitrine::raster {

/// A vertex on its way into setup: its record, and its snapped position for triangles.
struct SetupVertex {
  const Vertex* record;
  std::int32_t x, y;
};

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

/// What setup needs besides vertices: constant over a chunk but for the members with defaults.
struct SetupContext {
  const PipelinePlan* plan;
  const PassDesc* pass;
  PrimitiveList* out;
  bool drops_empty = false;  ///< triangles that cover nothing are not counted by a query
  std::uint32_t id = 0;
  std::uint16_t layer = 0;
  std::uint8_t viewport = 0;
  bool of_line = false;  ///< the triangle is half of a smooth line: never culled or biased, faces as `line_front` says
  bool line_front = true;
};

/// Snapped coordinate of triangles: nearest even (3.1).
std::int32_t snap_coordinate(float window, float pixel_offset);

/// Twice the signed area of window positions as the float cull computes it (2.2); negative is counter-clockwise.
float window_determinant(const Vertex* v0, const Vertex* v1, const Vertex* v2);

/// 2.2: culling by the float determinant.
bool culled_by_determinant(const State& state, float determinant);

/// Filled triangle in API order (provoking vertex first or last as the state says).
void setup_triangle(const SetupContext& context, const SetupVertex& v0, const SetupVertex& v1, const SetupVertex& v2);

/// Filled triangles of one chunk waiting to be set up together.
struct TriangleBatch {
  static constexpr std::uint32_t kSize = 16;
  std::uint32_t count = 0;
  alignas(64) std::int32_t x[3][kSize], y[3][kSize];  ///< snapped, by corner
  const Vertex* record[3][kSize];
  std::uint32_t id[kSize];
};

/// setup_triangle() of all of them in their order, those of a few pixels a vector at a time; empties the batch. Only
/// for plans with windows. context.id is not looked at.
void setup_triangles(SetupContext context, TriangleBatch& batch);

/// What is known of a triangle before it becomes a primitive.
struct TriangleFacts {
  bool front;
  PixelRect visible;
  base::LaneMask window;  ///< Primitive::window
};
/// Fills in everything but the corners.
void complete_triangle(const SetupContext& context, const TriangleFacts& facts, Primitive& p);

void setup_line(const SetupContext& context, const Vertex* v1, const Vertex* v2, bool front);
/// 6.5: two triangles around the line, with records in `arena`. Flat values of both ends are the same.
void setup_smooth_line(SetupContext context, Arena& arena, const Vertex* v0, const Vertex* v1, bool front);
void setup_point(const SetupContext& context, const Vertex* v, bool front);

/// 5.1, second form: depth of the three corners biased in place (polygon modes LINE and POINT).
float vertex_depth_bias(const PipelinePlan& plan, const PassDesc& pass, const Vertex* v0, const Vertex* v1,
                        const Vertex* v2);

}  // namespace vitrine::raster
