// The pipeline from SPIR-V words to an executable shader.
#include "spirv/compile.h"

#include <spirv-tools/libspirv.h>
#define SPV_ENABLE_UTILITY_CODE
#include <spirv/unified1/spirv.hpp11>

#include <algorithm>
#include <iterator>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "spirv/capabilities.h"
#include "spirv/exec/trace.h"
#include "spirv/front/translate.h"
#include "spirv/ir_passes.h"
#include "spirv/lower/lower.h"
#include "spirv/program.h"
#include "spirv/rewrite/rewrite.h"

namespace vitrine::spirv {
namespace {

/// Words of a module that cannot nest deeply.
constexpr std::size_t kSmallModule = 4096;

/// SPIRV-Tools' validator, told to accept every block layout that a device feature could allow: layouts are the
/// application's promise to the validation layer, not something that can harm us.
std::string validate(spv_context context, std::span<const std::uint32_t> words) {
  const spv_validator_options options = spvValidatorOptionsCreate();
  spvValidatorOptionsSetRelaxBlockLayout(options, true);
  spvValidatorOptionsSetUniformBufferStandardLayout(options, true);
  spvValidatorOptionsSetScalarBlockLayout(options, true);
  spvValidatorOptionsSetWorkgroupScalarBlockLayout(options, true);
  spvValidatorOptionsSetAllowLocalSizeId(options, true);
  spvValidatorOptionsSetFriendlyNames(options, false);
  spv_const_binary_t binary{words.data(), words.size()};
  spv_diagnostic diagnostic = nullptr;
  std::string message;
  if (spvValidateWithOptions(context, options, &binary, &diagnostic) != SPV_SUCCESS) {
    message = "invalid SPIR-V";
    if (diagnostic != nullptr && diagnostic->error != nullptr) message += std::string(": ") + diagnostic->error;
  }
  spvDiagnosticDestroy(diagnostic);
  spvValidatorOptionsDestroy(options);
  return message;
}

/// Capabilities that change nothing but what the validator admits: a module that uses one without declaring it means
/// the same as one that declares it.
constexpr std::string_view kOptional[] = {"SampleRateShading",
                                          "InterpolationFunction",
                                          "ImageGatherExtended",
                                          "ImageQuery",
                                          "DerivativeControl",
                                          "StorageImageExtendedFormats",
                                          "ImageCubeArray",
                                          "SampledCubeArray",
                                          "Image1D",
                                          "Sampled1D",
                                          "ImageBuffer",
                                          "SampledBuffer",
                                          "ClipDistance",
                                          "CullDistance",
                                          "MultiViewport",
                                          "MinLod",
                                          "DrawParameters",
                                          "DemoteToHelperInvocation",
                                          "GroupNonUniform",
                                          "GroupNonUniformBallot",
                                          "GroupNonUniformVote",
                                          "StorageImageReadWithoutFormat",
                                          "StorageImageWriteWithoutFormat",
                                          "Int8",
                                          "Int16",
                                          "Int64",
                                          "Float16",
                                          "Float64"};

/// The optional capability whose declaration is all that the validator misses, by its message. Empty: another fault.
std::string missing_capability(const std::string& message) {
  static constexpr std::string_view kWords = "requires one of these capabilities: ";
  const std::size_t at = message.find(kWords);
  if (at == std::string::npos) return {};
  const std::size_t first = at + kWords.size();
  const std::string name = message.substr(first, message.find_first_of(" \n", first) - first);
  return std::find(std::begin(kOptional), std::end(kOptional), name) != std::end(kOptional) ? name : std::string();
}

/// The module with one more OpCapability, which come first in a module. False when there is no such capability.
bool declare_capability(spv_context context, const std::string& name, std::vector<std::uint32_t>& words) {
  const std::string text = "OpCapability " + name;
  spv_binary binary = nullptr;
  const bool known = spvTextToBinary(context, text.c_str(), text.size(), &binary, nullptr) == SPV_SUCCESS;
  if (known) words.insert(words.begin() + 5, binary->code + 5, binary->code + binary->wordCount);
  spvBinaryDestroy(binary);
  return known;
}

/// Languages that are younger than the validator's tables become Unknown (0): OpSource means nothing to the module.
/// False when there is no OpSource with a language.
bool forget_source_languages(std::vector<std::uint32_t>& words) {
  bool found = false;
  for (std::size_t at = 5; at < words.size(); at += words[at] >> 16) {
    if ((words[at] & spv::OpCodeMask) != static_cast<std::uint32_t>(spv::Op::OpSource) || words[at] >> 16 < 3) continue;
    found |= std::exchange(words[at + 1], 0u) != 0;
  }
  return found;
}

/// ShaderLayer and ShaderViewportIndex in modules that are older than these (Slang's) become what geometry shaders
/// declare for the same built-ins. False when there is none.
bool age_layer_capabilities(std::vector<std::uint32_t>& words) {
  constexpr auto word = [](spv::Capability capability) { return static_cast<std::uint32_t>(capability); };
  bool found = false;
  for (std::size_t at = 5; at < words.size(); at += words[at] >> 16) {
    if ((words[at] & spv::OpCodeMask) != static_cast<std::uint32_t>(spv::Op::OpCapability)) break;
    std::uint32_t& capability = words[at + 1];
    const bool layer = capability == word(spv::Capability::ShaderLayer);
    if (!layer && capability != word(spv::Capability::ShaderViewportIndex)) continue;
    capability = word(layer ? spv::Capability::Geometry : spv::Capability::MultiViewport);
    found = true;
  }
  return found;
}

/// Conversions of floats to the width that they have (glslang writes them where a 16-bit constant is named as such)
/// become copies. False when there is none.
bool copy_unconverted(std::vector<std::uint32_t>& words) {
  std::unordered_map<std::uint32_t, std::uint32_t> types;
  bool found = false;
  for (std::size_t at = 5; at < words.size(); at += words[at] >> 16) {
    const std::uint32_t length = words[at] >> 16;
    const auto op = static_cast<spv::Op>(words[at] & spv::OpCodeMask);
    bool has_result = false, has_type = false;
    spv::HasResultAndType(op, &has_result, &has_type);
    if (!has_result || !has_type || length < 3) continue;
    types[words[at + 2]] = words[at + 1];
    if (op != spv::Op::OpFConvert || length != 4) continue;
    const auto value = types.find(words[at + 3]);
    if (value == types.end() || value->second != words[at + 1]) continue;
    words[at] = length << spv::WordCountShift | static_cast<std::uint32_t>(spv::Op::OpCopyObject);
    found = true;
  }
  return found;
}

/// What is wrong with modules that applications give drivers all the same, by the validator's words.
struct Leniency {
  const char* message;
  bool (*repair)(std::vector<std::uint32_t>& words);  ///< false when there is nothing to repair
};
constexpr Leniency kLeniencies[] = {
    {"Invalid source language operand", forget_source_languages},
    {"requires SPIR-V version 1.5 or later", age_layer_capabilities},
    {"different bit width from Result Type: FConvert", copy_unconverted},
};

/// Changes the words such that the validator has something else to say. False if nothing is known that would.
bool repair(spv_context context, const std::string& message, std::vector<std::uint32_t>& words) {
  for (const Leniency& leniency : kLeniencies)
    if (message.find(leniency.message) != std::string::npos) return leniency.repair(words);
  const std::string capability = missing_capability(message);
  return !capability.empty() && declare_capability(context, capability, words);
}

/// Locations that the inputs and outputs of a module take. The validator notes each of them: its memory is theirs.
class LocationCounter {
 public:
  explicit LocationCounter(std::span<const std::uint32_t> words) {
    for (std::size_t at = 5; at < words.size(); at += words[at] >> 16) visit(words.subspan(at, words[at] >> 16));
  }

  /// Of the largest variable.
  std::uint64_t largest() const { return largest_; }

 private:
  static constexpr std::uint64_t kMany = std::uint64_t{1} << 31;

  void visit(std::span<const std::uint32_t> inst) {
    switch (static_cast<spv::Op>(inst[0] & spv::OpCodeMask)) {
      case spv::Op::OpConstant:
      case spv::Op::OpSpecConstant:
        if (inst.size() > 3) literals_[inst[2]] = inst.size() > 4 && inst[4] != 0 ? kMany : inst[3];
        break;
      case spv::Op::OpTypeMatrix:
        if (inst.size() > 3) take(inst[1], locations(inst[2]) * inst[3]);
        break;
      case spv::Op::OpTypeArray:
        if (inst.size() > 3) take(inst[1], locations(inst[2]) * literal(inst[3]));
        break;
      case spv::Op::OpTypeStruct: {
        std::uint64_t sum = 0;
        for (const std::uint32_t member : inst.subspan(std::min<std::size_t>(2, inst.size()))) sum += locations(member);
        if (inst.size() > 1) take(inst[1], sum);
        break;
      }
      case spv::Op::OpTypePointer:
        if (inst.size() <= 3) break;
        if (inst[2] == static_cast<std::uint32_t>(spv::StorageClass::Input) ||
            inst[2] == static_cast<std::uint32_t>(spv::StorageClass::Output))
          largest_ = std::max(largest_, locations(inst[3]));
        break;
      default:
        break;
    }
  }

  void take(std::uint32_t id, std::uint64_t count) { locations_[id] = std::min(count, kMany); }

  /// Of a type: one where nothing else is known.
  std::uint64_t locations(std::uint32_t id) const {
    const auto found = locations_.find(id);
    return found == locations_.end() ? 1 : found->second;
  }

  std::uint64_t literal(std::uint32_t id) const {
    const auto found = literals_.find(id);
    return found == literals_.end() ? 1 : found->second;
  }

  std::unordered_map<std::uint32_t, std::uint64_t> literals_, locations_;
  std::uint64_t largest_ = 0;
};

/// More than any stage has; geometry shaders' inputs are arrays.
constexpr std::uint64_t kMaxLocations = 1 << 16;

/// Empty if the module is valid but for capabilities that it uses without declaring them: applications that were tried
/// on the reference alone get away with that there (zink decorates with Sample and leaves out SampleRateShading), and
/// but for what the table above lists.
std::string validate_leniently(std::span<const std::uint32_t> words) {
  static constexpr int kMaxRepairs = 8;
  const spv_context context = spvContextCreate(SPV_ENV_VULKAN_1_3);
  std::string message = validate(context, words);
  std::vector<std::uint32_t> repaired;
  for (int i = 0; i < kMaxRepairs && !message.empty(); ++i) {
    // Vertex inputs may share locations in OpenGL; each reads its attribute all the same.
    if (message.find("conflicting input location assignment") != std::string::npos) message.clear();
    if (repaired.empty()) repaired.assign(words.begin(), words.end());
    if (message.empty() || !repair(context, message, repaired)) break;
    message = validate(context, repaired);
  }
  spvContextDestroy(context);
  return message;
}

/// The module as SPIRV-Tools prints it, with the ids by number, which the other representations name.
std::string module_text(std::span<const std::uint32_t> words) {
  const spv_context context = spvContextCreate(SPV_ENV_UNIVERSAL_1_6);
  spv_text text = nullptr;
  std::string result;
  if (spvBinaryToText(context, words.data(), words.size(), SPV_BINARY_TO_TEXT_OPTION_INDENT, &text, nullptr) ==
      SPV_SUCCESS)
    result.assign(text->str, text->length);
  spvTextDestroy(text);
  spvContextDestroy(context);
  return result;
}

/// Numbers the forms that the rewrites give a shader: the same step may change it in several rounds.
StepListener keep_steps(std::vector<Representation>& kept) {
  return [&kept, number = 0](const char* step, const std::string& place, const std::string& text) mutable {
    kept.push_back({"IR " + std::to_string(++number) + ": " + step, "the shader in SSA form, " + place, text});
  };
}

}  // namespace

std::string check_module(std::span<const std::uint32_t> words) {
  if (words.size() < 5) return "shader module is too short";
  if (words[0] != spv::MagicNumber) return "shader module has the wrong magic number";
  const std::uint32_t version = words[1];
  if ((version >> 16) != 1 || (version >> 8 & 0xff) > 6 || (version & 0xff) != 0)
    return "SPIR-V version is not supported";
  if (words[3] == 0 || words[3] > 0x3fffff) return "SPIR-V id bound is out of range";
  for (std::size_t at = 5; at < words.size();) {
    const std::uint32_t length = words[at] >> 16;
    if (length == 0 || length > words.size() - at) return "SPIR-V instruction runs past the end of the module";
    at += length;
  }
  return {};
}

base::Result<std::unique_ptr<Shader>> compile(std::span<const std::uint32_t> words, const CompileOptions& options) {
  if (std::string error = check_module(words); !error.empty()) return base::Error{error};
  if (std::string error = missing_device_capability(words); !error.empty()) return base::Error{error};
  // The front end survives whatever the words say and bounds its work; the validator's time grows with the cube of the
  // nesting, so that it is not asked about large modules that are refused anyway. Its words are better otherwise.
  const auto observer = options.observer ? options.observer : exec::requested_tracer(options.stage);
  base::Result<ir::Function> function = translate(words, options, observer ? observer->interest() : exec::Interest{});
  if (!function && words.size() > kSmallModule) return function.error();
  if (LocationCounter(words).largest() > kMaxLocations) return base::Error{"SPIR-V interface takes too many locations"};
  if (options.validate)
    if (std::string error = validate_leniently(words); !error.empty()) return base::Error{error};
  if (!function) return function.error();
  std::vector<Representation>* const kept = options.representations;
  if (kept) kept->push_back({"SPIR-V", "the module as the application gave it, disassembled", module_text(words)});
  rewrite(function.value(), kept ? keep_steps(*kept) : StepListener());
  ir::make_joins_whole(function.value());
  base::Result<std::unique_ptr<Shader>> shader = lower(function.take(), observer);
  if (kept && shader)
    kept->push_back(
        {"program", "the instructions that run, with their registers", disassemble(shader.value()->program())});
  return shader;
}

}  // namespace vitrine::spirv
