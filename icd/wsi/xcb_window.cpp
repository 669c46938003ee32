// X11 windows through XCB: MIT-SHM where the server shares memory with us, PutImage where it does not.
#include <pthread.h>
#include <sys/ipc.h>
#include <sys/shm.h>
#include <xcb/shm.h>
#include <xcb/xcb.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <ctime>
#include <map>
#include <mutex>
#include <new>
#include <string>
#include <vector>

#include "base/lasting.h"
#include "icd/wsi/library.h"
#include "icd/wsi/window.h"

namespace vitrine::icd::wsi {
namespace {

/// The functions of libxcb, libxcb-shm, libX11-xcb and libX11 that we call.
struct Xcb {
  Library core{"libxcb.so.1"};
  Library shm{"libxcb-shm.so.0"};
  Library x11{"libX11-xcb.so.1"};
  Library xlib{"libX11.so.6"};
  bool usable = false;
  bool shm_usable = false;

  decltype(xcb_connect)* connect;
  decltype(xcb_disconnect)* disconnect;
  decltype(xcb_get_geometry)* get_geometry;
  decltype(xcb_get_geometry_reply)* get_geometry_reply;
  decltype(xcb_generate_id)* generate_id;
  decltype(xcb_create_gc)* create_gc;
  decltype(xcb_free_gc)* free_gc;
  decltype(xcb_put_image)* put_image;
  decltype(xcb_flush)* flush;
  decltype(xcb_get_input_focus)* get_input_focus;
  decltype(xcb_get_input_focus_reply)* get_input_focus_reply;
  decltype(xcb_get_maximum_request_length)* get_maximum_request_length;
  decltype(xcb_get_extension_data)* get_extension_data;
  decltype(xcb_request_check)* request_check;
  decltype(xcb_connection_has_error)* connection_has_error;
  decltype(xcb_get_setup)* get_setup;
  decltype(xcb_setup_roots_iterator)* setup_roots_iterator;
  decltype(xcb_screen_next)* screen_next;
  decltype(xcb_screen_allowed_depths_iterator)* screen_allowed_depths_iterator;
  decltype(xcb_depth_next)* depth_next;
  decltype(xcb_depth_visuals_iterator)* depth_visuals_iterator;
  decltype(xcb_visualtype_next)* visualtype_next;
  xcb_extension_t* shm_id;
  decltype(xcb_shm_attach_checked)* shm_attach_checked;
  decltype(xcb_shm_detach)* shm_detach;
  decltype(xcb_shm_put_image)* shm_put_image;
  xcb_connection_t* (*get_xcb_connection)(void* display);
  bool xlib_usable = false;
  char* (*display_string)(void* display);
  int (*sync)(void* display, int discard);

  Xcb() {
    usable = core.find("xcb_connect", connect) && core.find("xcb_disconnect", disconnect) &&
             core.find("xcb_get_geometry", get_geometry) && core.find("xcb_get_geometry_reply", get_geometry_reply) &&
             core.find("xcb_generate_id", generate_id) && core.find("xcb_create_gc", create_gc) &&
             core.find("xcb_free_gc", free_gc) && core.find("xcb_put_image", put_image) &&
             core.find("xcb_flush", flush) && core.find("xcb_get_input_focus", get_input_focus) &&
             core.find("xcb_get_input_focus_reply", get_input_focus_reply) &&
             core.find("xcb_get_maximum_request_length", get_maximum_request_length) &&
             core.find("xcb_get_extension_data", get_extension_data) && core.find("xcb_request_check", request_check) &&
             core.find("xcb_connection_has_error", connection_has_error) && core.find("xcb_get_setup", get_setup) &&
             core.find("xcb_setup_roots_iterator", setup_roots_iterator) && core.find("xcb_screen_next", screen_next) &&
             core.find("xcb_screen_allowed_depths_iterator", screen_allowed_depths_iterator) &&
             core.find("xcb_depth_next", depth_next) &&
             core.find("xcb_depth_visuals_iterator", depth_visuals_iterator) &&
             core.find("xcb_visualtype_next", visualtype_next);
    shm_usable = usable && shm.find("xcb_shm_id", shm_id) && shm.find("xcb_shm_attach_checked", shm_attach_checked) &&
                 shm.find("xcb_shm_detach", shm_detach) && shm.find("xcb_shm_put_image", shm_put_image);
    x11.find("XGetXCBConnection", get_xcb_connection);
    xlib_usable = xlib.find("XDisplayString", display_string) && xlib.find("XSync", sync);
  }
};

Xcb& xcb() {
  static Xcb instance;
  return instance;
}

/// Held while a thread waits for a reply: libxcb 1.15 may loop for ever, with its lock held, when the server dies while
/// several threads wait.
std::mutex waiting;

/// While it lives, what this thread writes to a server that has died raises no SIGPIPE, which ends a process that does
/// not expect it (libxcb writes without MSG_NOSIGNAL).
class NoBrokenPipe {
 public:
  explicit NoBrokenPipe(xcb_connection_t* connection) : connection_(connection) {
    sigemptyset(&pipe_);
    sigaddset(&pipe_, SIGPIPE);
    pthread_sigmask(SIG_BLOCK, &pipe_, &before_);
  }
  ~NoBrokenPipe() {
    if (sigismember(&before_, SIGPIPE)) return;  // the application's
    const timespec now{};
    if (xcb().connection_has_error(connection_)) sigtimedwait(&pipe_, nullptr, &now);
    pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  }
  NoBrokenPipe(const NoBrokenPipe&) = delete;
  NoBrokenPipe& operator=(const NoBrokenPipe&) = delete;

 private:
  xcb_connection_t* connection_;
  sigset_t pipe_{}, before_{};
};

/// A System V segment that client and server share; unusable (data == null) when the server is elsewhere.
class SharedSegment {
 public:
  SharedSegment(xcb_connection_t* connection, std::size_t bytes) : connection_(connection) {
    const int id = shmget(IPC_PRIVATE, bytes, IPC_CREAT | 0600);
    if (id < 0) return;
    void* address = shmat(id, nullptr, 0);
    if (address != reinterpret_cast<void*>(-1)) {
      const std::lock_guard one_waits(waiting);
      segment_ = xcb().generate_id(connection);
      xcb_generic_error_t* error = xcb().request_check(
          connection, xcb().shm_attach_checked(connection, segment_, static_cast<std::uint32_t>(id), 1));
      if (error) {
        std::free(error);
        shmdt(address);
      } else {
        data_ = static_cast<std::byte*>(address);
        size_ = bytes;
      }
    }
    shmctl(id, IPC_RMID, nullptr);  // both attachments keep it alive
  }
  ~SharedSegment() {
    if (!data_) return;
    xcb().shm_detach(connection_, segment_);
    xcb().flush(connection_);
    shmdt(data_);
  }
  SharedSegment(const SharedSegment&) = delete;
  SharedSegment& operator=(const SharedSegment&) = delete;

  std::byte* data() const { return data_; }
  std::size_t size() const { return size_; }
  xcb_shm_seg_t segment() const { return segment_; }

 private:
  xcb_connection_t* connection_;
  std::byte* data_ = nullptr;
  std::size_t size_ = 0;
  xcb_shm_seg_t segment_ = 0;
};

class XcbWindow final : public Window {
 public:
  XcbWindow(xcb_connection_t* connection, xcb_window_t window) : connection_(connection), window_(window) {}

  ~XcbWindow() override {
    if (gc_ == 0 || xcb().connection_has_error(connection_)) return;
    const NoBrokenPipe guard(connection_);
    segment_.reset();
    xcb().free_gc(connection_, gc_);
    xcb().flush(connection_);
  }

  VkResult extent(VkExtent2D& extent) override {
    const NoBrokenPipe guard(connection_);
    std::uint8_t depth;
    return geometry(extent, depth);
  }

  VkResult present(const Frame& frame, bool) override {
    const NoBrokenPipe guard(connection_);
    VkExtent2D size;
    std::uint8_t depth;
    if (const VkResult result = geometry(size, depth); result != VK_SUCCESS) return result;
    if (depth != 24 && depth != 32) return VK_ERROR_SURFACE_LOST_KHR;
    const bool same_size = size.width == frame.extent.width && size.height == frame.extent.height;
    if (!same_size) return VK_ERROR_OUT_OF_DATE_KHR;
    if (gc_ == 0) {
      gc_ = xcb().generate_id(connection_);
      const std::uint32_t no_exposures = 0;
      xcb().create_gc(connection_, gc_, window_, XCB_GC_GRAPHICS_EXPOSURES, &no_exposures);
    }
    if (!put_shared(frame, depth)) put_through_socket(frame, depth);
    // A round trip: afterwards the server has read the pixels.
    const std::lock_guard one_waits(waiting);
    if (!xcb().connection_has_error(connection_))
      std::free(xcb().get_input_focus_reply(connection_, xcb().get_input_focus(connection_), nullptr));
    return xcb().connection_has_error(connection_) ? VK_ERROR_SURFACE_LOST_KHR : VK_SUCCESS;
  }

 private:
  VkResult geometry(VkExtent2D& extent, std::uint8_t& depth) {
    const std::lock_guard one_waits(waiting);
    if (xcb().connection_has_error(connection_)) return VK_ERROR_SURFACE_LOST_KHR;
    xcb_get_geometry_reply_t* reply =
        xcb().get_geometry_reply(connection_, xcb().get_geometry(connection_, window_), nullptr);
    if (!reply) return VK_ERROR_SURFACE_LOST_KHR;
    extent = {reply->width, reply->height};
    depth = reply->depth;
    std::free(reply);
    return VK_SUCCESS;
  }

  bool put_shared(const Frame& frame, std::uint8_t depth) {
    if (!xcb().shm_usable || shm_refused_) return false;
    const std::size_t pitch = std::size_t{frame.extent.width} * 4;
    const std::size_t bytes = pitch * frame.extent.height;
    if (!segment_ || segment_->size() < bytes) {
      const xcb_query_extension_reply_t* extension = xcb().get_extension_data(connection_, xcb().shm_id);
      segment_.reset();
      if (extension && extension->present) segment_ = std::make_unique<SharedSegment>(connection_, bytes);
      shm_refused_ = !segment_ || !segment_->data();
      if (shm_refused_) return false;
    }
    copy_to_bgra(frame, segment_->data(), pitch);
    const auto width = static_cast<std::uint16_t>(frame.extent.width);
    const auto height = static_cast<std::uint16_t>(frame.extent.height);
    xcb().shm_put_image(connection_, window_, gc_, width, height, 0, 0, width, height, 0, 0, depth,
                        XCB_IMAGE_FORMAT_Z_PIXMAP, 0, segment_->segment(), 0);
    return true;
  }

  void put_through_socket(const Frame& frame, std::uint8_t depth) {
    const std::size_t pitch = std::size_t{frame.extent.width} * 4;
    staging_.resize(pitch * frame.extent.height);
    copy_to_bgra(frame, staging_.data(), pitch);
    const std::size_t request_bytes = std::size_t{xcb().get_maximum_request_length(connection_)} * 4 - 64;
    const std::size_t rows_per_request = std::max<std::size_t>(1, std::min<std::size_t>(request_bytes / pitch, 0xffff));
    for (std::size_t y = 0; y < frame.extent.height; y += rows_per_request) {
      const std::size_t rows = std::min<std::size_t>(rows_per_request, frame.extent.height - y);
      xcb().put_image(connection_, XCB_IMAGE_FORMAT_Z_PIXMAP, window_, gc_,
                      static_cast<std::uint16_t>(frame.extent.width), static_cast<std::uint16_t>(rows), 0,
                      static_cast<std::int16_t>(y), 0, depth, static_cast<std::uint32_t>(rows * pitch),
                      reinterpret_cast<const std::uint8_t*>(staging_.data() + y * pitch));
    }
  }

  xcb_connection_t* connection_;
  xcb_window_t window_;
  xcb_gcontext_t gc_ = 0;
  std::unique_ptr<SharedSegment> segment_;
  bool shm_refused_ = false;
  std::vector<std::byte> staging_;
};

/// Connections of our own to the servers of Xlib displays, one a server, for systems without libX11-xcb (a bare Debian
/// 11 with vulkan-tools): there Xlib does not give out its own.
class OwnConnections {
 public:
  ~OwnConnections() {
    for (const auto& [name, connection] : connections_) xcb().disconnect(connection);
  }

  /// Null: none can be made.
  xcb_connection_t* to_server_of(void* display) {
    if (!xcb().xlib_usable) return nullptr;
    xcb().sync(display, 0);  // what the application has asked for there exists, its window too
    const std::lock_guard lock(mutex_);
    const char* const name = xcb().display_string(display);
    const auto known = connections_.find(name);
    if (known != connections_.end() && !xcb().connection_has_error(known->second)) return known->second;
    xcb_connection_t* const made = xcb().connect(name, nullptr);
    if (xcb().connection_has_error(made)) {
      xcb().disconnect(made);
      return nullptr;
    }
    return connections_[name] = made;  // in place of a dead one, which windows may still hold
  }

 private:
  std::mutex mutex_;
  std::map<std::string, xcb_connection_t*> connections_;
};

xcb_connection_t* connection_of(void* display) {
  static OwnConnections& own = base::lasting([] { return OwnConnections(); });
  if (!xcb().usable) return nullptr;
  return xcb().get_xcb_connection ? xcb().get_xcb_connection(display) : own.to_server_of(display);
}

bool visual_fits(const xcb_visualtype_t& visual) {
  return visual.red_mask == 0xff0000 && visual.green_mask == 0xff00 && visual.blue_mask == 0xff;
}

}  // namespace

std::unique_ptr<Window> open_xcb_window(xcb_connection_t* connection, std::uint32_t window) {
  if (!xcb().usable) return nullptr;
  return std::make_unique<XcbWindow>(connection, window);
}

std::unique_ptr<Window> open_xlib_window(void* display, std::uint32_t window) {
  xcb_connection_t* const connection = connection_of(display);
  return connection ? open_xcb_window(connection, window) : nullptr;
}

bool xcb_presentation_supported(xcb_connection_t* connection, std::uint32_t visual) {
  if (!xcb().usable || xcb().connection_has_error(connection)) return false;
  for (auto screen = xcb().setup_roots_iterator(xcb().get_setup(connection)); screen.rem; xcb().screen_next(&screen)) {
    for (auto depth = xcb().screen_allowed_depths_iterator(screen.data); depth.rem; xcb().depth_next(&depth)) {
      if (depth.data->depth != 24 && depth.data->depth != 32) continue;
      for (auto type = xcb().depth_visuals_iterator(depth.data); type.rem; xcb().visualtype_next(&type)) {
        if (type.data->visual_id == visual) return visual_fits(*type.data);
      }
    }
  }
  return false;
}

bool xlib_presentation_supported(void* display, std::uint32_t visual) {
  xcb_connection_t* const connection = connection_of(display);
  return connection && xcb_presentation_supported(connection, visual);
}

}  // namespace vitrine::icd::wsi
