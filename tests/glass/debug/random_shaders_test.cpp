// Every variable at every line of shaders made at random, stepping forward to the end and then all the way back, is
// what the shader says (random_shader.h), and the values at the end are those of a run that nobody debugs.
#include <cstdlib>
#include <sstream>

#include "glass/debug/views.h"
#include "tests/glass/debug/random_shader.h"
#include "tests/glass/debug/random_values.h"
#include "tests/glass/debug/scripted.h"
#include "tests/glass/observed.h"

namespace vitrine::glass::debug::test {
namespace {

/// Steps to the end of one invocation and back, and compares at each stop.
class Walker : public Face {
 public:
  Walker(const RandomShader& shader, std::uint32_t lane) : shader_(shader), lane_(lane) {}

  void stopped(Engine& engine, const Stop& stop, std::unique_lock<std::mutex>&) override {
    engine.go(next(engine, stop));
  }
  void output(const std::string&) override {}

  std::string fault;
  bool done = false;

 private:
  Motion next(Engine& engine, const Stop& stop) {
    const Motion away{Motion::Kind::kDetach, false}, step{Motion::Kind::kStep, back_};
    if (stop.reason == Stop::Reason::kStart) {
      engine.add(parse_breakpoint(std::string("invocation ") + std::to_string(lane_)).take());
      return {};
    }
    if (stop.reason == Stop::Reason::kBreakpoint) {
      if (!engine.breakpoints().empty()) engine.remove(engine.breakpoints().begin()->first);
    }
    if (stop.reason == Stop::Reason::kEnd && !back_) {
      if (at_ != shader_.stops.size()) return complain("ends", std::string("before line ") + line_of(at_)), away;
      back_ = true;
      return {Motion::Kind::kStep, true};
    }
    if (stop.reason == Stop::Reason::kHistory && back_) {
      done = at_ == 0;
      if (!done) complain("is at the beginning", std::string("behind line ") + line_of(at_ - 1));
      return away;
    }
    if (is_closing_brace(engine)) return step;
    if (back_ ? at_ == 0 : at_ == shader_.stops.size()) return complain("goes on", where_text(engine)), away;
    if (!compare(engine, shader_.stops[back_ ? --at_ : at_++])) return away;
    return step;
  }

  /// Newer compilers have a line for the return at the end of a function.
  bool is_closing_brace(Engine& engine) const {
    const std::vector<CodeFrame> frames = frames_at(*engine.focus().run, engine.focus().lane);
    std::istringstream text(shader_.text);
    std::string line;
    for (std::uint32_t i = 0; !frames.empty() && i < frames[0].place.line; ++i) std::getline(text, line);
    return line == "}";
  }

  std::string line_of(std::size_t stop) const {
    return stop < shader_.stops.size() ? std::to_string(shader_.stops[stop].frames[0].line) : "none";
  }

  void complain(const std::string& what, const std::string& more) {
    fault = std::string(back_ ? "back" : "forward") + ", stop " + std::to_string(at_) + " of " +
            std::to_string(shader_.stops.size()) + ": the debugger " + what + ", " + more;
  }

  bool compare(Engine& engine, const ExpectedStop& expected) {
    const Run& run = *engine.focus().run;
    const std::vector<CodeFrame> frames = frames_at(run, engine.focus().lane);
    std::string lines, wanted;
    for (const CodeFrame& frame : frames) lines.append(" ").append(std::to_string(frame.place.line));
    for (const ExpectedFrame& frame : expected.frames) wanted.append(" ").append(std::to_string(frame.line));
    if (lines != wanted) return complain(std::string("stands at") + lines, std::string("not at") + wanted), false;
    for (std::size_t i = 0; i < frames.size(); ++i)
      for (const auto& [name, value] : expected.frames[i].values) {
        const auto place = FrameNames(run, &frames[i]).find(name);
        const std::string found =
            place ? to_text(engine.view(run, engine.focus().lane), Value{place, {}}) : "not there";
        if (without_signs_of_zeros(found) == value) continue;
        return complain(std::string("shows at line ") + lines + " " + name + " = " + found,
                        std::string("not ") + value),
               false;
      }
    return true;
  }

  const RandomShader& shader_;
  const std::uint32_t lane_;
  std::size_t at_ = 0;
  bool back_ = false;
};

std::vector<std::uint32_t> run(Tool* tool, const std::vector<std::uint32_t>& module) {
  std::vector<std::uint32_t> words;
  for (std::uint32_t i = 0; i < kRandomWords; ++i) words.push_back(10 + i);
  glass::test::run_observed(tool, module, words, 1);
  return words;
}

void walk(std::uint32_t seed) {
  const std::uint32_t lane = seed % kRandomLanes;
  const RandomShader shader = make_random_shader(seed, lane);
  std::string log;
  const auto module = vitrine::test::compile_glsl(
      VK_SHADER_STAGE_COMPUTE_BIT, shader.text, vitrine::test::VulkanVersion::k12, log,
      seed % 3 == 0 ? vitrine::test::DebugInfo::kLines : vitrine::test::DebugInfo::kNonSemantic);
  ASSERT_FALSE(module.empty()) << log << shader.text;
  EXPECT_EQ(run(nullptr, module), shader.words) << shader.text;
  Walker walker(shader, lane);
  Engine engine(walker);
  engine.start();
  const auto tool = make_tool(engine);
  EXPECT_EQ(run(tool.get(), module), shader.words) << shader.text;
  if (walker.fault.empty() && !walker.done) walker.fault = "the debugger has not come back to the beginning";
  EXPECT_EQ(walker.fault, "") << "shader " << seed << ":\n" << shader.text;
}

/// VITRINE_TEST_DEBUG_SHADERS says how many, or "FIRST:COUNT".
TEST(Debugger, ShowsEveryVariableOfRandomShaders) {
  const char* const wanted = std::getenv("VITRINE_TEST_DEBUG_SHADERS");
  std::string text = wanted != nullptr ? wanted : "60";
  std::uint32_t first = 0;
  if (const std::size_t colon = text.find(':'); colon != std::string::npos) {
    first = static_cast<std::uint32_t>(std::stoul(text));
    text.erase(0, colon + 1);
  }
  const auto count = static_cast<std::uint32_t>(std::stoul(text));
  for (std::uint32_t seed = first; seed < first + count && !HasFatalFailure(); ++seed) walk(seed);
}

}  // namespace
}  // namespace vitrine::glass::debug::test
