// Parts of shaders made at random (random_shader.h): expressions and statements, as text and as what they do.
#pragma once

#include <functional>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "tests/glass/debug/random_shader.h"
#include "tests/glass/debug/random_values.h"

namespace vitrine::glass::debug::test {

struct RandomVariable {
  std::string name;
  const RandomType* type = nullptr;
  std::size_t slot = 0;  ///< of its first number
};
using Visible = std::shared_ptr<const std::vector<RandomVariable>>;

/// More lines than that are too many to be worth it.
inline constexpr std::size_t kMostStops = 1500;

/// One invocation that runs.
struct Machine {
  struct Frame {
    std::uint32_t line = 0;
    Visible visible;
  };
  std::uint32_t id = 0;
  std::vector<std::uint64_t> memory;
  std::vector<Frame> frames;  ///< outermost first
  std::vector<std::uint64_t> result;
  std::vector<ExpectedStop> stops;
  bool records = false;

  /// A line begins.
  void come_to(std::uint32_t line, const Visible& visible) {
    frames.back() = {line, visible};
    if (!records || stops.size() > kMostStops) return;
    ExpectedStop stop;
    for (std::size_t i = frames.size(); i-- > 0;) {
      ExpectedFrame frame{frames[i].line, {}};
      for (const RandomVariable& variable : *frames[i].visible)
        frame.values.emplace_back(variable.name, text_of(*variable.type, &memory[variable.slot]));
      stop.frames.push_back(std::move(frame));
    }
    stops.push_back(std::move(stop));
  }
};

enum class Flow : std::uint8_t { kNext, kBreak, kContinue, kReturn };
using Action = std::function<Flow(Machine&)>;

/// A number.
struct Expression {
  std::string text;
  std::function<std::uint64_t(Machine&)> value;
};
/// A value of any type.
struct Whole {
  std::string text;
  std::function<std::vector<std::uint64_t>(Machine&)> value;
};
/// Where a number lies.
struct Target {
  std::string text;
  const RandomType* type = nullptr;
  std::function<std::size_t(Machine&)> slot;
};

struct RandomTypes {
  RandomType boolean{RandomType::Kind::kNumber, "bool", 'B', 32, nullptr, 0, {}};
  RandomType integer{RandomType::Kind::kNumber, "int", 'I', 32, nullptr, 0, {}};
  RandomType natural{RandomType::Kind::kNumber, "uint", 'U', 32, nullptr, 0, {}};
  RandomType real{RandomType::Kind::kNumber, "float", 'F', 32, nullptr, 0, {}};
  RandomType wide{RandomType::Kind::kNumber, "int64_t", 'I', 64, nullptr, 0, {}};
  RandomType ivec3{RandomType::Kind::kVector, "ivec3", '?', 32, &integer, 3, {}};
  RandomType uvec4{RandomType::Kind::kVector, "uvec4", '?', 32, &natural, 4, {}};
  RandomType vec2{RandomType::Kind::kVector, "vec2", '?', 32, &real, 2, {}};
  RandomType vec4{RandomType::Kind::kVector, "vec4", '?', 32, &real, 4, {}};
  RandomType ints{RandomType::Kind::kArray, "int[4]", '?', 32, &integer, 4, {}};
  RandomType pair{RandomType::Kind::kStruct,
                  "Pair",
                  '?',
                  32,
                  nullptr,
                  0,
                  {{"a", &integer}, {"v", &vec2}, {"w", &wide}, {"t", &ints}}};
  RandomType pairs{RandomType::Kind::kArray, "Pair[2]", '?', 32, &pair, 2, {}};
};

/// Makes expressions over what is visible.
class ExpressionMaker {
 public:
  explicit ExpressionMaker(std::uint32_t seed) : random_(seed) {}

  std::uint32_t below(std::uint32_t count) { return static_cast<std::uint32_t>(random_() % count); }
  bool chance(std::uint32_t percent) { return below(100) < percent; }

  const RandomType& any_number();
  const RandomType& any_type();
  /// What may be assigned to a number of this type.
  Expression number(const RandomType& type) { return type.letter == 'F' ? bounded(real(2)) : deep(type, 2); }
  /// Of a branch: it is no constant, for then no instruction of the module would belong to its line.
  Expression condition();
  Whole whole(const RandomType& type);
  /// A number of a variable that is visible and may be written; type null: there is none.
  Target target();

  RandomTypes types;
  std::vector<RandomVariable> visible;  ///< in the order of their declarations
  std::vector<std::string> constant;    ///< names of those that are not written

 private:
  Expression deep(const RandomType& type, int depth);
  Expression leaf(const RandomType& type);
  Expression literal(const RandomType& type);
  Expression boolean(int depth);
  Expression integer(const RandomType& type, int depth);
  Expression converted(const RandomType& type, int depth);
  Expression real(int depth);
  Expression bounded(Expression inner);
  Target number_in(const RandomVariable& variable);

  std::mt19937 random_;
};

}  // namespace vitrine::glass::debug::test
