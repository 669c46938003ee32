// A pixel's story as text: a paragraph an event, the first line as compilers write theirs where a shader's line is
// known.
#include <algorithm>

#include "glass/cli/pixel_history.h"

namespace vitrine::glass::cli {
namespace {

std::string weight_text(double weight) {
  if (weight == 0 || weight == 1) return "";
  char text[32];
  std::snprintf(text, sizeof text, ", weight %.4g", weight);
  return text;
}

std::string event_text(const PixelHistory& history, const PixelStory& story, const PixelEvent& event,
                       std::size_t number) {
  std::string text = std::to_string(number);
  text.insert(0, text.size() < 3 ? 3 - text.size() : 0, ' ').append("  ");
  if (!event.address.frames.empty()) text.append(to_text(event.address.frames[0])).append(": ");
  text.append(event.text).append("\n");
  const auto line = [&](const std::string& words) { text.append("     ").append(words).append("\n"); };
  if (!event.address.frames.empty() && !event.address.frames[0].text.empty())
    line(std::to_string(event.address.frames[0].line) + " | " + event.address.frames[0].text);
  if (const std::string address = to_text(event.address); !address.empty()) line("at " + address);
  for (const auto& [name, value] : event.facts) line(name + " " + value);
  for (const PixelSource& source : event.sources) {
    const std::string label = story.label_of(event, source.texel);
    line((label.empty() ? "from " : "from [" + label + "] ") + to_text(history, source.texel) +
         (source.value.empty() ? "" : ": " + source.value) + weight_text(source.weight));
  }
  if (!event.before.empty() && event.before != event.after)
    line(event.before + " -> " + event.after);
  else if (!event.after.empty())
    line("still " + event.after);
  return text;
}

std::string title_of(const PixelHistory& history, const PixelChapter& chapter) {
  std::string text = chapter.label.empty() ? "" : "[" + chapter.label + "] ";
  text += to_text(history, chapter.key);
  if (const PixelImage* image = history.image(chapter.key.image)) {
    text += " (" + image->format;
    for (std::size_t i = 0; i < image->extent.size(); ++i)
      if (i < 2 || image->extent[i] > 1) text += (i == 0 ? ", " : " x ") + std::to_string(image->extent[i]);
    text += ")";
  }
  if (!chapter.value().empty()) text += ": " + chapter.value();
  return text + "\n";
}

}  // namespace

std::string to_text(const PixelHistory& history, const TexelKey& key) {
  std::string text = "texel (" + std::to_string(key.x) + ", " + std::to_string(key.y) + ")";
  const auto add = [&](const char* name, std::uint32_t number) {
    if (number != 0) text.append(", ").append(name).append(" ").append(std::to_string(number));
  };
  add("level", key.level);
  add("layer", key.layer);
  add("slice", key.slice);
  const PixelImage* image = history.image(key.image);
  if (image && image->samples > 1) text.append(", sample ").append(std::to_string(key.sample));
  if (key.aspect != "color") text.append(", ").append(key.aspect);
  text.append(" of ").append(image && image->swapchain ? "swapchain image #" : "image #");
  text.append(std::to_string(key.image));
  if (image && !image->name.empty()) text.append(" '").append(image->name).append("'");
  return text;
}

std::string to_text(const PixelHistory& history, const PixelStory& story) {
  std::string text;
  bool was_brief = false;
  for (const PixelChapter& chapter : story.chapters) {
    const bool brief = !chapter.like.empty();
    text.append(text.empty() || (brief && was_brief) ? "" : "\n").append(title_of(history, chapter));
    was_brief = brief;
    if (brief) {
      text.append("     as [").append(chapter.like).append("]\n");
      continue;
    }
    if (chapter.texel && chapter.texel->dropped != 0)
      text.append("     the oldest ").append(std::to_string(chapter.texel->dropped)).append(" events are left out\n");
    std::size_t number = 0;
    for (const PixelEvent* event : chapter.events) text += event_text(history, story, *event, ++number);
    if (chapter.events.empty()) text += "     nothing touched it before\n";
    if (chapter.differs)
      text.append("     but who read it found ")
          .append(chapter.expected)
          .append(": something that is not followed has written it\n");
  }
  return text;
}

}  // namespace vitrine::glass::cli
