// When what ran: spans of time by thread, as Chrome trace events (docs/glass/timeline.md). Where nobody asked for a
// timeline a Span is a test of a pointer; spans stand around what takes long: submissions, pipelines, waits.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>

namespace vitrine::glass {

using TimelineClock = std::chrono::steady_clock;

/// Whether somebody asked for a timeline.
bool has_timeline();

/// Adds a span of this thread, or of the track of debug labels. Throws nothing: what finds no memory is left out.
enum class TimelineTrack : std::uint8_t { kThread, kLabels };
void add_to_timeline(TimelineTrack track, const char* category, std::string_view name, std::string_view detail,
                     TimelineClock::time_point begin, TimelineClock::time_point end) noexcept;

/// From its making to its end.
class Span {
 public:
  Span(const char* category, const char* name) : category_(has_timeline() ? category : nullptr), name_(name) {
    if (category_) begin_ = TimelineClock::now();
  }
  ~Span() {
    if (category_) add_to_timeline(TimelineTrack::kThread, category_, name_, detail_, begin_, TimelineClock::now());
  }
  Span(const Span&) = delete;
  Span& operator=(const Span&) = delete;

  /// Worth describing.
  bool on() const { return category_ != nullptr; }
  void describe(std::string detail) { detail_ = std::move(detail); }

 private:
  const char* category_;  ///< null: off
  const char* name_;
  std::string detail_;
  TimelineClock::time_point begin_;
};

}  // namespace vitrine::glass
