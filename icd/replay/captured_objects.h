// The objects that one captured command names, by number, with what their memory holds before it and behind it
// (glass/bug/bug.h).
#pragma once

#include <map>
#include <set>
#include <vector>

#include "glass/bug/bug.h"
#include "icd/object/image.h"
#include "icd/object/memory.h"
#include "icd/replay/replay.h"

namespace vitrine::icd {

/// Snapshots that stay the same from one command to the next are kept once: by where they were taken.
using Snapshots = std::map<const std::byte*, glass::bug::Blob>;

class CapturedObjects {
 public:
  CapturedObjects(const Device& device, bool keeps_shadow, glass::bug::Bug& bug)
      : device_(device), keeps_shadow_(keeps_shadow), bug_(bug) {}

  /// A place in a buffer: its number and the offset.
  struct Place {
    std::uint32_t buffer = glass::bug::kNone;
    std::uint64_t offset = 0;
  };
  /// Bytes that the command may touch; no buffer: they belong to none that lives.
  Place bytes(const std::byte* first, std::uint64_t size);
  /// The same of a buffer that is known.
  std::uint32_t buffer(const Buffer& buffer, std::uint64_t offset, std::uint64_t size);
  std::uint32_t view(const ImageView& view);
  /// What descriptors point to.
  std::uint32_t view(const texel::ImageView& view);
  std::uint32_t texels(const texel::BufferTexelView& view);
  std::uint32_t sampler(const texel::Sampler& sampler);
  /// All buffers that have device addresses, and those that had: the shader follows some that nobody foresees.
  void add_addressed();

  /// All objects are known: takes what their memory holds.
  void take_before(Snapshots& snapshots);
  /// The command is done: takes what differs.
  void take_after();

  const Device& device() const { return device_; }
  /// Why the command cannot be captured; empty: it can.
  const std::string& problem() const { return problem_; }

 private:
  /// Bytes of a piece of the Bug.
  struct Range {
    std::byte* first = nullptr;
    std::uint64_t size = 0;
    std::uint32_t memory = 0;
    std::size_t piece = 0;
  };
  /// Layers of the levels of an image that views show.
  using Layers = std::map<std::uint32_t, std::pair<std::uint32_t, std::uint32_t>>;

  /// Where a buffer of the Bug lies.
  struct Placed {
    std::byte* data = nullptr;
    std::uint64_t size = 0;
  };

  std::uint32_t add_buffer(const Buffer& buffer);
  void add_gone(const std::byte* first, std::uint64_t bytes, const std::string& name);
  std::uint32_t add_image(const Image& image);
  void place_buffers();
  void take_range(const Range& range, Snapshots& snapshots);
  void add_piece(const Range& range, std::uint64_t begin, std::uint64_t end, bool unwritten, Snapshots& snapshots);
  void take_written(const Image& image, glass::bug::Texels& texels) const;
  void take_image(std::uint32_t number, Snapshots& snapshots);
  glass::bug::Bytes packed(const Image& image, const glass::bug::Texels& texels) const;

  const Device& device_;
  const bool keeps_shadow_;
  glass::bug::Bug& bug_;
  std::string problem_;
  std::vector<Placed> buffers_;
  std::vector<const Image*> images_;
  std::vector<Layers> shown_;                     ///< by image
  std::map<const void*, std::uint32_t> numbers_;  ///< of views, buffer views and samplers, by where they are
  std::map<std::byte*, std::byte*> touched_;      ///< first byte and end, apart from each other
  std::vector<Range> pieces_;
};

}  // namespace vitrine::icd
