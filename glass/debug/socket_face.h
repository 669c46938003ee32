// The engine's face at the end of a socket: lines of JSON both ways. What comes in is not trusted; when the other end
// goes away, the application goes on.
//
//   to us    {"id": 1, "request": "command", "text": "print x"}          glass/debug/requests.h
//   from us  {"id": 1, "text": "x = 3\n", "going": false}
//            {"event": "stopped", "reason": "breakpoint", "text": ...}
//            {"event": "running"}, {"event": "output", "text": ...}
#pragma once

#include <atomic>
#include <condition_variable>
#include <deque>
#include <string>
#include <thread>

#include "glass/debug/engine.h"

namespace vitrine::glass::debug {

/// A socket of the file system; -1: nobody listens there.
int connect_to(const char* path);

class SocketFace : public Face {
 public:
  /// Takes the socket over.
  explicit SocketFace(int socket) : socket_(socket) {}
  ~SocketFace() override;
  SocketFace(const SocketFace&) = delete;
  SocketFace& operator=(const SocketFace&) = delete;

  /// From now on requests are answered: before anything runs.
  void listen(Engine& engine);
  void stopped(Engine& engine, const Stop& stop, std::unique_lock<std::mutex>& lock) override;
  void output(const std::string& text) override;

 private:
  void read(Engine& engine);
  void take(Engine& engine, std::string line);
  void answer(Engine& engine, const std::string& line);
  void send(std::string line);

  int socket_;
  std::thread reader_;
  std::condition_variable changed_;
  std::deque<std::string> lines_;  ///< that came while the shader is stopped
  bool stopped_ = false;
  bool closed_ = false;
};

}  // namespace vitrine::glass::debug
