// Which draws and dispatches of this process become bug files (VITRINE_CAPTURE), those that have been captured and may
// still be wanted, and the writing. icd/ captures (icd/replay/captured_replay.h).
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "glass/bug/bug.h"
#include "glass/finding.h"

namespace vitrine::glass::bug {

/// "2:7,finding,lost", "all".
struct Request {
  bool all = false;                                            ///< every draw and dispatch
  bool findings = false;                                       ///< commands of which a tool finds something
  bool losses = false;                                         ///< the one that loses the device
  std::set<std::pair<std::uint64_t, std::uint32_t>> commands;  ///< submission, command
  std::vector<std::string> unknown;                            ///< words that are none of this
};
Request parse_request(const char* text);

/// Any thread; devices are told apart by `owner`.
class Captures {
 public:
  explicit Captures(Request request) : request_(std::move(request)) {}

  /// Whether a command may become a file.
  bool wants(std::uint64_t submission, std::uint32_t command) const {
    return request_.all || request_.findings || request_.losses || request_.commands.contains({submission, command});
  }
  /// A command is about to run, with what it reads. Until it is done() the caller may add to it.
  void begin(const void* owner, std::unique_ptr<Bug> bug);
  void done(const void* owner);
  /// A tool has found something in a command of the submission that is about to end.
  void found(const void* owner, const Finding& finding);
  /// The device is lost, in the command that is running if one is.
  void lost(const void* owner, const std::string& reason) noexcept;
  /// The submission is done: files are written, the rest is forgotten.
  void end_submission(const void* owner) noexcept;
  /// Why a command is not captured, on stderr, once a reason.
  void refuse(std::uint64_t submission, std::uint32_t command, const std::string& reason);
  /// The file of the command that lost this device; empty: there is none.
  std::string file_of_loss(const void* owner) const;

 private:
  struct Owned {
    std::vector<std::unique_ptr<Bug>> kept;  ///< of this submission, in order
    bool running = false;                    ///< the last one
    std::string loss;
    std::uint64_t bytes = 0;
  };
  bool is_wanted(const Bug& bug) const;
  void write(const Bug& bug, const std::string& contents);

  const Request request_;
  std::uint64_t files_ = 0;
  mutable std::mutex mutex_;
  std::map<const void*, Owned> owners_;
  std::set<std::string> written_, refused_;
};

/// Null: nobody asked. Lives until the process ends.
Captures* captures();

}  // namespace vitrine::glass::bug
