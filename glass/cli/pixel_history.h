// Histories of texels as the tool `pixel` writes them (docs/glass/pixel.md), and which parts of them explain a pixel.
#pragma once

#include <compare>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "glass/finding.h"
#include "glass/pixel/request.h"

namespace vitrine::glass::cli {

struct TexelKey {
  std::uint64_t image = 0;
  std::string aspect;
  std::uint32_t level = 0, layer = 0, slice = 0, sample = 0, x = 0, y = 0;
  auto operator<=>(const TexelKey&) const = default;
};

struct PixelSource {
  TexelKey texel;
  std::string value;
  double weight = 0;                             ///< 0: not known
  std::pair<std::uint64_t, std::uint32_t> read;  ///< submission and command that read it, if not the event's: 0, 0
};

struct PixelEvent {
  std::string kind, text, fate, before, after;
  std::uint64_t frame = 0;
  bool replaces = false;  ///< what was there before no longer matters
  Address address;
  std::vector<std::pair<std::string, std::string>> facts;
  std::vector<PixelSource> sources;

  std::pair<std::uint64_t, std::uint32_t> place() const { return {address.submission, address.command}; }
};

struct PixelTexel {
  TexelKey key;
  std::string format, value;
  std::uint64_t dropped = 0;  ///< older events
  std::vector<PixelEvent> events;
};

struct PixelImage {
  std::uint64_t number = 0;
  std::string name, format;
  bool swapchain = false;
  std::vector<std::uint32_t> extent;
  std::uint32_t levels = 1, layers = 1, samples = 1;
};

/// What became of primitives of a draw that have the number that was asked for.
struct PixelPrimitive {
  Address address;
  std::string fate;
  std::uint64_t count = 0;
  std::vector<std::uint32_t> instances;  ///< ascending; none: the draw has instance 0 alone
  bool more = false;                     ///< instances
};

struct PixelHistory {
  std::uint64_t frames = 0;  ///< presented
  std::vector<PixelImage> images;
  std::vector<PixelTexel> texels;
  std::vector<PixelPrimitive> primitives;

  const PixelTexel* find(const TexelKey& key) const;
  const PixelImage* image(std::uint64_t number) const;
};

/// Nothing: it is none, or one of another version.
std::optional<PixelHistory> read_history(std::string_view json);

/// A texel and those of its events that say why it is what it is.
struct PixelChapter {
  TexelKey key;
  std::string label;                  ///< "" for the pixel that was asked for, then "a", "b"...
  const PixelTexel* texel = nullptr;  ///< null: nobody has watched it
  std::vector<const PixelEvent*> events;
  std::string expected;       ///< what who read it found; empty: not known
  bool differs = false;       ///< the history ends with something else
  std::string like;           ///< label of an earlier chapter that says the same of another texel; or empty
  std::string value() const;  ///< at the end of the events
};

/// The pixel, the texels it came from, those they came from...
struct PixelStory {
  std::vector<PixelChapter> chapters;
  std::vector<TexelKey> missing;  ///< sources that nobody has watched yet
  bool cut = false;               ///< more sources than the story follows

  /// The label of the chapter that tells of a source of an event; empty: there is none.
  std::string label_of(const PixelEvent& event, const TexelKey& source) const;
  std::vector<std::pair<const PixelEvent*, std::pair<TexelKey, std::string>>> labels;
};

/// The draw or dispatch that made what the pixel of a story holds, through copies, blits and resolves backwards; null:
/// none is known.
const PixelEvent* maker_of(const PixelStory& story);

/// What was asked for: of a texel as it was presented in a frame, or at its end. `frame`: 0: the last one.
struct PixelQuestion {
  std::string image;
  std::string aspect;
  std::uint32_t x = 0, y = 0, level = 0, layer = 0, slice = 0;
  std::optional<std::uint32_t> sample;
  std::uint64_t frame = 0;
  unsigned depth = 4;
};
PixelStory tell(const PixelHistory& history, const PixelQuestion& question);

/// "texel (3, 4), level 2, of image #5 'albedo'".
std::string to_text(const PixelHistory& history, const TexelKey& key);

/// The story for people.
std::string to_text(const PixelHistory& history, const PixelStory& story);
/// Why a primitive did not reach the pixel that the story is about.
std::string why_not(const PixelHistory& history, const PixelStory& story,
                    const glass::pixel::PrimitiveRequest& primitive);
/// The story as a page of its own.
std::string to_html(const PixelHistory& history, const PixelStory& story);

}  // namespace vitrine::glass::cli
