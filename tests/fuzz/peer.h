// Window systems that misbehave: a server in a thread of its own at the other end of a client library's socket, which
// answers as choices say. It lies about sizes and depths, withholds, repeats, interrupts with what nobody asked for,
// reports errors, cuts messages off, hangs up.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <thread>

#include "tests/fuzz/choices.h"

namespace vitrine::fuzz {

/// Bytes of a message, little-endian as the client's.
class Message {
 public:
  template <class T>
  Message& add(T value) {
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
    return *this;
  }
  Message& zeros(std::size_t count) {
    bytes_.append(count, '\0');
    return *this;
  }
  /// At bytes that are there.
  template <class T>
  void put(std::size_t at, T value) {
    std::memcpy(bytes_.data() + at, &value, sizeof value);
  }
  std::size_t size() const { return bytes_.size(); }
  std::span<const std::byte> bytes() const { return std::as_bytes(std::span(bytes_)); }

 private:
  std::string bytes_;
};

/// The number at a byte; 0 where it is not all there.
template <class T>
T number_at(std::span<const std::byte> bytes, std::size_t at) {
  T value{};
  if (at + sizeof value <= bytes.size()) std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

class Peer {
 public:
  explicit Peer(std::span<const std::uint8_t> choices);
  virtual ~Peer() = default;
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;

  /// For the client library, which closes it.
  int client_end() const { return client_; }
  void start();
  /// Once the client has closed its end. Before the peer is destroyed.
  void join() { thread_.join(); }

 protected:
  /// Answers one message of the client; false: hangs up.
  virtual bool serve() = 0;
  /// Nothing has come for a tenth of a second: what was withheld is given. False: there was nothing.
  virtual bool give_withheld() { return false; }

  /// False: the client has gone, or was waited for long enough.
  bool read(void* data, std::size_t bytes);
  bool skip(std::size_t bytes);
  bool write(std::span<const std::byte> bytes);
  /// The client may wait for what never comes, so this side hangs up when nothing happens.
  void be_odd() { odd_ = true; }

  Choices c_;

 private:
  int server_ = -1, client_ = -1;
  bool odd_ = false;
  std::thread thread_;
};

}  // namespace vitrine::fuzz
