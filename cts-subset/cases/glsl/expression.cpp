// The expression grammar.
#include "cases/glsl/expression.h"

namespace vitrine::cts {
namespace {

Type scalar(Base base) { return {base, 1}; }
Type with(Base base, Type like) { return {base, like.size}; }
std::string call(const char* name, std::initializer_list<std::string> arguments) {
  std::string text = std::string(name) + "(";
  const char* separator = "";
  for (const std::string& argument : arguments) {
    text += separator + argument;
    separator = ", ";
  }
  return text + ")";
}

}  // namespace

std::string type_name(Type type) {
  static const char* kScalars[] = {"float", "int", "uint", "bool"};
  static const char* kVectors[] = {"vec", "ivec", "uvec", "bvec"};
  const auto base = static_cast<size_t>(type.base);
  return type.size == 1 ? kScalars[base] : kVectors[base] + std::to_string(type.size);
}

Type ExpressionWriter::random_type() {
  const uint32_t size = grammar_.vectors ? 1 + random_.below(4) : 1;
  if (!grammar_.integers) return {Base::kFloat, size};
  return {random_.pick({Base::kFloat, Base::kFloat, Base::kInt, Base::kUint}), size};
}

std::string ExpressionWriter::literal(Type type) {
  const auto one = [&]() -> std::string {
    switch (type.base) {
      case Base::kFloat:
        return random_.pick<const char*>(
            {"0.0", "1.0", "-1.0", "2.0", "0.5", "0.3", "3.0", "-2.5", "0.25", "10.0", "1.7", "-0.1", "4.0", "255.0"});
      case Base::kInt:
        return random_.pick<const char*>({"0", "1", "-1", "2", "3", "7", "-5", "16", "255", "65536", "1000003"});
      case Base::kUint:
        return random_.pick<const char*>(
            {"0u", "1u", "2u", "3u", "7u", "16u", "255u", "65535u", "0x80000000u", "2654435761u"});
      default:
        return random_.chance(0.5f) ? "true" : "false";
    }
  };
  if (type.size == 1) return one();
  std::string text = type_name(type) + "(" + one();
  for (uint32_t c = 1; c < type.size; ++c) text += ", " + one();
  return text + ")";
}

std::string ExpressionWriter::leaf(Type type) {
  if (random_.chance(0.15f)) return literal(type);
  std::vector<const Variable*> fitting;
  for (const Variable& v : variables_)
    if (v.type.base == type.base && v.type.size >= type.size) fitting.push_back(&v);
  if (fitting.empty()) return literal(type);
  const Variable& v = *random_.pick(fitting);
  if (v.type.size == 1 || (v.type == type && random_.chance(0.7f))) return v.name;
  std::string text = v.name + ".";
  for (uint32_t c = 0; c < type.size; ++c) text += "xyzw"[random_.below(v.type.size)];
  return text;
}

std::string ExpressionWriter::expression(Type type, int depth) {
  if (depth <= 0 || random_.chance(0.1f)) return leaf(type);
  if (type.base == Base::kBool) return booleans(type, depth);
  if (random_.chance(0.06f)) {
    const std::string no = expression(type, depth - 1), yes = expression(type, depth - 1);
    return "(" + booleans(scalar(Base::kBool), depth - 1) + " ? " + yes + " : " + no + ")";
  }
  if (grammar_.vectors && random_.chance(0.1f)) return swizzled_or_built(type, depth);
  if (grammar_.conversions && grammar_.integers && random_.chance(0.08f)) return converted(type, depth);
  return type.base == Base::kFloat ? floats(type, depth) : integers(type, depth);
}

std::string ExpressionWriter::floats(Type type, int depth) {
  if (grammar_.transcendental && random_.chance(0.3f)) return transcendental(type, depth);
  if (grammar_.functions && random_.chance(0.35f)) return float_function(type, depth);
  if (grammar_.matrices && type.size > 1 && random_.chance(0.2f)) return matrix_product(type.size, depth);
  const std::string a = expression(type, depth - 1);
  const bool scalar_right = type.size > 1 && random_.chance(0.2f);
  const std::string b = expression(scalar_right ? scalar(Base::kFloat) : type, depth - 1);
  switch (random_.below(9)) {
    case 0:
      return "(- " + a + ")";
    case 1:
      return "(" + a + " / " + divisor(type, depth - 1) + ")";
    case 2:
    case 3:
      return "(" + a + " - " + b + ")";
    case 4:
    case 5:
      return "(" + a + " + " + b + ")";
    default:
      return "(" + a + " * " + b + ")";
  }
}

/// Never the constant zero: the reference's quotient is then an undefined value.
std::string ExpressionWriter::divisor(Type type, int depth) {
  if (random_.chance(0.5f)) return "(abs(" + expression(type, depth - 1) + ") + 0.5)";
  const std::string input = random_.pick({"a", "b", "p"});
  return type.size == 1 ? input + "." + "xyzw"[random_.below(4)]
                        : input + "." + std::string("wyxzw").substr(random_.below(2), type.size);
}

std::string ExpressionWriter::float_function(Type type, int depth) {
  if (grammar_.vectors && random_.chance(0.3f)) return vector_function(type, depth);
  const std::string a = expression(type, depth - 1);
  switch (random_.below(12)) {
    case 0: {
      const std::string b = expression(type, depth - 1);
      return call(random_.pick({"min", "max"}), {a, b});
    }
    case 1: {
      const std::string b = expression(type, depth - 1);
      return call(random_.pick({"mod", "step"}), {a, b});
    }
    case 2:
      return call("clamp", {a, random_.chance(0.5f) ? type_name(type) + "(0.0)" : expression(type, depth - 1),
                            random_.chance(0.5f) ? type_name(type) + "(1.0)" : expression(type, depth - 1)});
    case 3:
      return call("mix", {a, expression(type, depth - 1), expression(type, depth - 1)});
    case 4:
      return call("mix", {a, expression(type, depth - 1), expression(with(Base::kBool, type), depth - 1)});
    case 5:
      return call("smoothstep", {a, "(" + a + " + " + divisor(type, depth - 1) + ")", expression(type, depth - 1)});
    case 6:
      return call("fma", {a, expression(type, depth - 1), expression(type, depth - 1)});
    case 7: {
      const std::string of = random_.chance(0.7f) ? call("abs", {a}) : a;
      return call(random_.pick({"sqrt", "inversesqrt"}), {of});
    }
    case 8:
      return call(random_.pick({"radians", "degrees", "sign"}), {a});
    case 9:
      return grammar_.integers ? call("ldexp", {a, "(" + expression(with(Base::kInt, type), depth - 1) + " & " +
                                                       type_name(with(Base::kInt, type)) + "(31))"})
                               : call("fract", {a});
    default:
      return call(random_.pick({"abs", "floor", "ceil", "trunc", "round", "roundEven", "fract"}), {a});
  }
}

std::string ExpressionWriter::transcendental(Type type, int depth) {
  const std::string a = expression(type, depth - 1);
  const std::string name = type_name(type);
  switch (random_.below(8)) {
    case 0:
      return call("pow", {random_.chance(0.7f) ? call("abs", {a}) : a, expression(type, depth - 1)});
    case 1:
      return call("pow", {a, name + "(" + random_.pick<const char*>({"1.0", "2.0", "4.0", "0.5", "3.0", "2.2"}) + ")"});
    case 2:
      return call("atan", {a, expression(type, depth - 1)});
    case 3: {
      const std::string of = random_.chance(0.6f) ? call("fract", {a}) : a;
      return call(random_.pick({"asin", "acos"}), {of});
    }
    case 4: {
      const std::string of = random_.chance(0.6f) ? call("abs", {a}) : a;
      return call(random_.pick({"log", "log2", "acosh", "atanh"}), {of});
    }
    case 5:
      return call(random_.pick({"exp", "exp2"}), {a});
    case 6:
      return call(random_.pick({"sinh", "cosh", "tanh", "asinh", "atan"}), {a});
    default:
      return call(random_.pick({"sin", "cos", "tan"}), {a});
  }
}

std::string ExpressionWriter::vector_function(Type type, int depth) {
  if (type.size == 1) {
    const Type wide{Base::kFloat, 2 + random_.below(3)};
    const std::string a = expression(wide, depth - 1);
    if (random_.chance(0.3f)) return call("length", {a});
    const std::string b = expression(wide, depth - 1);
    return call(random_.pick({"dot", "distance"}), {a, b});
  }
  const std::string a = expression(type, depth - 1), b = expression(type, depth - 1);
  switch (random_.below(type.size == 3 ? 5 : 4)) {
    case 0:
      return call("normalize", {a});
    case 1:
      return call("reflect", {a, b});
    case 2:
      return call("refract", {a, b, expression(scalar(Base::kFloat), depth - 1)});
    case 3:
      return call("faceforward", {a, b, expression(type, depth - 1)});
    default:
      return call("cross", {a, b});
  }
}

std::string ExpressionWriter::matrix_product(uint32_t size, int depth) {
  const Type column{Base::kFloat, size};
  std::string matrix = "mat" + std::to_string(size) + "(";
  for (uint32_t c = 0; c < size; ++c) matrix += (c ? ", " : "") + expression(column, std::min(depth - 1, 1));
  matrix += ")";
  if (random_.chance(0.3f)) matrix = call("transpose", {matrix});
  const std::string v = expression(column, depth - 1);
  return random_.chance(0.5f) ? "(" + matrix + " * " + v + ")" : "(" + v + " * " + matrix + ")";
}

std::string ExpressionWriter::integers(Type type, int depth) {
  if (random_.chance(0.25f)) return integer_function(type, depth);
  const std::string name = type_name(type);
  const std::string a = expression(type, depth - 1), b = expression(type, depth - 1);
  switch (random_.below(12)) {
    case 0:
      return "(~" + a + ")";
    case 1:
      return "(" + a + " << (" + b + " & " + name + "(31)))";
    case 2:
      return "(" + a + " >> (" + b + " & " + name + "(31)))";
    case 3:
      return "(" + a + " / " + b + ")";
    // OpSMod of a negative number is where the reference is wrong (deviations.md).
    case 4:
      return "((" + a + " & " + name + "(0x7fffffff)) % ((" + b + " & " + name + "(0xff)) + " + name + "(1)))";
    case 5:
      return "(" + a + " & " + b + ")";
    case 6:
      return "(" + a + " | " + b + ")";
    case 7:
      return "(" + a + " ^ " + b + ")";
    case 8:
      return "(" + a + " - " + b + ")";
    case 9:
      return "(" + a + " * " + b + ")";
    default:
      return "(" + a + " + " + b + ")";
  }
}

std::string ExpressionWriter::integer_function(Type type, int depth) {
  const std::string a = expression(type, depth - 1);
  const auto small = [&](const char* mask) {
    return "(" + expression(scalar(Base::kInt), depth - 1) + " & " + mask + ")";
  };
  switch (random_.below(9)) {
    case 0:
      return type_name(type) + "(" + call(random_.pick({"bitCount", "findLSB", "findMSB"}), {a}) + ")";
    case 1:
      return call("bitfieldReverse", {a});
    case 2:
      return call("bitfieldExtract", {a, small("15"), small("15")});
    case 3:
      return call("bitfieldInsert", {a, expression(type, depth - 1), small("15"), small("15")});
    case 4:
      return call("clamp", {a, expression(type, depth - 1), expression(type, depth - 1)});
    case 5:
      return call("mix", {a, expression(type, depth - 1), expression(with(Base::kBool, type), depth - 1)});
    case 6:
      if (type.base == Base::kInt) return call(random_.pick({"abs", "sign"}), {a});
      [[fallthrough]];
    default: {
      const std::string b = expression(type, depth - 1);
      return call(random_.pick({"min", "max"}), {a, b});
    }
  }
}

std::string ExpressionWriter::booleans(Type type, int depth) {
  const Base base = grammar_.integers ? random_.pick({Base::kFloat, Base::kInt, Base::kUint}) : Base::kFloat;
  if (type.size > 1) {
    const std::string a = expression(with(base, type), depth - 1), b = expression(with(base, type), depth - 1);
    return call(random_.pick({"lessThan", "lessThanEqual", "greaterThan", "greaterThanEqual", "equal", "notEqual"}),
                {a, b});
  }
  switch (random_.below(10)) {
    case 0:
      return "(!" + expression(type, depth - 1) + ")";
    case 1: {
      const std::string right = expression(type, depth - 1), op = random_.pick({" && ", " || ", " ^^ "});
      return "(" + expression(type, depth - 1) + op + right + ")";
    }
    case 2: {
      const std::string of = expression(scalar(Base::kFloat), depth - 1);
      return call(random_.pick({"isnan", "isinf"}), {of});
    }
    case 3:
      if (grammar_.vectors) {
        const std::string of = booleans({Base::kBool, 2 + random_.below(3)}, depth);
        return call(random_.pick({"any", "all"}), {of});
      }
      [[fallthrough]];
    default: {
      const std::string right = expression(scalar(base), depth - 1);
      const std::string op = random_.pick({" < ", " <= ", " > ", " >= ", " == ", " != "});
      return "(" + expression(scalar(base), depth - 1) + op + right + ")";
    }
  }
}

/// What converts to integers is clamped to what they can hold: OpConvertFToS and OpConvertFToU of anything else are
/// undefined, and the reference drops the literals among it where it sees them. glsl.undefined_conversions has some of
/// these, spirv_opcodes has what is no literal.
std::string ExpressionWriter::converted(Type type, int depth) {
  const std::string name = type_name(type);
  if (random_.chance(0.15f)) return name + "(" + booleans(with(Base::kBool, type), depth - 1) + ")";
  Base from = Base::kInt;
  switch (type.base) {
    case Base::kFloat:
      from = random_.pick({Base::kInt, Base::kUint});
      break;
    case Base::kInt:
      from = random_.pick({Base::kFloat, Base::kUint});
      break;
    default:
      from = random_.pick({Base::kFloat, Base::kInt});
      break;
  }
  const std::string value = expression(with(from, type), depth - 1);
  if (from != Base::kFloat) return name + "(" + value + ")";
  return name + (type.base == Base::kInt ? "(clamp(" + value + ", -2147483648.0, 2147483520.0))"
                                         : "(clamp(" + value + ", 0.0, 4294967040.0))");
}

std::string ExpressionWriter::swizzled_or_built(Type type, int depth) {
  if (type.size == 1) {
    const Type wide{type.base, 2 + random_.below(3)};
    const char component = "xyzw"[random_.below(wide.size)];
    return "(" + expression(wide, depth - 1) + ")." + component;
  }
  std::string text = type_name(type) + "(" + expression(scalar(type.base), depth - 1);
  if (random_.chance(0.5f)) return text + ", " + expression({type.base, type.size - 1}, depth - 1) + ")";
  for (uint32_t c = 1; c < type.size; ++c) text += ", " + expression(scalar(type.base), depth - 1);
  return text + ")";
}

}  // namespace vitrine::cts
