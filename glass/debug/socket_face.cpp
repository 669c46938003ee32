// See socket_face.h.
#include "glass/debug/socket_face.h"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstring>
#include <nlohmann/json.hpp>

#include "glass/debug/requests.h"
#include "glass/debug/socket_io.h"

namespace vitrine::glass::debug {
namespace {

/// A line that is longer is rubbish.
constexpr std::size_t kLongestLine = std::size_t{1} << 22;

}  // namespace

int connect_to(const char* path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (std::strlen(path) >= sizeof(address.sun_path)) return -1;
  std::strcpy(address.sun_path, path);
  const int socket = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (socket < 0) return -1;
  if (::connect(socket, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0) return socket;
  ::close(socket);
  return -1;
}

SocketFace::~SocketFace() {
  ::shutdown(socket_, SHUT_RDWR);
  if (reader_.joinable()) reader_.join();
  ::close(socket_);
}

void SocketFace::listen(Engine& engine) {
  send(nlohmann::json{{"event", "hello"}, {"process", ::getpid()}}.dump());
  reader_ = std::thread([this, &engine] { read(engine); });
}

void SocketFace::read(Engine& engine) {
  std::string text;
  while (text.size() <= kLongestLine && append_received(socket_, text)) {
    std::size_t begin = 0;
    for (std::size_t end = 0; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1)
      take(engine, text.substr(begin, end - begin));
    text.erase(0, begin);
  }
  const std::unique_lock lock(engine.mutex());
  closed_ = true;
  if (!stopped_) engine.go({Motion::Kind::kDetach, false});
  changed_.notify_all();
}

void SocketFace::take(Engine& engine, std::string line) {
  const std::unique_lock lock(engine.mutex());
  if (!stopped_) return answer(engine, line);
  lines_.push_back(std::move(line));
  changed_.notify_all();
}

void SocketFace::answer(Engine& engine, const std::string& line) { send(answer_to(engine, line, stopped_)); }

void SocketFace::stopped(Engine& engine, const Stop& stop, std::unique_lock<std::mutex>& lock) {
  stopped_ = true;
  send(describe(engine, stop));
  while (!engine.going()) {
    changed_.wait(lock, [&] { return closed_ || !lines_.empty(); });
    if (closed_) {
      engine.go({Motion::Kind::kDetach, false});
      break;
    }
    const std::string line = std::move(lines_.front());
    lines_.pop_front();
    answer(engine, line);
  }
  stopped_ = false;
  send(nlohmann::json{{"event", "running"}}.dump());
  for (; !lines_.empty(); lines_.pop_front()) answer(engine, lines_.front());
}

void SocketFace::output(const std::string& text) {
  send(nlohmann::json{{"event", "output"}, {"text", text}}.dump(-1, ' ', false,
                                                                nlohmann::json::error_handler_t::replace));
}

void SocketFace::send(std::string line) {
  line += '\n';
  send_whole(socket_, line);
}

}  // namespace vitrine::glass::debug
