// See external_payload.h.
#include "icd/object/external_payload.h"

#include <fcntl.h>
#include <linux/futex.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <climits>
#include <ctime>

namespace vitrine::icd {
namespace {

constexpr std::uint32_t kMagic = 0x56697472;  // what the page begins with, "Vitr"
constexpr off_t kBytes = 4096;
constexpr int kSeals = F_SEAL_SHRINK | F_SEAL_GROW;

timespec to_timespec(std::chrono::nanoseconds time) {
  constexpr std::int64_t kSecond = 1'000'000'000;
  return {static_cast<time_t>(time.count() / kSecond), static_cast<long>(time.count() % kSecond)};
}

}  // namespace

/// What lies in the shared memory. Only lock-free atomics: the other side may be any process.
struct ExternalPayload::Page {
  std::uint32_t magic;
  Kind kind;
  std::atomic<std::uint32_t> changes;
  std::atomic<std::uint64_t> value;
  static_assert(std::atomic<std::uint64_t>::is_always_lock_free);
};

ExternalPayload::~ExternalPayload() {
  if (page_ != nullptr) munmap(page_, kBytes);
  if (file_ >= 0) close(file_);
}

/// Maps the file; null where that fails, and then the file is the caller's still.
std::shared_ptr<ExternalPayload> ExternalPayload::map(int file, Kind kind) {
  void* const page = mmap(nullptr, kBytes, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  if (page == MAP_FAILED) return nullptr;
  try {
    return std::shared_ptr<ExternalPayload>(new ExternalPayload(file, kind, static_cast<Page*>(page)));
  } catch (...) {
    munmap(page, kBytes);
    throw;
  }
}

std::shared_ptr<ExternalPayload> ExternalPayload::make(Kind kind, std::uint64_t value) {
  const int file = memfd_create("vitrine-sync", MFD_CLOEXEC | MFD_ALLOW_SEALING);
  if (file < 0) return nullptr;
  std::shared_ptr<ExternalPayload> payload;
  try {
    // Sealed: nobody can take the page away from those who have mapped it.
    if (ftruncate(file, kBytes) == 0 && fcntl(file, F_ADD_SEALS, kSeals) == 0) payload = map(file, kind);
  } catch (...) {
    close(file);
    throw;
  }
  if (!payload) {
    close(file);
    return nullptr;
  }
  payload->page_->kind = kind;
  payload->page_->value = value;
  payload->page_->magic = kMagic;
  return payload;
}

std::shared_ptr<ExternalPayload> ExternalPayload::open(int descriptor, Kind kind) {
  struct stat status {};
  const int seals = fcntl(descriptor, F_GET_SEALS);
  if (seals < 0 || (seals & kSeals) != kSeals || fstat(descriptor, &status) != 0 || status.st_size != kBytes)
    return nullptr;
  std::shared_ptr<ExternalPayload> payload = map(descriptor, kind);
  if (!payload || (payload->page_->magic == kMagic && payload->page_->kind == kind)) return payload;
  payload->file_ = -1;
  return nullptr;
}

std::shared_ptr<ExternalPayload> ExternalPayload::of_sync_file(int descriptor) {
  return std::shared_ptr<ExternalPayload>(new ExternalPayload(descriptor, Kind::kFence, nullptr));
}

int ExternalPayload::descriptor() const { return file_ < 0 ? -1 : fcntl(file_, F_DUPFD_CLOEXEC, 0); }

std::uint64_t ExternalPayload::value() const {
  if (page_ != nullptr) return page_->value.load(std::memory_order_acquire);
  if (file_ < 0) return 1;
  pollfd file{file_, POLLIN, 0};
  // A file that cannot be asked will never say more: nobody shall wait for it.
  return poll(&file, 1, 0) != 0;
}

void ExternalPayload::tell() {
  page_->changes.fetch_add(1, std::memory_order_release);
  syscall(SYS_futex, &page_->changes, FUTEX_WAKE, INT_MAX, nullptr, nullptr, 0);
}

void ExternalPayload::signal(std::uint64_t timeline_value) {
  if (page_ == nullptr) return;
  if (kind_ != Kind::kTimeline) {
    page_->value.fetch_add(1, std::memory_order_acq_rel);
  } else {
    std::uint64_t old = page_->value.load(std::memory_order_acquire);
    while (old < timeline_value && !page_->value.compare_exchange_weak(old, timeline_value)) {
    }
  }
  tell();
}

void ExternalPayload::set(bool signaled) {
  if (page_ == nullptr) return;
  page_->value.store(signaled, std::memory_order_release);
  tell();
}

bool ExternalPayload::take() {
  if (page_ == nullptr) return value() != 0;
  std::uint64_t old = page_->value.load(std::memory_order_acquire);
  while (old != 0) {
    if (page_->value.compare_exchange_weak(old, old - 1)) return true;
  }
  return false;
}

std::uint32_t ExternalPayload::changes() const {
  return page_ != nullptr ? page_->changes.load(std::memory_order_acquire) : 0;
}

void ExternalPayload::wait(std::uint32_t seen, std::chrono::nanoseconds at_most) const {
  const timespec time = to_timespec(at_most);
  if (page_ != nullptr) {
    syscall(SYS_futex, &page_->changes, FUTEX_WAIT, seen, &time, nullptr, 0);
  } else if (file_ >= 0) {
    pollfd file{file_, POLLIN, 0};
    ppoll(&file, 1, &time, nullptr);
  }
}

}  // namespace vitrine::icd
