// See wayland_peer.h. Requests and events are numbered in the order of their interface in wayland.xml.
#include "tests/fuzz/wayland_peer.h"

#include <algorithm>
#include <utility>

namespace vitrine::fuzz {
namespace {

std::uint32_t word(std::span<const std::byte> body, std::size_t index) {
  return number_at<std::uint32_t>(body, index * 4);
}

void add_text(Message& message, std::string_view text) {
  message.add(static_cast<std::uint32_t>(text.size() + 1));
  for (const char c : text) message.add(c);
  message.zeros(4 - text.size() % 4);
}

}  // namespace

bool WaylandPeer::serve() {
  struct Head {
    std::uint32_t object;
    std::uint16_t opcode, size;
  } head{};
  if (!read(&head, sizeof head) || head.size < sizeof head) return false;
  std::vector<std::byte> body(head.size - sizeof head);
  return read(body.data(), body.size()) && answer(head.object, head.opcode, body);
}

bool WaylandPeer::answer(std::uint32_t object, std::uint16_t opcode, std::span<const std::byte> body) {
  const std::uint32_t first = word(body, 0);
  const auto known = objects_.find(object);
  if (known == objects_.end()) return true;
  switch (known->second) {
    case Kind::kDisplay:
      return display(opcode, first);
    case Kind::kRegistry:
      return bound(body);
    case Kind::kCompositor:
      objects_[first] = Kind::kSurface;
      behaves_ = false;
      return true;
    case Kind::kSurface:
      return surface(opcode, first);
    case Kind::kShm:
      objects_[first] = Kind::kPool;
      return true;
    case Kind::kPool:
      if (opcode == 1) return forget(object);
      objects_[first] = Kind::kBuffer;
      return true;
    case Kind::kBuffer:
      std::erase(held_, object);
      return forget(object);
  }
  return true;
}

bool WaylandPeer::display(std::uint16_t opcode, std::uint32_t made) {
  if (opcode == 0) return misbehave() && done(made);
  objects_[made] = Kind::kRegistry;
  registry_ = made;
  return globals(made);
}

bool WaylandPeer::globals(std::uint32_t registry) {
  if (behaves_) return global(registry, 1, "wl_compositor", 4) && global(registry, 2, "wl_shm", 1);
  if (!c_.one_in(8) && !global(registry, 2, "wl_shm", c_.one_in(8) ? c_.hostile() : 1)) return false;
  if (c_.one_in(8) && !global(registry, c_.hostile(), "wl_shm", 1)) return false;
  return !c_.one_in(8) || global(registry, 3, "", 0);
}

bool WaylandPeer::global(std::uint32_t registry, std::uint32_t name, std::string_view interface,
                         std::uint32_t version) {
  Message body;
  body.add(name);
  add_text(body, interface);
  body.add(version);
  return event(registry, 0, body);
}

/// wl_registry.bind: name, interface, version, the new object.
bool WaylandPeer::bound(std::span<const std::byte> body) {
  const std::uint32_t length = word(body, 1);
  if (length == 0 || 8 + std::size_t{length} > body.size()) return false;
  const std::string_view interface(reinterpret_cast<const char*>(body.data()) + 8, length - 1);
  const std::uint32_t made = word(body, body.size() / 4 - 1);
  if (interface == "wl_compositor") {
    objects_[made] = Kind::kCompositor;
    return true;
  }
  objects_[made] = Kind::kShm;
  for (std::uint32_t format = 0; format < 2; ++format) {
    if (!event(made, 0, Message().add(c_.one_in(8) ? c_.hostile() : format))) return false;
  }
  return true;
}

bool WaylandPeer::surface(std::uint16_t opcode, std::uint32_t argument) {
  constexpr std::uint16_t kAttach = 1, kFrame = 3, kCommit = 6;
  if (opcode == kAttach) attached_ = argument;
  if (opcode == kFrame) awaited_.push_back(argument);
  return opcode != kCommit || commit();
}

bool WaylandPeer::commit() {
  if (!misbehave()) return false;
  if (attached_ != 0) held_.push_back(std::exchange(attached_, 0));
  if (c_.one_in(4)) return true;
  return give_withheld() || awaited_.empty();
}

bool WaylandPeer::give_withheld() {
  if (held_.empty() && awaited_.empty()) return false;
  for (const std::uint32_t buffer : std::exchange(held_, {})) {
    if (!release(buffer) || (c_.one_in(8) && !release(buffer))) return false;
  }
  for (const std::uint32_t callback : std::exchange(awaited_, {})) {
    if (!done(callback) || (c_.one_in(8) && !done(callback))) return false;
  }
  return true;
}

bool WaylandPeer::done(std::uint32_t callback) {
  return event(callback, 0, Message().add(c_.hostile())) && forget(callback);
}

bool WaylandPeer::forget(std::uint32_t object) {
  objects_.erase(object);
  return send(1, 1, Message().add(object));
}

bool WaylandPeer::event(std::uint32_t object, std::uint16_t opcode, const Message& body) {
  return misbehave() && send(object, opcode, body);
}

bool WaylandPeer::send(std::uint32_t object, std::uint16_t opcode, const Message& body) {
  Message message;
  message.add(object).add(opcode).add(static_cast<std::uint16_t>(8 + body.size()));
  return write(message.bytes()) && write(body.bytes());
}

/// Something that no compositor says, in one of many cases.
bool WaylandPeer::misbehave() {
  if (behaves_) return true;
  switch (c_.below(64)) {
    case 0: {  // wl_display.error
      Message error;
      error.add(c_.one_in(2) ? registry_ : c_.hostile()).add(c_.hostile());
      add_text(error, "no");
      return send(1, 0, error);
    }
    case 1:  // an event of whatever object
      be_odd();
      return send(c_.below(16), static_cast<std::uint16_t>(c_.below(4)), Message().add(c_.hostile()).add(c_.hostile()));
    case 2: {  // a message that is longer or shorter than it says
      be_odd();
      Message message;
      message.add(c_.below(16)).add(std::uint16_t{0}).add(static_cast<std::uint16_t>(c_.below(64)));
      return write(message.bytes());
    }
    case 3:  // an identifier is free that is not
      be_odd();
      return send(1, 1, Message().add(c_.below(16)));
    case 4:
      return global(registry_, c_.hostile(), "wl_shm", c_.hostile());
    case 5:  // wl_registry.global_remove
      return send(registry_, 1, Message().add(c_.below(4)));
    case 6:
      return false;
    case 7: {  // a text without its end
      be_odd();
      return send(registry_, 0, Message().add(1u).add(c_.hostile()).add(c_.hostile()).add(1u));
    }
    default:
      return true;
  }
}

}  // namespace vitrine::fuzz
