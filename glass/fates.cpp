// Counting draws: each watch counts for itself and adds what it has when it is done.
#include "glass/fates.h"

#include <algorithm>
#include <cstring>

#include "base/lane_count.h"

namespace vitrine::glass {
namespace {

using base::LaneMask;
using raster::FragmentGroup;
using raster::SampleLanes;

template <raster::PrimitiveFate fate>
std::uint64_t of(const Fates& fates) {
  return fates.primitives[static_cast<std::size_t>(fate)];
}
template <raster::FragmentTest test>
std::uint64_t ended_by(const Fates& fates) {
  return fates.ended[static_cast<std::size_t>(test)];
}

using Fate = raster::PrimitiveFate;
using Test = raster::FragmentTest;

constexpr FateCounter kCounters[] = {
    {"", "vertices", "vertices shaded", [](const Fates& f) { return f.vertices; }},
    {"primitives", "assembled", "primitives or patches of vertices", [](const Fates& f) { return f.assembled; }},
    {"primitives", "emitted", "primitives made by tessellator or geometry shader",
     [](const Fates& f) { return f.emitted; }},
    {"primitives", "culledByDistance", "outside of a cull distance", of<Fate::kCulledByDistance>},
    {"primitives", "outside", "outside of the view volume or a clip distance", of<Fate::kOutside>},
    {"primitives", "clipped", "cut by the view volume or a clip distance", of<Fate::kClipped>},
    {"primitives", "facing", "culled because of where they face", of<Fate::kFacing>},
    {"primitives", "zeroArea", "without area", of<Fate::kZeroArea>},
    {"primitives", "tooFar", "too far away, or at coordinates that are no numbers", of<Fate::kTooFar>},
    {"primitives", "scissor", "outside of scissor and framebuffer", of<Fate::kScissor>},
    {"primitives", "noSample", "that cover no sample", of<Fate::kNoSample>},
    {"primitives", "rasterized", "rasterized, parts of clipped ones one by one", of<Fate::kRasterized>},
    {"fragments", "generated", "fragments, before any test", [](const Fates& f) { return f.generated; }},
    {"fragments", "discardRectangle", "fragments that discard rectangles ended", ended_by<Test::kDiscardRectangle>},
    {"fragments", "scissor", "fragments that the scissor ended", ended_by<Test::kScissor>},
    {"fragments", "sampleMask", "fragments that the pipeline's sample mask ended", ended_by<Test::kSampleMask>},
    {"fragments", "depthBounds", "fragments that the depth bounds test ended", ended_by<Test::kDepthBounds>},
    {"fragments", "stencil", "fragments that the stencil test ended", ended_by<Test::kStencil>},
    {"fragments", "depth", "fragments that the depth test ended", ended_by<Test::kDepth>},
    {"fragments", "discard", "fragments that the shader discarded", ended_by<Test::kDiscard>},
    {"fragments", "shaderMask", "fragments that gl_SampleMask ended", ended_by<Test::kShaderMask>},
    {"fragments", "alphaToCoverage", "fragments that alpha to coverage ended", ended_by<Test::kAlphaToCoverage>},
    {"fragments", "passed", "fragments with a sample that passed all tests", [](const Fates& f) { return f.passed; }},
    {"shading", "invocations", "lanes that shaded a fragment", [](const Fates& f) { return f.invocations; }},
    {"shading", "helpers", "lanes that helped with derivatives", [](const Fates& f) { return f.helpers; }},
    {"shading", "idleLanes", "lanes of waves of fragments without work", [](const Fates& f) { return f.idle; }},
    {"attachments", "texels", "texels written to attachments", [](const Fates& f) { return f.texels; }},
    {"attachments", "bytes", "bytes written to attachments", [](const Fates& f) { return f.bytes; }},
};

std::string name_of_pipeline(std::uint64_t number, const std::string& name) {
  return name.empty() ? "pipeline " + std::to_string(number) : name;
}

/// Pixels of a tile in a row.
constexpr std::uint32_t kTileSide = 64;
/// Blocks of a tile in a row, and pixels of a block.
constexpr std::uint32_t kBlockSide = 8;
/// Passes that may go on at a time: one a device.
constexpr std::size_t kOpenPasses = 4;

std::uint64_t count(LaneMask lanes) { return base::count_lanes(lanes); }

/// Whether the quads are those of a block of the tile's grid, in its order.
bool is_block(const raster::QuadPositions& quads) {
  const std::uint32_t x = quads.x[0], y = quads.y[0];
  std::uint32_t differs = x % kBlockSide | y % kBlockSide;
  for (std::uint32_t q = 0; q < base::kQuadsPerWave; ++q)
    differs |= ((quads.x[q] - x) ^ static_cast<std::uint32_t>(raster::lane_x(4 * q))) |
               ((quads.y[q] - y) ^ static_cast<std::uint32_t>(raster::lane_y(4 * q)));
  return differs == 0;
}

/// One more fragment on pixels of a tile, those of a quad whose bits `lanes` has.
void add_quad(std::uint32_t* pixels, std::uint32_t x, std::uint32_t y, LaneMask lanes) {
  // Two neighbours at a time: no pixel has so many that they reach the other one's word.
  static constexpr std::uint64_t kPairs[4] = {0, 1, 1ull << 32, 1 | 1ull << 32};
  for (std::uint32_t row = 0; row < 2; ++row) {
    std::uint32_t* const two = pixels + std::size_t{(y + row) % kTileSide} * kTileSide + x % kTileSide;
    std::uint64_t both = 0;
    std::memcpy(&both, two, sizeof both);
    both += kPairs[lanes >> 2 * row & 3];
    std::memcpy(two, &both, sizeof both);
  }
}

LaneMask any_of(SampleLanes samples) {
  LaneMask any = 0;
  for (const LaneMask lanes : samples) any |= lanes;
  return any;
}

std::uint64_t sum_of(SampleLanes samples) {
  std::uint64_t sum = 0;
  for (const LaneMask lanes : samples) sum += count(lanes);
  return sum;
}

/// The most fragments on a pixel of a block, by pixel of the tile; adds to `covered`, unless it is all of them, how
/// many pixels have any.
std::uint32_t add_block(const std::uint32_t* pixels, std::uint32_t block, std::uint32_t& covered) {
  const std::uint32_t* const first =
      pixels + std::size_t{block / kBlockSide * kBlockSide} * kTileSide + block % kBlockSide * kBlockSide;
  std::uint32_t most = 0, any = 0;
  for (std::uint32_t y = 0; y < kBlockSide; ++y)
    for (std::uint32_t x = 0; x < kBlockSide; ++x) {
      const std::uint32_t fragments = first[y * kTileSide + x];
      most = std::max(most, fragments);
      any += fragments != 0;
    }
  if (covered == 0) covered = any;
  return most;
}

}  // namespace

void Fates::add(const Fates& other) {
  vertices += other.vertices;
  assembled += other.assembled;
  emitted += other.emitted;
  for (std::size_t i = 0; i < primitives.size(); ++i) primitives[i] += other.primitives[i];
  generated += other.generated;
  for (std::size_t i = 0; i < ended.size(); ++i) ended[i] += other.ended[i];
  passed += other.passed;
  invocations += other.invocations;
  helpers += other.helpers;
  idle += other.idle;
  texels += other.texels;
  bytes += other.bytes;
}

std::span<const FateCounter> fate_counters() { return kCounters; }

class DrawCounts::Watch : public raster::DrawWatch {
 public:
  Watch(DrawCounts& counts, const spirv::ObservedCommand* command, std::shared_ptr<TilePixels> pixels)
      : counts_(counts), command_(command), pixels_(std::move(pixels)) {}
  ~Watch() override {
    try {
      counts_.add(command_, fates_);
    } catch (const std::bad_alloc&) {
      // Not counted.
    }
  }

  void assembled(std::uint64_t vertices, std::uint64_t primitives) override {
    fates_.vertices += vertices;
    fates_.assembled += primitives;
  }
  void emitted(std::uint64_t primitives) override { fates_.emitted += primitives; }
  void primitive(std::uint32_t, std::optional<std::uint32_t>, raster::PrimitiveFate fate) override {
    ++fates_.primitives[static_cast<std::size_t>(fate)];
  }
  void generated(const FragmentGroup&, SampleLanes lanes) override { fates_.generated += count(any_of(lanes)); }
  void failed(const FragmentGroup&, raster::FragmentTest test, SampleLanes lost, SampleLanes left) override {
    fates_.ended[static_cast<std::size_t>(test)] += count(any_of(lost) & ~any_of(left));
  }
  void shaded(const FragmentGroup& group, LaneMask invocations, LaneMask helpers) override {
    fates_.invocations += count(invocations);
    fates_.helpers += count(helpers);
    fates_.idle += base::kWaveWidth - count(invocations | helpers);
    if (!pixels_) return;
    if (invocations == base::kAllLanes && is_block(group.position)) {
      ++pixels_->blocks[group.position.y[0] % kTileSide / kBlockSide * kBlockSide +
                        group.position.x[0] % kTileSide / kBlockSide];
      return;
    }
    if (pixels_->single.empty()) pixels_->single.resize(std::size_t{kTileSide} * kTileSide);
    if (group.rate != 0) return count_fragments(group, invocations);
    for (std::uint32_t q = 0; q < base::kQuadsPerWave; ++q)
      if (const LaneMask lanes = invocations >> 4 * q & 15; lanes != 0)
        add_quad(pixels_->single.data(), group.position.x[q], group.position.y[q], lanes);
  }
  bool takes_numbers() const override { return true; }
  void numbers(const raster::FragmentNumbers& numbers) override {
    fates_.generated += numbers.generated;
    for (std::size_t i = 0; i < numbers.ended.size(); ++i) fates_.ended[i] += numbers.ended[i];
    fates_.passed += numbers.passed;
    fates_.texels += numbers.texels;
    fates_.bytes += numbers.bytes;
  }
  void shaded_blocks(LaneMask places) override {
    fates_.invocations += count(places) * kBlockSide * kBlockSide;
    if (!pixels_) return;
    if (places == base::kAllLanes) {
      for (auto& fragments : pixels_->blocks) ++fragments;
      return;
    }
    for (; places != 0; places &= places - 1) {
      const auto place = static_cast<std::uint32_t>(__builtin_ctzll(places));
      ++pixels_->blocks[static_cast<std::size_t>(raster::lane_y(place)) * kBlockSide +
                        static_cast<std::size_t>(raster::lane_x(place))];
    }
  }
  void passed(const FragmentGroup&, SampleLanes lanes) override { fates_.passed += count(any_of(lanes)); }
  void written(const FragmentGroup&, const texel::ImageView& view, SampleLanes lanes) override {
    const std::uint64_t texels = sum_of(lanes);
    fates_.texels += texels;
    fates_.bytes += texels * view.format->block_bytes;
  }

 private:
  /// Fragments of several pixels count in the first one.
  void count_fragments(const FragmentGroup& group, LaneMask invocations) {
    base::for_each_lane(invocations, [&](std::size_t lane) {
      const std::uint32_t x =
          group.position.x[lane / 4] + static_cast<std::uint32_t>(lane & 1) * raster::width_of(group.rate);
      const std::uint32_t y =
          group.position.y[lane / 4] + static_cast<std::uint32_t>(lane >> 1 & 1) * raster::height_of(group.rate);
      add_quad(pixels_->single.data(), x, y, 1);
    });
  }

  DrawCounts& counts_;
  const spirv::ObservedCommand* command_;
  std::shared_ptr<TilePixels> pixels_;  ///< of the tile; null: not counted
  Fates fates_;
};

std::unique_ptr<raster::DrawWatch> DrawCounts::watch_chunk(const spirv::ObservedCommand* command) {
  return std::make_unique<Watch>(*this, command, nullptr);
}

std::unique_ptr<raster::DrawWatch> DrawCounts::watch_tile(const spirv::ObservedCommand* command, std::uint32_t tile) {
  return std::make_unique<Watch>(*this, command, command ? pixels_of(command, tile) : nullptr);
}

/// A tile of a pass belongs to one thread at a time.
std::shared_ptr<DrawCounts::TilePixels> DrawCounts::pixels_of(const spirv::ObservedCommand* command,
                                                              std::uint32_t tile) {
  const std::lock_guard lock(mutex_);
  PassPixels& pass = passes_[command->pass];
  if (const auto oldest = passes_.begin(); passes_.size() > kOpenPasses && &oldest->second != &pass) {
    add(overdraw_, oldest->second);
    for (auto& [number, pixels] : oldest->second)
      if (pixels.use_count() == 1) spare_.push_back(std::move(pixels));
    passes_.erase(oldest);
  }
  std::shared_ptr<TilePixels>& pixels = pass[tile];
  if (!pixels && !spare_.empty()) {
    pixels = std::move(spare_.back());
    spare_.pop_back();
    pixels->blocks.fill(0);
    pixels->single.clear();
  }
  if (!pixels) pixels = std::make_shared<TilePixels>();
  return pixels;
}

void DrawCounts::add(const spirv::ObservedCommand* command, const Fates& fates) {
  const std::lock_guard lock(mutex_);
  total_.add(fates);
  if (!command) return;
  pipelines_[command->pipeline_number][command->pipeline].add(fates);
  if (!by_draw_) return;
  Draw& draw = draws_[{command->submission, command->command}];
  if (draw.command == 0)
    draw = {command->submission,
            command->command,
            command->name,
            name_of_pipeline(command->pipeline_number, command->pipeline),
            {}};
  draw.fates.add(fates);
}

void DrawCounts::add(Overdraw& overdraw, const PassPixels& pass) {
  for (const auto& [tile, pixels] : pass) {
    const bool whole = pixels->single.empty();
    for (std::uint32_t b = 0; b < pixels->blocks.size(); ++b) {
      const std::uint32_t fragments = pixels->blocks[b];
      std::uint32_t most = fragments, covered = fragments != 0 ? kBlockSide * kBlockSide : 0;
      if (!whole) most += add_block(pixels->single.data(), b, covered);
      overdraw.pixels += covered;
      overdraw.most = std::max<std::uint64_t>(overdraw.most, most);
    }
  }
}

Fates DrawCounts::total() const {
  const std::lock_guard lock(mutex_);
  return total_;
}

std::map<std::string, Fates> DrawCounts::of_pipelines() const {
  const std::lock_guard lock(mutex_);
  std::map<std::string, Fates> pipelines;
  for (const auto& [number, names] : pipelines_)
    for (const auto& [name, fates] : names) pipelines[name_of_pipeline(number, name)].add(fates);
  return pipelines;
}

std::vector<DrawCounts::Draw> DrawCounts::of_draws() const {
  const std::lock_guard lock(mutex_);
  std::vector<Draw> draws;
  for (const auto& [place, draw] : draws_) draws.push_back(draw);
  return draws;
}

Overdraw DrawCounts::overdraw() const {
  const std::lock_guard lock(mutex_);
  Overdraw overdraw = overdraw_;
  for (const auto& [number, pass] : passes_) add(overdraw, pass);
  return overdraw;
}

}  // namespace vitrine::glass
