// See random_shader.h: statements, functions, and the whole.
#include "tests/glass/debug/random_shader.h"

#include <algorithm>

#include "tests/glass/debug/random_parts.h"

namespace vitrine::glass::debug::test {
namespace {

using Block = std::vector<Action>;

Flow run_block(const Block& block, Machine& m) {
  for (const Action& action : block)
    if (const Flow flow = action(m); flow != Flow::kNext) return flow;
  return Flow::kNext;
}

struct Parameter {
  RandomVariable variable;
  bool in = true, out = false;
};

struct Function {
  std::string name;
  const RandomType* result = nullptr;  ///< null: nothing
  std::vector<Parameter> parameters;
  Block body;
};

class Maker {
 public:
  explicit Maker(std::uint32_t seed) : make_(seed) {}

  void whole() {
    line("#version 450");
    line("#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require");
    line("layout(local_size_x = 8) in;");
    line("layout(std430, set = 0, binding = 0) buffer Data { uint data[]; };");
    line("struct Pair { int a; vec2 v; int64_t w; int t[4]; };");
    for (std::uint32_t i = make_.below(3); i-- > 0;) {
      const RandomType& type = make_.any_number();
      line(type.name + " " + declare("g", type).name + ";");
    }
    const std::vector<RandomVariable> global = make_.visible;
    for (std::uint32_t i = make_.below(4); i-- > 0;) {
      add_function();
      make_.visible = global;
    }
    add_main(global);
  }

  std::string text() const { return text_; }
  Machine run(std::uint32_t lane, bool records) const {
    Machine m;
    m.id = lane;
    m.records = records;
    m.memory.resize(slots_);
    m.frames.emplace_back();
    run_block(main_, m);
    return m;
  }

 private:
  /// Returns its number.
  std::uint32_t line(const std::string& text) {
    text_.append(indent_ * 2, ' ').append(text).append("\n");
    return ++lines_;
  }

  RandomVariable declare(const char* prefix, const RandomType& type) {
    const RandomVariable variable{prefix + std::to_string(++names_), &type, slots_};
    slots_ += type.numbers();
    make_.visible.push_back(variable);
    return variable;
  }

  Visible seen() const { return std::make_shared<const std::vector<RandomVariable>>(make_.visible); }

  /// A line, and what is visible when it begins.
  std::function<void(Machine&)> step(const std::string& text) {
    return [number = line(text), visible = seen()](Machine& m) { m.come_to(number, visible); };
  }

  Action assign(const RandomVariable& variable, const std::string& text, const Whole& value) {
    return [come = step(text), slot = variable.slot, value = value.value](Machine& m) {
      come(m);
      std::ranges::copy(value(m), m.memory.begin() + static_cast<std::ptrdiff_t>(slot));
      return Flow::kNext;
    };
  }

  Action declaration() {
    const RandomType& type = make_.any_type();
    const Whole value = make_.whole(type);
    const std::string name = std::string("v") + std::to_string(names_ + 1);
    // Not visible on its own line.
    const auto come = step(type.name + " " + name + " = " + value.text + ";");
    const RandomVariable variable = declare("v", type);
    return [come, slot = variable.slot, value = value.value](Machine& m) {
      come(m);
      std::ranges::copy(value(m), m.memory.begin() + static_cast<std::ptrdiff_t>(slot));
      return Flow::kNext;
    };
  }

  Action assignment() {
    const Target target = make_.target();
    if (target.type == nullptr) return declaration();
    const Expression value = make_.number(*target.type);
    return [come = step(target.text + " = " + value.text + ";"), slot = target.slot, value = value.value](Machine& m) {
      come(m);
      const std::size_t at = slot(m);
      m.memory[at] = value(m);
      return Flow::kNext;
    };
  }

  Action whole_assignment() {
    std::vector<RandomVariable> all;
    for (const RandomVariable& variable : make_.visible)
      if (variable.type->kind != RandomType::Kind::kNumber) all.push_back(variable);
    if (all.empty()) return declaration();
    const RandomVariable& variable = all[make_.below(static_cast<std::uint32_t>(all.size()))];
    const Whole value = make_.whole(*variable.type);
    return assign(variable, variable.name + " = " + value.text + ";", value);
  }

  /// Statements in braces that somebody else writes.
  Block block(std::uint32_t most) {
    const std::vector<RandomVariable> before = make_.visible;
    ++indent_;
    ++depth_;
    Block result;
    for (std::uint32_t i = 1 + make_.below(most); i-- > 0;) result.push_back(statement());
    --depth_;
    --indent_;
    make_.visible = before;
    return result;
  }

  Action branch() {
    const Expression condition = make_.condition();
    const auto come = step(std::string("if (") + condition.text + ") {");
    const Block yes = block(3);
    Block no;
    if (make_.chance(50)) {
      line("} else {");
      no = block(3);
    }
    line("}");
    return [come, yes, no, value = condition.value](Machine& m) {
      come(m);
      return run_block(value(m) != 0 ? yes : no, m);
    };
  }

  /// `if (...) break;` and the like, where they are allowed.
  Action leave() {
    const bool returns = function_ != nullptr && make_.chance(40);
    if (loops_ == 0 && !returns) return assignment();
    const Expression condition = make_.condition();
    const auto come = step(std::string("if (") + condition.text + ") {");
    ++indent_;
    Action action;
    if (returns) {
      action = return_statement();
    } else {
      const bool goes_on = make_.chance(40);
      line(goes_on ? "continue;" : "break;");
      action = [goes_on](Machine&) { return goes_on ? Flow::kContinue : Flow::kBreak; };
    }
    --indent_;
    line("}");
    return [come, action, value = condition.value](Machine& m) {
      come(m);
      return value(m) != 0 ? action(m) : Flow::kNext;
    };
  }

  Action return_statement() {
    if (function_->result == nullptr) {
      return [come = step("return;")](Machine& m) {
        come(m);
        return Flow::kReturn;
      };
    }
    const Whole value = make_.whole(*function_->result);
    return [come = step(std::string("return ") + value.text + ";"), value = value.value](Machine& m) {
      come(m);
      m.result = value(m);
      return Flow::kReturn;
    };
  }

  /// `body` comes before what may leave it: a loop's line is then another than the one before.
  Block loop_body() {
    ++loops_;
    Block body = block(3);
    --loops_;
    return body;
  }

  Action for_loop() {
    const std::vector<RandomVariable> before = make_.visible;
    const std::uint32_t count = 1 + make_.below(4);
    const bool constant = make_.chance(50);
    const Expression most = make_.number(make_.types.integer);
    const std::string bound = constant ? std::to_string(count) : std::string("(") + most.text + " & 3)";
    const std::string name = std::string("i") + std::to_string(names_ + 1);
    const auto come = step(std::string("for (int ") + name + " = 0; " + name + " < " + bound + "; ++" + name + ") {");
    const std::uint32_t number = lines_;
    const std::size_t slot = declare("i", make_.types.integer).slot;
    make_.constant.push_back(name);
    const Visible inside = seen();
    const Block body = loop_body();
    line("}");
    make_.visible = before;
    const auto limit = [constant, count, value = most.value](Machine& m) { return constant ? count : value(m) & 3; };
    return [=](Machine& m) {
      come(m);
      for (m.memory[slot] = 0; m.memory[slot] < limit(m); ++m.memory[slot]) {
        const Flow flow = run_block(body, m);
        if (flow == Flow::kReturn) return flow;
        if (flow == Flow::kBreak) break;
        m.come_to(number, inside);
      }
      return Flow::kNext;
    };
  }

  /// With a counter of its own.
  Action while_loop(bool tests_first) {
    const auto begin = [&](const RandomVariable& counter) {
      make_.constant.push_back(counter.name);
      const std::size_t slot = counter.slot;
      return [slot, come = step(counter.name + " += 1;")](Machine& m) { return come(m), ++m.memory[slot]; };
    };
    const auto reset = step(std::string("int n") + std::to_string(names_ + 1) + " = 0;");
    const RandomVariable counter = declare("n", make_.types.integer);
    const std::uint32_t most = 1 + make_.below(4);
    const Expression more = make_.condition();
    const std::string condition = counter.name + " < " + std::to_string(most) + " && " + more.text;
    const auto outside = seen();
    std::function<void(Machine&)> come;
    if (tests_first)
      come = step(std::string("while (") + condition + ") {");
    else
      line("do {");
    ++indent_;
    const auto count = begin(counter);
    --indent_;
    const Block body = loop_body();
    if (tests_first)
      line("}");
    else
      come = [number = line(std::string("} while (") + condition + ");"), outside](Machine& m) {
        m.come_to(number, outside);
      };
    return [=, slot = counter.slot, more = more.value](Machine& m) {
      reset(m);
      m.memory[slot] = 0;
      const auto holds = [&] {
        come(m);
        const bool goes_on = more(m) != 0;
        return m.memory[slot] < most && goes_on;
      };
      if (tests_first && !holds()) return Flow::kNext;
      do {
        count(m);
        const Flow flow = run_block(body, m);
        if (flow == Flow::kReturn) return flow;
        if (flow == Flow::kBreak) return Flow::kNext;
      } while (holds());
      return Flow::kNext;
    };
  }

  Action switch_statement() {
    const Expression value = make_.number(make_.types.natural);
    const auto come = step(std::string("switch (") + value.text + " + data[9] & 3u) {");
    const std::uint32_t cases = 2 + make_.below(3);
    std::vector<Block> blocks;
    std::vector<bool> breaks;
    const int loops = std::exchange(loops_, 0);
    for (std::uint32_t i = 0; i < cases; ++i) {
      line(i == 3 ? "default: {" : std::string("case ") + std::to_string(i) + ": {");
      blocks.push_back(block(2));
      breaks.push_back(i + 1 == cases || make_.chance(75));
      line("}");
      if (breaks.back()) line("break;");
    }
    loops_ = loops;
    line("}");
    return [=, value = value.value](Machine& m) {
      come(m);
      for (std::size_t i = (value(m) + 19) & 3; i < blocks.size(); ++i) {
        const Flow flow = run_block(blocks[i], m);
        if (flow == Flow::kBreak) return Flow::kNext;
        if (flow != Flow::kNext) return flow;
        if (breaks[i]) return Flow::kNext;
      }
      return Flow::kNext;
    };
  }

  Action call() {
    if (functions_.empty()) return assignment();
    const std::shared_ptr<const Function> function =
        functions_[make_.below(static_cast<std::uint32_t>(functions_.size()))];
    std::string text = function->name + "(";
    std::vector<Whole> in;
    std::vector<std::size_t> out;
    for (const Parameter& parameter : function->parameters) {
      if (text.back() != '(') text += ", ";
      const auto fits = [&](const RandomVariable& v) {
        return v.type == parameter.variable.type && std::ranges::find(make_.constant, v.name) == make_.constant.end();
      };
      in.push_back(make_.whole(*parameter.variable.type));
      out.push_back(0);
      if (parameter.out) {
        const auto found = std::ranges::find_if(make_.visible, fits);
        if (found == make_.visible.end()) return assignment();
        out.back() = found->slot;
        in.back() = {found->name, [slot = found->slot, n = found->type->numbers()](Machine& m) {
                       const auto first = m.memory.begin() + static_cast<std::ptrdiff_t>(slot);
                       return std::vector<std::uint64_t>(first, first + n);
                     }};
      }
      text += in.back().text;
    }
    text += ")";
    if (function->result == nullptr) return call_of(function, in, out, step(text + ";"), std::nullopt);
    const auto come = step(function->result->name + " v" + std::to_string(names_ + 1) + " = " + text + ";");
    return call_of(function, in, out, come, declare("v", *function->result).slot);
  }

  static Action call_of(const std::shared_ptr<const Function>& function, const std::vector<Whole>& in,
                        const std::vector<std::size_t>& out, const std::function<void(Machine&)>& come,
                        std::optional<std::size_t> result) {
    const auto put = [](Machine& m, std::size_t slot, const std::vector<std::uint64_t>& words) {
      std::ranges::copy(words, m.memory.begin() + static_cast<std::ptrdiff_t>(slot));
    };
    return [=](Machine& m) {
      come(m);
      std::vector<std::vector<std::uint64_t>> words;
      for (const Whole& one : in) words.push_back(one.value(m));
      for (std::size_t i = 0; i < in.size(); ++i) put(m, function->parameters[i].variable.slot, words[i]);
      m.frames.emplace_back();
      run_block(function->body, m);
      m.frames.pop_back();
      for (std::size_t i = 0; i < in.size(); ++i) {
        const Parameter& parameter = function->parameters[i];
        const auto first = m.memory.begin() + static_cast<std::ptrdiff_t>(parameter.variable.slot);
        if (parameter.out) put(m, out[i], {first, first + parameter.variable.type->numbers()});
      }
      if (result) put(m, *result, m.result);
      return Flow::kNext;
    };
  }

  Action statement() {
    const std::uint32_t kind = make_.below(100);
    if (kind < 25 || depth_ > 3) return assignment();
    if (kind < 40) return declaration();
    if (kind < 50) return whole_assignment();
    if (kind < 60) return call();
    if (kind < 72) return branch();
    if (kind < 80) return leave();
    if (kind < 86 && loops_ < 2) return for_loop();
    if (kind < 92 && loops_ < 2) return while_loop(make_.chance(50));
    return kind < 97 ? switch_statement() : assignment();
  }

  void add_function() {
    auto function = std::make_shared<Function>();
    function->name = std::string("f") + std::to_string(++names_);
    if (make_.chance(70)) function->result = &make_.any_type();
    std::string text = (function->result == nullptr ? "void" : function->result->name) + " " + function->name + "(";
    for (std::uint32_t i = make_.below(4); i-- > 0;) {
      Parameter parameter;
      parameter.out = make_.chance(30);
      parameter.variable = declare("p", make_.any_type());
      text += (parameter.out ? "inout " : "") + parameter.variable.type->name + " " + parameter.variable.name;
      if (i != 0) text += ", ";
      function->parameters.push_back(std::move(parameter));
    }
    line(text + ") {");
    function_ = function.get();
    function->body = block(5);
    if (function->result != nullptr) {
      ++indent_;
      function->body.push_back(return_statement());
      --indent_;
    }
    function_ = nullptr;
    line("}");
    functions_.push_back(std::move(function));
  }

  void add_main(const std::vector<RandomVariable>& global) {
    line("void main() {");
    ++indent_;
    make_.visible.clear();
    for (const RandomVariable& variable : global) {
      const Whole value = make_.whole(*variable.type);
      main_.push_back(assign(variable, variable.name + " = " + value.text + ";", value));
      make_.visible.push_back(variable);
    }
    const auto come = step("uint id = gl_LocalInvocationID.x;");
    make_.visible.push_back({"id", &make_.types.natural, slots_++});
    make_.constant.emplace_back("id");
    main_.push_back([come, slot = slots_ - 1](Machine& m) {
      come(m);
      m.memory[slot] = m.id;
      return Flow::kNext;
    });
    for (std::uint32_t i = 4 + make_.below(6); i-- > 0;) main_.push_back(statement());
    add_result();
    --indent_;
    line("}");
  }

  /// Everything that is visible at the end is in what the buffer gets.
  void add_result() {
    const Visible visible = seen();
    std::string sum = "7u";
    std::vector<std::pair<std::size_t, const RandomType*>> numbers;
    const std::function<void(const std::string&, const RandomType&)> add = [&](const std::string& path,
                                                                               const RandomType& type) {
      if (type.kind != RandomType::Kind::kNumber) {
        for (std::uint32_t i = 0; i < type.count; ++i) add(path + "[" + std::to_string(i) + "]", *type.element);
        for (const auto& [name, part] : type.members) add(path + "." + name, *part);
        return;
      }
      numbers.emplace_back(slots_, &type);
      ++slots_;
      sum = std::string("(") + sum + ") * 31u + ";
      sum += type.letter == 'F' ? std::string("uint(int(") + path + " * 4.0))" : std::string("uint(") + path + ")";
    };
    std::vector<Action> parts;
    const auto come = [&] {
      for (const RandomVariable& variable : *visible) {
        const std::size_t first = numbers.size();
        add(variable.name, *variable.type);
        for (std::size_t i = first; i < numbers.size(); ++i) numbers[i].first = variable.slot + (i - first);
      }
      return step(std::string("data[id] = ") + sum + ";");
    }();
    main_.push_back([come, numbers](Machine& m) {
      come(m);
      std::uint32_t sum_of_all = 7;
      for (const auto& [slot, type] : numbers) {
        const std::uint64_t bits = m.memory[slot];
        const auto word = static_cast<std::uint32_t>(
            type->letter == 'F' ? static_cast<std::uint32_t>(static_cast<std::int32_t>(float_of(bits) * 4.0f)) : bits);
        sum_of_all = sum_of_all * 31u + word;
      }
      m.result = {sum_of_all};
      return Flow::kNext;
    });
  }

  ExpressionMaker make_;
  std::string text_;
  std::uint32_t lines_ = 0;
  std::size_t indent_ = 0, slots_ = 0;
  int names_ = 0, loops_ = 0, depth_ = 0;
  std::vector<std::shared_ptr<const Function>> functions_;
  const Function* function_ = nullptr;  ///< whose statements are made
  Block main_;
};

}  // namespace

RandomShader make_random_shader(std::uint32_t seed, std::uint32_t lane) {
  for (std::uint32_t attempt = 0;; ++attempt) {
    Maker maker(seed + attempt * 0x9e3779b9u);
    maker.whole();
    RandomShader shader;
    shader.text = maker.text();
    Machine m = maker.run(lane, true);
    if (m.stops.size() > kMostStops) continue;
    shader.stops = std::move(m.stops);
    for (std::uint32_t i = 0; i < kRandomWords; ++i) shader.words.push_back(10 + i);
    for (std::uint32_t i = 0; i < kRandomLanes; ++i)
      shader.words[i] = static_cast<std::uint32_t>(maker.run(i, false).result.at(0));
    return shader;
  }
}

}  // namespace vitrine::glass::debug::test
