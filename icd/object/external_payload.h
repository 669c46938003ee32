// Payloads of fences and semaphores that other devices and processes see (Vulkan 1.3.239, Synchronization and Cache
// Control: Importing Fence Payloads, Importing Semaphore Payloads): a page of shared memory behind a file descriptor,
// or a file that the system's kernel makes readable once it is signalled (a Linux sync file).
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>

namespace vitrine::icd {

class ExternalPayload {
 public:
  enum class Kind : std::uint32_t { kBinary = 1, kTimeline, kFence };

  /// In shared memory of its own. Null if the system has none left; throws std::bad_alloc.
  static std::shared_ptr<ExternalPayload> make(Kind kind, std::uint64_t value);
  /// The one that descriptor() of another owner gave out. Takes the descriptor. Null, and does not take it, if it is
  /// no payload of this kind: whoever sent it is not trusted.
  static std::shared_ptr<ExternalPayload> open(int descriptor, Kind kind);
  /// A sync file, which is taken; -1 stands for one that has been signalled.
  static std::shared_ptr<ExternalPayload> of_sync_file(int descriptor);

  ExternalPayload(const ExternalPayload&) = delete;
  ExternalPayload& operator=(const ExternalPayload&) = delete;
  ~ExternalPayload();

  /// A descriptor of the same payload, the caller's to close; -1 if there is none left.
  int descriptor() const;

  /// A counter as Semaphore::value, or 1 where a fence or sync file is signalled.
  std::uint64_t value() const;
  /// To a larger value of a timeline, or one signal more of a binary semaphore.
  void signal(std::uint64_t timeline_value);
  void set(bool signaled);
  /// Takes a signal of a binary semaphore; false if there is none.
  bool take();

  /// Counts changes, so that none is missed between a look at the value and wait().
  std::uint32_t changes() const;
  /// Until a change behind `seen`, or at most as long.
  void wait(std::uint32_t seen, std::chrono::nanoseconds at_most) const;

 private:
  struct Page;
  ExternalPayload(int file, Kind kind, Page* page) : file_(file), kind_(kind), page_(page) {}
  static std::shared_ptr<ExternalPayload> map(int file, Kind kind);
  void tell();

  int file_ = -1;
  Kind kind_;
  Page* page_ = nullptr;  ///< null: a sync file
};

}  // namespace vitrine::icd
