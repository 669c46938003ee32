// See views.h.
#include "glass/debug/views.h"

#include <algorithm>

#include "glass/debug/words.h"

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

constexpr char kExactMemory[] = "what the shader writes is not recorded where it is shown as it always runs (--exact)";

/// The place of what is watched or asked about: cells, or memory that is there.
base::Result<Place> place_in(Engine& engine, const std::string& expression, std::size_t lane, std::size_t frame) {
  const auto value = evaluate_in(engine, expression, lane, frame);
  if (!value) return base::Error{value.message()};
  const std::optional<Place>& place = value.value().place;
  if (!place) return base::Error{quoted(expression) + " is no variable and no memory"};
  if (place->variable->memory == spirv::SourceVariable::Memory::kCells) return *place;
  if (memory_of_place(engine.view(*engine.focus().run, lane), *place).empty())
    return base::Error{quoted(expression) + " is in no memory that is bound now, or more than 1 MiB"};
  return *place;
}

bool in_cells(const Place& place) { return place.variable->memory == spirv::SourceVariable::Memory::kCells; }

/// "x was written at a.comp:3", with the line; `by`: an invocation.
std::string written_text(const std::string& expression, const Run& run, std::uint32_t number, const std::string& by) {
  const spirv::SourceInfo& sources = *run.subject->context.sources;
  const spirv::SourcePlace& place = sources.place(number);
  return expression + " was written at " + sources.files[place.file].name + ":" + std::to_string(place.line) + by +
         "\n" + numbered(sources, place.file, place.line, '|');
}

std::string who_wrote_cells(Engine& engine, const std::string& expression, const Place& place) {
  const Focus& focus = engine.focus();
  const Run& run = *focus.run;
  const std::uint32_t count = run.subject->variables->types[place.type].cells;
  for (std::size_t i = engine.history().position_in(run); i-- > 0;) {
    if (!run.assigns(run.entry(i), focus.lane, place.cell, count, true)) continue;
    if (run.entry(i).probe == kChange) return expression + " was set at the prompt\n";
    return written_text(expression, run, run.subject->probes[run.entry(i).probe].place, {});
  }
  return "nothing that is recorded has written " + expression + "\n";
}

std::string who_wrote_memory(Engine& engine, const std::string& expression, const Place& place) {
  const std::vector<MemoryRange> memory = memory_of_place(engine.view(*engine.focus().run, engine.focus().lane), place);
  std::string text;
  engine.history().for_each_back([&](const std::shared_ptr<Run>& run, const Run::Entry& entry) {
    const auto store = run->store_to(entry, memory, *engine.history().running());
    if (!store) return true;
    const std::uint32_t number = run->place_of_stores(entry);
    if (store->lane == kNoLane)
      text = "nothing has written " + expression + " since the workgroup began\n";
    else if (number == 0)
      text = expression + " was set at the prompt\n";
    else
      text = written_text(expression, *run, number,
                          " by " + invocation_text(*run, store->lane) + (run->where.empty() ? "" : ", " + run->where));
    return false;
  });
  return text.empty() ? "nothing that is recorded has written " + expression + "\n" : text;
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
  if (!engine.focus().run) return kNothing;
  const auto place = place_in(engine, expression, engine.focus().lane, engine.focus().frame);
  if (!place) return place.message() + "\n";
  if (in_cells(place.value())) return who_wrote_cells(engine, expression, place.value());
  return engine.records_stores() ? who_wrote_memory(engine, expression, place.value())
                                 : kExactMemory + std::string("\n");
}

base::Result<int> watch_in(Engine& engine, const std::string& expression, std::size_t lane, std::size_t frame,
                           std::string owner) {
  const auto place = place_in(engine, expression, lane, frame);
  if (!place) return base::Error{place.message()};
  const Run& run = *engine.focus().run;
  Watchpoint watchpoint;
  watchpoint.text = expression;
  watchpoint.owner = std::move(owner);
  watchpoint.subject = run.subject;
  watchpoint.id = run.id[lane];
  if (in_cells(place.value())) {
    watchpoint.cell = place.value().cell;
    watchpoint.count = run.subject->variables->types[place.value().type].cells;
  } else {
    if (!engine.records_stores()) return base::Error{kExactMemory};
    const Viewer viewer = engine.view(run, lane);
    watchpoint.place = place.value();
    watchpoint.memory = memory_of_place(viewer, place.value());
    watchpoint.value = to_text(viewer, {place.value(), {}});
    watchpoint.submission = run.submission;
  }
  return engine.watch(std::move(watchpoint));
}

std::string watch_text(Engine& engine, const std::string& expression) {
  if (!engine.focus().run) return kNothing;
  const Focus& focus = engine.focus();
  const auto number = watch_in(engine, expression, focus.lane, focus.frame, {});
  if (!number) return number.message() + "\n";
  std::string text = "watch " + std::to_string(number.value()) + ": " + expression;
  if (!engine.watchpoints().at(number.value()).is_memory()) text += " of " + invocation_text(*focus.run, focus.lane);
  return text + "\n";
}

base::Result<Value> set_in(Engine& engine, const std::string& target, const std::string& expression, std::size_t lane,
                           std::size_t frame) {
  const auto to = evaluate_in(engine, target, lane, frame), from = evaluate_in(engine, expression, lane, frame);
  if (!to) return base::Error{to.message()};
  if (!from) return base::Error{from.message()};
  const Viewer viewer = engine.view(*engine.focus().run, lane);
  const std::optional<Place>& place = to.value().place;
  if (!place) return base::Error{quoted(target) + " is no variable and no memory"};
  const auto placed = placed_numbers(viewer, *place, from.value());
  if (!placed) return placed.error();
  const std::string error = engine.change(*place, lane, placed.value());
  if (!error.empty()) return base::Error{error};
  return to.value();
}

std::string set_text(Engine& engine, const std::string& assignment) {
  if (!engine.focus().run) return kNothing;
  std::size_t at = std::string::npos;
  for (std::size_t i = 1; i + 1 < assignment.size() && at == std::string::npos; ++i)
    if (assignment[i] == '=' && assignment[i + 1] != '=' &&
        std::string_view("=!<>").find(assignment[i - 1]) == std::string_view::npos)
      at = i;
  if (at == std::string::npos) return "set VARIABLE = EXPRESSION\n";
  const std::string target(trimmed(std::string_view(assignment).substr(0, at)));
  const bool first = !engine.focus().run->changed;
  const auto value = set_in(engine, target, assignment.substr(at + 1), engine.focus().lane, engine.focus().frame);
  if (!value) return value.message() + "\n";
  return value_text(engine, target) + (first ? "from here on this run is another one than without the debugger\n" : "");
}

}  // namespace vitrine::glass::debug
