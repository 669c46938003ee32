// See x11_peer.h.
#include "tests/fuzz/x11_peer.h"

#include <algorithm>
#include <string_view>
#include <vector>

namespace vitrine::fuzz {
namespace {

enum : std::uint8_t {
  kGetGeometry = 14,
  kGetInputFocus = 43,
  kQueryExtension = 98,
  kShm = 130,  // as this server numbers its extensions
  kBigRequests = 133,
};

constexpr std::uint8_t kDepths[] = {24, 32, 24, 16, 8, 1, 0, 255};
constexpr std::uint16_t kSides[] = {64, 48, 1, 7, 0, 200, 16384, 16385, 65535};

}  // namespace

bool X11Peer::greet() {
  struct Client {
    std::uint8_t order, unused;
    std::uint16_t major, minor, name, data, pad;
  } client{};
  if (!read(&client, sizeof client)) return false;
  const auto padded = [](std::size_t bytes) { return (bytes + 3) / 4 * 4; };
  if (!skip(padded(client.name) + padded(client.data))) return false;

  depth_ = c_.of(kDepths);
  Message screen;
  screen.add(std::uint32_t{1}).add(std::uint32_t{2}).add(0xffffffu).add(0u).add(0u);  // root, colormap, white, black
  screen.add(std::uint16_t{1024}).add(std::uint16_t{768}).zeros(4).add(std::uint16_t{1}).add(std::uint16_t{1});
  screen.add(std::uint32_t{33}).zeros(2).add(depth_).add(std::uint8_t{1});  // visual of the root, one depth
  const auto visuals = static_cast<std::uint16_t>(c_.below(3));
  screen.add(depth_).zeros(1).add(visuals).zeros(4);
  for (std::uint32_t i = 0; i < visuals; ++i) {
    const std::uint32_t red = c_.one_in(4) ? c_.hostile() : 0xff0000u;
    screen.add(33 + i).add(std::uint8_t{4}).add(std::uint8_t{8}).add(std::uint16_t{256});
    screen.add(red).add(0xff00u).add(0xffu).zeros(4);
  }

  Message rest;
  rest.add(0u).add(0x200000u).add(0x1fffffu).add(0u);                   // release, identifiers, motion buffer
  rest.add(std::uint16_t{0});                                           // vendor
  constexpr std::uint16_t kLongest[] = {65535, 4096, 64, 32};           // with less libxcb waits for its own lock
  rest.add(c_.of(kLongest)).add(std::uint8_t{1}).add(std::uint8_t{1});  // screens, formats
  rest.add(std::uint8_t{0}).add(std::uint8_t{0}).add(std::uint8_t{32}).add(std::uint8_t{32});
  rest.add(std::uint8_t{8}).add(std::uint8_t{255}).zeros(4);
  rest.add(depth_).add(std::uint8_t{32}).add(std::uint8_t{32}).zeros(5);

  Message setup;
  const auto words = static_cast<std::uint16_t>((rest.size() + screen.size()) / 4);
  setup.add(std::uint8_t{1}).zeros(1).add(std::uint16_t{11}).add(std::uint16_t{0}).add(words);
  return write(setup.bytes()) && write(rest.bytes()) && write(screen.bytes());
}

bool X11Peer::serve() {
  if (!greeted_) {
    greeted_ = true;
    return greet();
  }
  struct Request {
    std::uint8_t opcode, data;
    std::uint16_t words;
  } request{};
  if (!read(&request, sizeof request)) return false;
  std::uint32_t words = request.words;
  std::uint32_t head = 1;
  if (words == 0) {
    if (!read(&words, sizeof words)) return false;
    head = 2;
  }
  if (words < head) return false;
  ++sequence_;
  opcode_ = request.opcode;
  std::vector<std::byte> body(std::min<std::size_t>(std::size_t{words - head} * 4, 64));
  if (!read(body.data(), body.size()) || !skip(std::size_t{words - head} * 4 - body.size())) return false;
  return answer_request(request.opcode, request.data, body);
}

bool X11Peer::answer_request(std::uint8_t opcode, std::uint8_t data, std::span<const std::byte> body) {
  switch (opcode) {
    case kGetGeometry:
      return geometry();
    case kGetInputFocus:
      return send(reply(1));
    case kQueryExtension:
      return extension(body);
    case kBigRequests: {
      Message longest = reply(0);
      constexpr std::uint32_t kLongest[] = {0x3fffff, 0x10000, 4096, 1, 0, 0xffffffff};
      longest.put(8, c_.of(kLongest));
      return send(longest);
    }
    case kShm:
      if (data == 0) return send(reply(1));  // its version
      return c_.one_in(4) ? send_error() : say_something();
    default:
      return say_something();
  }
}

Message X11Peer::reply(std::uint8_t data) const {
  Message message;
  message.add(std::uint8_t{1}).add(data).add(sequence_).zeros(28);
  return message;
}

bool X11Peer::geometry() {
  if (c_.one_in(8)) {
    width_ = c_.of(kSides);
    height_ = c_.of(kSides);
  }
  if (c_.one_in(16)) depth_ = c_.of(kDepths);
  Message message = reply(depth_);
  message.put(8, 1u);
  message.put(16, width_);
  message.put(18, height_);
  return send(message);
}

bool X11Peer::extension(std::span<const std::byte> body) {
  const std::span<const std::byte> text = body.subspan(std::min<std::size_t>(4, body.size()));
  const std::size_t length = std::min<std::size_t>(number_at<std::uint16_t>(body, 0), text.size());
  const std::string_view name(reinterpret_cast<const char*>(text.data()), length);
  Message message = reply(0);
  message.put(8, static_cast<std::uint8_t>(c_.one_in(4) ? 0 : 1));
  message.put(9, name == "MIT-SHM" ? +kShm : +kBigRequests);
  return send(message);
}

bool X11Peer::send(Message message) {
  switch (c_.below(24)) {
    case 0:
      return send_error();
    case 1:  // any byte but the length's, which would make the client wait for gigabytes
      be_odd();
      message.put(8 + c_.below(24), static_cast<std::uint8_t>(c_.below(256)));
      break;
    case 2:
      message.put(4, c_.between(1, 40));
      message.zeros(std::size_t{number_at<std::uint32_t>(message.bytes(), 4)} * 4);
      break;
    case 3:
      be_odd();
      message.put(2, answered_);
      break;
    case 4:
      be_odd();
      return write(message.bytes().first(c_.below(32)));
    case 5:
      be_odd();
      if (!write(message.bytes())) return false;
      break;
    case 6:
      return false;
    case 7:
      if (!send_event()) return false;
      break;
    default:
      break;
  }
  answered_ = sequence_;
  return write(message.bytes());
}

bool X11Peer::send_error() {
  Message message;
  message.add(std::uint8_t{0}).add(static_cast<std::uint8_t>(c_.below(256))).add(sequence_).add(c_.hostile());
  message.zeros(2).add(opcode_).zeros(21);
  return write(message.bytes());
}

bool X11Peer::send_event() {
  Message message;
  const auto code = static_cast<std::uint8_t>(c_.between(2, 255));
  message.add(code).add(static_cast<std::uint8_t>(c_.below(256))).add(sequence_);
  for (int i = 0; i < 7; ++i) message.add(c_.hostile());
  if ((code & 0x7f) == 35) message.put(4, 0u);  // a generic event says how much follows
  return write(message.bytes());
}

bool X11Peer::say_something() {
  switch (c_.below(16)) {
    case 0:
      return send_error();
    case 1:
      return send_event();
    case 2:
      return !c_.one_in(3);
    default:
      return true;
  }
}

}  // namespace vitrine::fuzz
