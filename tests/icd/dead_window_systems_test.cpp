// Window systems that hang up while a window is open. A server is what it has written into a socket.
#include <sys/socket.h>
#include <unistd.h>
#include <wayland-client.h>
#include <xcb/xcb.h>

#include <cerrno>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "icd/wsi/window.h"

namespace vitrine::icd::wsi {
namespace {

/// A socket whose other end is a client's.
class Server {
 public:
  Server() { EXPECT_EQ(socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends_), 0); }
  ~Server() { hang_up(); }
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  int client_end() const { return ends_[1]; }
  void wait_for(std::size_t bytes) {
    std::string heard(bytes, 0);
    EXPECT_EQ(recv(ends_[0], heard.data(), bytes, MSG_WAITALL), static_cast<ssize_t>(bytes));
  }
  void say(const std::string& bytes) {
    EXPECT_EQ(write(ends_[0], bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
  }
  /// As a server that dies after the client library has seen it alive: what is written raises SIGPIPE.
  void stop_reading() { EXPECT_EQ(shutdown(ends_[0], SHUT_RD), 0); }
  void hang_up() {
    if (ends_[0] >= 0) close(ends_[0]);
    ends_[0] = -1;
  }

 private:
  int ends_[2]{-1, -1};
};

template <class... T>
std::string bytes_of(T... values) {
  std::string bytes;
  (bytes.append(reinterpret_cast<const char*>(&values), sizeof values), ...);
  return bytes;
}

using Byte = std::uint8_t;
using Half = std::uint16_t;
using Word = std::uint32_t;

/// What an X server greets with (X11 protocol, "Connection Setup"): one screen, no visuals.
std::string x11_greeting() {
  const std::string rest = bytes_of(Word{0}, Word{0x200000}, Word{0x1fffff}, Word{0}, Half{0}, Half{65535}, Byte{1},
                                    Byte{0}, Byte{0}, Byte{0}, Byte{32}, Byte{32}, Byte{8}, Byte{255}, Word{0});
  const std::string screen = bytes_of(Word{1}, Word{2}, Word{0xffffff}, Word{0}, Word{0}, Half{64}, Half{48}, Half{17},
                                      Half{13}, Half{1}, Half{1}, Word{33}, Byte{0}, Byte{0}, Byte{24}, Byte{0});
  const auto words = static_cast<Half>((rest.size() + screen.size()) / 4);
  return bytes_of(Byte{1}, Byte{0}, Half{11}, Half{0}, words) + rest + screen;
}

TEST(DeadX11Server, LosesTheSurfaceAndNotTheProcess) {
  Server server;
  std::thread greeter([&server] {
    server.wait_for(12);  // a client without authorization
    server.say(x11_greeting());
  });
  xcb_connection_t* const connection = xcb_connect_to_fd(server.client_end(), nullptr);
  greeter.join();
  ASSERT_EQ(xcb_connection_has_error(connection), 0);
  const std::unique_ptr<Window> window = open_xcb_window(connection, 77);
  ASSERT_NE(window, nullptr);
  server.stop_reading();
  VkExtent2D extent{};
  EXPECT_EQ(window->extent(extent), VK_ERROR_SURFACE_LOST_KHR);
  EXPECT_EQ(window->present({}, true), VK_ERROR_SURFACE_LOST_KHR);
  EXPECT_FALSE(xcb_presentation_supported(connection, 33));
  xcb_disconnect(connection);
}

constexpr Word kOwnRegistry = 2, kCompositor = 3, kSurface = 4, kRegistry = 5, kRoundTrip = 6;

/// A message of Wayland ("Wire Format").
std::string event(Word object, Half opcode, const std::string& body) {
  return bytes_of(object, opcode, static_cast<Half>(8 + body.size())) + body;
}

std::string global(Word name, std::string interface, Word version) {
  const auto length = static_cast<Word>(interface.size() + 1);
  interface.resize((length + 3) / 4 * 4);
  return bytes_of(name, length) + interface + bytes_of(version);
}

class DeadWaylandCompositor : public ::testing::Test {
 protected:
  void SetUp() override {
    display = wl_display_connect_to_fd(server.client_end());
    ASSERT_NE(display, nullptr);
    registry = wl_display_get_registry(display);
    compositor = static_cast<wl_compositor*>(wl_registry_bind(registry, 1, &wl_compositor_interface, 4));
    surface = wl_compositor_create_surface(compositor);
    const auto id = [](auto* proxy) { return wl_proxy_get_id(reinterpret_cast<wl_proxy*>(proxy)); };
    ASSERT_EQ(id(registry), kOwnRegistry);
    ASSERT_EQ(id(compositor), kCompositor);
    ASSERT_EQ(id(surface), kSurface);
    server.say(event(kRegistry, 0, global(2, "wl_shm", 1)) + event(kRoundTrip, 0, bytes_of(Word{0})));
    window = open_wayland_window(display, surface);
    ASSERT_NE(window, nullptr);
    EXPECT_EQ(window->present(frame, true), VK_SUCCESS);
  }
  void TearDown() override {
    server.hang_up();
    for (const bool wait_for_display : {true, false}) {
      EXPECT_EQ(window->present(frame, wait_for_display), VK_ERROR_SURFACE_LOST_KHR);
    }
    window.reset();
    EXPECT_EQ(open_wayland_window(display, surface), nullptr);
    wl_surface_destroy(surface);
    wl_compositor_destroy(compositor);
    wl_registry_destroy(registry);
    wl_display_disconnect(display);
  }

  Server server;
  wl_display* display = nullptr;
  wl_registry* registry = nullptr;
  wl_compositor* compositor = nullptr;
  wl_surface* surface = nullptr;
  std::unique_ptr<Window> window;
  const Word pixel = 0;
  const Frame frame{reinterpret_cast<const std::byte*>(&pixel), 4, {1, 1}, false};
};

TEST_F(DeadWaylandCompositor, LosesTheSurfaceAfterAnUnknownEvent) {
  server.say(event(kRegistry, 99, {}));  // libwayland sets no errno, and remembers what it was
  errno = EAGAIN;
  EXPECT_EQ(window->present(frame, true), VK_ERROR_SURFACE_LOST_KHR);
}

TEST_F(DeadWaylandCompositor, LosesTheSurfaceInTheMiddleOfAMessage) {
  server.say(bytes_of(Half{1}));
  server.hang_up();
  EXPECT_EQ(window->present(frame, true), VK_ERROR_SURFACE_LOST_KHR);
}

TEST_F(DeadWaylandCompositor, OpensNoWindowInTheMiddleOfAMessage) {
  server.say(bytes_of(Half{1}));
  server.hang_up();
  EXPECT_EQ(open_wayland_window(display, surface), nullptr);
}

}  // namespace
}  // namespace vitrine::icd::wsi
