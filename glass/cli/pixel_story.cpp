// Which events explain a pixel: its own, and those of the texels it came from, up to when they were read.
#include <algorithm>
#include <map>

#include "glass/cli/pixel_history.h"

namespace vitrine::glass::cli {
namespace {

/// Chapters of a story: more than that nobody reads.
constexpr std::size_t kMostChapters = 200;

using Events = std::vector<PixelEvent>;

bool names(const std::string& wanted, const PixelImage& image) {
  if (wanted == "swapchain") return image.swapchain;
  if (!image.name.empty() && image.name == wanted) return true;
  return wanted.starts_with('#') && wanted.substr(1) == std::to_string(image.number);
}

bool is_asked(const PixelHistory& history, const PixelQuestion& question, const TexelKey& key) {
  const PixelImage* image = history.image(key.image);
  return image && names(question.image, *image) && key.x == question.x && key.y == question.y &&
         key.level == question.level && key.layer == question.layer && key.slice == question.slice &&
         (!question.sample || key.sample == *question.sample) &&
         (question.aspect.empty() || question.aspect == key.aspect);
}

/// The last of events [0, end) that replaces whatever was there; 0: none does.
std::size_t last_start(const Events& events, std::size_t end) {
  while (end > 0 && !events[end - 1].replaces) --end;
  return end > 0 ? end - 1 : 0;
}

/// Behind the event that presents a frame; nothing: the texel's image was not presented then.
std::optional<std::size_t> end_of_frame(const Events& events, std::uint64_t frame) {
  for (std::size_t i = events.size(); i-- > 0;)
    if (events[i].kind == "present" && (frame == 0 || events[i].frame == frame)) return i + 1;
  return std::nullopt;
}

std::uint64_t last_frame(const PixelHistory& history, const PixelQuestion& question) {
  std::uint64_t last = 0;
  for (const PixelTexel& texel : history.texels)
    if (is_asked(history, question, texel.key))
      for (const PixelEvent& event : texel.events)
        if (event.kind == "present") last = std::max(last, event.frame);
  return last;
}

void take(const Events& events, std::size_t first, std::size_t end, PixelChapter& chapter) {
  for (std::size_t i = first; i < end; ++i) chapter.events.push_back(&events[i]);
}

std::string label_at(std::size_t number) {
  std::string label;
  for (++number; number > 0; number = (number - 1) / 26)
    label.insert(label.begin(), static_cast<char>('a' + (number - 1) % 26));
  return label;
}

/// The bytes at the end of a value: views may show them in another format.
std::string_view bytes_of(std::string_view value) {
  const std::size_t at = value.rfind("0x");
  return at == std::string_view::npos ? value : value.substr(at);
}

/// What a chapter says but for where its texels are.
std::string gist_of(const PixelChapter& chapter) {
  std::string gist = std::to_string(chapter.key.image) + chapter.key.aspect + std::to_string(chapter.key.level);
  const auto add = [&](const std::string& text) { gist.append(text).append("\n"); };
  for (const PixelEvent* event : chapter.events) {
    add(event->kind + event->text + event->before + event->after);
    add(std::to_string(event->address.submission) + "," + std::to_string(event->address.command));
    for (const auto& [name, value] : event->facts)
      if (name != "window coordinates") add(name + value);
    for (const PixelSource& source : event->sources)
      add(std::to_string(source.texel.image) + "," + std::to_string(source.texel.level) + source.value);
  }
  return gist;
}

class Teller {
 public:
  Teller(const PixelHistory& history, const PixelQuestion& question) : history_(history), question_(question) {}

  PixelStory tell() {
    const std::uint64_t frame = question_.frame != 0 ? question_.frame : last_frame(history_, question_);
    for (const PixelTexel& texel : history_.texels)
      if (is_asked(history_, question_, texel.key)) begin(texel, frame);
    std::size_t first = 0;
    for (unsigned depth = 0; depth < question_.depth; ++depth) {
      const std::size_t end = story_.chapters.size();
      for (std::size_t i = first; i < end; ++i) follow(i);
      first = end;
    }
    return std::move(story_);
  }

 private:
  /// The chapter of a pixel that was asked for.
  void begin(const PixelTexel& texel, std::uint64_t frame) {
    PixelChapter chapter{texel.key, "", &texel, {}, "", false, ""};
    const std::optional<std::size_t> end = frame != 0 ? end_of_frame(texel.events, frame) : std::nullopt;
    const PixelImage* image = history_.image(texel.key.image);
    if (image->swapchain && frame != 0 && !end) return;
    if (end) {
      std::size_t first = *end - 1;
      while (first > 0 && texel.events[first - 1].frame == frame) --first;
      if (!texel.events[first].replaces) first = last_start(texel.events, first + 1);
      take(texel.events, first, *end, chapter);
    } else {
      take(texel.events, 0, texel.events.size(), chapter);
    }
    story_.chapters.push_back(std::move(chapter));
  }

  /// The sources of a chapter's events.
  void follow(std::size_t number) {
    if (!story_.chapters[number].like.empty()) return;
    const std::vector<const PixelEvent*> events = story_.chapters[number].events;
    for (const PixelEvent* event : events)
      for (const PixelSource& source : event->sources) add(*event, source);
  }

  void add(const PixelEvent& event, const PixelSource& source) {
    if (!history_.find(source.texel)) {
      if (std::ranges::find(story_.missing, source.texel) == story_.missing.end())
        story_.missing.push_back(source.texel);
      return;
    }
    PixelChapter chapter = chapter_of(event, source);
    const auto same = std::ranges::find_if(story_.chapters, [&](const PixelChapter& c) {
      return !c.label.empty() && c.key == chapter.key && c.events == chapter.events;
    });
    if (same != story_.chapters.end()) {
      story_.labels.push_back({&event, {source.texel, same->label}});
    } else if (story_.chapters.size() >= kMostChapters) {
      story_.cut = true;
    } else {
      chapter.label = label_at(labelled_++);
      const auto [told, first] = gists_.try_emplace(gist_of(chapter), chapter.label);
      if (!first && !chapter.events.empty() && !chapter.differs) chapter.like = told->second;
      story_.labels.push_back({&event, {source.texel, chapter.label}});
      story_.chapters.push_back(std::move(chapter));
    }
  }

  /// What made a source what it was when an event read it.
  PixelChapter chapter_of(const PixelEvent& event, const PixelSource& source) const {
    const PixelTexel* texel = history_.find(source.texel);
    PixelChapter chapter{source.texel, "", texel, {}, source.value, false, ""};
    const Events& events = texel->events;
    std::size_t end = 0;
    const auto read = source.read.first != 0 ? source.read : event.place();
    while (end < events.size() && events[end].place() < read) ++end;
    while (end > 0 && events[end - 1].kind == "present") --end;
    take(events, last_start(events, end), end, chapter);
    chapter.differs = !source.value.empty() && !chapter.events.empty() && !chapter.value().empty() &&
                      bytes_of(chapter.value()) != bytes_of(source.value);
    return chapter;
  }

  const PixelHistory& history_;
  const PixelQuestion& question_;
  PixelStory story_;
  std::size_t labelled_ = 0;
  std::map<std::string, std::string> gists_;  ///< labels of the chapters that said it first
};

}  // namespace

std::string PixelChapter::value() const {
  for (std::size_t i = events.size(); i-- > 0;)
    if (!events[i]->after.empty()) return events[i]->after;
  return {};
}

std::string PixelStory::label_of(const PixelEvent& event, const TexelKey& source) const {
  for (const auto& [at, told] : labels)
    if (at == &event && told.first == source) return told.second;
  return {};
}

PixelStory tell(const PixelHistory& history, const PixelQuestion& question) { return Teller(history, question).tell(); }

}  // namespace vitrine::glass::cli
