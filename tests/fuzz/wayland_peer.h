// A Wayland compositor that misbehaves.
#pragma once

#include <map>
#include <string_view>
#include <vector>

#include "tests/fuzz/peer.h"

namespace vitrine::fuzz {

/// Knows what the driver and peer_run.cpp ask of a compositor: wl_display, wl_registry, wl_compositor, wl_surface,
/// wl_shm with its pools and buffers (wayland.xml). Behaves until a surface has been made.
class WaylandPeer final : public Peer {
 public:
  using Peer::Peer;

 private:
  enum class Kind : std::uint8_t { kDisplay, kRegistry, kCompositor, kSurface, kShm, kPool, kBuffer };

  bool serve() override;
  bool give_withheld() override;
  bool answer(std::uint32_t object, std::uint16_t opcode, std::span<const std::byte> body);
  bool display(std::uint16_t opcode, std::uint32_t made);
  bool surface(std::uint16_t opcode, std::uint32_t argument);
  bool globals(std::uint32_t registry);
  bool global(std::uint32_t registry, std::uint32_t name, std::string_view interface, std::uint32_t version);
  bool bound(std::span<const std::byte> body);
  bool commit();
  /// An event, behind what misbehave() adds.
  bool event(std::uint32_t object, std::uint16_t opcode, const Message& body);
  bool send(std::uint32_t object, std::uint16_t opcode, const Message& body);
  bool forget(std::uint32_t object);
  bool release(std::uint32_t buffer) { return event(buffer, 0, {}); }
  /// A wl_callback has happened, which ends it.
  bool done(std::uint32_t callback);
  bool misbehave();

  std::map<std::uint32_t, Kind> objects_{{1, Kind::kDisplay}};
  std::uint32_t registry_ = 0;  ///< the one made last
  std::uint32_t attached_ = 0;
  std::vector<std::uint32_t> held_;     ///< buffers
  std::vector<std::uint32_t> awaited_;  ///< callbacks of frames
  bool behaves_ = true;
};

}  // namespace vitrine::fuzz
