// The timeline of this process. Written to VITRINE_TIMELINE ("%p" is the process; default timeline.json).
#include "glass/timeline.h"

#include <pthread.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <mutex>
#include <nlohmann/json.hpp>
#include <vector>

#include "base/loop_watch.h"
#include "glass/output.h"
#include "glass/tools.h"

namespace vitrine::glass {
namespace {

using Json = nlohmann::ordered_json;

struct Event {
  std::uint32_t track;
  const char* category;
  std::string name, detail;
  TimelineClock::time_point begin, end;
};

double microseconds(TimelineClock::duration duration) {
  return std::chrono::duration<double, std::micro>(duration).count();
}

std::string name_of_this_thread() {
  char name[16] = {};
  pthread_getname_np(pthread_self(), name, sizeof name);
  return name;
}

class Timeline {
 public:
  void add(TimelineTrack track, const char* category, std::string_view name, std::string_view detail,
           TimelineClock::time_point begin, TimelineClock::time_point end) {
    const std::lock_guard lock(mutex_);
    const std::uint32_t number = track == TimelineTrack::kLabels ? kLabelTrack : track_of_this_thread();
    events_.push_back({number, category, std::string(name), std::string(detail), begin, end});
  }

  std::string json() const;

 private:
  static constexpr std::uint32_t kLabelTrack = 0;

  /// Threads are numbered as they come.
  std::uint32_t track_of_this_thread() {
    static thread_local std::uint32_t track = 0;
    if (track == 0) {
      threads_.push_back(name_of_this_thread());
      track = static_cast<std::uint32_t>(threads_.size());
    }
    return track;
  }

  mutable std::mutex mutex_;
  std::vector<Event> events_;
  std::vector<std::string> threads_;  ///< by track, less one
  const TimelineClock::time_point start_ = TimelineClock::now();
};

Json name_track(const char* what, std::uint32_t track, const std::string& name) {
  return {{"ph", "M"}, {"pid", ::getpid()}, {"tid", track}, {"name", what}, {"args", {{"name", name}}}};
}

std::string Timeline::json() const {
  const std::lock_guard lock(mutex_);
  std::vector<const Event*> ordered;
  for (const Event& event : events_) ordered.push_back(&event);
  // Outer spans first where several begin together.
  std::stable_sort(ordered.begin(), ordered.end(), [](const Event* a, const Event* b) {
    return a->begin != b->begin ? a->begin < b->begin : a->end > b->end;
  });
  Json events =
      Json::array({name_track("process_name", 0, "Vitrine"), name_track("thread_name", kLabelTrack, "labels")});
  for (std::uint32_t i = 0; i < threads_.size(); ++i) events.push_back(name_track("thread_name", i + 1, threads_[i]));
  for (const Event* event : ordered) {
    Json json{{"ph", "X"},
              {"pid", ::getpid()},
              {"tid", event->track},
              {"cat", event->category},
              {"name", event->name},
              {"ts", microseconds(event->begin - start_)},
              {"dur", microseconds(event->end - event->begin)}};
    if (!event->detail.empty()) json["args"]["detail"] = event->detail;
    events.push_back(std::move(json));
  }
  const Json document{{"displayTimeUnit", "ms"}, {"traceEvents", std::move(events)}};
  return document.dump(0, ' ', false, Json::error_handler_t::replace) + '\n';
}

/// Of the process, once somebody has asked; lives until its end.
std::atomic<Timeline*> asked_for{nullptr};

void watch_loop(TimelineClock::time_point begin, TimelineClock::time_point end, std::size_t items) {
  add_to_timeline(TimelineTrack::kThread, "work", "work", std::to_string(items) + " items", begin, end);
}

/// Watches no shader and no draw.
class TimelineTool : public Tool {
 public:
  TimelineTool() {
    if (!asked_for.load()) asked_for = new Timeline;
    base::set_loop_watch(&watch_loop);
  }
  spirv::exec::Interest interest() const override { return {}; }
  std::shared_ptr<ProgramTool> attach(const ShaderIdentity&, const spirv::Program&) override { return nullptr; }
  void write() override { write_output("VITRINE_TIMELINE", "timeline.json", asked_for.load()->json()); }
};

}  // namespace

bool has_timeline() { return asked_for.load(std::memory_order_relaxed) != nullptr; }

void add_to_timeline(TimelineTrack track, const char* category, std::string_view name, std::string_view detail,
                     TimelineClock::time_point begin, TimelineClock::time_point end) noexcept {
  Timeline* timeline = asked_for.load();
  if (!timeline) return;
  try {
    timeline->add(track, category, name, detail, begin, end);
  } catch (const std::bad_alloc&) {
    // Left out.
  }
}

std::unique_ptr<Tool> make_timeline() { return std::make_unique<TimelineTool>(); }

}  // namespace vitrine::glass
