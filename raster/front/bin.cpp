// Binning: which tiles a primitive may touch, as one list per tile of a chunk.
#include "raster/front/bin.h"

namespace vitrine::raster {
namespace {

constexpr int kShift = 6;  // log2(kTileSize)
static_assert(1 << kShift == kTileSize);

/// Whether an edge of the triangle has the whole tile outside: the largest value of its function over the tile
/// (samples lie within 64 pixels; pixels that a triangle touches begin half of one before, coverage.h) is not positive.
/// 3.2; the fill rule's unit only ever adds.
bool outside_an_edge(const Primitive& p, int tile_x, int tile_y) {
  const std::int64_t left = std::int64_t{tile_x} * 256, top = std::int64_t{tile_y} * 256;
  constexpr std::int64_t kSpan = std::int64_t{kTileSize} * 256, kHalf = 128;
  for (int e = 0; e < 3; ++e) {
    const int n = e == 2 ? 0 : e + 1;
    const std::int64_t a = p.y[e] - p.y[n], b = p.x[e] - p.x[n];
    const std::int64_t qx = a > 0 ? left - kHalf : left + kSpan, qy = b > 0 ? top + kSpan : top - kHalf;
    if (a * (p.x[e] - qx) - b * (p.y[e] - qy) + 1 <= 0) return true;
  }
  return false;
}

void add_pair(BinScratch& s, std::uint32_t tile, std::uint32_t primitive) {
  if (s.tile_count[tile]++ == 0) s.tiles.push_back(tile);
  s.tile_pairs.push_back(std::uint64_t{tile} << 32 | primitive);
}

void bin_primitive(const TileGrid& grid, const Primitive& p, std::uint32_t index, BinScratch& s) {
  const int x0 = p.x0 >> kShift, x1 = p.x1 >> kShift, y0 = p.y0 >> kShift, y1 = p.y1 >> kShift;
  const bool check = p.kind == PrimitiveKind::kTriangle && (x1 - x0) + (y1 - y0) >= 2;
  for (int y = y0; y <= y1; ++y) {
    for (int x = x0; x <= x1; ++x) {
      if (check && outside_an_edge(p, x * kTileSize, y * kTileSize)) continue;
      add_pair(s, grid.index(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), p.layer), index);
    }
  }
}

}  // namespace

ChunkOutput bin_chunk(PrimitiveList& primitives, const TileGrid& grid, Arena& arena, BinScratch& s) {
  s.tile_pairs.clear();
  s.tiles.clear();
  if (s.tile_count.size() < grid.count()) s.tile_count.assign(grid.count(), 0);
  primitives.end();
  for (std::uint32_t i = 0; i < primitives.size(); ++i)
    if (primitives[i].layer < grid.layers) bin_primitive(grid, primitives[i], i, s);
  if (s.tiles.empty()) return {};

  std::uint32_t* index = arena.take<std::uint32_t>(s.tile_pairs.size());
  TileRange* ranges = arena.take<TileRange>(s.tiles.size());
  std::uint32_t begin = 0;
  for (std::size_t t = 0; t < s.tiles.size(); ++t) {
    std::uint32_t& tile_count = s.tile_count[s.tiles[t]];
    ranges[t] = {s.tiles[t], tile_count, index + begin};
    const std::uint32_t next = begin;
    begin += tile_count;
    tile_count = next;  // from here on: where the tile's next index goes
  }
  for (const std::uint64_t pair : s.tile_pairs) index[s.tile_count[pair >> 32]++] = static_cast<std::uint32_t>(pair);
  for (const std::uint32_t tile : s.tiles) s.tile_count[tile] = 0;
  return {primitives.data(), ranges, static_cast<std::uint32_t>(s.tiles.size())};
}

}  // namespace vitrine::raster
