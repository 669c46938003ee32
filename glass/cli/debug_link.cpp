// See debug_link.h.
#include "glass/cli/debug_link.h"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstring>

#include "glass/debug/socket_io.h"

namespace vitrine::glass::cli {

using nlohmann::json;

DebugLink::~DebugLink() { ::close(socket_); }

bool DebugLink::fill() { return debug::append_received(socket_, text_); }

std::optional<json> DebugLink::next() {
  const std::size_t end = text_.find('\n');
  if (end == std::string::npos) return std::nullopt;
  json message = json::parse(text_.substr(0, end), nullptr, false);
  text_.erase(0, end + 1);
  return message.is_object() ? std::move(message) : json::object();
}

std::optional<json> DebugLink::receive() {
  for (;;) {
    if (auto message = next()) return message;
    if (!fill()) return std::nullopt;
  }
}

std::optional<json> DebugLink::ask(json request, const std::function<void(const json&)>& events) {
  const int id = ++last_id_;
  request["id"] = id;
  const std::string line = request.dump(-1, ' ', false, json::error_handler_t::replace) + "\n";
  if (!debug::send_whole(socket_, line)) return std::nullopt;
  while (auto message = receive()) {
    if (message->value("id", 0) == id) return message;
    events(*message);
  }
  return std::nullopt;
}

int listen_at(const std::filesystem::path& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.string().size() >= sizeof(address.sun_path)) return -1;
  std::strcpy(address.sun_path, path.c_str());
  const int socket = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (socket < 0) return -1;
  if (::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0 && ::listen(socket, 16) == 0)
    return socket;
  ::close(socket);
  return -1;
}

}  // namespace vitrine::glass::cli
