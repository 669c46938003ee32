// A pixel's story as a page that needs nothing else.
#include "glass/cli/pixel_history.h"

namespace vitrine::glass::cli {
namespace {

constexpr char kHead[] =
    "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>Pixel history</title><style>\n"
    "body{font:14px/1.5 system-ui,sans-serif;margin:2em auto;max-width:64em;padding:0 1em;color:#222;background:#fff}\n"
    "h2{font-size:1.1em;border-bottom:1px solid #ccc;margin-top:2em}ol{padding-left:2em}li{margin:.7em 0}\n"
    "code,.v{font:12px/1.5 ui-monospace,monospace}.a{color:#666}.k{border-radius:3px;background:#eee;padding:0 .4em}\n"
    ".f{color:#a40000}.v{white-space:pre-wrap}ul{margin:.2em 0;padding-left:1.2em}\n"
    "@media(prefers-color-scheme:dark){body{color:#ddd;background:#1b1b1b}.k{background:#333}.a{color:#999}.f{color:#"
    "f88}}\n"
    "</style></head><body>\n<h1>Pixel history</h1>\n";

std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c == '<')
      result += "&lt;";
    else if (c == '>')
      result += "&gt;";
    else if (c == '&')
      result += "&amp;";
    else if (c == '"')
      result += "&quot;";
    else
      result += c;
  }
  return result;
}

std::string source_html(const PixelHistory& history, const PixelStory& story, const PixelEvent& event,
                        const PixelSource& source) {
  const std::string label = story.label_of(event, source.texel), text = escaped(to_text(history, source.texel));
  std::string html = "<li>from ";
  html += label.empty() ? text : "<a href=\"#" + label + "\">[" + label + "]</a> " + text;
  return html + " <span class=\"v\">" + escaped(source.value) + "</span></li>";
}

std::string event_html(const PixelHistory& history, const PixelStory& story, const PixelEvent& event) {
  const bool failed = event.kind == "fragment" && event.fate != "written";
  std::string html = "<li><span class=\"k\">" + escaped(event.kind) + "</span> <span" +
                     (failed ? " class=\"f\">" : ">") + escaped(event.text) + "</span>";
  if (!event.address.frames.empty()) {
    html += " <code>" + escaped(to_text(event.address.frames[0])) + "</code>";
    if (!event.address.frames[0].text.empty()) html += "<br><code>" + escaped(event.address.frames[0].text) + "</code>";
  }
  html += "<br><span class=\"a\">" + escaped(to_text(event.address)) + "</span>";
  if (!event.after.empty())
    html += "<br><span class=\"v\">" +
            escaped(event.before == event.after ? "still " + event.after : event.before + " \u2192 " + event.after) +
            "</span>";
  if (event.facts.empty() && event.sources.empty()) return html + "</li>\n";
  html += "<ul>";
  for (const auto& [name, value] : event.facts)
    html += "<li>" + escaped(name) + " <span class=\"v\">" + escaped(value) + "</span></li>";
  for (const PixelSource& source : event.sources) html += source_html(history, story, event, source);
  return html + "</ul></li>\n";
}

}  // namespace

std::string to_html(const PixelHistory& history, const PixelStory& story) {
  std::string html = kHead;
  for (const PixelChapter& chapter : story.chapters) {
    html += chapter.label.empty() ? "<h2>" : "<h2 id=\"" + chapter.label + "\">[" + chapter.label + "] ";
    html +=
        escaped(to_text(history, chapter.key)) + " <span class=\"v\">" + escaped(chapter.value()) + "</span></h2>\n";
    if (!chapter.like.empty()) {
      html += "<p>As <a href=\"#" + chapter.like + "\">[" + chapter.like + "]</a>.</p>\n";
      continue;
    }
    if (chapter.differs)
      html += "<p class=\"f\">Who read it found " + escaped(chapter.expected) +
              ": something that is not followed has written it.</p>\n";
    html += chapter.events.empty() ? "<p>Nothing touched it before.</p>\n" : "<ol>\n";
    for (const PixelEvent* event : chapter.events) html += event_html(history, story, *event);
    if (!chapter.events.empty()) html += "</ol>\n";
  }
  return html + "</body></html>\n";
}

}  // namespace vitrine::glass::cli
