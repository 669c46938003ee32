// vitrine debug: an application whose shaders stop where somebody wants it; its face is a prompt, or an editor
// (debug_adapter.cpp). The application runs in the thread that called, the face in another.
#include "glass/cli/debug.h"

#include <poll.h>
#include <signal.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <iostream>
#include <mutex>
#include <thread>

#include "glass/cli/application.h"
#include "glass/cli/debug_link.h"
#include "glass/cli/files.h"
#include "glass/cli/say.h"
#include "glass/debug/socket_io.h"

namespace vitrine::glass::cli {
namespace {

using nlohmann::json;

/// Lines that somebody types, or those of a file.
class Prompt {
 public:
  explicit Prompt(const DebugOptions& options) : options_(options), interactive_(::isatty(STDIN_FILENO) != 0) {
    if (!options.script.empty()) script_.open(options.script);
  }

  bool is_readable() const { return options_.script.empty() || script_.is_open(); }

  /// Nothing: there are no more.
  std::optional<std::string> line() {
    std::string text;
    if (script_.is_open() && std::getline(script_, text)) {
      if (!options_.json) std::fputs(("(vitrine) " + text + "\n").c_str(), stdout);
      return text;
    }
    if (!options_.script.empty() && !interactive_) return std::nullopt;
    if (interactive_ && !options_.json) std::fputs("(vitrine) ", stdout);
    std::fflush(stdout);
    if (!std::getline(std::cin, text)) return std::nullopt;
    // An empty line repeats the last one, as debuggers do.
    if (text.empty() && interactive_) return last_;
    return last_ = text;
  }

  void show(const json& message, const std::string& line) {
    if (options_.json) {
      json shown = message;
      shown.erase("id");
      if (!line.empty()) shown["command"] = line;
      std::fputs((shown.dump(-1, ' ', false, json::error_handler_t::replace) + "\n").c_str(), stdout);
    } else if (message.value("event", "") == "stopped" || !message.contains("event")) {
      std::fputs((message.contains("error") ? message.value("error", "") + "\n" : message.value("text", "")).c_str(),
                 stdout);
    } else if (message.value("event", "") == "output") {
      std::fputs((message.value("text", "") + "\n").c_str(), stdout);
    }
    std::fflush(stdout);
  }

 private:
  const DebugOptions& options_;
  bool interactive_;
  std::ifstream script_;
  std::string last_;
};

/// Ctrl-C: the shader that runs stops, or soon one that comes.
class Pausing {
 public:
  /// Of the process that shaders run in; -1: none does.
  void connect(int socket) {
    const std::lock_guard lock(mutex_);
    socket_ = socket;
    state_ = State::kRuns;
  }
  void stopped(bool stopped) {
    const std::lock_guard lock(mutex_);
    state_ = stopped ? State::kStopped : State::kRuns;
  }
  /// Nothing stops any more.
  void detach() {
    const std::lock_guard lock(mutex_);
    socket_ = -1;
  }
  /// False: the application is to end, it does not stop.
  bool interrupt() {
    const std::lock_guard lock(mutex_);
    if (state_ == State::kStopped && socket_ >= 0) {
      std::fputs("\n(the shader waits; detach lets the application go on by itself)\n", stdout);
      std::fflush(stdout);
      return true;
    }
    if (socket_ < 0 || state_ == State::kPausing) return false;
    state_ = State::kPausing;
    return debug::send_whole(socket_, "{\"request\": \"pause\"}\n");
  }

 private:
  enum class State : std::uint8_t { kRuns, kStopped, kPausing };
  std::mutex mutex_;
  int socket_ = -1;
  State state_ = State::kRuns;
};

/// Asks the person until the shader goes on; false: the process has ended.
bool answer_stop(DebugLink& link, Prompt& prompt, Pausing& pausing) {
  for (;;) {
    std::optional<std::string> line = prompt.line();
    if (!line) line = "detach";
    if (*line == "detach" || *line == "quit") pausing.detach();
    const auto answer =
        link.ask({{"request", "command"}, {"text", *line}}, [&](const json& event) { prompt.show(event, ""); });
    if (!answer) return false;
    prompt.show(*answer, *line);
    if (answer->value("going", true)) return true;
  }
}

void follow_link(DebugLink& link, Prompt& prompt, Pausing& pausing) {
  while (const auto message = link.receive()) {
    // Answers without a question of the prompt: to Ctrl-C.
    if (!message->contains("event")) continue;
    const bool stopped = message->value("event", "") == "stopped";
    if (stopped) pausing.stopped(true);
    prompt.show(*message, "");
    if (!stopped) continue;
    if (!answer_stop(link, prompt, pausing)) return;
    pausing.stopped(false);
  }
}

void follow(int socket, Prompt& prompt, Pausing& pausing) {
  DebugLink link(socket);
  pausing.connect(socket);
  follow_link(link, prompt, pausing);
  pausing.connect(-1);
}

void converse(int listener, int ended, Prompt& prompt, Pausing& pausing) {
  for (;;) {
    pollfd waited[] = {{listener, POLLIN, 0}, {ended, POLLIN, 0}};
    if (::poll(waited, 2, -1) < 0) continue;
    if ((waited[0].revents & POLLIN) != 0) {
      if (const int socket = ::accept4(listener, nullptr, nullptr, SOCK_CLOEXEC); socket >= 0)
        follow(socket, prompt, pausing);
      continue;
    }
    if (waited[1].revents != 0) return;
  }
}

}  // namespace

std::thread quiet_thread(std::function<void()> work) {
  sigset_t all, before;
  ::sigfillset(&all);
  ::pthread_sigmask(SIG_SETMASK, &all, &before);
  std::thread thread(std::move(work));
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  return thread;
}

Environment debug_environment(const std::filesystem::path& socket, const DebugOptions& options) {
  Environment environment{{"VITRINE_TOOLS", "debug"}, {"VITRINE_DEBUG", socket}, {"VITRINE_THREADS", "1"}};
  if (options.exact) environment["VITRINE_DEBUG_EXACT"] = "1";
  return environment;
}

int debug(const DebugOptions& options) {
  if (!options.port.empty()) return debug_with_editor(options);
  Prompt prompt(options);
  if (!prompt.is_readable()) {
    say(options.script + " cannot be read");
    return kCouldNotRun;
  }
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "debug";
  const int listener = listen_at(path);
  int ended[2];
  if (folder.path().empty() || listener < 0 || ::pipe(ended) != 0) {
    say("no socket can be made");
    return kCouldNotRun;
  }
  Pausing pausing;
  std::thread face = quiet_thread([&] { converse(listener, ended[0], prompt, pausing); });
  const Ending ending =
      run_application(options.application, debug_environment(path, options), [&] { return pausing.interrupt(); });
  ::close(ended[1]);
  face.join();
  ::close(ended[0]);
  ::close(listener);
  return ending.code;
}

}  // namespace vitrine::glass::cli
