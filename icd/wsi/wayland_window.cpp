// Wayland surfaces through wl_shm. Talks on an event queue of its own, so that the application's events are not
// touched.
#include <poll.h>
#include <sys/mman.h>
#include <unistd.h>
#include <wayland-client-core.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <string_view>

#include "icd/wsi/library.h"
#include "icd/wsi/window.h"

namespace vitrine::icd::wsi {
namespace {

// Requests and formats of the core protocol (wayland.xml), numbered in the order of their interface.
enum : std::uint32_t {
  kDisplaySync = 0,
  kDisplayGetRegistry = 1,
  kRegistryBind = 0,
  kShmCreatePool = 0,
  kShmPoolCreateBuffer = 0,
  kShmPoolDestroy = 1,
  kBufferDestroy = 0,
  kSurfaceAttach = 1,
  kSurfaceDamage = 2,
  kSurfaceFrame = 3,
  kSurfaceCommit = 6,
  kFormatXrgb8888 = 1,
};

/// The functions and interface descriptions of libwayland-client that we use.
struct Wayland {
  Library library{"libwayland-client.so.0"};
  bool usable = false;
  decltype(wl_proxy_marshal_flags)* marshal;
  decltype(wl_proxy_add_listener)* add_listener;
  decltype(wl_proxy_create_wrapper)* create_wrapper;
  decltype(wl_proxy_wrapper_destroy)* wrapper_destroy;
  decltype(wl_proxy_set_queue)* set_queue;
  decltype(wl_proxy_destroy)* proxy_destroy;
  decltype(wl_proxy_get_version)* get_version;
  decltype(wl_display_create_queue)* create_queue;
  decltype(wl_event_queue_destroy)* queue_destroy;
  decltype(wl_display_prepare_read_queue)* prepare_read;
  decltype(wl_display_cancel_read)* cancel_read;
  decltype(wl_display_read_events)* read_events;
  decltype(wl_display_get_fd)* get_fd;
  decltype(wl_display_dispatch_queue_pending)* dispatch_pending;
  decltype(wl_display_flush)* flush;
  decltype(wl_display_get_error)* get_error;
  const wl_interface* registry_interface;
  const wl_interface* shm_interface;
  const wl_interface* shm_pool_interface;
  const wl_interface* buffer_interface;
  const wl_interface* callback_interface;

  Wayland() {
    const Library& l = library;
    usable = l.find("wl_proxy_marshal_flags", marshal) && l.find("wl_proxy_add_listener", add_listener) &&
             l.find("wl_proxy_create_wrapper", create_wrapper) && l.find("wl_proxy_wrapper_destroy", wrapper_destroy) &&
             l.find("wl_proxy_set_queue", set_queue) && l.find("wl_proxy_destroy", proxy_destroy) &&
             l.find("wl_proxy_get_version", get_version) && l.find("wl_display_create_queue", create_queue) &&
             l.find("wl_event_queue_destroy", queue_destroy) && l.find("wl_display_prepare_read_queue", prepare_read) &&
             l.find("wl_display_cancel_read", cancel_read) && l.find("wl_display_read_events", read_events) &&
             l.find("wl_display_get_fd", get_fd) && l.find("wl_display_dispatch_queue_pending", dispatch_pending) &&
             l.find("wl_display_flush", flush) && l.find("wl_display_get_error", get_error) &&
             l.find("wl_registry_interface", registry_interface) && l.find("wl_shm_interface", shm_interface) &&
             l.find("wl_shm_pool_interface", shm_pool_interface) && l.find("wl_buffer_interface", buffer_interface) &&
             l.find("wl_callback_interface", callback_interface);
  }
};

Wayland& wayland() {
  static Wayland instance;
  return instance;
}

using Listener = void (*)(void);

/// One wl_buffer in its own pool; the compositor holds it while `busy`.
struct ShmBuffer {
  wl_proxy* buffer = nullptr;
  std::byte* data = nullptr;
  std::size_t bytes = 0;
  VkExtent2D extent{};
  bool busy = false;

  void release() {
    if (buffer) {
      wayland().marshal(buffer, kBufferDestroy, nullptr, wayland().get_version(buffer), WL_MARSHAL_FLAG_DESTROY);
    }
    if (data) munmap(data, bytes);
    *this = {};
  }
};

void on_buffer_release(void* data, wl_proxy*) { static_cast<ShmBuffer*>(data)->busy = false; }
const std::array<Listener, 1> kBufferListener{reinterpret_cast<Listener>(on_buffer_release)};

void on_frame_done(void* data, wl_proxy* callback, std::uint32_t) {
  *static_cast<bool*>(data) = false;
  wayland().proxy_destroy(callback);
}
const std::array<Listener, 1> kFrameListener{reinterpret_cast<Listener>(on_frame_done)};

class WaylandWindow final : public Window {
 public:
  WaylandWindow(wl_display* display, wl_surface* surface) : display_(display) {
    queue_ = wayland().create_queue(display);
    display_wrapper_ = static_cast<wl_proxy*>(wayland().create_wrapper(display));
    surface_ = static_cast<wl_proxy*>(wayland().create_wrapper(surface));
    if (!queue_ || !display_wrapper_ || !surface_) return;
    wayland().set_queue(display_wrapper_, queue_);
    wayland().set_queue(surface_, queue_);
    registry_ = wayland().marshal(display_wrapper_, kDisplayGetRegistry, wayland().registry_interface,
                                  wayland().get_version(display_wrapper_), 0, nullptr);
    if (!registry_ || wayland().get_error(display_) != 0) return;
    wayland().add_listener(registry_, const_cast<Listener*>(kRegistryListener.data()), this);
    round_trip();
  }

  ~WaylandWindow() override {
    for (ShmBuffer& buffer : buffers_) buffer.release();
    if (frame_callback_ && frame_pending_) wayland().proxy_destroy(frame_callback_);
    if (shm_) wayland().proxy_destroy(shm_);
    if (registry_) wayland().proxy_destroy(registry_);
    if (surface_) wayland().wrapper_destroy(surface_);
    if (display_wrapper_) wayland().wrapper_destroy(display_wrapper_);
    if (queue_) wayland().queue_destroy(queue_);
  }

  bool usable() const { return shm_ != nullptr; }

  VkResult extent(VkExtent2D& extent) override {
    extent = {0xFFFFFFFF, 0xFFFFFFFF};
    return VK_SUCCESS;
  }

  VkResult present(const Frame& frame, bool wait_for_display) override {
    while (wait_for_display && frame_pending_) {
      if (!wait_for_events()) return VK_ERROR_SURFACE_LOST_KHR;
    }
    ShmBuffer* buffer = free_buffer(frame.extent);
    if (!buffer) return VK_ERROR_SURFACE_LOST_KHR;
    copy_to_bgra(frame, buffer->data, std::uint64_t{frame.extent.width} * 4);
    const std::uint32_t version = wayland().get_version(surface_);
    wayland().marshal(surface_, kSurfaceAttach, nullptr, version, 0, buffer->buffer, 0, 0);
    wayland().marshal(surface_, kSurfaceDamage, nullptr, version, 0, 0, 0, INT32_MAX, INT32_MAX);
    if (wait_for_display) request_frame(version);
    wayland().marshal(surface_, kSurfaceCommit, nullptr, version, 0);
    buffer->busy = true;
    if (wayland().flush(display_) < 0) return VK_ERROR_SURFACE_LOST_KHR;
    wayland().dispatch_pending(display_, queue_);
    return VK_SUCCESS;
  }

 private:
  static void on_global(void* data, wl_proxy* registry, std::uint32_t name, const char* interface, std::uint32_t) {
    auto* window = static_cast<WaylandWindow*>(data);
    if (std::string_view(interface) != "wl_shm" || window->shm_) return;
    window->shm_ = wayland().marshal(registry, kRegistryBind, wayland().shm_interface, 1, 0, name,
                                     wayland().shm_interface->name, 1, nullptr);
    if (window->shm_) wayland().add_listener(window->shm_, const_cast<Listener*>(kShmListener.data()), nullptr);
  }
  static void on_global_remove(void*, wl_proxy*, std::uint32_t) {}
  static void on_shm_format(void*, wl_proxy*, std::uint32_t) {}  // XRGB8888 is mandatory

  static inline const std::array<Listener, 2> kRegistryListener{reinterpret_cast<Listener>(on_global),
                                                                reinterpret_cast<Listener>(on_global_remove)};
  static inline const std::array<Listener, 1> kShmListener{reinterpret_cast<Listener>(on_shm_format)};

  void request_frame(std::uint32_t version) {
    frame_callback_ = wayland().marshal(surface_, kSurfaceFrame, wayland().callback_interface, version, 0, nullptr);
    if (!frame_callback_) return;
    frame_pending_ = true;
    wayland().add_listener(frame_callback_, const_cast<Listener*>(kFrameListener.data()), &frame_pending_);
  }

  /// False: the compositor has gone. libwayland's own wait may never end then: 1.21's where an error was EAGAIN, as
  /// after an event that the interface does not have, 1.23's where the last message is not whole.
  bool wait_for_events() {
    if (wayland().get_error(display_) != 0) return false;
    if (wayland().prepare_read(display_, queue_) != 0) return wayland().dispatch_pending(display_, queue_) >= 0;
    const bool is_full = wayland().flush(display_) < 0 && errno == EAGAIN;
    pollfd ready{wayland().get_fd(display_), static_cast<short>(is_full ? POLLIN | POLLOUT : POLLIN), 0};
    if (poll(&ready, 1, -1) < 0) {
      const bool again = errno == EINTR;
      wayland().cancel_read(display_);
      return again;
    }
    if (wayland().read_events(display_) < 0) return false;
    const int events = wayland().dispatch_pending(display_, queue_);
    return events > 0 || (events == 0 && (ready.revents & POLLHUP) == 0);
  }

  /// What the compositor has to say by now has been heard, or it has gone.
  void round_trip() {
    bool pending = true;
    wl_proxy* const callback = wayland().marshal(display_wrapper_, kDisplaySync, wayland().callback_interface,
                                                 wayland().get_version(display_wrapper_), 0, nullptr);
    if (!callback) return;
    wayland().add_listener(callback, const_cast<Listener*>(kFrameListener.data()), &pending);
    while (pending && wait_for_events()) {
    }
    if (pending) wayland().proxy_destroy(callback);
  }

  /// A buffer of this size that the compositor does not hold; waits for one.
  ShmBuffer* free_buffer(VkExtent2D extent) {
    for (;;) {
      wayland().dispatch_pending(display_, queue_);
      for (ShmBuffer& buffer : buffers_) {
        if (buffer.busy) continue;
        if (buffer.extent.width == extent.width && buffer.extent.height == extent.height) return &buffer;
        buffer.release();
        return create(buffer, extent) ? &buffer : nullptr;
      }
      if (!wait_for_events()) return nullptr;
    }
  }

  bool create(ShmBuffer& buffer, VkExtent2D extent) {
    const std::uint64_t bytes = std::uint64_t{extent.width} * extent.height * 4;
    if (bytes == 0 || bytes > INT32_MAX) return false;
    const int file = memfd_create("vitrine-wl_shm", MFD_CLOEXEC);
    if (file < 0) return false;
    void* data = MAP_FAILED;
    if (ftruncate(file, static_cast<off_t>(bytes)) == 0) {
      data = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    }
    if (data != MAP_FAILED) {
      wl_proxy* pool = wayland().marshal(shm_, kShmCreatePool, wayland().shm_pool_interface, 1, 0, nullptr, file,
                                         static_cast<std::int32_t>(bytes));
      if (pool) {
        buffer.buffer =
            wayland().marshal(pool, kShmPoolCreateBuffer, wayland().buffer_interface, 1, 0, nullptr, 0,
                              static_cast<std::int32_t>(extent.width), static_cast<std::int32_t>(extent.height),
                              static_cast<std::int32_t>(extent.width * 4), kFormatXrgb8888);
        wayland().marshal(pool, kShmPoolDestroy, nullptr, 1, WL_MARSHAL_FLAG_DESTROY);
      }
      buffer.data = static_cast<std::byte*>(data);
      buffer.bytes = bytes;
      buffer.extent = extent;
    }
    close(file);
    if (!buffer.buffer) {
      buffer.release();
      return false;
    }
    wayland().add_listener(buffer.buffer, const_cast<Listener*>(kBufferListener.data()), &buffer);
    return true;
  }

  wl_display* display_;
  wl_event_queue* queue_ = nullptr;
  wl_proxy* display_wrapper_ = nullptr;
  wl_proxy* surface_ = nullptr;
  wl_proxy* registry_ = nullptr;
  wl_proxy* shm_ = nullptr;
  wl_proxy* frame_callback_ = nullptr;
  bool frame_pending_ = false;
  std::array<ShmBuffer, 4> buffers_{};
};

}  // namespace

std::unique_ptr<Window> open_wayland_window(wl_display* display, wl_surface* surface) {
  if (!wayland().usable) return nullptr;
  auto window = std::make_unique<WaylandWindow>(display, surface);
  return window->usable() ? std::move(window) : nullptr;
}

bool wayland_presentation_supported(wl_display* display) { return display != nullptr && wayland().usable; }

}  // namespace vitrine::icd::wsi
