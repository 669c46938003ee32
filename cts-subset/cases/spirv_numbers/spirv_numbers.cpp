// Arithmetic on numbers of every width, one instruction at a time: each row of the tables below for each type that it
// allows, on corner values and random ones. Modules are assembled; input and output are 32-bit words, so that no
// storage feature is needed.
#include "harness/case.h"
#include "harness/run.h"
#include "harness/shader.h"
#include "tests/spirv/compute_text.h"

#include <algorithm>
#include <stdexcept>

namespace vitrine::cts {
namespace {

constexpr uint32_t kInvocations = 1024;
/// Numbers that an invocation reads, two words each; then k.
constexpr uint32_t kScalars = 21, kWords = 2 * kScalars + 1;

struct Number {
  const char* name;
  uint32_t width;
  char kind;  ///< f, i, u
};
constexpr Number kNumbers[] = {{"half", 16, 'f'}, {"float", 32, 'f'}, {"double", 64, 'f'}, {"int8", 8, 'i'},
                               {"uint8", 8, 'u'}, {"int16", 16, 'i'}, {"uint16", 16, 'u'}, {"int", 32, 'i'},
                               {"uint", 32, 'u'}, {"int64", 64, 'i'}, {"uint64", 64, 'u'}};

/// One instruction: %x %y %z are scalars of the type T, %k a 32-bit integer below the width, %v %w vectors of three, %m
/// %o matrices of 3 x 3. Its result: T (u: only for types that are not signed), U another scalar, B boolean, V vector,
/// M matrix, P a struct of two T, Q a struct of T and int.
struct Row {
  const char* name;
  const char* text;
  char result;
};

constexpr Row kIntRows[] = {
    {"IAdd", "OpIAdd %T %x %y", 'T'},
    {"ISub", "OpISub %T %x %y", 'T'},
    {"IMul", "OpIMul %T %x %y", 'T'},
    {"UDiv", "OpUDiv %T %x %y", 'u'},
    {"SDiv", "OpSDiv %T %x %y", 'T'},
    {"UMod", "OpUMod %T %x %y", 'u'},
    {"SRem", "OpSRem %T %x %y", 'T'},
    {"SNegate", "OpSNegate %T %x", 'T'},
    {"Not", "OpNot %T %x", 'T'},
    {"BitwiseAnd", "OpBitwiseAnd %T %x %y", 'T'},
    {"BitwiseOr", "OpBitwiseOr %T %x %y", 'T'},
    {"BitwiseXor", "OpBitwiseXor %T %x %y", 'T'},
    {"ShiftLeftLogical", "OpShiftLeftLogical %T %x %k", 'T'},
    {"ShiftRightLogical", "OpShiftRightLogical %T %x %k", 'T'},
    {"ShiftRightArithmetic", "OpShiftRightArithmetic %T %x %k", 'T'},
    {"IEqual", "OpIEqual %bool %x %y", 'B'},
    {"INotEqual", "OpINotEqual %bool %x %y", 'B'},
    {"ULessThan", "OpULessThan %bool %x %y", 'B'},
    {"ULessThanEqual", "OpULessThanEqual %bool %x %y", 'B'},
    {"UGreaterThan", "OpUGreaterThan %bool %x %y", 'B'},
    {"UGreaterThanEqual", "OpUGreaterThanEqual %bool %x %y", 'B'},
    {"SLessThan", "OpSLessThan %bool %x %y", 'B'},
    {"SLessThanEqual", "OpSLessThanEqual %bool %x %y", 'B'},
    {"SGreaterThan", "OpSGreaterThan %bool %x %y", 'B'},
    {"SGreaterThanEqual", "OpSGreaterThanEqual %bool %x %y", 'B'},
    {"SAbs", "OpExtInst %T %glsl SAbs %x", 'T'},
    {"SSign", "OpExtInst %T %glsl SSign %x", 'T'},
    {"SMin", "OpExtInst %T %glsl SMin %x %y", 'T'},
    {"SMax", "OpExtInst %T %glsl SMax %x %y", 'T'},
    {"UMin", "OpExtInst %T %glsl UMin %x %y", 'T'},
    {"UMax", "OpExtInst %T %glsl UMax %x %y", 'T'},
    {"SClamp", "OpExtInst %T %glsl SClamp %x %y %z", 'T'},
    {"UClamp", "OpExtInst %T %glsl UClamp %x %y %z", 'T'},
    {"IAddCarry", "OpIAddCarry %pair %x %y", 'p'},
    {"ISubBorrow", "OpISubBorrow %pair %x %y", 'p'},
    {"UMulExtended", "OpUMulExtended %pair %x %y", 'p'},
    {"SMulExtended", "OpSMulExtended %pair %x %y", 'P'},
    {"VectorIMul", "OpIMul %V %v %w", 'V'},
    {"VectorShuffle", "OpVectorShuffle %V %v %w 4 0 5", 'V'},
};

constexpr Row kFloatRows[] = {
    {"FAdd", "OpFAdd %T %x %y", 'T'},
    {"FSub", "OpFSub %T %x %y", 'T'},
    {"FMul", "OpFMul %T %x %y", 'T'},
    {"FDiv", "OpFDiv %T %x %y", 'T'},
    {"FNegate", "OpFNegate %T %x", 'T'},
    {"FRem", "OpFRem %T %x %y", 'T'},
    {"FMod", "OpFMod %T %x %y", 'T'},
    {"IsNan", "OpIsNan %bool %x", 'B'},
    {"IsInf", "OpIsInf %bool %x", 'B'},
    {"FOrdEqual", "OpFOrdEqual %bool %x %y", 'B'},
    {"FUnordEqual", "OpFUnordEqual %bool %x %y", 'B'},
    {"FOrdNotEqual", "OpFOrdNotEqual %bool %x %y", 'B'},
    {"FUnordNotEqual", "OpFUnordNotEqual %bool %x %y", 'B'},
    {"FOrdLessThan", "OpFOrdLessThan %bool %x %y", 'B'},
    {"FUnordLessThan", "OpFUnordLessThan %bool %x %y", 'B'},
    {"FOrdGreaterThan", "OpFOrdGreaterThan %bool %x %y", 'B'},
    {"FOrdLessThanEqual", "OpFOrdLessThanEqual %bool %x %y", 'B'},
    {"FUnordGreaterThanEqual", "OpFUnordGreaterThanEqual %bool %x %y", 'B'},
    {"RoundEven", "OpExtInst %T %glsl RoundEven %x", 'T'},
    {"Round", "OpExtInst %T %glsl Round %x", 'T'},
    {"Trunc", "OpExtInst %T %glsl Trunc %x", 'T'},
    {"FAbs", "OpExtInst %T %glsl FAbs %x", 'T'},
    {"FSign", "OpExtInst %T %glsl FSign %x", 'T'},
    {"Floor", "OpExtInst %T %glsl Floor %x", 'T'},
    {"Ceil", "OpExtInst %T %glsl Ceil %x", 'T'},
    {"Fract", "OpExtInst %T %glsl Fract %x", 'T'},
    {"FMin", "OpExtInst %T %glsl FMin %x %y", 'T'},
    {"FMax", "OpExtInst %T %glsl FMax %x %y", 'T'},
    {"NMin", "OpExtInst %T %glsl NMin %x %y", 'T'},
    {"NMax", "OpExtInst %T %glsl NMax %x %y", 'T'},
    {"FClamp", "OpExtInst %T %glsl FClamp %x %y %z", 'T'},
    {"NClamp", "OpExtInst %T %glsl NClamp %x %y %z", 'T'},
    {"FMix", "OpExtInst %T %glsl FMix %x %y %z", 'T'},
    {"Step", "OpExtInst %T %glsl Step %x %y", 'T'},
    {"SmoothStep", "OpExtInst %T %glsl SmoothStep %x %y %z", 'T'},
    {"Fma", "OpExtInst %T %glsl Fma %x %y %z", 'T'},
    {"Sqrt", "OpExtInst %T %glsl Sqrt %x", 'T'},
    {"InverseSqrt", "OpExtInst %T %glsl InverseSqrt %x", 'T'},
    {"Length", "OpExtInst %T %glsl Length %v", 'T'},
    {"Distance", "OpExtInst %T %glsl Distance %v %w", 'T'},
    {"Cross", "OpExtInst %V %glsl Cross %v %w", 'V'},
    {"Normalize", "OpExtInst %V %glsl Normalize %v", 'V'},
    {"FaceForward", "OpExtInst %V %glsl FaceForward %v %w %v", 'V'},
    {"Reflect", "OpExtInst %V %glsl Reflect %v %w", 'V'},
    {"Dot", "OpDot %T %v %w", 'T'},
    {"VectorTimesScalar", "OpVectorTimesScalar %V %v %z", 'V'},
    {"MatrixTimesVector", "OpMatrixTimesVector %V %m %w", 'V'},
    {"VectorTimesMatrix", "OpVectorTimesMatrix %V %w %m", 'V'},
    {"MatrixTimesMatrix", "OpMatrixTimesMatrix %M %m %o", 'M'},
    {"MatrixTimesScalar", "OpMatrixTimesScalar %M %m %y", 'M'},
    {"Transpose", "OpTranspose %M %m", 'M'},
    {"OuterProduct", "OpOuterProduct %M %v %w", 'M'},
    {"Determinant", "OpExtInst %T %glsl Determinant %m", 'T'},
    {"MatrixInverse", "OpExtInst %M %glsl MatrixInverse %m", 'M'},
    {"ModfStruct", "OpExtInst %pair %glsl ModfStruct %x", 'P'},
    {"FrexpStruct", "OpExtInst %frexp %glsl FrexpStruct %x", 'Q'},
    {"Ldexp", "OpExtInst %T %glsl Ldexp %x %k", 'T'},
};

constexpr Row kHalfRows[] = {
    {"Radians", "OpExtInst %T %glsl Radians %x", 'T'}, {"Degrees", "OpExtInst %T %glsl Degrees %x", 'T'},
    {"Sin", "OpExtInst %T %glsl Sin %x", 'T'},         {"Cos", "OpExtInst %T %glsl Cos %x", 'T'},
    {"Tan", "OpExtInst %T %glsl Tan %x", 'T'},         {"Asin", "OpExtInst %T %glsl Asin %x", 'T'},
    {"Acos", "OpExtInst %T %glsl Acos %x", 'T'},       {"Atan", "OpExtInst %T %glsl Atan %x", 'T'},
    {"Sinh", "OpExtInst %T %glsl Sinh %x", 'T'},       {"Cosh", "OpExtInst %T %glsl Cosh %x", 'T'},
    {"Tanh", "OpExtInst %T %glsl Tanh %x", 'T'},       {"Asinh", "OpExtInst %T %glsl Asinh %x", 'T'},
    {"Acosh", "OpExtInst %T %glsl Acosh %x", 'T'},     {"Atanh", "OpExtInst %T %glsl Atanh %x", 'T'},
    {"Atan2", "OpExtInst %T %glsl Atan2 %x %y", 'T'},  {"Pow", "OpExtInst %T %glsl Pow %x %y", 'T'},
    {"Exp", "OpExtInst %T %glsl Exp %x", 'T'},         {"Log", "OpExtInst %T %glsl Log %x", 'T'},
    {"Exp2", "OpExtInst %T %glsl Exp2 %x", 'T'},       {"Log2", "OpExtInst %T %glsl Log2 %x", 'T'},
};

bool same(const Number& a, const Number& b) { return a.width == b.width && a.kind == b.kind; }
const Number& number(uint32_t width, char kind) {
  for (const Number& candidate : kNumbers)
    if (candidate.width == width && candidate.kind == kind) return candidate;
  throw std::runtime_error("no such type");
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
  return text;
}

/// A module that runs rows of instructions on the scalar type `type`; results may also be of type `other`.
class Module {
 public:
  Module(const Number& type, const Number* other) : type_(type) {
    need(type);
    if (other != nullptr) need(*other);
    if (type.width < 32) need(number(type.width, 'u'));
    if (other != nullptr && other->width < 32) need(number(other->width, 'u'));
  }

  struct Slot {
    std::string name;
    Number type;
  };
  std::vector<Slot> slots;  ///< results: two words each per invocation

  /// `%T` in the row's text is the type.
  void add(const Row& row, const Number& result) {
    const std::string r = fresh();
    body_ += r + " = " + row.text + "\n";
    const auto part = [&](const std::string& indices, const Number& of) {
      const std::string id = fresh();
      body_ += id + " = OpCompositeExtract %" + of.name + " " + r + " " + indices + "\n";
      store(row.name, id, of);
    };
    switch (row.result) {
      case 'B': {
        const std::string id = fresh();
        const std::string no = constant(0), yes = constant(1);
        body_ += id + " = OpSelect %uint " + r + " " + yes + " " + no + "\n";
        return store(row.name, id, number(32, 'u'));
      }
      case 'V':
        for (int c = 0; c < 3; ++c) part(std::to_string(c), type_);
        return;
      case 'M':
        for (int c = 0; c < 9; ++c) part(std::to_string(c / 3) + " " + std::to_string(c % 3), type_);
        return;
      case 'P':
      case 'p':
        for (int c = 0; c < 2; ++c) part(std::to_string(c), type_);
        return;
      case 'Q':
        part("0", type_);
        return part("1", number(32, 'i'));
      default:
        return store(row.name, r, result);
    }
  }

  std::string text() {
    std::string loads = "%base = OpIMul %uint %n " + constant(kWords) + "\n";
    for (uint32_t i = 0; i < kScalars; ++i) loads += load("%s" + std::to_string(i), 2 * i);
    loads += load_at("%kw", 2 * kScalars) + "%k = OpBitcast %int %kw\n" + body_begin();
    const std::string vector = same(type_, number(32, 'u')) ? "%v3uint" : "%vector";
    std::string types = vector == "%vector" ? "%V = OpTypeVector %T 3\n" : "";
    types += "%pair = OpTypeStruct %T %T\n";
    if (type_.kind == 'f') types += "%M = OpTypeMatrix %V 3\n%frexp = OpTypeStruct %T %int\n";
    ComputeText module;
    module.uniform = true;
    module.capabilities = capabilities_ + "%glsl = OpExtInstImport \"GLSL.std.450\"\n";
    module.declarations =
        "%int = OpTypeInt 32 1\n%v2uint = OpTypeVector %uint 2\n" + declarations_ + types + constants_;
    module.body = loads + body_;
    const std::string all = module.text();
    return replaced(replaced(replaced(all, "%V ", vector + " "), "%T ", std::string("%") + type_.name + " "), "%T\n",
                    std::string("%") + type_.name + "\n");
  }

 private:
  /// Matrices share no element: the reference's compiler would factor sums of products.
  std::string body_begin() const {
    std::string text = "%x = OpCopyObject %T %s0\n%y = OpCopyObject %T %s1\n%z = OpCopyObject %T %s2\n";
    const char* kVectors[] = {"%v", "%w", "%c1", "%c2", "%c3", "%c4", "%c5"};
    for (uint32_t i = 0; i < 7; ++i) {
      text += std::string(kVectors[i]) + " = OpCompositeConstruct %V";
      for (uint32_t c = 0; c < 3; ++c) text += " %s" + std::to_string(3 * i + c);
      text += "\n";
    }
    if (type_.kind == 'f')
      text += "%m = OpCompositeConstruct %M %v %c1 %c2\n%o = OpCompositeConstruct %M %c3 %c4 %c5\n";
    return text;
  }

  void need(const Number& wanted) {
    for (const Number& known : needed_)
      if (same(known, wanted)) return;
    needed_.push_back(wanted);
    const std::string width = std::to_string(wanted.width);
    if (wanted.width != 32) {
      const std::string name = (wanted.kind == 'f' ? "Float" : "Int") + width;
      if (capabilities_.find(name + "\n") == std::string::npos) capabilities_ += "OpCapability " + name + "\n";
    }
    if (wanted.width == 32 && wanted.kind != 'f') return;
    declarations_ +=
        std::string("%") + wanted.name + " = " +
        (wanted.kind == 'f' ? "OpTypeFloat " + width : "OpTypeInt " + width + (wanted.kind == 'i' ? " 1" : " 0")) +
        "\n";
  }

  std::string fresh() { return "%t" + std::to_string(ids_++); }

  std::string constant(uint32_t value) {
    const std::string id = "%u_" + std::to_string(value);
    if (constants_.find(id + " ") == std::string::npos)
      constants_ += id + " = OpConstant %uint " + std::to_string(value) + "\n";
    return id;
  }

  std::string load_at(const std::string& id, uint32_t word) {
    const std::string at = fresh(), pointer = fresh();
    const std::string zero = constant(0), offset = constant(word);
    return at + " = OpIAdd %uint %base " + offset + "\n" + pointer + " = OpAccessChain %uint_ptr %in " + zero + " " +
           at + "\n" + id + " = OpLoad %uint " + pointer + "\n";
  }

  /// Two words as a number of the type.
  std::string load(const std::string& id, uint32_t word) {
    const std::string low = fresh(), high = fresh(), both = fresh();
    std::string text = load_at(low, word);
    if (type_.width == 64)
      return text + load_at(high, word + 1) + both + " = OpCompositeConstruct %v2uint " + low + " " + high + "\n" + id +
             " = OpBitcast %T " + both + "\n";
    if (type_.width == 32 && type_.kind == 'u') return text + id + " = OpCopyObject %T " + low + "\n";
    if (type_.width == 32) return text + id + " = OpBitcast %T " + low + "\n";
    const std::string bits = std::string("%") + number(type_.width, 'u').name;
    if (type_.kind == 'u') return text + id + " = OpUConvert %T " + low + "\n";
    return text + both + " = OpUConvert " + bits + " " + low + "\n" + id + " = OpBitcast %T " + both + "\n";
  }

  /// Writes a number to the next slot.
  void store(const std::string& name, std::string id, const Number& type) {
    const auto word = [&](const std::string& value, uint32_t part) {
      const std::string at = fresh(), pointer = fresh(), place = fresh();
      const std::string zero = constant(0);
      const std::string first = constant(static_cast<uint32_t>(slots.size()) * 2 * kInvocations + part);
      body_ += place + " = OpIMul %uint %n " + constant(2) + "\n" + at + " = OpIAdd %uint " + place + " " + first +
               "\n" + pointer + " = OpAccessChain %uint_ptr %out " + zero + " " + at + "\nOpStore " + pointer + " " +
               value + "\n";
    };
    const auto make = [&](const std::string& operation) {
      const std::string result = fresh();
      body_ += result + " = " + operation + "\n";
      return result;
    };
    if (type.width == 64) {
      const std::string both = make("OpBitcast %v2uint " + id);
      word(make("OpCompositeExtract %uint " + both + " 0"), 0);
      word(make("OpCompositeExtract %uint " + both + " 1"), 1);
    } else {
      if (type.width < 32) {
        if (type.kind != 'u') id = make(std::string("OpBitcast %") + number(type.width, 'u').name + " " + id);
        id = make("OpUConvert %uint " + id);
      } else if (type.kind != 'u') {
        id = make("OpBitcast %uint " + id);
      }
      word(id, 0);
    }
    slots.push_back({name, type});
  }

  const Number& type_;
  std::vector<Number> needed_;
  std::string capabilities_, declarations_, constants_, body_;
  int ids_ = 0;
};

/// Bits of an operand: corner values of the type, small numbers, numbers near the limits of other types, anything.
uint64_t operand(Random& random, const Number& type) {
  const uint64_t mask = type.width == 64 ? ~uint64_t{0} : (uint64_t{1} << type.width) - 1;
  if (type.kind != 'f') {
    switch (random.below(5)) {
      case 0:
        return random.pick<uint64_t>({0, 1, ~uint64_t{0}, mask >> 1, (mask >> 1) + 1, mask - 1, 2, 3}) & mask;
      case 1:
        return static_cast<uint64_t>(static_cast<int64_t>(random.between(-100, 100))) & mask;
      case 2:
        return (random.bits64() >> random.below(64)) & mask;
      default:
        return random.bits64() & mask;
    }
  }
  const uint32_t mantissa = type.width == 64 ? 52 : type.width == 32 ? 23 : 10;
  const uint32_t bias = type.width == 64 ? 1023 : type.width == 32 ? 127 : 15;
  const auto number = [&](uint64_t sign, uint64_t exponent, uint64_t fraction) {
    return (sign << (type.width - 1)) | (exponent << mantissa) | (fraction & ((uint64_t{1} << mantissa) - 1));
  };
  const uint64_t sign = random.below(2);
  switch (random.below(8)) {
    case 0:  // zeros, denormals
      return number(sign, 0, random.pick<uint64_t>({0, 0, 1, ~uint64_t{0}, random.bits64()}));
    case 1:  // infinities and quiet NaN
      return number(sign, 2 * bias + 1, random.chance(0.5f) ? 0 : uint64_t{1} << (mantissa - 1));
    case 2: {
      const auto fraction = random.pick<uint64_t>({0, 1, ~uint64_t{0}});
      return number(sign, random.pick<uint64_t>({1, 2 * bias, bias, bias - 1, bias + 1}), fraction);
    }
    case 3: {  // halves of small integers
      const uint64_t fraction = random.bits64() & ~((uint64_t{1} << (mantissa - 4)) - 1);
      return number(sign, bias + random.below(4), fraction);
    }
    case 4: {  // anything but signalling NaN
      const uint64_t bits = random.bits64();
      return number(sign, bits % (2 * bias + 1), bits >> 11);
    }
    default: {
      const int32_t spread = type.width == 16 ? 6 : 40;
      const uint64_t fraction = random.bits64();
      return number(sign, static_cast<uint64_t>(static_cast<int32_t>(bias) + random.between(-spread, spread)),
                    fraction);
    }
  }
}

bool is_nan(const Number& type, uint64_t bits) {
  if (type.kind != 'f') return false;
  const uint64_t infinity = type.width == 64 ? 0x7ff0000000000000u : type.width == 32 ? 0x7f800000u : 0x7c00u;
  return (bits & ((uint64_t{1} << (type.width - 1)) - 1)) > infinity;
}

void require_types(const Run& run, const Number& type) {
  if (type.width == 64 && type.kind == 'f') run.require(run.gpu.features.shaderFloat64, "shaderFloat64");
  if (type.width == 64 && type.kind != 'f') run.require(run.gpu.features.shaderInt64, "shaderInt64");
}

/// Runs the module and puts out every slot; NaN have one sign and payload (SPIR-V leaves them open).
void run_module(Run& run, Module& module, const Number& type) {
  std::vector<uint32_t> words;
  for (uint32_t i = 0; i < kInvocations; ++i) {
    for (uint32_t k = 0; k < kScalars; ++k) {
      const uint64_t bits = operand(run.random, type);
      words.push_back(static_cast<uint32_t>(bits));
      words.push_back(static_cast<uint32_t>(bits >> 32));
    }
    words.push_back(static_cast<uint32_t>(run.random.between(0, static_cast<int32_t>(type.width) - 1)));
  }
  const std::string text = module.text();
  run.note("module", text);
  const Buffer in = run.buffer_of(words), out = run.buffer(module.slots.size() * kInvocations * 8);
  std::memset(out.data, 0, out.size);
  const Resources res = run.resources({storage_buffer(0, in), storage_buffer(1, out)});
  const VkPipeline pipeline = run.compute(res.layout, run.module(assemble_spirv(text)));
  run.dispatch(res, pipeline, kInvocations / 64);
  for (size_t k = 0; k < module.slots.size(); ++k) {
    Output output;
    output.name = module.slots[k].name + "." + std::to_string(k);
    output.format = format_info(VK_FORMAT_R32G32_UINT);
    output.width = kInvocations;
    output.may_be_blank = true;
    output.bytes.assign(out.data + k * kInvocations * 8, out.data + (k + 1) * kInvocations * 8);
    for (uint32_t i = 0; i < kInvocations; ++i) {
      uint64_t bits;
      std::memcpy(&bits, output.bytes.data() + 8 * i, 8);
      if (is_nan(module.slots[k].type, bits)) bits = 0x7fffffffffffffff;
      std::memcpy(output.bytes.data() + 8 * i, &bits, 8);
    }
    run.out(std::move(output));
  }
}

template <size_t size>
void add_rows(Module& module, const Row (&rows)[size], const Number& type) {
  for (const Row& row : rows) {
    if ((row.result == 'u' || row.result == 'p') && type.kind == 'i') continue;
    module.add(row, type);
  }
}

void arithmetic(Run& run, const Number& type) {
  require_types(run, type);
  Module module(type, nullptr);
  if (type.kind == 'f')
    add_rows(module, kFloatRows, type);
  else
    add_rows(module, kIntRows, type);
  run_module(run, module, type);
}

/// Functions that SPIR-V has for 16 and 32 bits only; sets of their own, as the modules would be too large.
void functions(Run& run, const Number& type) {
  require_types(run, type);
  Module module(type, nullptr);
  add_rows(module, kHalfRows, type);
  run_module(run, module, type);
}

/// Every conversion between two types that SPIR-V has.
void conversion(Run& run, const Number& from, const Number& to) {
  require_types(run, from);
  require_types(run, to);
  const bool both_int = from.kind != 'f' && to.kind != 'f';
  std::vector<std::string> opcodes;
  if (both_int && from.width != to.width)
    opcodes = {to.kind == 'u' ? "OpUConvert" : "OpSConvert"};
  else if (from.kind == 'f' && to.kind == 'f' && from.width != to.width)
    opcodes = {"OpFConvert"};
  else if (from.kind == 'f' && to.kind != 'f')
    opcodes = {to.kind == 'u' ? "OpConvertFToU" : "OpConvertFToS"};
  else if (from.kind != 'f' && to.kind == 'f')
    opcodes = {from.kind == 'u' ? "OpConvertUToF" : "OpConvertSToF"};
  Module module(from, &to);
  std::vector<std::string> texts;
  for (const std::string& opcode : opcodes) texts.push_back(opcode + " %" + to.name + " %x");
  if (from.width == to.width && !same(from, to)) texts.push_back(std::string("OpBitcast %") + to.name + " %x");
  for (const std::string& text : texts) module.add({text.c_str(), text.c_str(), 'U'}, to);
  run_module(run, module, from);
}

/// Types whose cases the device's claims allow.
constexpr uint32_t kWidths[] = {8, 16, 32, 64};

const bool kRegistered = [] {
  const auto tested = [](const Number& type) {
    return std::find(std::begin(kWidths), std::end(kWidths), type.width) != std::end(kWidths);
  };
  for (const Number& type : kNumbers) {
    if (!tested(type)) continue;
    AddCase("spirv_numbers", std::string("arithmetic.") + type.name, [&type](Run& run) { arithmetic(run, type); });
    if (type.kind == 'f' && type.width < 64)
      AddCase("spirv_numbers", std::string("functions.") + type.name, [&type](Run& run) { functions(run, type); });
    for (const Number& to : kNumbers)
      if (tested(to) && !same(type, to) && (type.kind == 'f' || to.kind == 'f' || type.width != to.width))
        AddCase("spirv_numbers", std::string("convert.") + type.name + "_to_" + to.name,
                [&type, &to](Run& run) { conversion(run, type, to); });
  }
  return true;
}();

}  // namespace
}  // namespace vitrine::cts
