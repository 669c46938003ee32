// See commands.h.
#include "glass/debug/commands.h"

#include <algorithm>
#include <charconv>

#include "glass/debug/views.h"
#include "glass/debug/words.h"

namespace vitrine::glass::debug {
namespace {

using Kind = Motion::Kind;

bool parse_number(std::string_view text, std::size_t& number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size() && !text.empty();
}

std::string set_breakpoint(Engine& engine, std::string_view rest, bool once) {
  auto parsed = parse_breakpoint(rest);
  if (!parsed) return parsed.message() + "\n";
  Breakpoint breakpoint = parsed.take();
  breakpoint.once = once;
  const std::vector<CodeFrame> frames = focus_frames(engine);
  if (breakpoint.kind == Breakpoint::Kind::kLine && breakpoint.file.empty() && !frames.empty())
    breakpoint.file = frames[engine.focus().frame].file;
  const std::string text = to_text(breakpoint);
  return "breakpoint " + std::to_string(engine.add(std::move(breakpoint))) + ": " + text + "\n";
}

std::string break_at(Engine& engine, std::string_view rest) { return set_breakpoint(engine, rest, false); }
std::string break_once(Engine& engine, std::string_view rest) { return set_breakpoint(engine, rest, true); }

std::string remove_one(Engine& engine, std::string_view rest) {
  std::size_t number = 0;
  if (rest.empty()) {
    while (!engine.breakpoints().empty()) engine.remove(engine.breakpoints().begin()->first);
    while (!engine.watchpoints().empty()) engine.remove(engine.watchpoints().begin()->first);
    return {};
  }
  if (!parse_number(rest, number) || !engine.remove(static_cast<int>(number)))
    return "there is no breakpoint '" + std::string(rest) + "'\n";
  return {};
}

std::string catch_it(Engine& engine, std::string_view rest) {
  const unsigned bit = catch_of(rest);
  if (bit == 0 && rest != "nothing") return "catch printf, nan, finding or nothing\n";
  engine.set_catches(bit == 0 ? 0 : engine.catches() | bit);
  const std::string text = catches_text(engine.catches());
  return text.empty() ? "nothing is caught\n" : "caught: " + text + "\n";
}

std::string move(Engine& engine, Motion motion) {
  if (!engine.focus().run && (motion.backward || motion.kind != Kind::kContinue)) {
    // Nothing has begun: the first line of anything is the next.
    if (motion.backward) return "nothing has run yet\n";
    engine.pause();
    motion.kind = Kind::kContinue;
  }
  engine.go(motion);
  return {};
}

template <Kind kKind, bool kBackward>
std::string go(Engine& engine, std::string_view) {
  return move(engine, {kKind, kBackward});
}

std::string detach(Engine& engine, std::string_view) {
  engine.go({Kind::kDetach, false});
  return {};
}

std::string print(Engine& engine, std::string_view rest) {
  const std::size_t at = rest.rfind('@');
  if (at != std::string_view::npos && trimmed(rest.substr(at + 1)) == "lanes")
    return table_of(engine, std::string(trimmed(rest.substr(0, at))));
  return value_text(engine, std::string(rest));
}

std::string info(Engine& engine, std::string_view rest) {
  if (rest == "lanes") return lanes_text(engine);
  if (rest == "locals") return locals_text(engine);
  if (rest == "globals") return globals_text(engine);
  if (rest == "breakpoints" || rest == "b") return breakpoints_text(engine);
  return "info lanes, locals, globals or breakpoints\n";
}

std::string choose_lane(Engine& engine, std::string_view rest) {
  std::size_t number = 0;
  const Run* run = engine.focus().run.get();
  if (run == nullptr || !parse_number(rest, number) || number >= base::kWaveWidth || (run->launched >> number & 1) == 0)
    return "there is no lane '" + std::string(rest) + "' in the wave\n";
  engine.focus().lane = number;
  engine.focus().frame = 0;
  return where_text(engine);
}

std::string choose_frame(Engine& engine, std::size_t frame) {
  if (frame >= focus_frames(engine).size()) return "there is no frame further that way\n";
  engine.focus().frame = frame;
  return where_text(engine);
}

std::string frame(Engine& engine, std::string_view rest) {
  std::size_t number = engine.focus().frame;
  if (!rest.empty() && !parse_number(rest, number)) return "frame NUMBER\n";
  return choose_frame(engine, number);
}
std::string up(Engine& engine, std::string_view) { return choose_frame(engine, engine.focus().frame + 1); }
std::string down(Engine& engine, std::string_view) { return choose_frame(engine, engine.focus().frame - 1); }

std::string backtrace(Engine& engine, std::string_view) { return backtrace_text(engine); }
std::string list(Engine& engine, std::string_view rest) {
  std::size_t line = 0;
  if (!rest.empty() && !parse_number(rest, line)) return "list LINE\n";
  return list_text(engine, static_cast<std::uint32_t>(line));
}
std::string disassemble(Engine& engine, std::string_view) { return disassembly_text(engine); }
std::string who_wrote(Engine& engine, std::string_view rest) { return who_wrote_text(engine, std::string(rest)); }
std::string watch(Engine& engine, std::string_view rest) { return watch_text(engine, std::string(rest)); }
std::string set_value(Engine& engine, std::string_view rest) {
  if (rest.starts_with("var ") || rest.starts_with("variable ")) rest = trimmed(rest.substr(rest.find(' ')));
  return set_text(engine, std::string(rest));
}
std::string help(Engine&, std::string_view);

struct Row {
  const char* name;
  const char* alias;
  std::string (*run)(Engine&, std::string_view);
  const char* help;
};

constexpr Row kRows[] = {
    {"break", "b", break_at,
     "FILE:LINE, LINE, FUNCTION, pixel X,Y, vertex N, workgroup X,Y,Z or invocation X,Y,Z; [if EXPRESSION]"},
    {"tbreak", "tb", break_once, "the same, once"},
    {"catch", nullptr, catch_it,
     "printf: messages; nan: operations that make a NaN; finding: what sanitize and race find; the latter two in "
     "shaders "
     "made from then on; nothing"},
    {"delete", "d", remove_one, "[NUMBER]: a breakpoint or watch; without a number, all"},
    {"run", "r", go<Kind::kContinue, false>, "the same as continue"},
    {"continue", "c", go<Kind::kContinue, false>, "to the next breakpoint"},
    {"step", "s", go<Kind::kStep, false>, "to the next line, into functions"},
    {"next", "n", go<Kind::kNext, false>, "to the next line, over functions"},
    {"finish", "fin", go<Kind::kFinish, false>, "out of the function"},
    {"back", "rs", go<Kind::kStep, true>, "to the line before, into functions"},
    {"reverse-next", "rn", go<Kind::kNext, true>, "to the line before, over functions"},
    {"reverse-finish", "rfin", go<Kind::kFinish, true>, "to the line that calls the function"},
    {"reverse-continue", "rc", go<Kind::kContinue, true>, "back to the last breakpoint"},
    {"print", "p", print, "EXPRESSION; EXPRESSION @lanes: in all lanes of the wave"},
    {"watch", nullptr, watch,
     "VARIABLE: stop when it changes in this invocation; MEMORY: when any invocation changes it"},
    {"whowrote", nullptr, who_wrote, "VARIABLE or MEMORY: the line that gave it its value"},
    {"set", nullptr, set_value, "VARIABLE or MEMORY = EXPRESSION: the run goes on with another value"},
    {"info", "i", info, "lanes, locals, globals or breakpoints"},
    {"lane", nullptr, choose_lane, "NUMBER: look at another invocation of the wave"},
    {"backtrace", "bt", backtrace, "the calls that lead here"},
    {"frame", "f", frame, "[NUMBER]: look at a caller"},
    {"up", nullptr, up, "to the caller"},
    {"down", nullptr, down, "to what it calls"},
    {"list", "l", list, "[LINE]: the source"},
    {"disassemble", "dis", disassemble, "the instructions of the line, as they run"},
    {"detach", "quit", detach, "let the application go on by itself"},
    {"help", "h", help, "this text"},
};

std::string help(Engine&, std::string_view) {
  std::string text;
  for (const Row& row : kRows) {
    std::string name = row.name;
    if (row.alias != nullptr) name.append(", ").append(row.alias);
    name.resize(std::max<std::size_t>(name.size() + 2, 22), ' ');
    text.append(name).append(row.help).append("\n");
  }
  return text;
}

}  // namespace

std::string command(Engine& engine, std::string_view line) {
  line = trimmed(line);
  if (line.empty() || line[0] == '#') return {};
  const std::size_t space = line.find_first_of(" \t");
  const std::string_view word = line.substr(0, space);
  const std::string_view rest = space == std::string_view::npos ? std::string_view() : trimmed(line.substr(space));
  for (const Row& row : kRows)
    if (word == row.name || (row.alias != nullptr && word == row.alias)) return row.run(engine, rest);
  return quoted(word) + " is no command; help lists them\n";
}

std::string stop_text(Engine& engine, const Stop& stop) {
  std::string text;
  if (stop.reason == Stop::Reason::kStart) return "nothing has run yet; set breakpoints, then run\n";
  if (!stop.text.empty()) text = stop.text + "\n";
  return text + where_text(engine);
}

}  // namespace vitrine::glass::debug
