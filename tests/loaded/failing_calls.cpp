// A library for LD_PRELOAD that makes one call for memory, a thread or a file fail, if the driver makes it:
// faults_test.py. FAULTS_KIND: memory, threads or files. FAULTS_AT: the number of the call that fails, from 0 on; -1:
// none. FAULTS_ON=1: all further ones fail as well. FAULTS_COUNT: a file of eight bytes; it then has the number of
// calls so far.
#include <dlfcn.h>
#include <fcntl.h>
#include <link.h>
#include <pthread.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>

extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
void __libc_free(void* memory);
}

namespace {

using Counter = std::atomic<long long>;

Counter unseen{0};
Counter* calls = &unseen;  ///< so far, in the shared file
long long failing = -1;
bool further = false;
char kind = 0;  ///< the first letter of FAULTS_KIND

[[gnu::constructor]] void read_settings() {
  const auto setting = [](const char* name) { return std::getenv(name) ? std::getenv(name) : ""; };
  kind = *setting("FAULTS_KIND");
  failing = std::strtoll(setting("FAULTS_AT"), nullptr, 10);
  further = *setting("FAULTS_ON") == '1';
  const int file = ::open(setting("FAULTS_COUNT"), O_RDWR);
  if (file < 0) return;
  void* const mapped = ::mmap(nullptr, sizeof(Counter), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  ::close(file);
  if (mapped != MAP_FAILED) calls = static_cast<Counter*>(mapped);
}

/// Whether the code at `address` is the driver's; threads and streams it makes through the C++ library.
bool of_driver(void* address) {
  dl_find_object found{};
  if (_dl_find_object(address, &found) != 0) return false;
  const char* const name = found.dlfo_link_map->l_name;
  return std::strstr(name, "libvitrine_icd") || (kind != 'm' && std::strstr(name, "libstdc++"));
}

/// Whether this call of a kind fails.
bool fails(char of_kind, void* caller) {
  if (of_kind != kind || !of_driver(caller)) return false;
  const long long number = calls->fetch_add(1, std::memory_order_relaxed);
  return failing >= 0 && (number == failing || (further && number > failing));
}

void* new_memory(std::size_t size, std::size_t alignment, void* caller) {
  void* const memory = fails('m', caller) ? nullptr
                       : alignment        ? __libc_memalign(alignment, size)
                                          : __libc_malloc(size ? size : 1);
  if (!memory) throw std::bad_alloc();
  return memory;
}

}  // namespace

#define CALLER __builtin_return_address(0)

// NOLINTBEGIN: the signatures are the C library's.
void* operator new(std::size_t size) { return new_memory(size, 0, CALLER); }
void* operator new[](std::size_t size) { return new_memory(size, 0, CALLER); }
void* operator new(std::size_t size, std::align_val_t to) {
  return new_memory(size, static_cast<std::size_t>(to), CALLER);
}
void* operator new[](std::size_t size, std::align_val_t to) {
  return new_memory(size, static_cast<std::size_t>(to), CALLER);
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  return fails('m', CALLER) ? nullptr : __libc_malloc(size ? size : 1);
}
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept {
  return fails('m', CALLER) ? nullptr : __libc_malloc(size ? size : 1);
}
void* operator new(std::size_t size, std::align_val_t to, const std::nothrow_t&) noexcept {
  return fails('m', CALLER) ? nullptr : __libc_memalign(static_cast<std::size_t>(to), size);
}
void operator delete(void* memory) noexcept { __libc_free(memory); }
void operator delete[](void* memory) noexcept { __libc_free(memory); }
void operator delete(void* memory, std::size_t) noexcept { __libc_free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { __libc_free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { __libc_free(memory); }
void operator delete[](void* memory, std::align_val_t) noexcept { __libc_free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { __libc_free(memory); }
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept { __libc_free(memory); }

extern "C" {

void* malloc(std::size_t size) { return fails('m', CALLER) ? (errno = ENOMEM, nullptr) : __libc_malloc(size); }
void* calloc(std::size_t count, std::size_t size) {
  return fails('m', CALLER) ? (errno = ENOMEM, nullptr) : __libc_calloc(count, size);
}
void* realloc(void* memory, std::size_t size) {
  return fails('m', CALLER) ? (errno = ENOMEM, nullptr) : __libc_realloc(memory, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  return fails('m', CALLER) ? (errno = ENOMEM, nullptr) : __libc_memalign(alignment, size);
}
int posix_memalign(void** memory, std::size_t alignment, std::size_t size) {
  if (fails('m', CALLER)) return ENOMEM;
  *memory = __libc_memalign(alignment, size);
  return *memory ? 0 : ENOMEM;
}

void* mmap(void* where, std::size_t size, int protection, int flags, int file, off_t offset) {
  static void* (*real)(void*, std::size_t, int, int, int, off_t);
  if (fails('m', CALLER)) return errno = ENOMEM, MAP_FAILED;
  if (!real) real = reinterpret_cast<decltype(real)>(dlsym(RTLD_NEXT, "mmap"));
  return real(where, size, protection, flags, file, offset);
}
void* mmap64(void* where, std::size_t size, int protection, int flags, int file, off64_t offset) {
  static void* (*real)(void*, std::size_t, int, int, int, off64_t);
  if (fails('m', CALLER)) return errno = ENOMEM, MAP_FAILED;
  if (!real) real = reinterpret_cast<decltype(real)>(dlsym(RTLD_NEXT, "mmap64"));
  return real(where, size, protection, flags, file, offset);
}

int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*begin)(void*), void* argument) {
  static int (*real)(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*);
  if (fails('t', CALLER)) return EAGAIN;
  if (!real) real = reinterpret_cast<decltype(real)>(dlsym(RTLD_NEXT, "pthread_create"));
  return real(thread, attributes, begin, argument);
}

// Calls that give a file descriptor.
#define GIVES_FILE(name, parameters, arguments)                                  \
  int name parameters {                                                          \
    static int(*real) parameters;                                                \
    if (fails('f', CALLER)) return errno = EMFILE, -1;                           \
    if (!real) real = reinterpret_cast<decltype(real)>(dlsym(RTLD_NEXT, #name)); \
    return real arguments;                                                       \
  }
GIVES_FILE(socket, (int domain, int type, int protocol), (domain, type, protocol))
GIVES_FILE(memfd_create, (const char* name, unsigned flags), (name, flags))
GIVES_FILE(eventfd, (unsigned value, int flags), (value, flags))
GIVES_FILE(pipe2, (int files[2], int flags), (files, flags))
GIVES_FILE(dup, (int file), (file))
GIVES_FILE(shmget, (int key, std::size_t size, int flags), (key, size, flags))

// The last argument, where there is one, is a number or a pointer.
#define OPENS_FILE(name, parameters, arguments)                                  \
  int name parameters {                                                          \
    static int(*real) parameters;                                                \
    if (fails('f', CALLER)) return errno = EMFILE, -1;                           \
    if (!real) real = reinterpret_cast<decltype(real)>(dlsym(RTLD_NEXT, #name)); \
    std::va_list rest;                                                           \
    va_start(rest, flags);                                                       \
    void* const mode = va_arg(rest, void*);                                      \
    va_end(rest);                                                                \
    return real arguments;                                                       \
  }
OPENS_FILE(open, (const char* path, int flags, ...), (path, flags, mode))
OPENS_FILE(open64, (const char* path, int flags, ...), (path, flags, mode))
OPENS_FILE(openat, (int folder, const char* path, int flags, ...), (folder, path, flags, mode))
OPENS_FILE(fcntl, (int file, int flags, ...), (file, flags, mode))

#define OPENS_STREAM(name)                                                       \
  FILE* name(const char* path, const char* mode) {                               \
    static FILE* (*real)(const char*, const char*);                              \
    if (fails('f', CALLER)) return errno = EMFILE, nullptr;                      \
    if (!real) real = reinterpret_cast<decltype(real)>(dlsym(RTLD_NEXT, #name)); \
    return real(path, mode);                                                     \
  }
OPENS_STREAM(fopen)
OPENS_STREAM(fopen64)
}
// NOLINTEND
