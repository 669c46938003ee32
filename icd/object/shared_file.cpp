// Memory files, their seals, and dma-bufs of their pages (Linux: memfd_create, fcntl F_ADD_SEALS, udmabuf).
#include "icd/object/shared_file.h"

#include <fcntl.h>
#include <linux/udmabuf.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <limits>

namespace vitrine::icd {
namespace {

/// Of the file system that dma-bufs are files of; not every system's headers name it.
constexpr auto kDmaBufMagic = 0x444d4142;

bool is_dma_buf(int descriptor) {
  struct statfs status {};
  return fstatfs(descriptor, &status) == 0 && status.f_type == kDmaBufMagic;
}

/// Only memory files have seals at all.
bool cannot_shrink(int descriptor) {
  const int seals = fcntl(descriptor, F_GET_SEALS);
  if (seals < 0) return false;
  return (seals & F_SEAL_SHRINK) || fcntl(descriptor, F_ADD_SEALS, F_SEAL_SHRINK) == 0;
}

std::uint64_t bytes_of(int descriptor) {
  const off_t end = lseek(descriptor, 0, SEEK_END);
  return end < 0 ? 0 : static_cast<std::uint64_t>(end);
}

/// -1: the kernel has no udmabuf, lets this process not use it, or wants smaller buffers.
int make_dma_buf(int memory_file) {
  const int maker = open("/dev/udmabuf", O_RDWR | O_CLOEXEC);
  if (maker < 0) return -1;
  udmabuf_create wanted{};
  wanted.memfd = static_cast<__u32>(memory_file);
  wanted.flags = UDMABUF_FLAGS_CLOEXEC;
  wanted.size = bytes_of(memory_file);
  const int made = ioctl(maker, UDMABUF_CREATE, &wanted);
  close(maker);
  return made;
}

}  // namespace

int make_shared_file(std::uint64_t bytes) {
  const auto page = static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
  if (bytes > static_cast<std::uint64_t>(std::numeric_limits<off_t>::max()) - page) return -1;
  const int descriptor = memfd_create("vitrine-memory", MFD_CLOEXEC | MFD_ALLOW_SEALING);
  if (descriptor < 0) return -1;
  const auto whole = static_cast<off_t>((bytes + page - 1) / page * page);
  constexpr int kSeals = F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_SEAL;
  if (ftruncate(descriptor, whole) == 0 && fcntl(descriptor, F_ADD_SEALS, kSeals) == 0) return descriptor;
  close(descriptor);
  return -1;
}

std::uint64_t lasting_bytes_of(int descriptor) {
  return is_dma_buf(descriptor) || cannot_shrink(descriptor) ? bytes_of(descriptor) : 0;
}

int export_dma_buf(int descriptor) {
  const int made = is_dma_buf(descriptor) ? -1 : make_dma_buf(descriptor);
  return made >= 0 ? made : fcntl(descriptor, F_DUPFD_CLOEXEC, 0);
}

}  // namespace vitrine::icd
