// What fixed function did, in numbers: vertices, primitives and fragments by what became of them, lanes, texels.
#pragma once

#include <array>
#include <map>
#include <mutex>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "raster/observe.h"
#include "spirv/observed_command.h"

namespace vitrine::glass {

/// Of a draw, of several, or of a part of one.
struct Fates {
  std::uint64_t vertices = 0;   ///< shaded
  std::uint64_t assembled = 0;  ///< primitives or patches
  std::uint64_t emitted = 0;    ///< primitives that tessellator or geometry shader made
  std::array<std::uint64_t, raster::kPrimitiveFates> primitives{};
  std::uint64_t generated = 0;                                ///< fragments
  std::array<std::uint64_t, raster::kFragmentTests> ended{};  ///< fragments, by the test that took their last sample
  std::uint64_t passed = 0;                                   ///< fragments with a sample that passed all tests
  std::uint64_t invocations = 0, helpers = 0, idle = 0;  ///< lanes of waves of fragments: shaded, helping, without work
  std::uint64_t texels = 0, bytes = 0;                   ///< written to attachments

  void add(const Fates& other);
  bool any() const { return assembled != 0 || generated != 0; }
};

/// A number of Fates, for people and files.
struct FateCounter {
  const char* group;  ///< "primitives"; may be empty
  const char* name;
  const char* description;
  std::uint64_t (*value)(const Fates& fates);
};
std::span<const FateCounter> fate_counters();

/// Pixels of the passes that fragments were shaded on.
struct Overdraw {
  std::uint64_t pixels = 0;  ///< with a fragment; of every pass
  std::uint64_t most = 0;    ///< fragments on one pixel in one pass
};

/// Counts draws.
class DrawCounts : public raster::DrawObserver {
 public:
  /// `by_draw`: of_draws() is wanted.
  explicit DrawCounts(bool by_draw) : by_draw_(by_draw) {}

  std::unique_ptr<raster::DrawWatch> watch_chunk(const spirv::ObservedCommand* command) override;
  std::unique_ptr<raster::DrawWatch> watch_tile(const spirv::ObservedCommand* command, std::uint32_t tile) override;

  /// A draw of a submission.
  struct Draw {
    std::uint64_t submission = 0;
    std::uint32_t command = 0;
    std::string name, pipeline;
    Fates fates;
  };
  Fates total() const;                                ///< draws that nobody has named, too
  std::map<std::string, Fates> of_pipelines() const;  ///< by name
  std::vector<Draw> of_draws() const;                 ///< in order
  Overdraw overdraw() const;

 private:
  class Watch;
  /// Fragments shaded on the pixels of a tile: in whole blocks by block, the others by pixel.
  struct TilePixels {
    std::array<std::uint32_t, 64> blocks{};
    std::vector<std::uint32_t> single;  ///< empty until there are any
  };
  using PassPixels = std::map<std::uint32_t, std::shared_ptr<TilePixels>>;

  void add(const spirv::ObservedCommand* command, const Fates& fates);
  std::shared_ptr<TilePixels> pixels_of(const spirv::ObservedCommand* command, std::uint32_t tile);
  static void add(Overdraw& overdraw, const PassPixels& pass);

  const bool by_draw_;
  mutable std::mutex mutex_;
  Fates total_;
  std::map<std::uint64_t, std::map<std::string, Fates>> pipelines_;  ///< by number and name
  std::map<std::pair<std::uint64_t, std::uint32_t>, Draw> draws_;
  std::map<std::uint64_t, PassPixels> passes_;      ///< those that may go on
  std::vector<std::shared_ptr<TilePixels>> spare_;  ///< memory of those that are done
  Overdraw overdraw_;                               ///< of those
};

}  // namespace vitrine::glass
