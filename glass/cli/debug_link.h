// The other end of the debugger's socket: the process whose shaders may be stopped. Lines of JSON
// (glass/debug/requests.h).
#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace vitrine::glass::cli {

/// One process.
class DebugLink {
 public:
  explicit DebugLink(int socket) : socket_(socket) {}
  ~DebugLink();
  DebugLink(const DebugLink&) = delete;
  DebugLink& operator=(const DebugLink&) = delete;

  int socket() const { return socket_; }
  /// The next line; waits for it. Nothing: the process has ended.
  std::optional<nlohmann::json> receive();
  /// Takes what has come; false: the process has ended.
  bool fill();
  /// A whole line of what has been taken.
  std::optional<nlohmann::json> next();
  /// Asks something, waits for the answer; events that come meanwhile go to `events`.
  std::optional<nlohmann::json> ask(nlohmann::json request, const std::function<void(const nlohmann::json&)>& events);

 private:
  int socket_;
  int last_id_ = 0;
  std::string text_;
};

/// A socket of the file system that processes connect to; -1: it cannot be made.
int listen_at(const std::filesystem::path& path);

}  // namespace vitrine::glass::cli
