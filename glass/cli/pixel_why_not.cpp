// Why a primitive did not reach a pixel: what became of it, draw by draw, and of its fragments.
#include <algorithm>

#include "glass/cli/pixel_history.h"

namespace vitrine::glass::cli {
namespace {

using glass::pixel::PrimitiveRequest;

/// "instance 5", "instances 0 to 3, 7".
std::string instances_text(const PixelPrimitive& drawn) {
  const std::vector<std::uint32_t>& all = drawn.instances;
  std::string text;
  for (std::size_t i = 0, end = 0; i < all.size(); i = end) {
    end = i + 1;
    while (end < all.size() && all[end] == all[end - 1] + 1) ++end;
    text.append(i == 0 ? "" : ", ").append(std::to_string(all[i]));
    if (end - i > 1) text.append(end - i > 2 ? " to " : ", ").append(std::to_string(all[end - 1]));
  }
  if (drawn.more) text.append(" and more");
  return (all.size() > 1 ? "instances " : "instance ") + text;
}

/// How the event of a fragment of such a primitive begins. A draw with instance 0 alone does not name it.
std::vector<std::string> names_of_fragments(const PrimitiveRequest& primitive) {
  const std::string name = "fragment of primitive " + std::to_string(primitive.primitive);
  if (!primitive.instance) return {name + " "};
  std::vector<std::string> names{name + " of instance " + std::to_string(*primitive.instance) + " "};
  if (*primitive.instance == 0) names.push_back(name + " (");
  return names;
}

/// The events of the pixel at which fragments of the primitive end, in a draw.
std::string fragments_text(const PixelChapter& pixel, const PixelPrimitive& drawn, const PrimitiveRequest& primitive) {
  const std::vector<std::string> names = names_of_fragments(primitive);
  std::string text;
  for (const PixelEvent* event : pixel.events) {
    const bool same = event->address.submission == drawn.address.submission &&
                      event->address.command == drawn.address.command &&
                      std::ranges::any_of(names, [&](const auto& name) { return event->text.starts_with(name); });
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

std::string why_not(const PixelHistory& history, const PixelStory& story, const PrimitiveRequest& primitive) {
  const std::string name = "primitive " + std::to_string(primitive.primitive);
  std::string asked = name;
  if (primitive.instance) asked.append(" of instance ").append(std::to_string(*primitive.instance));
  const PixelChapter& pixel = story.chapters.front();
  std::string text;
  for (const PixelPrimitive& drawn : history.primitives) {
    if (!is_told(pixel, drawn.address.submission)) continue;
    text.append("  ").append(name);
    if (!drawn.instances.empty()) text.append(" of ").append(instances_text(drawn));
    text.append(" ").append(drawn.fate);
    if (drawn.count > 1) text.append(", ").append(std::to_string(drawn.count)).append(" times");
    text.append("\n     at ").append(to_text(drawn.address)).append("\n");
    if (drawn.fate != "is rasterized") continue;
    const std::string fragments = fragments_text(pixel, drawn, primitive);
    text.append(fragments.empty() ? "       but does not cover the pixel\n" : fragments);
  }
  if (text.empty()) text = "  no draw to the pixel's image has " + asked + "\n";
  return "\nwhy not " + asked + ":\n" + text;
}

}  // namespace vitrine::glass::cli
