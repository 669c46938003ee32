// vitrine pixel: runs an application with the tool that watches texels, again for every texel that another one came
// from, and tells the story.
#include <charconv>
#include <cstdio>
#include <set>

#include "glass/cli/application.h"
#include "glass/cli/commands.h"
#include "glass/cli/files.h"
#include "glass/cli/pixel_bug.h"
#include "glass/cli/pixel_history.h"
#include "glass/cli/say.h"
#include "glass/pixel/request.h"

namespace vitrine::glass::cli {
namespace {

/// Texels that further runs watch: beyond that, what is still missing stays so.
constexpr std::size_t kMostRequests = 1000;

bool parse(std::string_view text, std::uint32_t& number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size() && !text.empty();
}

/// "X,Y" in the options' position. False: it is none.
bool read_position(const std::string& text, PixelQuestion& question) {
  const std::size_t comma = text.find(',');
  return comma != std::string::npos && parse(std::string_view(text).substr(0, comma), question.x) &&
         parse(std::string_view(text).substr(comma + 1), question.y);
}

std::string request_of(const TexelKey& key) {
  return std::to_string(key.x) + "," + std::to_string(key.y) + ":image=#" + std::to_string(key.image) +
         ":aspect=" + key.aspect + ":level=" + std::to_string(key.level) + ":layer=" + std::to_string(key.layer) +
         ":slice=" + std::to_string(key.slice) + ":sample=" + std::to_string(key.sample);
}

std::string request_of(const PixelQuestion& question) {
  std::string text = std::to_string(question.x) + "," + std::to_string(question.y) +
                     ":image=" + glass::pixel::escaped(question.image) + ":level=" + std::to_string(question.level) +
                     ":layer=" + std::to_string(question.layer) + ":slice=" + std::to_string(question.slice);
  if (!question.aspect.empty()) text += ":aspect=" + question.aspect;
  if (question.sample) text += ":sample=" + std::to_string(*question.sample);
  return text;
}

/// What one run recorded.
struct Run {
  Ending ending;
  std::optional<PixelHistory> history;  ///< nothing: nothing was recorded
  std::string text;                     ///< as it was written
};

/// Of several processes the one that had most of what was asked for.
Run run_once(const PixelOptions& options, const std::string& requests) {
  Run run;
  const TemporaryFolder folder;
  if (folder.path().empty()) return run;
  Environment environment{
      {"VITRINE_TOOLS", "pixel"}, {"VITRINE_PIXEL", requests}, {"VITRINE_PIXEL_HISTORY", folder.path() / "%p.json"}};
  if (options.frame) environment.emplace("VITRINE_PIXEL_UNTIL", "frame=" + std::to_string(*options.frame));
  if (options.submission)
    environment.emplace("VITRINE_PIXEL_UNTIL", "submission=" + std::to_string(*options.submission));
  if (!options.primitive.empty()) environment.emplace("VITRINE_PIXEL_PRIMITIVE", options.primitive);
  run.ending = run_application(options.application, environment);
  for (const auto& path : folder.files(".json")) {
    std::optional<std::string> text = read_file(path);
    std::optional<PixelHistory> history = text ? read_history(*text) : std::nullopt;
    if (!history) {
      say("what process " + path.stem().string() + " recorded cannot be read");
    } else if (!run.history || history->texels.size() > run.history->texels.size()) {
      run.history = std::move(history);
      run.text = std::move(*text);
    }
  }
  return run;
}

/// Why there is no story.
void say_images(const PixelHistory& history, const PixelQuestion& question) {
  say("no image '" + question.image + "' with that texel was " +
      (question.image == "swapchain" ? "presented" : "made") + "; images of the application:");
  for (const PixelImage& image : history.images) {
    std::string text = "  #" + std::to_string(image.number) + (image.name.empty() ? "" : " '" + image.name + "'");
    text.append(": ").append(image.format);
    for (std::size_t i = 0; i < image.extent.size(); ++i)
      text.append(i == 0 ? ", " : " x ").append(std::to_string(image.extent[i]));
    const auto add = [&](const char* name, std::uint32_t number) {
      if (number > 1) text.append(", ").append(std::to_string(number)).append(name);
    };
    add(" levels", image.levels);
    add(" layers", image.layers);
    add(" samples", image.samples);
    std::fprintf(stderr, "%s%s\n", text.c_str(), image.swapchain ? ", of a swapchain" : "");
  }
}

}  // namespace

int pixel(const PixelOptions& options) {
  PixelQuestion question{options.image,
                         options.aspect,
                         0,
                         0,
                         options.level,
                         options.layer,
                         options.slice,
                         options.sample,
                         options.frame.value_or(0),
                         options.depth};
  if (!read_position(options.position, question)) {
    say("'" + options.position + "' is no pixel: X,Y is wanted");
    return kCouldNotRun;
  }
  const auto primitive = glass::pixel::parse_primitive(options.primitive);
  if (!options.primitive.empty() && !primitive) {
    say("'" + options.primitive + "' is no primitive: N or N@INSTANCE is wanted");
    return kCouldNotRun;
  }
  if (!demand_tool("pixel")) return kCouldNotRun;
  std::string requests = request_of(question);
  std::size_t count = 1;
  std::set<std::string> values;  ///< of the pixel, in all runs
  for (unsigned round = 0;; ++round) {
    const Run run = run_once(options, requests);
    if (!run.ending.error.empty()) return kCouldNotRun;
    if (!run.history) {
      say("nothing was recorded: no process of the application used this driver");
      return run.ending.code ? run.ending.code : kCouldNotRun;
    }
    const PixelStory story = tell(*run.history, question);
    if (story.chapters.empty()) {
      say_images(*run.history, question);
      return run.ending.code ? run.ending.code : kCouldNotRun;
    }
    values.insert(story.chapters[0].value());
    if (round < options.depth && !story.missing.empty() && count < kMostRequests) {
      for (std::size_t i = 0; i < story.missing.size() && count < kMostRequests; ++i, ++count)
        requests += ";" + request_of(story.missing[i]);
      continue;
    }
    std::fputs(to_text(*run.history, story).c_str(), stdout);
    if (primitive) std::fputs(why_not(*run.history, story, *primitive).c_str(), stdout);
    if (values.size() > 1) say("the application does not draw the same in every run: this is the last one");
    if (story.cut || (!story.missing.empty() && options.depth > 0)) say("not all sources are told of");
    bool written = options.json.empty() || write_file(options.json, run.text);
    written = (options.html.empty() || write_file(options.html, to_html(*run.history, story))) && written;
    written = (options.bug.empty() || write_maker(story, options.application, options.bug)) && written;
    if (run.ending.code) return run.ending.code;
    return written ? 0 : kCouldNotRun;
  }
}

}  // namespace vitrine::glass::cli
