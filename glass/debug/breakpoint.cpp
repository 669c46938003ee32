// See breakpoint.h.
#include "glass/debug/breakpoint.h"
#include "glass/debug/words.h"

#include <algorithm>
#include <charconv>

namespace vitrine::glass::debug {
namespace {

using Kind = Breakpoint::Kind;

bool parse_number(std::string_view text, std::uint32_t& number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size() && !text.empty();
}

/// "1,2,3"; numbers that are not there stay 0.
bool parse_id(std::string_view text, std::size_t least, std::size_t most, std::array<std::uint32_t, 3>& id) {
  std::size_t count = 0;
  while (count < most) {
    const std::size_t comma = text.find(',');
    if (!parse_number(trimmed(text.substr(0, comma)), id[count++])) return false;
    if (comma == std::string_view::npos) return count >= least;
    text.remove_prefix(comma + 1);
  }
  return false;
}

/// Takes the condition away from the end of the text.
std::string take_condition(std::string_view& text) {
  if (text.starts_with("if ")) return {};
  const std::size_t at = text.find(" if ");
  if (at == std::string_view::npos) return {};
  const std::string condition(trimmed(text.substr(at + 4)));
  text = trimmed(text.substr(0, at));
  return condition;
}

struct Beginning {
  std::string_view word;
  Kind kind;
  std::size_t least, most;
};
constexpr Beginning kBeginnings[] = {{"pixel ", Kind::kPixel, 2, 2},
                                     {"vertex ", Kind::kVertex, 1, 1},
                                     {"workgroup ", Kind::kWorkgroup, 1, 3},
                                     {"invocation ", Kind::kInvocation, 1, 3}};

std::string_view base_name(std::string_view path) {
  const std::size_t slash = path.find_last_of("/\\");
  return slash == std::string_view::npos ? path : path.substr(slash + 1);
}

}  // namespace

base::Result<Breakpoint> parse_breakpoint(std::string_view text) {
  Breakpoint breakpoint;
  text = trimmed(text);
  breakpoint.condition = take_condition(text);
  for (const Beginning& beginning : kBeginnings) {
    if (!text.starts_with(beginning.word)) continue;
    breakpoint.kind = beginning.kind;
    if (parse_id(trimmed(text.substr(beginning.word.size())), beginning.least, beginning.most, breakpoint.id))
      return breakpoint;
    return base::Error{quoted(text) + ": numbers are wanted, separated by commas"};
  }
  const std::size_t colon = text.rfind(':');
  if (colon != std::string_view::npos && parse_number(text.substr(colon + 1), breakpoint.line)) {
    breakpoint.file = trimmed(text.substr(0, colon));
    return breakpoint;
  }
  if (parse_number(text, breakpoint.line)) return breakpoint;
  if (text.empty() || text.find_first_of(" :,") != std::string_view::npos)
    return base::Error{"where? FILE:LINE, LINE, FUNCTION, pixel X,Y, vertex N, workgroup X,Y,Z or invocation X,Y,Z"};
  breakpoint.kind = Kind::kFunction;
  breakpoint.function = text;
  return breakpoint;
}

std::string to_text(const Breakpoint& breakpoint) {
  std::string text;
  const auto& id = breakpoint.id;
  switch (breakpoint.kind) {
    case Kind::kLine:
      if (breakpoint.file.empty())
        text.append("line ");
      else
        text.append(breakpoint.file).append(":");
      text.append(std::to_string(breakpoint.line));
      break;
    case Kind::kFunction:
      text = "function " + breakpoint.function;
      break;
    default:
      for (const Beginning& beginning : kBeginnings)
        if (beginning.kind == breakpoint.kind) text = beginning.word;
      text += std::to_string(id[0]);
      if (breakpoint.kind != Kind::kVertex) text += ',' + std::to_string(id[1]);
      if (breakpoint.kind == Kind::kWorkgroup || breakpoint.kind == Kind::kInvocation)
        text += ',' + std::to_string(id[2]);
  }
  if (!breakpoint.condition.empty()) text += " if " + breakpoint.condition;
  return text;
}

bool wants_hit(const Breakpoint& breakpoint) {
  std::string_view wanted = trimmed(breakpoint.hits_wanted);
  const std::size_t digits = wanted.find_first_of("0123456789");
  std::uint32_t number = 0;
  if (digits == std::string_view::npos || !parse_number(wanted.substr(digits), number)) return true;
  const std::string_view op = trimmed(wanted.substr(0, digits));
  if (op == "==" || op == "=") return breakpoint.hits == number;
  if (op == "%") return number != 0 && breakpoint.hits % number == 0;
  if (op == ">") return breakpoint.hits > number;
  if (op == "<") return breakpoint.hits < number;
  if (op == "<=") return breakpoint.hits <= number;
  return breakpoint.hits >= number;
}

std::vector<std::uint32_t> steps_of(const Breakpoint& breakpoint, const Subject& subject) {
  std::vector<std::uint32_t> steps;
  std::uint32_t best = ~std::uint32_t{0};
  const spirv::SourceInfo& sources = *subject.context.sources;
  for (std::uint32_t i = 0; i < subject.probes.size(); ++i) {
    const spirv::Probe& probe = subject.probes[i];
    if (probe.kind != spirv::Probe::Kind::kStep) continue;
    if (probe.number != static_cast<std::uint32_t>(spirv::StepKind::kLine)) continue;
    const spirv::SourcePlace& place = subject.place(i);
    if (breakpoint.kind == Kind::kFunction) {
      const std::string& name = sources.functions[sources.scopes[place.scope].function].name;
      if (probe.enters && (name == breakpoint.function || name.substr(0, name.find('(')) == breakpoint.function))
        steps.push_back(i);
      continue;
    }
    const std::string& file = sources.files[place.file].name;
    if (!breakpoint.file.empty() && base_name(file) != base_name(breakpoint.file)) continue;
    if (breakpoint.kind != Kind::kLine || breakpoint.line == 0) continue;
    if (place.line < breakpoint.line || place.line > best) continue;
    if (place.line < best) steps.clear();
    best = place.line;
    steps.push_back(i);
  }
  return steps;
}

bool is_about_beginning(const Breakpoint& breakpoint) {
  return breakpoint.kind != Kind::kLine && breakpoint.kind != Kind::kFunction;
}

bool begins(const Breakpoint& breakpoint, const Run& run, std::size_t lane) {
  const auto& id = run.id[lane];
  const VkShaderStageFlagBits stage = run.subject->context.stage;
  switch (breakpoint.kind) {
    case Kind::kPixel:
      return stage == VK_SHADER_STAGE_FRAGMENT_BIT && id[0] == breakpoint.id[0] && id[1] == breakpoint.id[1];
    case Kind::kVertex:
      return stage == VK_SHADER_STAGE_VERTEX_BIT && id[0] == breakpoint.id[0];
    case Kind::kWorkgroup:
      return stage == VK_SHADER_STAGE_COMPUTE_BIT && run.workgroup_of(lane) == breakpoint.id;
    case Kind::kInvocation:
      return stage == VK_SHADER_STAGE_COMPUTE_BIT && id == breakpoint.id;
    default:
      return false;
  }
}

}  // namespace vitrine::glass::debug
