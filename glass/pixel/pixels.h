// The texels that this process watches: which images they are in, where they lie, what has happened to them. icd tells
// of images and commands, observers of fragments and shaders. Exists where the tool `pixel` is on.
#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "glass/pixel/locate.h"
#include "glass/pixel/request.h"
#include "glass/pixel/staged.h"
#include "spirv/observed_command.h"

namespace vitrine::glass::pixel {

struct Image {
  std::uint64_t number = 0;  ///< in the order of creation, counted from 1
  std::string name;          ///< that the application gave; empty: none
  bool in_swapchain = false;
  ImagePlace place;
  std::vector<Texel*> texels;  ///< those that are watched
  std::set<TexelId> watched;
};

/// What is known of an image when it is gone, too.
struct ImageNote {
  std::string name;
  bool in_swapchain = false;
  texel::ImageDesc desc;
};

/// A fragment or a store of a shader: what is to be told of it when its command is done.
struct Pending {
  const void* owner = nullptr;  ///< ObservedCommand::owner
  Texel* texel = nullptr;
  std::array<std::uint32_t, 4> order{};  ///< within the command
  bool stored = false;                   ///< by a shader: what it left is known only when the command is done
  Event event;
};

/// What has become of a primitive of a draw, and of how many that have its number.
struct PrimitiveNote {
  Address address;
  std::uint64_t count = 0;
  std::set<std::uint32_t> instances;  ///< the first ones; of a draw with instance 0 alone none
  bool more = false;                  ///< instances
};

/// When to stop, and the primitives whose fate is wanted. 0: never.
struct PixelLimits {
  std::uint64_t last_frame = 0, last_submission = 0;
  std::optional<PrimitiveRequest> primitive;
};

class Pixels {
 public:
  Pixels(std::vector<Request> requests, const PixelLimits& limits) : requests_(std::move(requests)), limits_(limits) {}

  // Objects: any thread.
  void image_made(const void* key, const ImagePlace& place, bool in_swapchain);
  void image_named(const void* key, std::string_view name);
  void image_gone(const void* key);

  // Commands: the thread that replays, on one device.
  void submission_begins(std::uint64_t submission);
  void submission_ends();
  /// An image is shown, as it is now.
  void presented(const void* key);
  /// The texels of an image that are watched; none: nobody cares. Their addresses are there.
  std::vector<Texel*> texels_of(const void* key);
  /// All that are watched and have memory.
  std::vector<Texel*> texels();
  /// Something has happened to a texel: its value is read.
  void add(Texel& texel, Event event);
  /// The same of what leaves the value as it was.
  void add_unchanged(Texel& texel, Event event);
  /// What shaders and fragments did, sorted in when their commands are done.
  void add(std::vector<Pending> pending);
  void commands_done(const void* owner);

  /// The primitives of each draw whose fate is wanted; nothing: none. `fate`: a raster::PrimitiveFate.
  const std::optional<PrimitiveRequest>& primitive() const { return limits_.primitive; }
  void add_primitive(const spirv::ObservedCommand& command, std::optional<std::uint32_t> instance, std::size_t fate);

  /// The texel at an address; null: it is not watched. Any thread.
  Texel* find(const std::byte* address) const;
  /// Any texel of any image that has memory; image 0: none lies there.
  TexelId locate(const std::byte* address) const;
  /// A texel as a source, with what it holds now.
  Source source_at(const std::byte* address, const texel::FormatDesc& format, float weight = 1) const;

  /// Of the thread that replays, on one device.
  Staged& staged() { return staged_; }

  /// Nothing is recorded any more: the frame or submission that was asked for is done.
  bool stopped() const { return stopped_.load(std::memory_order_relaxed); }

  std::string to_json() const;

 private:
  void match(Image& image);
  void watch(Image& image, const Request& request);
  void place(Texel& texel);
  void append(Texel& texel, Event event);
  void check(Texel& texel, const char* text);
  template <class F>
  void for_each_placed(F&& f);

  const std::vector<Request> requests_;
  const PixelLimits limits_;
  std::atomic<bool> stopped_{false};
  std::atomic<std::uint64_t> submission_{0};  ///< the last one that began
  mutable std::mutex mutex_;
  std::uint64_t frame_ = 1;
  std::map<const void*, std::unique_ptr<Image>> images_;
  std::map<std::uint64_t, ImageNote> notes_;  ///< by number
  std::vector<std::unique_ptr<Texel>> texels_;
  std::map<const std::byte*, Texel*> by_address_;
  std::vector<Pending> pending_;
  /// By submission, command and fate.
  std::map<std::tuple<std::uint64_t, std::uint32_t, std::size_t>, PrimitiveNote> primitives_;
  std::uint64_t image_count_ = 0;
  Staged staged_;
};

/// Where a draw or dispatch is, without a shader.
Address address_of(const spirv::ObservedCommand& command);

/// Of this process; null: the tool is off.
Pixels* pixels();

}  // namespace vitrine::glass::pixel
