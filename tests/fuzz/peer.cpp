// The sockets and the thread of a peer.
#include "tests/fuzz/peer.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>

#include "tests/fuzz/driver.h"

namespace vitrine::fuzz {
namespace {

/// File descriptors that came with the bytes are closed.
ssize_t receive(int socket, void* data, std::size_t bytes) {
  alignas(cmsghdr) std::array<char, CMSG_SPACE(28 * sizeof(int))> control;
  iovec part{data, bytes};
  msghdr message{};
  message.msg_iov = &part;
  message.msg_iovlen = 1;
  message.msg_control = control.data();
  message.msg_controllen = control.size();
  const ssize_t count = recvmsg(socket, &message, MSG_CMSG_CLOEXEC);
  if (count <= 0) return count;
  for (cmsghdr* header = CMSG_FIRSTHDR(&message); header; header = CMSG_NXTHDR(&message, header)) {
    if (header->cmsg_level != SOL_SOCKET || header->cmsg_type != SCM_RIGHTS) continue;
    for (std::size_t at = CMSG_LEN(0); at + sizeof(int) <= header->cmsg_len; at += sizeof(int)) {
      int file;
      std::memcpy(&file, reinterpret_cast<const char*>(header) + at, sizeof file);
      close(file);
    }
  }
  return count;
}

}  // namespace

Peer::Peer(std::span<const std::uint8_t> choices) : c_(choices) {
  int ends[2];
  demand(socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) == 0, "a pair of sockets");
  server_ = ends[0];
  client_ = ends[1];
}

void Peer::start() {
  thread_ = std::thread([this] {
    while (serve()) {
    }
    close(server_);
  });
}

bool Peer::read(void* data, std::size_t bytes) {
  constexpr int kPatience = 100;  // milliseconds
  constexpr int kMostSilent = 10;
  int silent = 0;
  auto* at = static_cast<std::byte*>(data);
  while (bytes > 0) {
    pollfd wanted{server_, POLLIN, 0};
    if (poll(&wanted, 1, kPatience) == 0) {
      if (!give_withheld() && (odd_ || ++silent > kMostSilent)) return false;
      continue;
    }
    const ssize_t count = receive(server_, at, bytes);
    if (count <= 0) return false;
    at += count;
    bytes -= static_cast<std::size_t>(count);
  }
  return true;
}

bool Peer::skip(std::size_t bytes) {
  std::array<std::byte, 4096> unread;
  while (bytes > 0) {
    const std::size_t part = std::min(bytes, unread.size());
    if (!read(unread.data(), part)) return false;
    bytes -= part;
  }
  return true;
}

bool Peer::write(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t count = send(server_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (count <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
  return true;
}

}  // namespace vitrine::fuzz
