// See expression.h: a parser by precedence that computes as it reads (GLSL 4.60, 5.1 Operators; without assignments).
#include "glass/debug/expression.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <stdexcept>

#include "glass/debug/operators.h"
#include "glass/debug/words.h"

namespace vitrine::glass::debug {
namespace {

struct Mistake : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Operators by how tightly they bind, the loosest first.
constexpr const char* kOperators[][5] = {{"||"},       {"^^"},     {"&&"},         {"|"},
                                         {"^"},        {"&"},      {"==", "!="},   {"<=", ">=", "<", ">"},
                                         {"<<", ">>"}, {"+", "-"}, {"*", "/", "%"}};
constexpr std::size_t kLevels = std::size(kOperators);
constexpr int kMostNested = 100;

class Parser {
 public:
  Parser(std::string_view text, const Viewer& viewer, const Names& names)
      : text_(text), viewer_(viewer), names_(names) {}

  Value all() {
    Value value = ternary();
    skip();
    if (at_ != text_.size()) throw Mistake(quoted(text_.substr(at_)) + " is not understood");
    return value;
  }

 private:
  void skip() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_]))) ++at_;
  }

  bool take(std::string_view word) {
    skip();
    if (!text_.substr(at_).starts_with(word)) return false;
    at_ += word.size();
    return true;
  }

  void demand(std::string_view word) {
    if (!take(word)) throw Mistake(quoted(word) + " is missing");
  }

  /// The operator of this level that stands here; null: none does.
  const char* take_operator(std::size_t level) {
    skip();
    const std::string_view rest = text_.substr(at_);
    for (const char* const word : kOperators[level]) {
      if (word == nullptr || !rest.starts_with(word)) continue;
      const std::string_view longer = rest.substr(0, std::string_view(word).size() + 1);
      // "&" is not the beginning of "&&", nor "<" of "<<".
      if (longer == "&&" || longer == "||" || longer == "^^" || longer == "<<" || longer == ">>")
        if (longer != word) continue;
      at_ += std::string_view(word).size();
      return word;
    }
    return nullptr;
  }

  std::vector<Scalar> numbers(const Value& value) const {
    std::vector<Scalar> result = value.place ? numbers_of(viewer_, *value.place) : value.scalars;
    if (result.empty()) throw Mistake("a number or vector is wanted");
    for (const Scalar& scalar : result)
      if (scalar.type == '?') throw Mistake("a value that nobody has written");
    return result;
  }

  static Value of(std::vector<Scalar> scalars) { return {std::nullopt, std::move(scalars)}; }

  Value ternary() {
    if (++nested_ > kMostNested) throw Mistake("too deeply nested");
    Value value = binary(0);
    if (take("?")) {
      const bool first = to_bool(numbers(value)[0]);
      Value yes = ternary();
      demand(":");
      Value no = ternary();
      value = first ? yes : no;
    }
    --nested_;
    return value;
  }

  Value binary(std::size_t level) {
    if (level == kLevels) return unary();
    Value left = binary(level + 1);
    while (const char* const word = take_operator(level)) {
      const Value right = binary(level + 1);
      std::vector<Scalar> result;
      std::string error;
      if (!apply(word, numbers(left), numbers(right), result, error)) throw Mistake(error);
      left = of(std::move(result));
    }
    return left;
  }

  Value unary() {
    if (++nested_ > kMostNested) throw Mistake("too deeply nested");
    Value value = prefixed();
    --nested_;
    return value;
  }

  Value prefixed() {
    for (const char sign : {'-', '!', '~', '+'}) {
      if (!take(std::string_view(&sign, 1))) continue;
      std::vector<Scalar> operand = numbers(unary());
      for (Scalar& scalar : operand) scalar = negate(sign, scalar);
      return of(std::move(operand));
    }
    return postfix();
  }

  Value postfix() {
    Value value = primary();
    for (;;) {
      if (take("[")) {
        const std::int64_t index = to_int(numbers(ternary())[0]);
        demand("]");
        value = element(value, index);
      } else if (take(".")) {
        value = member(value, word());
      } else {
        return value;
      }
    }
  }

  std::string word() {
    skip();
    const std::size_t begin = at_;
    while (at_ < text_.size() &&
           (std::isalnum(static_cast<unsigned char>(text_[at_])) || text_[at_] == '_' || text_[at_] == '%'))
      ++at_;
    if (at_ == begin) throw Mistake("a name or number is missing");
    return std::string(text_.substr(begin, at_ - begin));
  }

  Value element(const Value& value, std::int64_t index) const {
    if (!value.place) {
      if (index < 0 || index >= static_cast<std::int64_t>(value.scalars.size())) throw Mistake("index out of range");
      return of({value.scalars[static_cast<std::size_t>(index)]});
    }
    if (index < 0 || index >= static_cast<std::int64_t>(count_of(viewer_, *value.place)))
      throw Mistake("index " + std::to_string(index) + " is out of range: there are " +
                    std::to_string(count_of(viewer_, *value.place)));
    return {element_of(viewer_.tables(), *value.place, static_cast<std::uint32_t>(index)), {}};
  }

  Value member(const Value& value, const std::string& name) const {
    if (value.place && !value.place->descriptors) {
      const spirv::SourceType& type = viewer_.tables().types[value.place->type];
      for (std::uint32_t i = 0; i < type.members.size(); ++i)
        if (type.members[i].name == name) return {member_of(viewer_.tables(), *value.place, i), {}};
      if (type.kind == spirv::SourceType::Kind::kStruct) throw Mistake("there is no member '" + name + "'");
    }
    return swizzle(value, name);
  }

  Value swizzle(const Value& value, const std::string& name) const {
    const std::vector<Scalar> from = value.place ? numbers_of(viewer_, *value.place) : value.scalars;
    std::vector<Scalar> result;
    for (const char letter : name) {
      std::size_t component = 4;
      for (const std::string_view letters : {"xyzw", "rgba", "stpq"})
        if (const std::size_t at = letters.find(letter); at != std::string_view::npos) component = at;
      if (component >= from.size() || name.size() > 4) throw Mistake("there is no member '" + name + "'");
      // One component stays where it is, so that it can be watched.
      if (name.size() == 1 && value.place) return element(value, static_cast<std::int64_t>(component));
      result.push_back(from[component]);
    }
    return of(std::move(result));
  }

  Value primary() {
    if (take("(")) {
      Value value = ternary();
      demand(")");
      return value;
    }
    skip();
    if (at_ < text_.size() && (std::isdigit(static_cast<unsigned char>(text_[at_])) || text_[at_] == '.'))
      return number();
    const std::string name = word();
    if (name == "true" || name == "false") return of({make_bool(name == "true")});
    if (const std::optional<Place> place = names_.find(name)) return {*place, {}};
    if (take("(")) return call(name);
    throw Mistake("no variable '" + name + "' is visible here");
  }

  Value number() {
    const std::string_view rest = text_.substr(at_);
    const bool hex = rest.starts_with("0x") || rest.starts_with("0X");
    std::size_t end = hex ? 2 : 0;
    bool real = false;
    for (; end < rest.size(); ++end) {
      const char c = rest[end];
      if (!hex && (c == '.' || c == 'e' || c == 'E')) real = true;
      const bool sign = !hex && (c == '-' || c == '+') && (rest[end - 1] == 'e' || rest[end - 1] == 'E');
      if (!std::isxdigit(static_cast<unsigned char>(c)) && c != '.' && !sign) break;
      if (!hex && (c == 'f' || c == 'F')) break;
    }
    at_ += end;
    const std::string_view digits = rest.substr(0, end);
    if (take("f") || take("F")) real = true;
    if (real) {
      double value = 0;
      const auto [stop, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
      if (error != std::errc() || stop != digits.data() + digits.size()) throw Mistake("that is no number");
      return of({make_float(value)});
    }
    std::uint64_t value = 0;
    const char* const begin = digits.data() + (hex ? 2 : 0);
    const auto [stop, error] = std::from_chars(begin, digits.data() + digits.size(), value, hex ? 16 : 10);
    if (error != std::errc() || stop != digits.data() + digits.size()) throw Mistake("that is no number");
    const bool is_unsigned = take("u") || take("U");
    return of({is_unsigned ? make_uint(value) : make_int(static_cast<std::int64_t>(value))});
  }

  Value call(const std::string& name) {
    std::vector<std::vector<Scalar>> arguments;
    if (!take(")")) {
      do arguments.push_back(numbers(ternary()));
      while (take(","));
      demand(")");
    }
    std::vector<Scalar> result;
    std::string error;
    if (!call_function(name, arguments, result, error)) throw Mistake(error);
    return of(std::move(result));
  }

  std::string_view text_;
  const Viewer& viewer_;
  const Names& names_;
  std::size_t at_ = 0;
  int nested_ = 0;
};

}  // namespace

base::Result<Value> evaluate(std::string_view text, const Viewer& viewer, const Names& names) {
  try {
    return Parser(text, viewer, names).all();
  } catch (const Mistake& mistake) {
    return base::Error{mistake.what()};
  }
}

}  // namespace vitrine::glass::debug
