// Why a primitive did not reach a pixel: what became of it, draw by draw, and of its fragments.
#include "glass/cli/pixel_history.h"

namespace vitrine::glass::cli {
namespace {

/// The events of the pixel at which fragments of the primitive end, in a draw.
std::string fragments_text(const PixelChapter& pixel, const PixelPrimitive& drawn, const std::string& name) {
  std::string text;
  for (const PixelEvent* event : pixel.events) {
    const bool same = event->address.submission == drawn.address.submission &&
                      event->address.command == drawn.address.command && event->text.starts_with("fragment of " + name);
    if (!same) continue;
    text.append("       ").append(event->text);
    for (const auto& [fact, value] : event->facts)
      if (fact == "depth" || fact == "stored depth") text.append("; ").append(fact).append(" ").append(value);
    text.append("\n");
  }
  return text;
}

/// Whether the story is about this submission, or may go on in it.
bool is_told(const PixelChapter& pixel, std::uint64_t submission) {
  if (pixel.events.empty()) return true;
  const std::uint64_t first = pixel.events.front()->address.submission, last = pixel.events.back()->address.submission;
  const bool goes_on = pixel.events.back() == &pixel.texel->events.back();
  return submission >= first && (submission <= last || goes_on);
}

}  // namespace

std::string why_not(const PixelHistory& history, const PixelStory& story, std::uint32_t primitive) {
  const std::string name = "primitive " + std::to_string(primitive);
  const PixelChapter& pixel = story.chapters.front();
  std::string text;
  for (const PixelPrimitive& drawn : history.primitives) {
    if (!is_told(pixel, drawn.address.submission)) continue;
    text.append("  ").append(name).append(" ").append(drawn.fate);
    if (drawn.count > 1) text.append(", ").append(std::to_string(drawn.count)).append(" times");
    text.append("\n     at ").append(to_text(drawn.address)).append("\n");
    if (drawn.fate != "is rasterized") continue;
    const std::string fragments = fragments_text(pixel, drawn, name + " (");
    text.append(fragments.empty() ? "       but does not cover the pixel\n" : fragments);
  }
  if (text.empty()) text = "  no draw to the pixel's image has " + name + "\n";
  return "\nwhy not " + name + ":\n" + text;
}

}  // namespace vitrine::glass::cli
