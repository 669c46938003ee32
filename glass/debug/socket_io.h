// Reading from and writing to the debugger's sockets.
#pragma once

#include <sys/socket.h>

#include <string>
#include <string_view>

namespace vitrine::glass::debug {

/// Appends what has come; waits for something. False: the other end is gone.
inline bool append_received(int socket, std::string& text) {
  char part[4096];
  const ssize_t count = ::recv(socket, part, sizeof(part), 0);
  if (count <= 0) return false;
  text.append(part, static_cast<std::size_t>(count));
  return true;
}

/// Sends all of it. False: the other end is gone.
inline bool send_whole(int socket, std::string_view text) {
  while (!text.empty()) {
    const ssize_t count = ::send(socket, text.data(), text.size(), MSG_NOSIGNAL);
    if (count <= 0) return false;
    text.remove_prefix(static_cast<std::size_t>(count));
  }
  return true;
}

}  // namespace vitrine::glass::debug
