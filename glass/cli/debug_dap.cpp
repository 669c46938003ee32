// vitrine debug --dap: waits for an editor, runs the application when the editor wants it, and carries messages between
// the two. Whatever the editor does, the application goes on.
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <charconv>
#include <chrono>
#include <future>

#include "glass/cli/application.h"
#include "glass/cli/debug.h"
#include "glass/cli/debug_adapter.h"
#include "glass/cli/files.h"
#include "glass/cli/say.h"

namespace vitrine::glass::cli {
namespace {

constexpr std::chrono::milliseconds kPatience{500};

/// Everything that the face's thread waits for.
class Server {
 public:
  Server(int editors, int processes, int ended) : editors_(editors), processes_(processes), ended_(ended) {}

  /// Whether the application is to run, once that is known.
  std::promise<void> start;
  int code = 0;  ///< of the application, when it has ended

  void serve() {
    for (;;) {
      pollfd waited[] = {{editors_, POLLIN, 0},
                         {processes_, POLLIN, 0},
                         {ended_, POLLIN, 0},
                         {wire_ ? wire_->socket() : -1, POLLIN, 0},
                         {link_ ? link_->socket() : -1, POLLIN, 0}};
      if (::poll(waited, std::size(waited), -1) < 0) continue;
      if (waited[4].revents != 0) hear_process();
      if (waited[3].revents != 0) hear_editor();
      if (waited[0].revents != 0) take_editor();
      if (waited[1].revents != 0) take_process();
      // Questions to the process may have brought more than their answers.
      tell_editor();
      if (waited[2].revents == 0) continue;
      if (adapter_) adapter_->ended(code);
      return take_leave();
    }
  }

 private:
  /// The application has ended: the editor says that it leaves, too, and may wait for the answer. One that says nothing
  /// is not waited for.
  void take_leave() {
    const auto until = std::chrono::steady_clock::now() + kPatience;
    while (wire_) {
      const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - std::chrono::steady_clock::now());
      pollfd waited{wire_->socket(), POLLIN, 0};
      if (left.count() <= 0 || ::poll(&waited, 1, static_cast<int>(left.count())) <= 0) return;
      hear_editor();
    }
  }

  /// One editor at a time, and none when the application has run without one.
  void take_editor() {
    const int socket = ::accept4(editors_, nullptr, nullptr, SOCK_CLOEXEC);
    if (socket < 0) return;
    if (wire_ || started_) {
      ::close(socket);
      return;
    }
    wire_ = std::make_unique<DapWire>(socket);
    adapter_ = std::make_unique<DebugAdapter>(*wire_);
  }

  /// One process at a time: others run by themselves.
  void take_process() {
    const int socket = ::accept4(processes_, nullptr, nullptr, SOCK_CLOEXEC);
    if (socket < 0) return;
    if (link_ || !adapter_) {
      ::close(socket);
      return;
    }
    link_ = std::make_unique<DebugLink>(socket);
    adapter_->connect(link_.get());
  }

  void hear_process() {
    if (link_ && !link_->fill()) drop_process();
  }

  void tell_editor() {
    while (auto message = link_ ? link_->next() : std::nullopt) adapter_->told(*message);
  }

  void drop_process() {
    if (adapter_) adapter_->connect(nullptr);
    link_.reset();
  }

  void hear_editor() {
    if (!wire_->fill()) return drop_editor();
    while (auto request = wire_->next()) {
      if (!adapter_->take(*request)) return drop_editor();
      if (!adapter_->wants_start() || started_) continue;
      started_ = true;
      start.set_value();
    }
    if (wire_->broken()) drop_editor();
  }

  /// The process sees the end of its socket and goes on by itself.
  void drop_editor() {
    drop_process();
    adapter_.reset();
    wire_.reset();
  }

  int editors_, processes_, ended_;
  bool started_ = false;
  std::unique_ptr<DapWire> wire_;
  std::unique_ptr<DebugAdapter> adapter_;
  std::unique_ptr<DebugLink> link_;
};

}  // namespace

int debug_with_editor(const DebugOptions& options) {
  std::uint16_t port = 0;
  const char* const end = options.port.data() + options.port.size();
  const auto [stop, error] = std::from_chars(options.port.data(), end, port);
  if (error != std::errc() || stop != end) {
    say("'" + options.port + "' is no port");
    return kCouldNotRun;
  }
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "debug";
  const int editors = listen_on_loopback(port), processes = listen_at(path);
  int ended[2];
  if (editors < 0 || processes < 0 || ::pipe(ended) != 0) {
    say("port " + options.port + " of 127.0.0.1 is not free");
    return kCouldNotRun;
  }
  say("an editor may connect to 127.0.0.1:" + std::to_string(port));
  Server server(editors, processes, ended[0]);
  std::thread face = quiet_thread([&] { server.serve(); });
  server.start.get_future().wait();
  const Ending ending = run_application(options.application, debug_environment(path, options));
  server.code = ending.code;
  ::close(ended[1]);
  face.join();
  for (const int socket : {ended[0], processes, editors}) ::close(socket);
  return ending.code;
}

}  // namespace vitrine::glass::cli
