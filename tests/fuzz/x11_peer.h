// An X server that misbehaves.
#pragma once

#include "tests/fuzz/peer.h"

namespace vitrine::fuzz {

/// Knows what the driver asks of a server: the X Window System Protocol, version 11, its encoding, with MIT-SHM and
/// BIG-REQUESTS. Every number is a window. Gives no reply to a request that has none: libxcb ends the process.
class X11Peer final : public Peer {
 public:
  using Peer::Peer;

 private:
  bool serve() override;
  bool greet();
  bool answer_request(std::uint8_t opcode, std::uint8_t data, std::span<const std::byte> body);
  Message reply(std::uint8_t data) const;
  bool geometry();
  bool extension(std::span<const std::byte> body);
  /// A reply, or what the choices make of it.
  bool send(Message reply);
  bool send_error();
  bool send_event();
  /// Behind a request that has no reply.
  bool say_something();

  bool greeted_ = false;
  std::uint16_t sequence_ = 0;
  std::uint16_t answered_ = 0;  ///< the request with the last reply
  std::uint8_t opcode_ = 0;
  std::uint16_t width_ = 64, height_ = 48;
  std::uint8_t depth_ = 24;
};

}  // namespace vitrine::fuzz
