// SPIRV-Tools' validator as a diagnosis.
#include "spirv/diagnosis.h"

#include <spirv-tools/libspirv.h>
#include <spirv/unified1/spirv.hpp11>

#include <algorithm>
#include <unordered_map>

#include "base/log.h"

namespace vitrine::spirv {
namespace {

/// Words of a module that cannot nest deeply: the validator's time grows with the cube of the nesting.
constexpr std::size_t kSmallModule = 4096;

/// SPIRV-Tools' validator, told to accept every block layout that a device feature could allow: layouts are the
/// application's promise to the validation layer, not something that can harm us.
std::string validate(std::span<const std::uint32_t> words) {
  const spv_context context = spvContextCreate(SPV_ENV_VULKAN_1_3);
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
    message = diagnostic != nullptr && diagnostic->error != nullptr ? diagnostic->error : "invalid SPIR-V";
  }
  spvDiagnosticDestroy(diagnostic);
  spvValidatorOptionsDestroy(options);
  spvContextDestroy(context);
  return message;
}

/// How large the types of a module are: locations of inputs and outputs, each of which the validator notes, and the
/// structures within structures that it walks over, each time it meets them.
class TypeSizes {
 public:
  explicit TypeSizes(std::span<const std::uint32_t> words) {
    for (std::size_t at = 5; at < words.size(); at += words[at] >> 16) visit(words.subspan(at, words[at] >> 16));
  }

  /// Locations of the largest variable.
  std::uint64_t locations() const { return largest_; }
  /// Of the largest type: itself and the members of its members.
  std::uint64_t parts() const { return most_parts_; }

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
        [[fallthrough]];
      case spv::Op::OpTypeRuntimeArray:
        if (inst.size() > 2) take_parts(inst[1], parts_of(inst[2]) + 1);
        break;
      case spv::Op::OpTypeStruct: {
        std::uint64_t sum = 0;
        std::uint64_t parts = 1;
        for (const std::uint32_t member : inst.subspan(std::min<std::size_t>(2, inst.size()))) {
          sum += locations(member);
          parts += parts_of(member);
        }
        if (inst.size() > 1) take(inst[1], sum);
        if (inst.size() > 1) take_parts(inst[1], parts);
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

  void take_parts(std::uint32_t id, std::uint64_t count) {
    parts_[id] = std::min(count, kMany);
    most_parts_ = std::max(most_parts_, parts_[id]);
  }

  std::uint64_t parts_of(std::uint32_t id) const {
    const auto found = parts_.find(id);
    return found == parts_.end() ? 1 : found->second;
  }

  /// Of a type: one where nothing else is known.
  std::uint64_t locations(std::uint32_t id) const {
    const auto found = locations_.find(id);
    return found == locations_.end() ? 1 : found->second;
  }

  std::uint64_t literal(std::uint32_t id) const {
    const auto found = literals_.find(id);
    return found == literals_.end() ? 1 : found->second;
  }

  std::unordered_map<std::uint32_t, std::uint64_t> literals_, locations_, parts_;
  std::uint64_t largest_ = 0, most_parts_ = 0;
};

/// Below it the validator prints the instruction, which the front end names.
std::string first_line(const std::string& message) { return message.substr(0, message.find('\n')); }

/// More locations than any stage has; geometry shaders' inputs are arrays.
constexpr std::uint64_t kMaxLocations = 1 << 16, kMaxParts = 1 << 12;

/// Whether the validator finds an end in reasonable time and memory.
bool is_bounded(std::span<const std::uint32_t> words) {
  const TypeSizes sizes(words);
  return sizes.locations() <= kMaxLocations && sizes.parts() <= kMaxParts;
}

}  // namespace

std::string validator_message(std::span<const std::uint32_t> words) {
  if (words.size() > kSmallModule || !is_bounded(words)) return {};
  return first_line(validate(words));
}

void log_diagnosis(std::span<const std::uint32_t> words) {
#ifdef NDEBUG
  constexpr bool kDebug = false;
#else
  constexpr bool kDebug = true;
#endif
  if (!base::log_enabled("validator") && !(kDebug && base::log_enabled("shader"))) return;
  if (!is_bounded(words)) return;
  if (const std::string message = first_line(validate(words)); !message.empty())
    base::log("validator", "a module runs that SPIRV-Tools calls invalid: " + message);
}

}  // namespace vitrine::spirv
