// Random expressions over numbers of every width: integers of 8 to 64 bits, binary16 and binary64, and conversions
// between all of them; precise, and open to the reference's rewrites.
#include "cases/glsl/evaluate.h"
#include "harness/case.h"

namespace vitrine::cts {
namespace {

constexpr uint32_t kInvocations = 512;

struct Sized {
  const char* name;
  uint32_t width;
  char kind;  ///< f, i, u
};
constexpr Sized kTypes[] = {{"int8_t", 8, 'i'},     {"uint8_t", 8, 'u'}, {"int16_t", 16, 'i'}, {"uint16_t", 16, 'u'},
                            {"int", 32, 'i'},       {"uint", 32, 'u'},   {"int64_t", 64, 'i'}, {"uint64_t", 64, 'u'},
                            {"float16_t", 16, 'f'}, {"double", 64, 'f'}};

class Writer {
 public:
  Writer(Random& random, bool precise) : random_(random), precise_(precise) {}

  const Sized& any_type() { return kTypes[random_.below(std::size(kTypes))]; }

  std::string expression(const Sized& type, int depth) {
    if (depth <= 0 || random_.chance(0.1f)) return leaf(type);
    if (random_.chance(0.08f)) {
      const std::string no = expression(type, depth - 1), yes = expression(type, depth - 1);
      return "(" + condition(depth - 1) + " ? " + yes + " : " + no + ")";
    }
    if (random_.chance(0.15f)) return converted(type, depth);
    return type.kind == 'f' ? real(type, depth) : integer(type, depth);
  }

 private:
  std::string leaf(const Sized& type) {
    const std::string name = type.name;
    if (random_.chance(0.2f))
      return name + "(" +
             (type.kind == 'f' ? random_.pick<const char*>({"0.5", "1.0", "-2.0", "0.1", "3.0"})
                               : random_.pick<const char*>({"0", "1", "3", "7", "100", "5", "85"})) +
             ")";
    return random_.pick<const char*>({"x_", "y_", "z_"}) + name;
  }

  std::string condition(int depth) {
    const Sized& type = any_type();
    const std::string right = expression(type, depth);
    const std::string op = random_.pick<const char*>({" < ", " <= ", " == ", " != ", " >= "});
    return "(" + expression(type, depth) + op + right + ")";
  }

  /// Never out of range of an integer: that is undefined.
  std::string converted(const Sized& type, int depth) {
    const Sized& from = any_type();
    const std::string inner = expression(from, depth - 1);
    const std::string name = from.name;
    if (name == "int" && std::string(type.name) == "int64_t") return "WIDENED(" + inner + ")";
    if (from.kind != 'f' || type.kind == 'f') return std::string(type.name) + "(" + inner + ")";
    return std::string(type.name) + "(clamp(" + inner + ", " + name + (type.kind == 'u' ? "(0.0), " : "(-100.0), ") +
           name + "(100.0)))";
  }

  std::string integer(const Sized& type, int depth) {
    const std::string name = type.name, a = expression(type, depth - 1), b = expression(type, depth - 1);
    const std::string count = "(" + b + " & " + name + "(" + std::to_string(type.width - 1) + "))";
    switch (random_.below(14)) {
      case 0:
        return name + "(~" + a + ")";
      case 1:
        return name + "(" + a + " << " + count + ")";
      case 2:
        return name + "(" + a + " >> " + count + ")";
      case 3:
        return "(" + a + " & " + b + ")";
      case 4:
        return "(" + a + " | " + b + ")";
      case 5:
        return "(" + a + " ^ " + b + ")";
      case 6:
        return "(" + a + " / (" + b + " | " + name + "(1)))";
      case 7:
        if (type.kind == 'u') return "(" + a + " % (" + b + " | " + name + "(1)))";
        return "abs(" + a + ")";
      case 8:
        return "min(" + a + ", " + b + ")";
      case 9:
        return "max(" + a + ", " + b + ")";
      case 10:
        return "(" + a + " - " + b + ")";
      case 11:
        return "(" + a + " * " + b + ")";
      default:
        return "(" + a + " + " + b + ")";
    }
  }

  std::string real(const Sized& type, int depth) {
    if (!precise_ && random_.chance(0.35f)) return rewritable(type, depth);
    const std::string a = expression(type, depth - 1), b = expression(type, depth - 1);
    switch (random_.below(12)) {
      case 0:
        return "(-" + a + ")";
      case 1:
        return "(" + a + " / (abs(" + b + ") + " + type.name + "(0.5)))";  // by 0: undefined in SPIR-V
      case 2:
        return "(" + a + " - " + b + ")";
      case 3:
        return "min(" + a + ", " + b + ")";
      case 4:
        return std::string(random_.pick<const char*>({"floor", "ceil", "trunc", "fract", "abs", "roundEven"})) + "(" +
               a + ")";
      case 5:
        return "sqrt(abs(" + a + "))";
      case 6:
        return "fma(" + a + ", " + b + ", " + expression(type, depth - 1) + ")";
      case 7:
      case 8:
        return "(" + a + " * " + b + ")";
      default:
        return "(" + a + " + " + b + ")";
    }
  }

  /// What the reference's inexact rules look for.
  std::string rewritable(const Sized& type, int depth) {
    const std::string name = type.name, x = leaf(type), a = expression(type, depth - 1),
                      b = expression(type, depth - 1);
    const std::string k = name + "(" + random_.pick<const char*>({"0.0", "1.0", "-1.0", "2.0", "4.0", "0.3"}) + ")";
    switch (random_.below(14)) {
      case 0:
        return "(" + x + " * " + a + " + " + b + " * " + x + ")";
      case 1:
        return "((" + a + " * " + b + ") * " + k + ")";
      case 2:
        return "((" + a + " + " + b + ") + " + k + ")";
      case 3:
        return "(" + a + " * " + b + " + " + x + " * " + x + " + " + b + ")";
      case 4:
        return "mix(" + a + ", " + b + ", " + name + condition(depth - 1) + ")";
      case 5:
        return "mix(" + a + ", " + b + ", " + k + ")";
      case 6:
        return "(" + k + " * (" + a + " * " + name + "(0.7)))";
      case 7:
        return "(" + k + " - (" + a + " + " + name + "(0.7)))";
      case 8:
        return "(-" + x + " + (" + x + " + " + a + "))";
      case 9:
        return "(sqrt(abs(" + x + ")) * sqrt(abs(" + x + ")))";
      case 10:
        return "(" + k + " / (" + k + " / (abs(" + a + ") + " + name + "(0.5))))";
      case 11:
        return "(" + a + " * " + k + " + " + x + ")";
      case 12:
        return "(abs(" + x + ") * " + k + " - max(" + a + ", -" + x + "))";
      default:
        return "(" + condition(depth - 1) + " ? " + x + " * " + a + " : " + x + " * " + b + ")";
    }
  }

  Random& random_;
  bool precise_;
};

/// A value of the type from the words `low` and `high`.
std::string loaded(const Sized& type, const std::string& low, const std::string& high) {
  if (type.kind == 'f' && type.width == 64) return "packDouble2x32(uvec2(" + low + ", " + high + " & 0xbfffffffu))";
  if (type.kind == 'f') return "uint16BitsToFloat16(uint16_t(" + low + " & 0xbfffu))";
  if (type.width == 64) return std::string(type.name) + "(packUint2x32(uvec2(" + low + ", " + high + ")))";
  return std::string(type.name) + "(" + low + ")";
}

std::string stored(const Sized& type, const std::string& value) {
  if (type.kind == 'f' && type.width == 64)
    return "isnan(" + value + ") ? uvec2(77u) : unpackDouble2x32(" + value + ")";
  if (type.kind == 'f')
    return "isnan(" + value + ") ? uvec2(77u) : uvec2(uint(float16BitsToUint16(" + value + ")), 0u)";
  if (type.width == 64) return "unpackUint2x32(uint64_t(" + value + "))";
  return "uvec2(uint(" + value + "), 0u)";
}

/// Sign extensions of 32-bit integers to 64 bits, and the same that the reference does not know for one: its
/// comparisons of such numbers with constants are wrong (deviations.md, widened-comparisons).
constexpr char kWidened[] = "#define WIDENED(x) int64_t(x)\n";
constexpr char kWidenedByHand[] = "#define WIDENED(x) packInt2x32(ivec2(x) >> ivec2(0, 31))\n";

constexpr uint32_t kResults = 8;

/// One invocation per point or pixel.
void draw(Run& run, Stage stage, const std::string& text, const Resources& res) {
  const VkPhysicalDeviceFeatures& features = run.gpu.features;
  run.require(stage == Stage::kVertex ? features.vertexPipelineStoresAndAtomics : features.fragmentStoresAndAtomics,
              "stores in graphics stages");
  TargetSpec target_spec;
  target_spec.height = kInvocations / target_spec.width;
  const Target target = make_target(run, target_spec);
  GraphicsSpec spec;
  spec.layout = res.layout;
  spec.vertex = stage == Stage::kVertex ? text : kFullScreenVertex;
  spec.fragment =
      stage == Stage::kVertex ? "layout(location = 0) out vec4 color;\nvoid main() { color = vec4(1.0); }\n" : text;
  if (stage == Stage::kVertex) spec.assembly.topology = VK_PRIMITIVE_TOPOLOGY_POINT_LIST;
  draw_once(run, target, make_pipeline(run, spec, target), &res, stage == Stage::kVertex ? kInvocations : 3);
}

/// The shader's start, which makes a value x_, y_ and z_ of each type out of words of a buffer.
std::string loads(Stage stage) {
  std::string text;
  if (stage == Stage::kCompute) text += "layout(local_size_x = 64) in;\n";
  if (stage == Stage::kFragment) text += "layout(location = 0) out vec4 color;\n";
  text +=
      "layout(std430, binding = 0) readonly buffer In { uint v[]; };\n"
      "layout(std430, binding = 1) writeonly buffer Out { uvec2 r[]; };\nvoid main() {\n";
  if (stage == Stage::kCompute) text += "  uint id = gl_GlobalInvocationID.x;\n";
  if (stage == Stage::kVertex)
    text += "  uint id = uint(gl_VertexIndex);\n  gl_Position = vec4(0.0, 0.0, 0.5, 1.0);\n  gl_PointSize = 1.0;\n";
  if (stage == Stage::kFragment)
    text += "  uint id = uint(gl_FragCoord.x) + 64u * uint(gl_FragCoord.y);\n  color = vec4(1.0);\n";
  uint32_t word = 0;
  const auto next = [&] { return "v[id * 60u + " + std::to_string(word++) + "u]"; };
  for (const char* name : {"x_", "y_", "z_"})
    for (const Sized& type : kTypes) {
      const std::string low = next(), high = next();
      text += std::string("  ") + type.name + " " + name + type.name + " = " + loaded(type, low, high) + ";\n";
    }
  return text;
}

/// Result `k`.
std::string assigned(const Sized& type, uint32_t k, const std::string& expression) {
  const std::string value = "t" + std::to_string(k);
  return std::string(type.name) + " " + value + " = " + expression + ";\n  r[id + " + std::to_string(k * kInvocations) +
         "u] = " + stored(type, value) + ";\n";
}

/// Runs the shader, given without its first lines and its last one.
void compare_shader(Run& run, std::string text, Stage stage) {
  text += "}\n";
  const std::string head = "#version 450\n#extension GL_EXT_shader_explicit_arithmetic_types : require\n";
  run.note("shader", head + kWidened + text);
  std::vector<uint32_t> words(kInvocations * 60);
  for (uint32_t& w : words) w = run.random.chance(0.3f) ? run.random.below(200) : run.random.bits();
  const Buffer in = run.buffer_of(words);
  const auto results = [&](const char* name, const std::string& source) {
    const Buffer out = run.buffer(kResults * kInvocations * 8);
    const Resources res = run.resources({storage_buffer(0, in), storage_buffer(1, out)});
    if (stage == Stage::kCompute)
      run.dispatch(res, run.compute(res.layout, run.shader(VK_SHADER_STAGE_COMPUTE_BIT, source)), kInvocations / 64);
    else
      draw(run, stage, source, res);
    run.out(name, out, VK_FORMAT_R32G32_UINT).may_be_blank = true;
  };
  results("results", head + kWidened + text);
  if (text.find("WIDENED(") == std::string::npos) return;
  results("by_hand", head + kWidenedByHand + text);
  if (run.outputs[0].bytes != run.outputs[1].bytes) run.outputs[0].deviation = "widened-comparisons";
}

void require_sizes(Run& run) {
  const auto& sizes = run.gpu.extension_features;
  run.require(run.gpu.features.shaderInt64 && run.gpu.features.shaderFloat64 && run.gpu.features.shaderInt16 &&
                  sizes.shaderInt8 && sizes.shaderFloat16,
              "numbers of every width");
}

void compare_expressions(Run& run, bool precise, Stage stage = Stage::kCompute) {
  require_sizes(run);
  std::string text = loads(stage);
  Writer writer(run.random, precise);
  for (uint32_t k = 0; k < kResults; ++k) {
    const Sized& type = writer.any_type();
    text += (precise ? "  precise " : "  ") + assigned(type, k, writer.expression(type, 4));
  }
  compare_shader(run, text, stage);
}

/// At most kResults expressions of one type each.
void compare_fixed(Run& run, const std::vector<std::pair<const char*, std::string>>& expressions,
                   Stage stage = Stage::kCompute) {
  require_sizes(run);
  std::string text = loads(stage);
  uint32_t k = 0;
  for (const auto& [name, expression] : expressions)
    for (const Sized& type : kTypes)
      if (std::string(type.name) == name) text += "  " + assigned(type, k++, expression);
  compare_shader(run, text, stage);
}

CTS_RANDOM("glsl", "random_sized.compute", 40) { compare_expressions(run, true); }
CTS_RANDOM("glsl", "random_sized.inexact", 40) { compare_expressions(run, false); }
CTS_RANDOM("glsl", "random_sized.vertex", 30) { compare_expressions(run, run.index % 2 == 0, Stage::kVertex); }
CTS_RANDOM("glsl", "random_sized.fragment", 30) { compare_expressions(run, run.index % 2 == 0, Stage::kFragment); }

// Mixes of halves, which stay one operation in the reference until its end: terms and factors of both sides, literals
// on both sides.
CTS_CASE("glsl", "sized.mixes") {
  compare_fixed(run, {{"float16_t", "mix(x_float16_t, x_float16_t + y_float16_t, z_float16_t)"},
                      {"float16_t", "mix(x_float16_t + y_float16_t, x_float16_t + float16_t(0.3), z_float16_t)"},
                      {"float16_t", "mix(x_float16_t, x_float16_t * y_float16_t, z_float16_t)"},
                      {"float16_t", "mix(x_float16_t * y_float16_t, x_float16_t * z_float16_t, y_float16_t)"},
                      {"float16_t", "mix(x_float16_t, float16_t(0.0), z_float16_t)"},
                      {"float16_t", "mix(float16_t(0.3), float16_t(1.7), z_float16_t)"},
                      {"float16_t",
                       "x_int < y_int ? mix(x_float16_t, y_float16_t, z_float16_t) * x_float16_t"
                       " : mix(x_float16_t, y_float16_t, float16_t(0.3)) * x_float16_t"},
                      {"float16_t", "mix(float16_t(0.3), float16_t(2.0), float16_t(0.7)) * x_float16_t"}});
}

// Mixes of doubles between literals: of similar sizes and not, from one and from minus one.
CTS_CASE("glsl", "sized.mixes_of_literals") {
  compare_fixed(run, {{"double", "mix(double(0.3), double(1.7), x_double)"},
                      {"double", "mix(double(3.0e-7), double(1.7), y_double)"},
                      {"double", "mix(double(1.0e-9), double(1.7), z_double)"},
                      {"double", "mix(double(1.0), double(1.0e-9), x_double)"},
                      {"double", "mix(double(1.0), x_double, y_double)"},
                      {"double", "mix(double(-1.0), y_double, z_double)"},
                      {"double", "mix(z_double, double(-1.0), x_double)"},
                      {"double", "mix(dvec2(0.3, 1.0), dvec2(1.7, 3.0), dvec2(x_double, y_double)).x"}});
}

// Literals are equal only from the second round on; selections move into both words of doubles; what widens numbers is
// no use of them in comparisons.
CTS_CASE("glsl", "sized.values") {
  compare_fixed(run, {{"double", "double(3.0) * x_double + (sqrt(abs(y_double)) * sqrt(abs(y_double))) * double(3.0)"},
                      {"double", "(x_int < y_int ? double(0.1) * y_double : double(0.1) * x_double) * double(0.7)"},
                      {"double", "double((x_float16_t + y_float16_t) + float16_t(0.3))"},
                      {"float16_t", "float16_t(3.0) * x_float16_t + (y_float16_t * z_float16_t) * float16_t(3.0)"}});
}

// The absolute value of the least integer, shifted: the reference takes it for positive.
CTS_CASE("glsl", "sized.absolutes") {
  compare_fixed(run, {{"int64_t", "abs(abs(int64_t(x_int64_t << 63)) >> (y_int64_t & int64_t(3)))"},
                      {"int16_t", "abs(abs(int16_t(x_int16_t << 15)) >> (y_int16_t & int16_t(3)))"},
                      {"int8_t", "abs(abs(int8_t(x_int8_t << 7)) >> (y_int8_t & int8_t(3)))"}});
}

// Where denormals count as zero, the smaller and the larger of two doubles do so, too.
CTS_CASE("glsl", "sized.flushed_extrema") {
  compare_fixed(run,
                {{"double", "min(x_double, y_double)"},
                 {"double", "max(x_double, z_double)"},
                 {"double", "max(min(x_double, double(1.0)), -z_double)"}},
                Stage::kFragment);
}

// Of two zeros the extremum is the second, and a literal comes second.
CTS_CASE("glsl", "sized.half_extrema_of_zeros") {
  const std::string zero = "uint16BitsToFloat16(uint16_t(x_uint16_t & uint16_t(0x8000)))";
  compare_fixed(run, {{"float16_t", "max(float16_t(0.0), " + zero + ")"},
                      {"float16_t", "min(-float16_t(0.0), " + zero + ")"},
                      {"float16_t", "max(" + zero + ", -float16_t(0.0))"},
                      {"float16_t", "min(x_float16_t, float16_t(y_uint16_t & uint16_t(1)))"},
                      {"float16_t", "max(float16_t(y_uint16_t & uint16_t(1)), x_float16_t)"}});
}

// 64-bit integers that are zero whatever their operands are: products with them are literal, without a sign.
CTS_CASE("glsl", "sized.zeros") {
  compare_fixed(run, {{"double", "x_double * double(min(uint64_t(7) ^ uint64_t(7), x_uint64_t))"},
                      {"double", "y_double * double(x_uint64_t * min(uint64_t(0), y_uint64_t))"},
                      {"double", "z_double * double((x_int64_t - x_int64_t) % y_int64_t)"},
                      {"double", "x_double * double(y_int64_t % int64_t(-1))"},
                      {"double", "y_double * double((uint64_t(y_uint - y_uint) << z_uint64_t) >> x_uint64_t)"},
                      {"double", "z_double * double(x_uint64_t < x_uint64_t ? z_uint64_t : uint64_t(0))"},
                      {"double", "x_double * double((uint64_t(y_uint - y_uint) + uint64_t(5)) / uint64_t(7))"}});
}

// What is known of larger and smaller integers of 8 and 16 bits makes the weights literal.
CTS_CASE("glsl", "sized.ordered") {
  compare_fixed(run, {{"double", "1.0 - (mix(x_double, x_double, double(x_int8_t <= max(x_int8_t, y_int8_t))) + 0.7)"},
                      {"double", "y_double * double(x_int16_t < min(y_int16_t, x_int16_t))"},
                      {"double", "z_double * double(max(min(x_int8_t, y_int8_t), z_int8_t) < z_int8_t)"},
                      {"double", "x_double * double(min(y_int16_t, int16_t(7)) > int16_t(7))"}});
}

// The same of 64-bit integers, and of literals beside them.
CTS_CASE("glsl", "sized.ordered_wide") {
  const std::string product =
      "z_float16_t * (max(z_int64_t, int64_t(5)) < z_int64_t ? x_float16_t : "
      "x_float16_t * y_float16_t) + (z_float16_t * y_float16_t) * z_float16_t";
  compare_fixed(run, {{"float16_t", product},
                      {"double", "y_double * double(x_int64_t < min(y_int64_t, x_int64_t))"},
                      {"double", "z_double * double(max(x_uint64_t, y_uint64_t) < y_uint64_t)"},
                      {"double", "x_double * double(min(y_uint64_t, uint64_t(7)) > uint64_t(7))"},
                      {"double", "y_double * double(int64_t(5) >= max(z_int64_t, int64_t(9)))"},
                      {"double", "(z_double + double(x_int64_t >= min(x_int64_t, y_int64_t))) + double(0.7)"},
                      {"double", "(x_double + double(min(z_uint64_t, uint64_t(7)) < uint64_t(9))) + double(0.3)"},
                      {"double", "x_double * double(x_int64_t < max(y_int64_t, x_int64_t))"}});
}

// Doubles that branches yield are selected as doubles in the round in which the branches become selections, before one
// of the products becomes zero; also where only their words are read.
CTS_CASE("glsl", "sized.selected_products") {
  const std::string number = "double((int(y_uint * 3u) + 7 * x_int) << (z_uint & 31u))";
  const std::string product =
      "(x_int < y_int ? x_double * " + number + " : x_double * sqrt(abs(double(y_uint - y_uint))))";
  compare_fixed(
      run, {{"double", product},
            {"double", "x_int < y_int ? z_double * double(y_uint) : z_double * double(z_uint - z_uint)"},
            {"double", "-1.0 - ((x_uint != y_uint ? ceil(double(0.5)) : 0.3 * ((x_double + z_double) * 0.7)) + 0.7)"},
            {"uint64_t", "packUint2x32(unpackDouble2x32" + product + ")"},
            {"uint",
             "unpackDouble2x32(x_int < y_int ? y_double * double(y_uint)"
             " : y_double * double(x_uint - x_uint)).y"}});
}

// Equal conversions are one value, so that rules see equal products.
CTS_CASE("glsl", "sized.equal_conversions") {
  const char* half =
      "252.0 * ((double(x_float16_t) * y_double) * 2.0) * z_double + "
      "252.0 * ((double(x_float16_t) * y_double) * 2.0)";
  const char* integer =
      "252.0 * ((double(y_int64_t) * x_double) * 2.0) * z_double + "
      "252.0 * ((double(y_int64_t) * x_double) * 2.0)";
  compare_fixed(run, {{"double", half}, {"double", integer}});
}

}  // namespace
}  // namespace vitrine::cts
