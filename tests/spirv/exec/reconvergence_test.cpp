// SPV_KHR_maximal_reconvergence: random structured programs whose invocations note who executes an instruction with
// them, against a model that walks over the same program with sets of invocations.
#include <algorithm>
#include <bit>
#include <memory>
#include <random>
#include <string_view>

#include <spirv/unified1/spirv.hpp11>

#include "spirv/newer_numbers.h"
#include "tests/spirv/buffers.h"
#include "tests/spirv/front/glsl.h"

namespace vitrine::spirv::test {
namespace {

constexpr std::uint32_t kLanes = 64, kDepth = 3;

std::string joined(std::initializer_list<std::string_view> parts) {
  std::string result;
  for (const std::string_view part : parts) result.append(part);
  return result;
}

std::string word(std::uint32_t number) { return std::to_string(number).append("u"); }

/// Something that differs between invocations, and between turns of a loop.
struct Choice {
  std::uint32_t factor, turn, by, shift, mask;

  std::string text() const {
    return joined({"((x * ", word(factor), " + c", std::to_string(turn), " * ", word(by), ") >> ", word(shift), " & ",
                   word(mask), ")"});
  }
};

struct Statement {
  enum class Kind : std::uint8_t { kNote, kIf, kSwitch, kLoop, kCall, kBreak, kContinue, kReturn } kind;
  std::uint32_t number = 0;  ///< of a note, a function; of a loop that of its counter
  Choice choice{};
  std::vector<std::vector<Statement>> parts{};
  std::vector<bool> falls{};   ///< cases: into the next one
  bool has_default = false;    ///< the last case is the default
  bool leaves_inside = false;  ///< loops: by a break in the body, not by the condition in front
};

/// Where statements stand.
struct Surroundings {
  bool in_loop = false, can_break = false;
  std::uint32_t depth = 0, loops = 0;
};

class Generator {
 public:
  explicit Generator(std::uint32_t seed) : random_(seed) {}

  std::vector<Statement> list(const Surroundings& at) {
    std::vector<Statement> result;
    for (std::uint32_t n = 1 + below(3); n > 0; n--) {
      result.push_back(statement(at));
      if (below(2) == 0) result.push_back(note());
    }
    return result;
  }

  std::string functions;

  std::string text(const std::vector<Statement>& statements) {
    std::string result;
    for (const Statement& s : statements) result += text(s);
    return result;
  }

 private:
  std::uint32_t below(std::uint32_t end) { return static_cast<std::uint32_t>(random_() % end); }
  Choice choice(std::uint32_t mask) {
    return {2 * below(500) + 1, below(kDepth), 2 * below(50) + 1, 3 + below(4), mask};
  }
  Statement note() { return {.kind = Statement::Kind::kNote, .number = ++notes_}; }

  Statement statement(const Surroundings& at) {
    using Kind = Statement::Kind;
    Surroundings inside = at;
    inside.depth++;
    Statement s{.kind = Kind::kNote, .number = ++notes_};
    switch (at.depth >= 3 ? 6 + below(2) : below(8)) {
      case 0:
      case 1:
        s = {.kind = Kind::kIf, .choice = choice(1)};
        s.parts.push_back(list(inside));
        if (below(2) == 0) s.parts.push_back(list(inside));
        return s;
      case 2: {
        s = {.kind = Kind::kSwitch, .choice = choice(3)};
        inside.can_break = true;
        const std::uint32_t count = 2 + below(3);
        for (std::uint32_t i = 0; i < count; i++) {
          s.parts.push_back(list(inside));
          s.falls.push_back(i + 1 < count && below(3) == 0);
        }
        s.has_default = below(2) == 0;
        return s;
      }
      case 3:
      case 4:
        if (at.loops == kDepth) return s;
        s = {.kind = Kind::kLoop, .number = at.loops, .choice = choice(3), .leaves_inside = below(2) == 0};
        inside.in_loop = inside.can_break = true;
        inside.loops++;
        s.parts.push_back(list(inside));
        return s;
      case 5:
        s = {.kind = Kind::kCall, .number = calls_++};
        inside.in_loop = inside.can_break = false;
        s.parts.push_back(list(inside));
        functions += joined({"void f", std::to_string(s.number), "() {\n", text(s.parts[0]), "}\n"});
        return s;
      default: {
        const std::uint32_t which = below(3);
        const Kind kind = which == 0 && at.can_break ? Kind::kBreak
                          : which == 1 && at.in_loop ? Kind::kContinue
                                                     : Kind::kReturn;
        s = {.kind = Kind::kIf, .choice = choice(which == 2 ? 7 : 1)};
        s.parts.push_back({note(), {.kind = kind}});
        return s;
      }
    }
  }

  std::string text(const Statement& s) {
    using Kind = Statement::Kind;
    const std::string number = std::to_string(s.number), c = joined({"c", number});
    switch (s.kind) {
      case Kind::kNote:
        return joined({"note(", number, "u);\n"});
      case Kind::kIf:
        return joined({"if (", s.choice.text(), " == 0u) {\n", text(s.parts[0]), "}\n",
                       s.parts.size() > 1 ? joined({"else {\n", text(s.parts[1]), "}\n"}) : std::string()});
      case Kind::kSwitch: {
        std::string result = joined({"switch (", s.choice.text(), ") {\n"});
        for (std::size_t i = 0; i < s.parts.size(); i++) {
          const bool is_default = s.has_default && i + 1 == s.parts.size();
          result += is_default ? std::string("default:\n") : joined({"case ", std::to_string(i), "u:\n"});
          result += joined({text(s.parts[i]), s.falls[i] ? "" : "break;\n"});
        }
        return result.append("}\n");
      }
      case Kind::kLoop: {
        const std::string done = joined({c, " > ", s.choice.text()}), body = text(s.parts[0]);
        if (s.leaves_inside)
          return joined({c, " = 0u;\nwhile (true) {\n", c, "++;\nif (", done, ") break;\n", body, "}\n"});
        return joined({"for (", c, " = 0u; !(", done, "); ", c, "++) {\n", body, "}\n"});
      }
      case Kind::kCall:
        return joined({"f", number, "();\n"});
      case Kind::kBreak:
        return "break;\n";
      case Kind::kContinue:
        return "continue;\n";
      case Kind::kReturn:
        return "return;\n";
    }
    return {};
  }

  std::minstd_rand random_;
  std::uint32_t notes_ = 0, calls_ = 0;
};

/// Invocations that run a program together.
class Model {
 public:
  using Mask = std::uint64_t;
  explicit Model(std::uint32_t subgroup) : subgroup_(subgroup) {}

  std::uint32_t x[kLanes], h[kLanes] = {};

  /// Those that come to the end of the list.
  Mask run(const std::vector<Statement>& list, Mask active) {
    for (const Statement& s : list)
      if (active != 0) active = run(s, active);
    return active;
  }

 private:
  struct Left {
    Mask broken = 0, continued = 0, returned = 0;
  };

  std::uint32_t value(const Choice& c, std::uint32_t lane) const {
    return (x[lane] * c.factor + turn_[c.turn][lane] * c.by) >> c.shift & c.mask;
  }

  template <class F>
  static Mask where(Mask active, const F& holds) {
    Mask result = 0;
    for (std::uint32_t lane = 0; lane < kLanes; lane++)
      if ((active >> lane & 1) != 0 && holds(lane)) result |= Mask{1} << lane;
    return result;
  }

  void note(Mask active, std::uint32_t number) {
    where(active, [&](std::uint32_t lane) {
      const std::uint32_t first = lane / subgroup_ * subgroup_;
      const Mask own = active >> first & (subgroup_ == 64 ? ~Mask{0} : (Mask{1} << subgroup_) - 1);
      const auto low = static_cast<std::uint32_t>(own), high = static_cast<std::uint32_t>(own >> 32);
      h[lane] = ((h[lane] ^ low) * 16777619u ^ high) * 16777619u + number;
      return true;
    });
  }

  Mask run(const Statement& s, Mask active) {
    using Kind = Statement::Kind;
    switch (s.kind) {
      case Kind::kNote:
        note(active, s.number);
        return active;
      case Kind::kIf: {
        const Mask then = where(active, [&](std::uint32_t lane) { return value(s.choice, lane) == 0; });
        const Mask rest = active & ~then;
        const Mask behind = run(s.parts[0], then);
        return behind | (s.parts.size() > 1 ? run(s.parts[1], rest) : rest);
      }
      case Kind::kSwitch:
        return run_switch(s, active);
      case Kind::kLoop:
        return run_loop(s, active);
      case Kind::kCall: {
        const Left outside = std::exchange(left_, {});
        run(s.parts[0], active);
        left_ = outside;
        return active;
      }
      case Kind::kBreak:
        left_.broken |= active;
        return 0;
      case Kind::kContinue:
        left_.continued |= active;
        return 0;
      case Kind::kReturn:
        left_.returned |= active;
        return 0;
    }
    return active;
  }

  Mask run_switch(const Statement& s, Mask active) {
    const Mask broken = std::exchange(left_.broken, 0);
    Mask waiting = active, fallen = 0, behind = 0;
    for (std::size_t i = 0; i < s.parts.size(); i++) {
      const bool is_default = s.has_default && i + 1 == s.parts.size();
      const Mask entering =
          is_default ? waiting : where(waiting, [&](std::uint32_t lane) { return value(s.choice, lane) == i; });
      waiting &= ~entering;
      const Mask ended = run(s.parts[i], entering | fallen);
      fallen = s.falls[i] ? ended : 0;
      behind |= s.falls[i] ? 0 : ended;
    }
    behind |= waiting | std::exchange(left_.broken, broken);
    return behind;
  }

  Mask run_loop(const Statement& s, Mask active) {
    const Mask broken = std::exchange(left_.broken, 0), continued = std::exchange(left_.continued, 0);
    auto& turn = turn_[s.number];
    const auto count = [&](std::uint32_t lane) { return ++turn[lane], true; };
    where(active, [&](std::uint32_t lane) { return turn[lane] = 0, true; });
    while (active != 0) {
      if (s.leaves_inside) where(active, count);
      const Mask done = where(active, [&](std::uint32_t lane) { return turn[lane] > value(s.choice, lane); });
      left_.broken |= done;
      active = run(s.parts[0], active & ~done) | std::exchange(left_.continued, 0);
      if (!s.leaves_inside) where(active, count);
    }
    left_.continued = continued;
    return std::exchange(left_.broken, broken);
  }

  std::uint32_t subgroup_;
  std::uint32_t turn_[kDepth][kLanes] = {};
  Left left_;
};

std::uint32_t input_of(std::uint32_t i) { return i * 2654435761u >> 20; }

/// With the execution mode MaximallyReconvergesKHR, which the installed compiler cannot write.
Words reconverging(Words words) {
  const auto mode = std::find_if(words.begin() + 5, words.end(), [](std::uint32_t word) {
    return (word & 0xffffu) == static_cast<std::uint32_t>(spv::Op::OpExecutionMode) && word >> 16 >= 3;
  });
  if (mode == words.end()) return words;
  const std::uint32_t added[] = {3u << 16 | static_cast<std::uint32_t>(spv::Op::OpExecutionMode), *(mode + 1),
                                 static_cast<std::uint32_t>(newer::kMaximallyReconverges)};
  words.insert(mode, std::begin(added), std::end(added));
  return words;
}

constexpr char kHead[] = R"(
#extension GL_KHR_shader_subgroup_ballot : enable
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) buffer B { uint v[]; };
uint x, h = 0u;
)";
constexpr char kNote[] = R"(
void note(uint number) {
  uvec4 b = subgroupBallot(true);
  h = ((h ^ b.x) * 16777619u ^ b.y) * 16777619u + number;
}
)";
constexpr char kMain[] = R"(}
void main() {
  x = v[gl_LocalInvocationIndex];
  run();
  note(1000u);
  v[gl_LocalInvocationIndex] = h;
}
)";

void expect_tangles(std::uint32_t seed) {
  Generator generator(seed);
  const std::vector<Statement> program = generator.list({});
  std::string counters;
  for (std::uint32_t i = 0; i < kDepth; i++) counters += joined({"uint c", std::to_string(i), " = 0u;\n"});
  const std::string body = generator.text(program);
  const std::string source = joined({kHead, counters, kNote, generator.functions, "void run() {\n", body, kMain});
  for (const std::uint32_t subgroup : {64u, 8u}) {
    std::vector<std::uint32_t> words(kLanes);
    Model model(subgroup);
    for (std::uint32_t i = 0; i < kLanes; i++) words[i] = model.x[i] = input_of(i + seed * kLanes);
    model.run(program, ~Model::Mask{0});
    model.run({{.kind = Statement::Kind::kNote, .number = 1000}}, ~Model::Mask{0});
    CompileOptions options = options_for(VK_SHADER_STAGE_COMPUTE_BIT);
    options.subgroup_size = subgroup;
    ASSERT_TRUE(dispatch_over(words, reconverging(compile_glsl(VK_SHADER_STAGE_COMPUTE_BIT, source)), options, 1));
    for (std::uint32_t lane = 0; lane < kLanes; lane++)
      ASSERT_EQ(words[lane], model.h[lane]) << "seed " << seed << ", lane " << lane << "\n" << source;
  }
}

TEST(Reconvergence, WhoExecutesTogetherIsWhatStructureSays) {
  for (std::uint32_t seed = 1; seed <= 60 && !HasFatalFailure(); seed++) expect_tangles(seed);
}

}  // namespace
}  // namespace vitrine::spirv::test
