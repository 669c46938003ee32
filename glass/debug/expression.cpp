// See expression.h: a parser by precedence (GLSL 4.60, 5.1 Operators; without assignments), and what computes.
#include "glass/debug/expression.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <stdexcept>

#include "glass/debug/operators.h"
#include "glass/debug/words.h"

namespace vitrine::glass::debug {

struct ExpressionNode {
  enum class Kind : std::uint8_t { kConstant, kName, kChoice, kBinary, kPrefix, kElement, kMember, kCall, kList } kind;
  std::string word;  ///< a name, an operator
  std::vector<ExpressionNode> parts;
  std::vector<Scalar> constant;
  std::vector<std::string> names = {};  ///< of the parts of a list, if they have any
};

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

using Node = ExpressionNode;

/// Makes a tree of the text.
class Parser {
 public:
  explicit Parser(std::string_view text) : text_(text) {}

  Node all() {
    Node root = ternary();
    skip();
    if (at_ != text_.size()) throw Mistake(quoted(text_.substr(at_)) + " is not understood");
    return root;
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

  static Node made(Node::Kind kind, std::string word, std::vector<Node> parts) {
    return {kind, std::move(word), std::move(parts), {}};
  }
  static Node constant(Scalar scalar) { return {Node::Kind::kConstant, {}, {}, {scalar}}; }

  Node ternary() {
    if (++nested_ > kMostNested) throw Mistake("too deeply nested");
    Node node = binary(0);
    if (take("?")) {
      Node yes = ternary();
      demand(":");
      Node no = ternary();
      node = made(Node::Kind::kChoice, {}, {std::move(node), std::move(yes), std::move(no)});
    }
    --nested_;
    return node;
  }

  Node binary(std::size_t level) {
    if (level == kLevels) return unary();
    Node left = binary(level + 1);
    while (const char* const word = take_operator(level)) {
      Node right = binary(level + 1);
      left = made(Node::Kind::kBinary, word, {std::move(left), std::move(right)});
    }
    return left;
  }

  Node unary() {
    if (++nested_ > kMostNested) throw Mistake("too deeply nested");
    Node node = prefixed();
    --nested_;
    return node;
  }

  Node prefixed() {
    for (const char sign : {'-', '!', '~', '+'})
      if (take(std::string_view(&sign, 1))) return made(Node::Kind::kPrefix, std::string(1, sign), {unary()});
    return postfix();
  }

  Node postfix() {
    Node node = primary();
    for (;;) {
      if (take("[")) {
        std::vector<Node> parts = {std::move(node)};
        do parts.push_back(ternary());
        while (take(","));
        demand("]");
        node = made(Node::Kind::kElement, {}, std::move(parts));
      } else if (take(".")) {
        node = made(Node::Kind::kMember, word(), {std::move(node)});
      } else {
        return node;
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

  /// The name in front of '=' in a list; empty: there is none.
  std::string take_name() {
    const std::size_t begin = at_;
    skip();
    if (at_ < text_.size() && (std::isalpha(static_cast<unsigned char>(text_[at_])) || text_[at_] == '_')) {
      std::string name = word();
      if (take("=") && !take("=")) return name;
    }
    at_ = begin;
    return {};
  }

  /// {a, b}, {first = a, rest = b}: behind the brace.
  Node list() {
    Node node = made(Node::Kind::kList, {}, {});
    do {
      if (std::string name = take_name(); !name.empty()) node.names.push_back(std::move(name));
      node.parts.push_back(ternary());
    } while (take(","));
    demand("}");
    if (!node.names.empty() && node.names.size() != node.parts.size()) throw Mistake("some members have no names");
    return node;
  }

  Node primary() {
    if (take("{")) return list();
    if (take("(")) {
      Node node = ternary();
      // (a, b): as values are shown.
      if (take(",")) {
        node = made(Node::Kind::kList, {}, {std::move(node)});
        do node.parts.push_back(ternary());
        while (take(","));
      }
      demand(")");
      return node;
    }
    skip();
    if (at_ < text_.size() && (std::isdigit(static_cast<unsigned char>(text_[at_])) || text_[at_] == '.'))
      return number();
    std::string name = word();
    if (name == "true" || name == "false") return constant(make_bool(name == "true"));
    if (!take("(")) return made(Node::Kind::kName, std::move(name), {});
    std::vector<Node> arguments;
    if (!take(")")) {
      do arguments.push_back(ternary());
      while (take(","));
      demand(")");
    }
    return made(Node::Kind::kCall, std::move(name), std::move(arguments));
  }

  Node number() {
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
      return constant(make_float(value));
    }
    std::uint64_t value = 0;
    const char* const begin = digits.data() + (hex ? 2 : 0);
    const auto [stop, error] = std::from_chars(begin, digits.data() + digits.size(), value, hex ? 16 : 10);
    if (error != std::errc() || stop != digits.data() + digits.size()) throw Mistake("that is no number");
    const bool is_unsigned = take("u") || take("U");
    return constant(is_unsigned ? make_uint(value) : make_int(static_cast<std::int64_t>(value)));
  }

  std::string_view text_;
  std::size_t at_ = 0;
  int nested_ = 0;
};

/// Computes a tree for one invocation.
class Evaluator {
 public:
  Evaluator(const Viewer& viewer, const Names& names) : viewer_(viewer), names_(names) {}

  Value value_of(const Node& node) const {
    using Kind = Node::Kind;
    switch (node.kind) {
      case Kind::kConstant:
        return of(node.constant);
      case Kind::kName:
        if (const std::optional<Place> place = names_.find(node.word)) return {*place, {}};
        throw Mistake("no variable '" + node.word + "' is visible here");
      case Kind::kChoice:
        return value_of(node.parts[to_bool(numbers(node.parts[0])[0]) ? 1 : 2]);
      case Kind::kBinary:
        return binary(node);
      case Kind::kPrefix: {
        std::vector<Scalar> operand = numbers(node.parts[0]);
        for (Scalar& scalar : operand) scalar = negate(node.word[0], scalar);
        return of(std::move(operand));
      }
      case Kind::kElement: {
        const Value value = value_of(node.parts[0]);
        if (is_image(value)) return texel(value, node);
        if (node.parts.size() != 2) throw Mistake("texels of images have several indices");
        return element(value, to_int(numbers(node.parts[1])[0]));
      }
      case Kind::kMember:
        return member(value_of(node.parts[0]), node.word);
      case Kind::kCall:
        return call(node);
      case Kind::kList: {
        Value value;
        for (const Node& part : node.parts) value.list.push_back(value_of(part));
        value.names = node.names;
        return value;
      }
    }
    return {};
  }

 private:
  static Value of(std::vector<Scalar> scalars) { return {std::nullopt, std::move(scalars)}; }

  std::vector<Scalar> numbers(const Node& node) const {
    Value value = value_of(node);
    std::vector<Scalar> result = value.place ? numbers_of(viewer_, *value.place) : std::move(value.scalars);
    if (result.empty()) throw Mistake("a number or vector is wanted");
    for (const Scalar& scalar : result)
      if (scalar.type == '?') throw Mistake("a value that nobody has written");
    return result;
  }

  /// Where the left operand of && or || decides, the right one is not looked at (GLSL 4.60, 5.9 Expressions).
  Value binary(const Node& node) const {
    const std::vector<Scalar> left = numbers(node.parts[0]);
    const bool is_and = node.word == "&&";
    if ((is_and || node.word == "||") && left.size() == 1 && to_bool(left[0]) != is_and)
      return of({make_bool(!is_and)});
    std::vector<Scalar> result;
    std::string error;
    if (!apply(node.word, left, numbers(node.parts[1]), result, error)) throw Mistake(error);
    return of(std::move(result));
  }

  Value element(const Value& given, std::int64_t index) const {
    // A texel's numbers are no places of their own.
    const Value value = given.place && given.place->texel ? of(numbers_of(viewer_, *given.place)) : given;
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
      if (name.size() == 1 && value.place && !value.place->texel)
        return element(value, static_cast<std::int64_t>(component));
      result.push_back(from[component]);
    }
    return of(std::move(result));
  }

  Value call(const Node& node) const {
    if (node.word == "imageLoad" || node.word == "texelFetch") {
      if (node.parts.empty()) throw Mistake("which image?");
      return texel(value_of(node.parts[0]), node);
    }
    if (names_.find(node.word)) throw Mistake("'" + node.word + "' is a variable, and no function");
    std::vector<std::vector<Scalar>> arguments;
    for (const Node& argument : node.parts) arguments.push_back(numbers(argument));
    std::vector<Scalar> result;
    std::string error;
    if (!call_function(node.word, arguments, result, error)) throw Mistake(error);
    return of(std::move(result));
  }

  static bool is_image(const Value& value) {
    return value.place && !value.place->descriptors && !value.place->texel &&
           value.place->variable->memory == spirv::SourceVariable::Memory::kOpaque;
  }

  /// imageLoad(image, 1, 2), imageLoad(image, ivec2(1, 2)), image[1, 2]: coordinates are all parts but the first.
  Value texel(Value value, const Node& node) const {
    if (!is_image(value)) throw Mistake("that is no image");
    TexelCoordinates at{};
    std::size_t next = 0;
    for (std::size_t i = 1; i < node.parts.size(); ++i)
      for (const Scalar& number : numbers(node.parts[i]))
        if (next < at.size()) at[next++] = to_int(number);
    value.place->texel = at;
    if (memory_of_place(viewer_, *value.place).empty()) throw Mistake("there is no such texel, or it is compressed");
    return value;
  }

  const Viewer& viewer_;
  const Names& names_;
};

}  // namespace

base::Result<Expression> Expression::read(std::string_view text) {
  try {
    return Expression(std::make_shared<const Node>(Parser(text).all()));
  } catch (const Mistake& mistake) {
    return base::Error{mistake.what()};
  }
}

base::Result<Value> Expression::evaluate(const Viewer& viewer, const Names& names) const {
  try {
    return Evaluator(viewer, names).value_of(*root_);
  } catch (const Mistake& mistake) {
    return base::Error{mistake.what()};
  }
}

base::Result<Value> evaluate(std::string_view text, const Viewer& viewer, const Names& names) {
  const base::Result<Expression> expression = Expression::read(text);
  if (!expression) return base::Error{expression.message()};
  return expression.value().evaluate(viewer, names);
}

}  // namespace vitrine::glass::debug
