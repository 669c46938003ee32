// vitrine pixel --bug: the draw or dispatch that made a pixel's value as a bug file (docs/glass/bugfile.md), which one
// more run of the application captures.
#include <algorithm>
#include <filesystem>

#include "glass/cli/application.h"
#include "glass/cli/bug_files.h"
#include "glass/cli/pixel_bug.h"
#include "glass/cli/say.h"

namespace vitrine::glass::cli {
namespace {

const PixelChapter* chapter_of(const PixelStory& story, const std::string& label) {
  const auto at = std::ranges::find(story.chapters, label, &PixelChapter::label);
  return at == story.chapters.end() ? nullptr : &*at;
}

/// Who made the value of a chapter's texel; `left`: how many chapters further it may be.
const PixelEvent* maker_of(const PixelStory& story, const PixelChapter& chapter, std::size_t left) {
  for (auto at = chapter.events.rbegin(); at != chapter.events.rend(); ++at) {
    const PixelEvent& event = **at;
    if (event.kind == "store" || (event.kind == "fragment" && event.fate == "written")) return &event;
    if (event.kind == "fragment" || event.kind == "present") continue;
    // Of several sources the one that weighs most.
    const auto source = std::ranges::max_element(event.sources, {}, &PixelSource::weight);
    if (source == event.sources.end() || left == 0) return nullptr;
    const PixelChapter* next = chapter_of(story, story.label_of(event, source->texel));
    if (next && !next->like.empty()) next = chapter_of(story, next->like);
    return next ? maker_of(story, *next, left - 1) : nullptr;
  }
  return nullptr;
}

}  // namespace

const PixelEvent* maker_of(const PixelStory& story) {
  return story.chapters.empty() ? nullptr : maker_of(story, story.chapters[0], story.chapters.size());
}

bool write_maker(const PixelStory& story, const CommandLine& application, const std::string& file) {
  const PixelEvent* maker = maker_of(story);
  if (!maker) {
    say("no draw or dispatch is known that made the pixel's value: no bug file");
    return false;
  }
  const std::string command = std::to_string(maker->address.submission) + ":" + std::to_string(maker->address.command);
  std::error_code error;
  const std::filesystem::path path = std::filesystem::absolute(file, error);
  std::filesystem::remove(path, error);
  const Ending ending = run_application(application, {{"VITRINE_CAPTURE", command}, {"VITRINE_CAPTURE_FILE", path}});
  if (!ending.error.empty()) return false;
  const std::optional<bug::Bug> bug = std::filesystem::exists(path, error) ? read_bug(path) : std::nullopt;
  if (bug && bug->command_name == maker->address.command_name) return true;
  say("the application does not run the same in every run: command " + command + " is " +
      (bug ? bug->command_name : "not there, or not captured"));
  return false;
}

}  // namespace vitrine::glass::cli
