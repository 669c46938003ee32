// Times of commands, of passes and of debug labels.
#include "icd/replay/timed_replay.h"

#include <string_view>

#include "glass/timeline.h"
#include "icd/record/command_buffer.h"
#include "icd/replay/observed_replay.h"

namespace vitrine::icd {
namespace {

using Clock = glass::TimelineClock;
using glass::TimelineTrack;

struct OpenLabel {
  std::string name;
  Clock::time_point begin;
};

class TimedReplay {
 public:
  TimedReplay(ReplayState& state, void (*run)(ReplayState&, const CommandHeader&)) : state_(state), run_(run) {}

  /// Labels that are still open end with the buffer here.
  ~TimedReplay() {
    while (!labels_.empty()) end_label();
  }

  void step(const CommandHeader& header) {
    const auto type = static_cast<CommandType>(header.type);
    if (type == kCommandType<CmdBeginLabel>) {
      const auto& label = *static_cast<const CmdBeginLabel*>(header.command());
      labels_.push_back({std::string(label.name.data(), label.name.size()), Clock::now()});
    }
    if (is_for_observers(type))
      run_(state_, header);
    else
      work(header);
    if (type == kCommandType<CmdEndLabel>) end_label();
  }

 private:
  void work(const CommandHeader& header) {
    const bool had_pass = state_.pass.has_value();
    const std::string_view name = state_.observed->name;
    const Clock::time_point begin = Clock::now();
    run_(state_, header);
    if (state_.pass) flush_pass(state_);
    const Clock::time_point end = Clock::now();
    if (!had_pass && state_.pass) pass_begin_ = begin;
    if (is_work(name)) add("command", name, "command " + std::to_string(state_.observed->command), begin, end);
    if (had_pass && !state_.pass) add("pass", "pass", "", pass_begin_, end);
  }

  void end_label() {
    if (labels_.empty()) return;
    glass::add_to_timeline(TimelineTrack::kLabels, "label", labels_.back().name, "", labels_.back().begin,
                           Clock::now());
    labels_.pop_back();
  }

  static void add(const char* category, std::string_view name, const std::string& detail, Clock::time_point begin,
                  Clock::time_point end) {
    glass::add_to_timeline(TimelineTrack::kThread, category, name, detail, begin, end);
  }

  ReplayState& state_;
  void (*run_)(ReplayState&, const CommandHeader&);
  std::vector<OpenLabel> labels_;
  Clock::time_point pass_begin_ = Clock::now();
};

}  // namespace

bool is_for_observers(CommandType type) {
  return type == kCommandType<CmdMark> || type == kCommandType<CmdBeginLabel> || type == kCommandType<CmdEndLabel> ||
         type == kCommandType<CmdInsertLabel> || type == kCommandType<CmdDependency> ||
         type == kCommandType<CmdUsedLayouts>;
}

bool is_work(std::string_view name) {
  for (const std::string_view prefix : {"vkCmdBind", "vkCmdSet", "vkCmdPush", "vkCmdExecute"})
    if (name.starts_with(prefix)) return false;
  return true;
}

void replay_timed(ReplayState& state, const CommandBuffer& buffer, void (*run)(ReplayState&, const CommandHeader&)) {
  TimedReplay timed(state, run);
  for (const CommandHeader* header = buffer.arena.first(); header; header = header->next) {
    timed.step(*header);
    if (state.fault.raised.load(std::memory_order_relaxed)) return;
  }
}

}  // namespace vitrine::icd
