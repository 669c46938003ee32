// See views.h.
#include "glass/debug/views.h"

#include <algorithm>

namespace vitrine::glass::debug {
namespace {

constexpr char kNothing[] = "nothing has run yet\n";
constexpr std::uint32_t kLinesAround = 5;

std::string padded(std::string text, std::size_t width) {
  text.resize(std::max(text.size(), width), ' ');
  return text;
}

std::string numbered(const spirv::SourceInfo& sources, std::uint32_t file, std::uint32_t line, char mark) {
  const std::string number = std::to_string(line);
  return std::string(number.size() < 5 ? 5 - number.size() : 0, ' ') + number + " " + mark + " " +
         line_text(sources, file, line) + "\n";
}

const spirv::SourceInfo& sources_of(Engine& engine) { return *engine.focus().run->subject->context.sources; }

std::string variables_text(Engine& engine, const std::vector<const spirv::SourceVariable*>& variables) {
  const Focus& focus = engine.focus();
  const Viewer viewer = engine.view(*focus.run, focus.lane);
  std::string text;
  for (const spirv::SourceVariable* variable : variables)
    text.append(variable->name).append(" = ").append(to_text(viewer, {place_of(*variable), {}})).append("\n");
  return text;
}

/// The cells of a variable that is watched or asked about. False: `error` says why there are none.
bool cells_of(Engine& engine, const std::string& expression, std::uint32_t& cell, std::uint32_t& count,
              std::string& error) {
  if (!engine.focus().run) return error = kNothing, false;
  const auto value = evaluate_in(engine, expression, engine.focus().lane, engine.focus().frame);
  if (!value) return error = value.message() + "\n", false;
  const std::optional<Place>& place = value.value().place;
  if (!place || place->variable->memory != spirv::SourceVariable::Memory::kCells)
    return error = std::string("'") + expression + "' is no variable of the invocation\n", false;
  cell = place->cell;
  count = engine.focus().run->subject->variables->types[place->type].cells;
  return true;
}

}  // namespace

std::vector<CodeFrame> focus_frames(Engine& engine) {
  const Focus& focus = engine.focus();
  return focus.run ? frames_at(*focus.run, focus.lane) : std::vector<CodeFrame>();
}

base::Result<Value> evaluate_in(Engine& engine, const std::string& text, std::size_t lane, std::size_t frame) {
  const Focus& focus = engine.focus();
  if (!focus.run) return base::Error{"nothing has run yet"};
  const std::vector<CodeFrame> frames = frames_at(*focus.run, lane);
  const FrameNames names(*focus.run, frame < frames.size() ? &frames[frame] : nullptr);
  return evaluate(text, engine.view(*focus.run, lane), names);
}

std::string where_text(Engine& engine) {
  const Focus& focus = engine.focus();
  if (!focus.run) return kNothing;
  std::string text = invocation_text(*focus.run, focus.lane) + ", lane " + std::to_string(focus.lane);
  if (!focus.run->where.empty()) text += ", " + focus.run->where;
  text += "\n";
  const std::vector<CodeFrame> frames = focus_frames(engine);
  if (focus.frame >= frames.size()) return text;
  const CodeFrame& frame = frames[focus.frame];
  return text + to_text(frame) + "\n" + numbered(sources_of(engine), frame.place.file, frame.place.line, '|');
}

std::string value_text(Engine& engine, const std::string& expression) {
  const Focus& focus = engine.focus();
  const auto value = evaluate_in(engine, expression, focus.lane, focus.frame);
  if (!value) return value.message() + "\n";
  return expression + " = " + to_text(engine.view(*focus.run, focus.lane), value.value()) + "\n";
}

std::string table_of(Engine& engine, const std::string& expression) {
  const Focus& focus = engine.focus();
  if (!focus.run) return kNothing;
  std::string text = "lane  " + padded("invocation", 28) + expression + "\n";
  base::for_each_lane(focus.run->launched, [&](std::size_t lane) {
    const auto value = evaluate_in(engine, expression, lane, lane == focus.lane ? focus.frame : 0);
    text += padded(std::to_string(lane), 6) + padded(invocation_text(*focus.run, lane), 28) +
            (value ? to_text(engine.view(*focus.run, lane), value.value()) : '<' + value.message() + ">") + "\n";
  });
  return text;
}

std::string lanes_text(Engine& engine) {
  const Focus& focus = engine.focus();
  if (!focus.run) return kNothing;
  std::string text;
  base::for_each_lane(focus.run->launched, [&](std::size_t lane) {
    const std::vector<CodeFrame> frames = frames_at(*focus.run, lane);
    text += (lane == focus.lane ? "* " : "  ") + padded(std::to_string(lane), 4) +
            padded(invocation_text(*focus.run, lane), 28) +
            (frames.empty() ? std::string("has not begun") : to_text(frames[0])) +
            ((focus.run->helpers >> lane & 1) != 0 ? ", helper" : "") + "\n";
  });
  return text;
}

std::string locals_text(Engine& engine) {
  const Focus& focus = engine.focus();
  const std::vector<CodeFrame> frames = focus_frames(engine);
  if (focus.frame >= frames.size()) return kNothing;
  return variables_text(engine, FrameNames(*focus.run, &frames[focus.frame]).locals());
}

std::string globals_text(Engine& engine) {
  if (!engine.focus().run) return kNothing;
  return variables_text(engine, FrameNames(*engine.focus().run, nullptr).globals());
}

std::string breakpoints_text(Engine& engine) {
  std::string text;
  for (const auto& [number, breakpoint] : engine.breakpoints())
    text += std::to_string(number) + "  " + to_text(breakpoint) + ", hits: " + std::to_string(breakpoint.hits) + "\n";
  for (const auto& [number, watchpoint] : engine.watchpoints())
    text += std::to_string(number) + "  watch " + watchpoint.text + "\n";
  if (engine.catches() != 0) text += "catch " + catches_text(engine.catches()) + "\n";
  return text.empty() ? "none\n" : text;
}

std::string backtrace_text(Engine& engine) {
  std::string text;
  const std::vector<CodeFrame> frames = focus_frames(engine);
  for (std::size_t i = 0; i < frames.size(); ++i)
    text += (i == engine.focus().frame ? "* #" : "  #") + std::to_string(i) + " " + to_text(frames[i]) + "\n";
  return text.empty() ? kNothing : text;
}

std::string list_text(Engine& engine, std::uint32_t line) {
  const std::vector<CodeFrame> frames = focus_frames(engine);
  if (engine.focus().frame >= frames.size()) return kNothing;
  const spirv::SourcePlace& place = frames[engine.focus().frame].place;
  const std::uint32_t middle = line == 0 ? place.line : line;
  std::string text;
  const std::string& source = sources_of(engine).files[place.file].text;
  const auto lines = static_cast<std::uint32_t>(std::count(source.begin(), source.end(), '\n'));
  for (std::uint32_t i = middle > kLinesAround ? middle - kLinesAround : 1; i <= middle + kLinesAround && i <= lines;
       ++i)
    text += numbered(sources_of(engine), place.file, i, i == place.line ? '>' : '|');
  return text.empty() ? "the source is not in the module\n" : text;
}

std::string disassembly_text(Engine& engine) {
  const Focus& focus = engine.focus();
  const std::vector<CodeFrame> frames = focus_frames(engine);
  if (focus.frame >= frames.size()) return kNothing;
  const CodeFrame& here = frames[focus.frame];
  std::string wanted = here.file;
  wanted.append(":").append(std::to_string(here.place.line));
  const std::string& program = focus.run->subject->program;
  std::string text;
  for (std::size_t begin = 0; begin < program.size();) {
    const std::size_t end = std::min(program.find('\n', begin), program.size());
    const std::string row = program.substr(begin, end - begin);
    const std::size_t at = row.find(wanted);
    const std::size_t behind = at + wanted.size();
    if (at != std::string::npos && (behind == row.size() || row[behind] < '0' || row[behind] > '9')) text += row + "\n";
    begin = end + 1;
  }
  return text.empty() ? "no instruction is left of this line\n" : text;
}

std::string who_wrote_text(Engine& engine, const std::string& expression) {
  std::uint32_t cell = 0, count = 0;
  std::string error;
  if (!cells_of(engine, expression, cell, count, error)) return error;
  const Focus& focus = engine.focus();
  const Run& run = *focus.run;
  for (std::size_t i = engine.history().position_in(run); i-- > 0;) {
    if (!run.assigns(run.entry(i), focus.lane, cell, count, true)) continue;
    const spirv::SourcePlace& place = run.subject->place(run.entry(i).probe);
    const spirv::SourceInfo& sources = *run.subject->context.sources;
    return expression + " was written at " + sources.files[place.file].name + ":" + std::to_string(place.line) + "\n" +
           numbered(sources, place.file, place.line, '|');
  }
  return "nothing that is recorded has written " + expression + "\n";
}

std::string watch_text(Engine& engine, const std::string& expression) {
  Watchpoint watchpoint;
  std::string error;
  if (!cells_of(engine, expression, watchpoint.cell, watchpoint.count, error)) return error;
  const Focus& focus = engine.focus();
  watchpoint.text = expression;
  watchpoint.subject = focus.run->subject;
  watchpoint.id = focus.run->id[focus.lane];
  return "watch " + std::to_string(engine.watch(std::move(watchpoint))) + ": " + expression + " of " +
         invocation_text(*focus.run, focus.lane) + "\n";
}

}  // namespace vitrine::glass::debug
