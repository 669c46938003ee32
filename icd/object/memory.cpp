// Device memory as mappings (Linux): anonymous, of a memory file, or the application's own pages.
#include "icd/object/memory.h"

#include <sys/mman.h>
#include <sys/uio.h>
#include <unistd.h>

#include "base/shake.h"
#include "glass/digest.h"
#include "glass/memory_shadow.h"
#include "glass/session.h"
#include "glass/sync/sync.h"
#include "icd/object/shared_file.h"

namespace vitrine::icd {
namespace {

/// Of an allocation: the pages of more would be in use from then on.
constexpr VkDeviceSize kPoisonedBytes = VkDeviceSize{256} << 20;

std::size_t page_size() { return static_cast<std::size_t>(sysconf(_SC_PAGESIZE)); }

// Far from where Linux puts programs, their heaps and mappings of its own choice: what lies here is free in the next
// process, too. Nothing comes twice in one process.
constexpr std::uintptr_t kFirstThatComesAgain = 0x2000'0000'0000, kGrain = std::uintptr_t{1} << 21;
std::atomic<std::uintptr_t> next_that_comes_again = kFirstThatComesAgain;

/// NORESERVE: a large allocation that is never touched costs address space only. MAP_FAILED: not at this place.
void* map_anonymous(std::size_t bytes, Placement placement = {}) {
  void* wanted = reinterpret_cast<void*>(placement.address);
  if (placement.comes_again)
    wanted = reinterpret_cast<void*>(next_that_comes_again.fetch_add((bytes / kGrain + 1) * kGrain));
  const int fixed = placement.address ? MAP_FIXED_NOREPLACE : 0;
  void* mapping =
      mmap(wanted, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE | fixed, -1, 0);
  if (!fixed || mapping == MAP_FAILED || mapping == wanted) return mapping;
  munmap(mapping, bytes);  // a system before Linux 4.17
  return MAP_FAILED;
}

bool is_readable(const void* address) {
  std::byte out{};
  iovec to{&out, 1}, from{const_cast<void*>(address), 1};
  return process_vm_readv(getpid(), &to, 1, &from, 1, 0) == 1;
}

}  // namespace

std::atomic<VkDeviceSize>& allocated_bytes() {
  static std::atomic<VkDeviceSize> bytes = 0;
  return bytes;
}

DeviceMemory::DeviceMemory(const HostMemory& m, VkDeviceSize bytes, std::atomic<VkDeviceSize>& total,
                           Placement placement)
    : Object(m), size(bytes) {
  mapping_bytes_ = size + kTailBytes;
  void* mapping = map_anonymous(mapping_bytes_, placement);
  if (mapping == MAP_FAILED) return;
  mapping_ = mapping;
  data = static_cast<std::byte*>(mapping);
  counted_ = &total;
  total += size;
  if (glass::session().shadows_memory()) glass::add_shadow(data, size);
  if (glass::has_digest()) glass::add_digested(data, size);
  if (base::shakes(base::ShakeKind::kPoison)) base::poison(data, std::min(size, kPoisonedBytes));
}

DeviceMemory::~DeviceMemory() {
  if (data) glass::sync::forget_memory(data, size);
  if (counted_ && glass::session().shadows_memory()) glass::remove_shadow(data);
  if (counted_ && glass::has_digest()) glass::remove_digested(data);
  if (mapping_) munmap(mapping_, mapping_bytes_);
  if (file >= 0) close(file);
  if (counted_) *counted_ -= size;
}

bool DeviceMemory::map_file(int descriptor) {
  if (lasting_bytes_of(descriptor) < size) return false;
  // The file lies over the front of an anonymous mapping that is a page longer.
  const std::size_t page = page_size();
  mapping_bytes_ = (size + page - 1) / page * page + page;
  void* mapping = map_anonymous(mapping_bytes_);
  if (mapping == MAP_FAILED) return false;
  mapping_ = mapping;
  if (mmap(mapping, size, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_FIXED, descriptor, 0) == MAP_FAILED) return false;
  data = static_cast<std::byte*>(mapping);
  file = descriptor;
  return true;
}

bool DeviceMemory::map_new_file() {
  const int descriptor = make_shared_file(size);
  if (descriptor < 0) return false;
  if (map_file(descriptor)) return true;
  close(descriptor);
  return false;
}

bool DeviceMemory::use_host_pages(void* pages) {
  std::byte* end = static_cast<std::byte*>(pages) + size;
  const std::size_t page = page_size();
  void* guard = mmap(end, page, PROT_READ, MAP_PRIVATE | MAP_ANONYMOUS | MAP_FIXED_NOREPLACE, -1, 0);
  if (guard == end) {
    mapping_ = guard;
    mapping_bytes_ = page;
  } else {
    if (guard != MAP_FAILED) munmap(guard, page);
    if (!is_readable(end)) return false;
  }
  data = static_cast<std::byte*>(pages);
  return true;
}

}  // namespace vitrine::icd
