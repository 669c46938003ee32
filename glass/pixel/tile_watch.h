// The fragments of one draw on the watched pixels of one tile: their fates, and what they leave in attachments.
#pragma once

#include "glass/pixel/tile_pixels.h"
#include "raster/observe.h"
#include "raster/pass_desc.h"

namespace vitrine::glass::pixel {

/// A fragment on a watched pixel.
struct Fragment {
  const WatchedPixel* pixel = nullptr;
  const raster::Primitive* from = nullptr;
  std::uint32_t primitive = 0;            ///< gl_PrimitiveID
  std::optional<std::uint32_t> instance;  ///< gl_InstanceIndex, of draws with several
  std::uint32_t samples = 0;              ///< covered
  bool shaded = false, has_shader = false;
  struct Failure {
    raster::FragmentTest test{};
    std::uint32_t samples = 0;
  };
  std::vector<Failure> failures;
  struct Depth {
    std::uint32_t sample = 0;
    float value = 0;
    Value stored;
  };
  std::vector<Depth> depths;
  struct Color {
    std::uint32_t slot = 0;
    std::array<std::uint32_t, 4> components{};
  };
  std::vector<Color> colors;
  struct Write {
    const Texel* texel = nullptr;
    Value before, after;
  };
  std::vector<Write> writes;
  Address discarded;  ///< where; no frames and no SPIR-V id: it has not been
  std::vector<Source> sources;
  std::vector<std::string> lookups;                         ///< in words
  std::vector<std::pair<std::string, std::string>> inputs;  ///< of the shader, though it may not run
};

class TileWatch final : public raster::DrawWatch {
 public:
  TileWatch(Pixels& pixels, const TilePixels& tile, const spirv::ObservedCommand* command,
            const raster::TilePlace& place);
  ~TileWatch() override;

  void generated(const raster::FragmentGroup& group, raster::SampleLanes lanes) override;
  void failed(const raster::FragmentGroup& group, raster::FragmentTest test, raster::SampleLanes lost,
              raster::SampleLanes left) override;
  void testing(const raster::FragmentGroup& group, std::uint32_t sample, const float* depth) override;
  void shading(const raster::FragmentGroup& group) override;
  void shaded(const raster::FragmentGroup& group, base::LaneMask invocations, base::LaneMask helpers) override;
  void coloring(const raster::FragmentGroup& group, std::uint32_t attachment,
                const raster::ColorRegisters& color) override;
  void written(const raster::FragmentGroup& group, const texel::ImageView& view, raster::SampleLanes lanes) override;

  /// What this thread watches; null: nothing.
  static TileWatch* current();
  /// While the fragment shader runs: the fragment of a lane; null: it is not on a watched pixel.
  Fragment* fragment_of(std::size_t lane) { return running_[lane]; }
  bool runs_watched() const { return any_running_; }

 private:
  /// Calls f(fragment, lane) for the lanes of a group that are on watched pixels.
  template <class F>
  void for_each_fragment(const raster::FragmentGroup& group, base::LaneMask lanes, F&& f);  ///< of several pixels
  template <class F>
  void for_each(const raster::FragmentGroup& group, base::LaneMask lanes, F&& f);
  Fragment* find(const WatchedPixel& pixel, const raster::Primitive* from);
  const texel::ImageView* view_of(std::uint32_t slot) const;

  Pixels& pixels_;
  const TilePixels& tile_;
  const spirv::ObservedCommand* const command_;
  const raster::TilePlace place_;
  std::deque<Fragment> fragments_;  ///< in the order of primitives, on every pixel
  std::map<const WatchedPixel*, std::vector<Fragment*>> by_pixel_;
  std::array<Fragment*, base::kWaveWidth> running_{};
  bool any_running_ = false;
};

/// What a fragment means for the texels of its pixel. `depth_format`: of the pass; null: it has none.
std::vector<Pending> events_of(const Fragment& fragment, const spirv::ObservedCommand& command,
                               const texel::FormatDesc* depth_format);

}  // namespace vitrine::glass::pixel
