// What the C++ runtime and the headers of this system ask of glibc 2.32 to 2.36, for programs that are linked with an
// older one (VITRINE_OLD_GLIBC, ./package): Debian 11 has 2.31. Part of what is packed alone.
#include <link.h>
#include <sys/random.h>
#include <sys/stat.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>

extern "C" {
// glibc 2.31 and older; their headers call these where newer ones call stat and fstat.
int __xstat(int version, const char* path, struct stat* out);
int __fxstat(int version, int descriptor, struct stat* out);
}

namespace {

// _STAT_VER.
#ifdef __aarch64__
constexpr int kStatVersion = 0;
#else
constexpr int kStatVersion = 1;
#endif

struct Search {
  std::uintptr_t pc;
  dl_find_object* found;
};

/// dl_iterate_phdr's callback: 1 once the object that has the address is found.
int look_at(dl_phdr_info* info, std::size_t, void* data) {
  auto& search = *static_cast<Search*>(data);
  std::uintptr_t first = UINTPTR_MAX, last = 0;
  void* frames = nullptr;
  bool inside = false;
  for (int i = 0; i < info->dlpi_phnum; ++i) {
    const ElfW(Phdr)& part = info->dlpi_phdr[i];
    const std::uintptr_t begin = info->dlpi_addr + part.p_vaddr, end = begin + part.p_memsz;
    if (part.p_type == PT_GNU_EH_FRAME) frames = reinterpret_cast<void*>(begin);
    if (part.p_type != PT_LOAD) continue;
    first = std::min(first, begin);
    last = std::max(last, end);
    inside |= search.pc >= begin && search.pc < end;
  }
  if (!inside || !frames) return 0;
  search.found->dlfo_flags = 0;
  search.found->dlfo_map_start = reinterpret_cast<void*>(first);
  search.found->dlfo_map_end = reinterpret_cast<void*>(last);
  search.found->dlfo_link_map = nullptr;
  search.found->dlfo_eh_frame = frames;
  return 1;
}

}  // namespace

extern "C" {

/// 2.32: whether the process has one thread; libstdc++ counts references without atomics then.
char __libc_single_threaded = 0;

/// 2.35: where the unwinder finds the frames of an address (GCC's unwind-dw2-fde-dip.c).
int _dl_find_object(void* pc, dl_find_object* found) noexcept {
  Search search{reinterpret_cast<std::uintptr_t>(pc), found};
  return dl_iterate_phdr(look_at, &search) == 1 ? 0 : -1;
}

/// 2.36: std::random_device.
std::uint32_t arc4random() noexcept {
  std::uint32_t bits = 0;
  if (getrandom(&bits, sizeof(bits), 0) != sizeof(bits)) std::abort();
  return bits;
}

/// 2.33.
int stat(const char* __restrict path, struct stat* __restrict out) noexcept { return __xstat(kStatVersion, path, out); }
int fstat(int descriptor, struct stat* out) noexcept { return __fxstat(kStatVersion, descriptor, out); }
int fstat64(int descriptor, struct stat64* out) noexcept {
  return __fxstat(kStatVersion, descriptor, reinterpret_cast<struct stat*>(out));
}
int stat64(const char* __restrict path, struct stat64* __restrict out) noexcept {
  return __xstat(kStatVersion, path, reinterpret_cast<struct stat*>(out));
}

}  // extern "C"
