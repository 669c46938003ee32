// See debug_wire.h.
#include "glass/cli/debug_wire.h"

#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <charconv>
#include <string_view>

#include "glass/debug/socket_io.h"

namespace vitrine::glass::cli {

using nlohmann::json;

namespace {

constexpr std::size_t kLongestHeader = 4096, kLongestBody = std::size_t{1} << 24;
constexpr std::string_view kLength = "Content-Length: ";

}  // namespace

int listen_on_loopback(std::uint16_t& port) {
  const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (socket < 0) return -1;
  const int on = 1;
  ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &on, sizeof(on));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof(address);
  if (::bind(socket, reinterpret_cast<const sockaddr*>(&address), size) == 0 && ::listen(socket, 4) == 0 &&
      ::getsockname(socket, reinterpret_cast<sockaddr*>(&address), &size) == 0) {
    port = ntohs(address.sin_port);
    return socket;
  }
  ::close(socket);
  return -1;
}

DapWire::~DapWire() { ::close(socket_); }

bool DapWire::fill() { return debug::append_received(socket_, text_); }

std::optional<json> DapWire::next() {
  const std::size_t end = text_.find("\r\n\r\n");
  if (end == std::string::npos) {
    broken_ |= text_.size() > kLongestHeader || (!text_.empty() && text_[0] != 'C');
    return std::nullopt;
  }
  const std::string_view header = std::string_view(text_).substr(0, end);
  const std::size_t at = header.find(kLength);
  std::size_t length = 0;
  if (at != std::string_view::npos) {
    const char* const begin = header.data() + at + kLength.size();
    std::from_chars(begin, header.data() + header.size(), length);
  }
  if (length == 0 || length > kLongestBody) {
    broken_ = true;
    return std::nullopt;
  }
  if (text_.size() - end - 4 < length) return std::nullopt;
  json message = json::parse(text_.substr(end + 4, length), nullptr, false);
  text_.erase(0, end + 4 + length);
  broken_ = !message.is_object();
  return broken_ ? std::nullopt : std::optional<json>(std::move(message));
}

void DapWire::send(json message) {
  message["seq"] = ++sequence_;
  const std::string body = message.dump(-1, ' ', false, json::error_handler_t::replace);
  debug::send_whole(socket_, std::string(kLength).append(std::to_string(body.size())).append("\r\n\r\n").append(body));
}

}  // namespace vitrine::glass::cli
