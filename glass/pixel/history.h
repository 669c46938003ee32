// What happened to a texel: events in the order in which commands took effect.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <string>
#include <utility>
#include <vector>

#include "glass/finding.h"
#include "texel/view.h"

namespace vitrine::glass::pixel {

/// What a texel (or block) holds.
struct Value {
  std::array<std::byte, 16> bytes{};
  std::uint8_t size = 0;  ///< 0: not known
  bool operator==(const Value&) const = default;
};

/// A texel of an image, in numbers that are the same whenever the application does the same.
struct TexelId {
  std::uint64_t image = 0;  ///< number of the image, counted from 1; 0: unknown
  VkImageAspectFlags aspect = VK_IMAGE_ASPECT_COLOR_BIT;
  std::uint32_t level = 0, layer = 0, slice = 0, sample = 0, x = 0, y = 0;
  auto operator<=>(const TexelId&) const = default;
};

/// A texel that an event took its value from.
struct Source {
  TexelId texel;
  const texel::FormatDesc* format = nullptr;
  Value value;                   ///< then
  float weight = 1;              ///< 0: not known
  std::uint64_t submission = 0;  ///< in which it was read, if not by the event's command: 0
  std::uint32_t command = 0;
};

enum class EventKind : std::uint8_t {
  kClear,      ///< vkCmdClear*, load op CLEAR
  kLoad,       ///< load op LOAD
  kUndefined,  ///< contents given up: DONT_CARE, VK_IMAGE_LAYOUT_UNDEFINED
  kFragment,
  kShaderStore,
  kShaderAtomic,
  kCopy,
  kBlit,
  kResolve,
  kUpload,  ///< from a buffer
  kPresent,
  kUnknown,  ///< the value is another one, and nobody has told who changed it
};

struct Event {
  EventKind kind = EventKind::kUnknown;
  Address address;
  std::uint64_t frame = 0;  ///< presents before it, plus 1
  std::string text;         ///< what it is, in words
  std::string fate;         ///< of fragments: "written", "depth test"...
  bool replaces = false;    ///< whatever the texel held before no longer matters
  Value before, after;
  std::vector<std::pair<std::string, std::string>> facts;  ///< "output": "(1, 0, 0, 1)"
  std::vector<Source> sources;
};

struct Image;

/// A texel that is watched, and its history. Only the thread that works on its tile, or that replays, touches it.
struct Texel {
  TexelId id;
  const texel::FormatDesc* format = nullptr;  ///< of the plane
  Image* image = nullptr;                     ///< null: it is gone
  const std::byte* address = nullptr;         ///< null: the image has no memory (yet)
  Value value;                                ///< what the last event left
  std::deque<Event> events;
  std::uint64_t dropped = 0;  ///< older events, of which there were too many

  /// What it holds.
  Value read() const;
};

/// A number of 32 bits.
std::string component_text(std::uint32_t bits, texel::Kind kind);
/// As words: components for plain formats, bytes for others.
std::string to_text(const Value& value, const texel::FormatDesc& format);
/// The same of registers of a shader, of the kind that the format has.
std::string to_text(const std::array<std::uint32_t, 4>& components, std::size_t count, texel::Kind kind);
/// The only component of a texel of 64 bits.
std::string wide_text(std::uint64_t number, texel::Kind kind);
/// Components in R, G, B, A that a format has.
std::size_t components_of(const texel::FormatDesc& format);

}  // namespace vitrine::glass::pixel
