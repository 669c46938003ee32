// The Debug Adapter Protocol's transport: "Content-Length: N", an empty line, N bytes of JSON, over TCP on the loopback
// interface.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace vitrine::glass::cli {

/// A listening socket at 127.0.0.1; -1: the port is in use, or is none. `port`: 0: any; then the one it got.
int listen_on_loopback(std::uint16_t& port);

/// One client.
class DapWire {
 public:
  explicit DapWire(int socket) : socket_(socket) {}
  ~DapWire();
  DapWire(const DapWire&) = delete;
  DapWire& operator=(const DapWire&) = delete;

  int socket() const { return socket_; }
  /// Takes what has come; false: the client is gone.
  bool fill();
  /// A whole message of what has been taken. Rubbish closes the connection: broken().
  std::optional<nlohmann::json> next();
  bool broken() const { return broken_; }
  /// Numbers the message and sends it.
  void send(nlohmann::json message);

 private:
  int socket_;
  int sequence_ = 0;
  bool broken_ = false;
  std::string text_;
};

}  // namespace vitrine::glass::cli
