// Which bytes of device memory anything has written: the shadow that tools keep of it, a byte for each byte.
// Process-wide, as spirv/addresses.h is. Memory that the shadow does not know (imported, exported, the device's own)
// counts as written, and so does what the application may write through a mapping.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

namespace vitrine::glass {

/// What is known of a byte.
enum class ByteState : std::uint8_t {
  kFresh,      ///< as it was allocated: written only if the host may have written it
  kWritten,    ///< by a command or a shader
  kDiscarded,  ///< texels of an image whose contents were given up: the host does not write those
  kDerived,    ///< by an invocation that read it before, when nothing had written it
};

/// Who reads: bytes of buffers, which the host can write through a mapping, or texels.
enum class Contents : std::uint8_t { kBytes, kTexels };

/// The shadow of one allocation. The states are touched where the memory is: pages of the rest cost nothing.
class ShadowRegion {
 public:
  /// No shadow (has_states()) if the system has no memory.
  ShadowRegion(const std::byte* data, std::uint64_t size);
  ~ShadowRegion();
  ShadowRegion(const ShadowRegion&) = delete;
  ShadowRegion& operator=(const ShadowRegion&) = delete;

  bool has_states() const { return states_ != nullptr; }
  std::uintptr_t first() const { return first_; }
  std::uintptr_t end() const { return first_ + size_; }
  bool contains(std::uintptr_t address, std::uint64_t bytes) const {
    return address >= first_ && bytes <= size_ && address - first_ <= size_ - bytes;
  }
  /// States of the bytes from `address` on, one byte each, for who copies them.
  std::byte* states(std::uintptr_t address) const {
    generation_.fetch_add(1, std::memory_order_relaxed);
    return reinterpret_cast<std::byte*>(states_ + (address - first_));
  }
  /// Changes whenever bytes that had been written may no longer be; of no two regions ever the same.
  std::uint64_t generation() const { return generation_.load(std::memory_order_relaxed); }

  /// The host may write these bytes at any time from now on.
  void map(std::uintptr_t first, std::uint64_t bytes);
  bool is_mapped(std::uintptr_t address, std::uint64_t bytes) const {
    return address >= mapped_first_.load(std::memory_order_relaxed) &&
           address + bytes <= mapped_end_.load(std::memory_order_relaxed);
  }

  /// The offset of the first of these bytes that has not been written; `bytes`: all have. What lies outside counts as
  /// written. Any thread.
  std::uint64_t first_unwritten(std::uintptr_t address, std::uint64_t bytes, Contents contents) const;
  bool written(std::uintptr_t address, std::uint64_t bytes, Contents contents) const {
    return first_unwritten(address, bytes, contents) == bytes;
  }
  /// A shader writes a few bytes. Any thread.
  void mark(std::uintptr_t address, std::uint32_t bytes, ByteState state = ByteState::kWritten) const;
  /// A command writes or gives up many. No shader runs on them.
  void fill(std::uintptr_t address, std::uint64_t bytes, ByteState state) const;
  /// As fill(kWritten), but only of what written() takes for written; the rest keeps its state.
  void settle(std::uintptr_t address, std::uint64_t bytes, Contents contents) const;

 private:
  bool byte_written(std::uintptr_t address, Contents contents) const;

  std::uintptr_t first_ = 0;
  std::uint64_t size_ = 0;
  std::uint8_t* states_ = nullptr;
  mutable std::atomic<std::uint64_t> generation_;
  /// Ranges that have ever been mapped, together.
  std::atomic<std::uintptr_t> mapped_first_{UINTPTR_MAX}, mapped_end_{0};
};

/// An allocation has been made, or ends. Without memory for it, it stays unknown. Any thread.
void add_shadow(const std::byte* data, std::uint64_t size) noexcept;
void remove_shadow(const std::byte* data) noexcept;

/// The region that has this byte, while its allocation lives; null: unknown memory. Any thread; cheap while no memory
/// is allocated or freed.
ShadowRegion* find_shadow(const void* address);

}  // namespace vitrine::glass
