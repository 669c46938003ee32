// Parses the text form of the intermediate representation.
#include "tests/spirv/ir_text.h"

#include <cctype>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iterator>
#include <map>
#include <stdexcept>
#include <vector>

#include "base/numeric.h"
#include "spirv/ir_passes.h"

namespace vitrine::spirv::test {
namespace {

using ir::NodeList;
using ir::Op;
using ir::Src;
using ir::ValueId;

struct TextLine {
  std::size_t indent;
  std::string_view text;
};

std::vector<TextLine> lines_of(std::string_view text) {
  std::vector<TextLine> lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    const std::size_t indent = line.find_first_not_of(' ');
    if (indent == std::string_view::npos) continue;
    line.remove_prefix(indent);
    line = line.substr(0, line.find(';'));  // origins
    lines.push_back({indent, line.substr(0, line.find_last_not_of(' ') + 1)});
  }
  return lines;
}

/// The op of this name; kAluCount: none.
Op op_named(std::string_view name) {
  for (std::uint16_t i = 0; i < static_cast<std::uint16_t>(Op::kCount); ++i) {
    const Op op = static_cast<Op>(i);
    if (op == Op::kAluCount || op == Op::kIntrinsicEnd) continue;
    if (ir::op_name(op) == name) return op;
  }
  return Op::kAluCount;
}

/// Inputs that have a name without being loaded: %a, %b, ...
constexpr std::uint32_t kLetters = 8;

bool is_name(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

class Parser {
 public:
  explicit Parser(std::string_view text) : lines_(lines_of(text)) {}

  ir::Function parse() {
    while (at_ < lines_.size() && lines_[at_].text.starts_with("Arrays")) arrays();
    if (at_ < lines_.size()) list(function_.body, lines_[at_].indent);
    if (at_ < lines_.size()) fail("indentation");
    function_.body.insert(function_.body.begin(), std::make_move_iterator(inputs_.begin()),
                          std::make_move_iterator(inputs_.end()));
    return std::move(function_);
  }

 private:
  struct Head {
    ValueId value;
    std::uint32_t components;
    int boolean;  ///< -1: not said
  };

  [[noreturn]] void fail(const std::string& what) const {
    throw std::runtime_error(what + ": " + std::string(line_) + " | left: " + std::string(rest_));
  }

  // ---- words of a line

  void spaces() {
    while (!rest_.empty() && rest_.front() == ' ') rest_.remove_prefix(1);
  }
  bool take(std::string_view word) {
    spaces();
    if (!rest_.starts_with(word)) return false;
    rest_.remove_prefix(word.size());
    return true;
  }
  void expect(std::string_view word) {
    if (!take(word)) fail(std::string(word).append(" expected"));
  }
  bool done() {
    spaces();
    return rest_.empty();
  }
  std::string_view name() {
    std::size_t length = 0;
    while (length < rest_.size() && is_name(rest_[length])) ++length;
    if (length == 0) fail("name expected");
    const std::string_view word = rest_.substr(0, length);
    rest_.remove_prefix(length);
    return word;
  }
  std::uint32_t number() {
    spaces();
    char* end = nullptr;
    const std::string text(rest_);
    const auto value = static_cast<std::uint32_t>(std::strtoull(text.c_str(), &end, 0));
    if (end == text.c_str()) fail("number expected");
    rest_.remove_prefix(static_cast<std::size_t>(end - text.c_str()));
    return value;
  }
  bool starts_literal() {
    spaces();
    return !rest_.empty() &&
           (std::isdigit(static_cast<unsigned char>(rest_[0])) != 0 || rest_[0] == '-' || rest_.starts_with("true") ||
            rest_.starts_with("false") || rest_.starts_with("inf") || rest_.starts_with("nan"));
  }
  /// Bits of a float (with a point, an exponent or by name), an integer or a boolean.
  std::uint32_t literal(bool& boolean) {
    spaces();
    if (take("true")) return boolean = true, 1u;
    if (take("false")) return boolean = true, 0u;
    boolean = false;
    std::size_t length = 0;
    while (length < rest_.size() && (is_name(rest_[length]) || rest_[length] == '.' || rest_[length] == '-' ||
                                     (rest_[length] == '+' && length != 0)))
      ++length;
    const std::string word(rest_.substr(0, length));
    rest_.remove_prefix(length);
    const bool hexadecimal = word.starts_with("0x");
    if (!hexadecimal && word.find_first_of(".en") != std::string::npos)
      return base::bits_of(std::strtof(word.c_str(), nullptr));
    return static_cast<std::uint32_t>(std::strtoll(word.c_str(), nullptr, 0));
  }

  // ---- values

  ValueId known(std::string_view word) {
    const auto found = names_.find(std::string(word));
    if (found != names_.end()) return found->second;
    if (word.size() != 1 || word[0] < 'a' || word[0] >= static_cast<char>('a' + kLetters))
      fail(std::string(word).append(" is no value"));
    ir::Instr load;
    load.op = Op::kLoadInput;
    load.data[0] = static_cast<std::uint32_t>(word[0] - 'a');
    const ValueId value = function_.new_value(1, false);
    names_[std::string(word)] = value;
    return add(inputs_, std::move(load), {value, 1, -1});
  }

  /// "%x:2b" where a value is made.
  Head head() {
    expect("%");
    const std::string word(name());
    Head result{function_.new_value(1, false), 1, -1};
    names_[word] = result.value;
    if (take(":")) {
      result.components = number();
      result.boolean = take("b") ? 1 : 0;
    }
    return result;
  }
  ValueId head_of_join() {
    const Head made = head();
    set_type(made.value, made.components, made.boolean == 1);
    return made.value;
  }
  void set_type(ValueId value, std::uint32_t components, bool boolean) {
    function_.values[value] = {static_cast<std::uint8_t>(components), boolean};
  }
  std::vector<ValueId> heads() {
    std::vector<ValueId> values;
    while (spaces(), !rest_.empty() && rest_[0] == '%') values.push_back(head_of_join());
    return values;
  }

  void swizzle(Src& src) {
    if (!rest_.starts_with(".")) return;
    rest_.remove_prefix(1);
    const std::string_view letters = name();
    for (std::size_t i = 0; i < 4; ++i) {
      const char letter = letters[std::min(i, letters.size() - 1)];
      src.swizzle[i] = static_cast<std::uint8_t>(std::string_view("xyzw").find(letter));
    }
  }

  /// "%x.yz", a literal, or an operation with its operands in brackets, which goes in front.
  Src operand(NodeList& to) {
    Src src;
    spaces();
    if (take("%")) {
      src.value = known(name());
      swizzle(src);
      if (src.swizzle == std::array<std::uint8_t, 4>{0, 1, 2, 3} && function_.values[src.value].components == 1)
        src.swizzle = {0, 0, 0, 0};
      return src;
    }
    if (starts_literal()) {
      ir::Instr instr;
      instr.op = Op::kConst;
      instr.imm[0] = literal(instr.boolean);
      src.value = add(to, std::move(instr), {function_.new_value(1, false), 1, -1});
    } else {
      ir::Instr instr = operation();
      expect("(");
      if (!take(")")) {
        do instr.src.push_back(operand(to));
        while (take(","));
        expect(")");
      }
      if (instr.op > Op::kAluCount) parameters(instr);
      src.value = add(to, std::move(instr), {function_.new_value(1, false), 1, -1});
      swizzle(src);
      if (src.swizzle != std::array<std::uint8_t, 4>{0, 1, 2, 3}) return src;
    }
    src.swizzle = {0, 0, 0, 0};
    return src;
  }

  // ---- instructions

  ir::Instr operation() {
    ir::Instr instr;
    spaces();
    instr.op = op_named(name());
    if (instr.op == Op::kAluCount) fail("unknown operation");
    if (take("@")) instr.width = static_cast<std::uint8_t>(number());
    instr.exact = take("!");
    return instr;
  }

  void parameters(ir::Instr& instr) {
    if (take("["))
      for (int i = 0; !take("]"); ++i) instr.data[i] = number();
    if (take("{"))
      for (std::size_t i = 0; !take("}"); ++i) instr.imm[i] = number();
    if (instr.op != Op::kImage) return;
    auto image = std::make_shared<ir::ImageInfo>();
    if (take("access=")) image->access = static_cast<ir::ImageAccess>(number());
    if (take("dim=")) image->dim = static_cast<ir::ImageDim>(number());
    if (take("slot=")) image->slot = number();
    if (take("operands=")) image->operands = number();
    instr.image = std::move(image);
  }

  bool is_boolean(const ir::Instr& instr) {
    if (instr.op < Op::kAluCount) return ir::alu_info(instr.op).result == 'B';
    if (ir::is_wide(instr.op)) return ir::wide_info(instr.op).result == 'B';
    if (instr.op == Op::kHelperInvocation || instr.op == Op::kElect) return true;
    if (instr.op == Op::kVec) return !instr.src.empty() && function_.values[instr.src[0].value].boolean;
    return instr.boolean;
  }

  void note_interface(const ir::Instr& instr) {
    auto& slots = instr.op == Op::kLoadInput ? function_.interface.inputs : function_.interface.outputs;
    while (slots.size() <= instr.data[0]) {
      InterfaceSlot slot;
      slot.location = static_cast<std::uint16_t>(slots.size());
      slots.push_back(slot);
    }
  }

  ValueId add(NodeList& to, ir::Instr instr, const Head& made) {
    if (instr.op == Op::kLoadInput || instr.op == Op::kStoreOutput) note_interface(instr);
    instr.result = made.value;
    instr.boolean = made.boolean == -1 ? is_boolean(instr) : made.boolean == 1;
    instr.components = static_cast<std::uint8_t>(made.value == ir::kNoValue ? 0 : made.components);
    if (made.value != ir::kNoValue) set_type(made.value, made.components, instr.boolean);
    auto node = std::make_unique<ir::Node>();
    node->instr = std::move(instr);
    to.push_back(std::move(node));
    return made.value;
  }

  void instruction(NodeList& to) {
    Head made{ir::kNoValue, 0, -1};
    if (rest_.starts_with("%")) {
      made = head();
      expect("=");
    }
    ir::Instr instr = operation();
    if (instr.op == Op::kConst) {
      for (std::size_t i = 0; !done(); ++i) instr.imm[i] = literal(instr.boolean);
    } else {
      while (!done() && rest_[0] != '[' && rest_[0] != '{' && !rest_.starts_with("access=")) {
        instr.src.push_back(operand(to));
        if (!take(",")) break;
      }
      parameters(instr);
    }
    if (!done()) fail("end of the line expected");
    add(to, std::move(instr), made);
  }

  // ---- lists

  void arrays() {
    next_line();
    expect("Arrays");
    while (!done()) function_.arrays.push_back({number()});
  }

  void next_line() {
    line_ = lines_[at_++].text;
    rest_ = line_;
  }

  void list(NodeList& to, std::size_t indent) {
    while (at_ < lines_.size() && lines_[at_].indent == indent) {
      if (lines_[at_].text == "Else" || lines_[at_].text.starts_with("Continuing")) return;
      next_line();
      if (take("If ")) {
        branch(to, indent);
      } else if (line_ == "Loop" || take("Loop ")) {
        loop(to, indent);
      } else {
        instruction(to);
      }
    }
  }

  /// The lines below the one just read, if they are indented further.
  void nested(NodeList& to, std::size_t indent) {
    if (at_ < lines_.size() && lines_[at_].indent > indent) list(to, lines_[at_].indent);
  }

  void branch(NodeList& to, std::size_t indent) {
    auto node = std::make_unique<ir::Node>();
    node->kind = ir::Node::Kind::kIf;
    node->condition = operand(to);
    const std::string_view results = rest_;
    nested(node->then_list, indent);
    if (at_ == lines_.size() || lines_[at_].text != "Else") fail("Else expected");
    next_line();
    nested(node->else_list, indent);
    rest_ = results;
    if (take("->")) node->results = heads();
    to.push_back(std::move(node));
  }

  void loop(NodeList& to, std::size_t indent) {
    auto node = std::make_unique<ir::Node>();
    node->kind = ir::Node::Kind::kLoop;
    if (line_ == "Loop") rest_ = {};
    std::string_view params;
    if (take("params")) {
      params = rest_;
      while (!done() && !rest_.starts_with("init")) rest_.remove_prefix(1);
    }
    if (take("init")) {
      do node->init.push_back(operand(to));
      while (take(","));
    }
    const std::string_view results = rest_;
    rest_ = params;
    node->params = heads();
    nested(node->body, indent);
    if (at_ == lines_.size() || !lines_[at_].text.starts_with("Continuing")) fail("Continuing expected");
    next_line();
    expect("Continuing");
    node->continue_params = heads();
    nested(node->continuing, indent);
    rest_ = results;
    if (take("->")) node->results = heads();
    to.push_back(std::move(node));
  }

  std::vector<TextLine> lines_;
  std::size_t at_ = 0;
  std::string_view line_, rest_;
  ir::Function function_;
  NodeList inputs_;
  std::map<std::string, ValueId> names_;
};

}  // namespace

ir::Function parse_ir(std::string_view text) { return Parser(text).parse(); }

namespace {

/// A literal as a test writes it: numbers near one are floats, small ones integers.
std::string literal_text(std::uint32_t bits, bool boolean) {
  if (boolean) return bits != 0 ? "true" : "false";
  char text[32];
  const auto number = static_cast<std::int32_t>(bits);
  const double real = static_cast<double>(base::float_of(bits));
  if (number > -65536 && number < 65536) {
    std::snprintf(text, sizeof text, "%d", number);
  } else if (std::fabs(real) > 1e-9 && std::fabs(real) < 1e12) {
    std::snprintf(text, sizeof text, real == std::floor(real) ? "%.1f" : "%.9g", real);
  } else {
    std::snprintf(text, sizeof text, "%#x", bits);
  }
  return text;
}

std::string numbered(std::size_t number) {
  char name[24];
  std::snprintf(name, sizeof name, "%%%zu", number);
  return name;
}

/// What stands for values instead of their names: scalar constants and the first inputs.
void collect_inline(const NodeList& list, std::map<std::string, std::string>& names) {
  for (const auto& node : list) {
    const ir::Instr& instr = node->instr;
    const std::string name = numbered(instr.result);
    if (instr.op == Op::kConst && instr.components == 1) names[name] = literal_text(instr.imm[0], instr.boolean);
    if (instr.op == Op::kLoadInput && instr.data[0] < kLetters)
      names[name] = {'%', static_cast<char>('a' + instr.data[0])};
    for (const NodeList* inner : {&node->then_list, &node->else_list, &node->body, &node->continuing})
      collect_inline(*inner, names);
  }
}

}  // namespace

std::string text_of(const ir::Function& function) {
  std::map<std::string, std::string> names;
  collect_inline(function.body, names);
  const std::size_t inlined = names.size();
  std::string result;
  const std::string dump = ir::dump(function);
  for (const TextLine& line : lines_of(dump)) {
    const std::string_view text = line.text;
    const auto length_of = [&](std::size_t i) {
      std::size_t end = i + 1;
      while (end < text.size() && is_name(text[end])) ++end;
      return end - i;
    };
    if (text[0] == '%' && names.contains(std::string(text.substr(0, length_of(0)))) &&
        (text.find("= Const") != text.npos || text.find("= LoadInput") != text.npos))
      continue;
    result.append(line.indent, ' ');
    for (std::size_t i = 0; i < text.size();) {
      if (text[i] != '%') {
        result += text[i++];
        continue;
      }
      const std::string name(text.substr(i, length_of(i)));
      const auto number = names.size() - inlined;
      result += names.try_emplace(name, numbered(number)).first->second;
      i += name.size();
      if (text.substr(i, 2) == ":1" && (i + 2 == text.size() || text[i + 2] != 'b')) i += 2;
    }
    result += '\n';
  }
  return result;
}

}  // namespace vitrine::spirv::test
