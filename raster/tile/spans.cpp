// Triangles in windows of 16x16 pixels: from coverage by rows to waves of quads that lie side by side.
#include "raster/tile/spans.h"

#include <algorithm>
#include <bit>

#include "raster/tile/block_shade.h"
#include "raster/tile/early_tests.h"
#include "raster/tile/fragment.h"
#include "raster/tile/fragment_outputs.h"
#include "raster/tile/pack.h"

namespace vitrine::raster {
namespace {

using base::LaneMask;

/// Quads of what is left for a last wave from which on it is shaded on its own: fewer would waste more lanes than
/// packing costs.
constexpr std::uint32_t kNearlyFull = 12, kNearlyFullIfShort = 3;

/// A window's place in its tile: it starts at an even pixel at or before the primitive's first one.
int window_start(int first) { return std::min(first & ~1, kTileSize - kLargeWindow); }

bool fits_window(const TileWorker& worker, const Primitive& p, const TileEdges& edges, const PixelRect& rect) {
  const PipelinePlan& plan = *worker.draw->plan;
  if (!plan.windows || !is_area(p.kind) || edges.count > 3) return false;
  if (plan.shades && (!plan.shades_blocks || plan.depth_order == TestOrder::kLate)) return false;
  if (!plan.tests_rows && plan.depth_order == TestOrder::kEarly) return false;
  const int x = window_start(rect.x0), y = window_start(rect.y0);
  const TileTarget& target = worker.target;
  return rect.x1 - x < kLargeWindow && rect.y1 - y < kLargeWindow && target.x + x + kLargeWindow <= target.right &&
         target.y + y + kLargeWindow <= target.bottom;
}

/// `count`: less than 32.
constexpr std::uint32_t first_bits(std::uint32_t count) { return (1u << count) - 1; }

/// Whether quads of `wave` wait in the packed wave.
bool waits_in_wave(const TileWorker& worker, const SpanWave& wave) {
  if (worker.wave.quads == 0) return false;
  const auto x = static_cast<std::uint32_t>(wave.x - worker.target.x);
  const auto y = static_cast<std::uint32_t>(wave.y - worker.target.y);
  std::uint32_t waiting = 0;
  for (const QuadSpan* span = wave.span; span != wave.span + wave.count; ++span)
    waiting |= worker.packed.from(x + span->x, y + span->y) & first_bits(span->count);
  return waiting != 0;
}

void shade(TileWorker& worker, const Primitive& primitive, SpanWave& wave) {
  // Quads on the same pixels come first.
  if (waits_in_wave(worker, wave)) shade_wave(worker, worker.wave);
  shade_spans(worker, primitive, wave);
}

/// Moves quads to the packed wave.
void pack(TileWorker& worker, const Primitive& primitive, const SpanWave& wave) {
  const LaneMask lanes = lanes_of_spans(wave.rows);
  for (const QuadSpan* span = wave.span; span != wave.span + wave.count; ++span) {
    // Parts of a row of quads as blocks have them.
    constexpr std::uint32_t kPart = kBlockSize / 2;
    for (std::uint32_t q = 0; q < span->count; q += kPart) {
      const std::size_t part = std::size_t{4} * std::min(kPart, span->count - q);
      const BlockCoverage block{{lanes >> 4 * (span->first + q) & base::first_lanes(part)}};
      append_quads(worker, primitive, wave.x + span->x + static_cast<int>(2 * q), wave.y + span->y, block, block,
                   base::quads_of_lanes(block.lanes[0]));
    }
  }
}

/// A wave in the making: what changes with every span is kept apart from the spans.
struct SpanList {
  std::uint32_t quads = 0, count = 0, upper = 0, lower = 0;
  std::uint64_t quad_x = 0, quad_y = 0;

  /// Appends `add` quads from column `first` on of two rows of a window, the upper one in the lower bits.
  void append(SpanWave& wave, std::uint32_t two, std::uint32_t row, std::uint32_t first, std::uint32_t add) {
    constexpr std::uint64_t kOnes = 0x1111111111111111, kQuads = 0xfedcba9876543210;
    const std::uint32_t columns = first_bits(2 * add);
    const std::uint64_t places = (std::uint64_t{1} << 4 * add) - 1;
    upper |= (two >> first & columns) << 2 * quads;
    lower |= (two >> (16 + first) & columns) << 2 * quads;
    quad_x |= ((kQuads + kOnes * (first / 2)) & places) << 4 * quads;
    quad_y |= (kOnes * (row / 2) & places) << 4 * quads;
    wave.span[count++] = {static_cast<std::uint8_t>(first), static_cast<std::uint8_t>(row),
                          static_cast<std::uint8_t>(quads), static_cast<std::uint8_t>(add)};
    quads += add;
  }
  void finish(SpanWave& wave) const {
    wave.quads = quads;
    wave.count = count;
    wave.rows = std::uint64_t{lower} << 32 | upper;
    wave.quad_x = quad_x;
    wave.quad_y = quad_y;
  }
};

/// The quads of the window at (x, y), sixteen to a wave.
void shade_window(TileWorker& worker, const Primitive& primitive, int x, int y, const LargeWindow& window) {
  SpanWave wave(x, y);
  SpanList list;
  for (std::uint32_t row = 0; row < kLargeWindow; row += 2) {
    const auto two = static_cast<std::uint32_t>(window.rows[row / 4] >> 16 * (row % 4));
    const std::uint32_t any = (two | two >> 16) & 0xffff;
    if (any == 0) continue;
    auto first = static_cast<std::uint32_t>(std::countr_zero(any)) & ~1u;
    auto left = (static_cast<std::uint32_t>(std::bit_width(any)) - first + 1) / 2;
    const std::uint32_t room = base::kQuadsPerWave - list.quads;
    if (left >= room) {
      list.append(wave, two, row, first, room);
      list.finish(wave);
      shade(worker, primitive, wave);
      list = {};
      left -= room;
      first += 2 * room;
      if (left == 0) continue;
    }
    list.append(wave, two, row, first, left);
  }
  if (list.quads == 0) return;
  list.finish(wave);
  if (wave.quads >= (worker.block_draw.is_short ? kNearlyFullIfShort : kNearlyFull))
    shade(worker, primitive, wave);
  else
    pack(worker, primitive, wave);
}

}  // namespace

bool emit_large_window(TileWorker& worker, const Primitive& primitive, TileEdges& edges, const PixelRect& rect) {
  if (!fits_window(worker, primitive, edges, rect)) return false;
  const PipelinePlan& plan = *worker.draw->plan;
  const int x = window_start(rect.x0), y = window_start(rect.y0);
  for (std::uint32_t e = 0; e < edges.count; ++e) edges.f[0][e] += x * edges.step_x[e] + y * edges.step_y[e];
  for (std::uint32_t e = edges.count; e < 3; ++e) edges.f[0][e] = edges.step_x[e] = edges.step_y[e] = 0;
  LargeWindow window;
  if (!cover_large_window(edges, {rect.x0 - x, rect.y0 - y, rect.x1 - x, rect.y1 - y}, window)) return true;
  const int left = worker.target.x + x, top = worker.target.y + y;
  if (plan.depth_order == TestOrder::kEarly && !test_large_window(worker, primitive, left, top, window)) {
    if (plan.hides_blocks) learn_hidden_rect(worker, primitive, rect);
    return true;
  }
  if (plan.shades) {
    shade_window(worker, primitive, left, top, window);
  } else {
    for (const std::uint64_t rows : window.rows) count_samples(worker, rows);
  }
  return true;
}

}  // namespace vitrine::raster
