// Files that memory is shared as (Linux): memory files of a size that nobody changes any more, and dma-bufs.
#pragma once

#include <cstdint>

namespace vitrine::icd {

/// A memory file of at least `bytes` zeros, in whole pages, sealed so that its size stays. Negative: the system has no
/// memory or no file left. The caller's to close.
int make_shared_file(std::uint64_t bytes);

/// The bytes that a file has for as long as somebody maps it: those of a dma-buf, or of a memory file that cannot
/// shrink, which is seen to by a seal where the owner has left that open. 0: none of these, since reading behind the
/// end of a file that somebody cut off would end the process. Any descriptor may be asked about.
std::uint64_t lasting_bytes_of(int descriptor);

/// A descriptor of the file as a dma-buf: the file itself if it is one, else one that the kernel makes of its pages
/// where it has udmabuf, else the memory file, which can be mapped like one but which drivers of GPUs refuse. Negative:
/// there is no descriptor left. The caller's to close.
int export_dma_buf(int descriptor);

}  // namespace vitrine::icd
