// Execution modes (SPIR-V 3.6; Vulkan, the chapters of the stages): what the entry point declares about itself, into
// its interface.
#include <algorithm>

#include "spirv/front/functions.h"
#include "spirv/newer_numbers.h"

namespace vitrine::spirv::front {
namespace {

using spv::Decoration;

bool is_per_sample(const DecorationRow& row) {
  const auto built_in = static_cast<spv::BuiltIn>(row.value);
  return row.kind == Decoration::Sample ||
         (row.kind == Decoration::BuiltIn &&
          (built_in == spv::BuiltIn::SampleId || built_in == spv::BuiltIn::SamplePosition));
}

/// Vulkan 1.3.239, Sample Shading: "If a fragment shader entry point's interface includes an input variable decorated
/// with SamplePosition, Sample Shading is considered enabled with a minSampleShading value of 1.0." The same holds for
/// SampleId and for Sample, which may decorate members too. Whether the shader reads the variable does not matter.
bool shades_per_sample(const Module& module) {
  for (const std::uint32_t id : module.interface) {
    const Type& pointer = module.type(module.def(id).result_type);
    if (pointer.storage != spv::StorageClass::Input) continue;
    const auto of_variable = module.decorations_of(id), of_type = module.decorations_of(pointer.element);
    if (std::any_of(of_variable.begin(), of_variable.end(), is_per_sample)) return true;
    if (std::any_of(of_type.begin(), of_type.end(),
                    [](const DecorationRow& row) { return row.member != 0 && is_per_sample(row); }))
      return true;
  }
  return false;
}

void set_local_size(Translator& t, const std::uint32_t size[3]) {
  for (int i = 0; i < 3; i++) t.function.interface.local_size[i] = size[i];
}

/// maxComputeWorkGroupSize and maxComputeWorkGroupInvocations.
void check_local_size(const ShaderInterface& interface) {
  constexpr std::uint64_t kMost = 1024;
  std::uint64_t product = 1;
  for (const std::uint32_t size : interface.local_size) {
    if (size == 0 || size > kMost) throw Failure("local size is out of range");
    product *= size;
  }
  if (product > kMost) throw Failure("local size is out of range");
  // VUID-StandaloneSpirv-None-10129 and -10130, which later versions of the specification have.
  const bool halves = interface.local_size[0] % 2 == 0 && interface.local_size[1] % 2 == 0;
  if (interface.derivative_group == DerivativeGroup::kQuads && !halves)
    throw Failure("local size is odd in a shader whose derivatives are of quads");
  if (interface.derivative_group == DerivativeGroup::kLinear && product % 4 != 0)
    throw Failure("local size is no multiple of 4 in a shader with derivatives");
}

/// Modes of tessellation and geometry stages. False: another one.
bool read_stage_mode(StageModes& modes, spv::ExecutionMode mode, std::uint32_t value, VkShaderStageFlagBits stage) {
  const auto domain = [&](TessDomain which) {
    modes.domain = which;
    modes.has_domain = true;
    modes.input_vertices = 3;  // Triangles of a geometry shader
    return true;
  };
  const auto spacing = [&](TessSpacing which) {
    modes.spacing = which;
    return modes.has_spacing = true;
  };
  const auto order = [&](bool clockwise) {
    modes.clockwise = clockwise;
    return modes.has_order = true;
  };
  const auto input = [&](std::uint32_t vertices) { return (modes.input_vertices = vertices) != 0; };
  const auto output = [&](VkPrimitiveTopology topology) {
    modes.output = topology;
    return true;
  };
  switch (mode) {
    case spv::ExecutionMode::Invocations:
      modes.invocations = value;
      return true;
    case spv::ExecutionMode::SpacingEqual:
      return spacing(TessSpacing::kEqual);
    case spv::ExecutionMode::SpacingFractionalEven:
      return spacing(TessSpacing::kFractionalEven);
    case spv::ExecutionMode::SpacingFractionalOdd:
      return spacing(TessSpacing::kFractionalOdd);
    case spv::ExecutionMode::VertexOrderCw:
      return order(true);
    case spv::ExecutionMode::VertexOrderCcw:
      return order(false);
    case spv::ExecutionMode::PointMode:
      return modes.point_mode = true;
    case spv::ExecutionMode::Triangles:
      return domain(TessDomain::kTriangles);
    case spv::ExecutionMode::Quads:
      return domain(TessDomain::kQuads);
    case spv::ExecutionMode::Isolines:
      return domain(TessDomain::kIsolines);
    case spv::ExecutionMode::InputPoints:
      return input(1);
    case spv::ExecutionMode::InputLines:
      return input(2);
    case spv::ExecutionMode::InputLinesAdjacency:
      return input(4);
    case spv::ExecutionMode::InputTrianglesAdjacency:
      return input(6);
    case spv::ExecutionMode::OutputVertices:
      (stage == VK_SHADER_STAGE_GEOMETRY_BIT ? modes.max_vertices : modes.control_points) = value;
      return true;
    case spv::ExecutionMode::OutputPoints:
      return output(VK_PRIMITIVE_TOPOLOGY_POINT_LIST);
    case spv::ExecutionMode::OutputLineStrip:
      return output(VK_PRIMITIVE_TOPOLOGY_LINE_STRIP);
    case spv::ExecutionMode::OutputTriangleStrip:
      return output(VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP);
    default:
      return false;
  }
}

/// Modes that older headers do not know. False: another one.
bool read_newer_mode(Translator& t, spv::ExecutionMode mode) {
  // read_fast_math() reads it; derivatives are of quads anyway.
  if (mode == newer::kFPFastMathDefault || mode == newer::kQuadDerivatives) return true;
  t.function.helpers_take_part |= mode == newer::kMaximallyReconverges;
  t.function.interface.needs_helpers |= mode == newer::kRequireFullQuads;
  return mode == newer::kMaximallyReconverges || mode == newer::kRequireFullQuads;
}

/// The limits of the device hold; memory is sized by these numbers.
void check_stage_modes(const StageModes& modes) {
  if (modes.max_vertices > 1024 || modes.invocations == 0 || modes.invocations > 32 || modes.control_points > 32)
    throw Failure("execution mode is beyond the device's limits");
}

}  // namespace

void read_modes(Translator& t) {
  ShaderInterface& interface = t.function.interface;
  interface.stage = t.options.stage;
  interface.per_sample = t.options.stage == VK_SHADER_STAGE_FRAGMENT_BIT && shades_per_sample(t.module);
  for (const Inst& mode : t.module.modes) {
    if (read_newer_mode(t, static_cast<spv::ExecutionMode>(mode.operand(1)))) continue;
    auto word = [&](std::uint32_t i) { return mode.operand(i + 2); };
    auto id = [&](std::uint32_t i) { return t.module.constant_u32(mode.operand(i + 2), mode); };
    switch (static_cast<spv::ExecutionMode>(mode.operand(1))) {
      case spv::ExecutionMode::LocalSize: {
        const std::uint32_t size[3] = {word(0), word(1), word(2)};
        set_local_size(t, size);
        break;
      }
      case spv::ExecutionMode::LocalSizeId: {
        const std::uint32_t size[3] = {id(0), id(1), id(2)};
        set_local_size(t, size);
        break;
      }
      case spv::ExecutionMode::DerivativeGroupQuadsNV:
        interface.derivative_group = DerivativeGroup::kQuads;
        break;
      case spv::ExecutionMode::DerivativeGroupLinearNV:
        interface.derivative_group = DerivativeGroup::kLinear;
        break;
      case spv::ExecutionMode::Xfb:
        interface.captures = true;
        break;
      case spv::ExecutionMode::EarlyFragmentTests:
        interface.early_fragment_tests = true;
        break;
      case spv::ExecutionMode::PostDepthCoverage:
        interface.post_depth_coverage = true;
        break;
      case spv::ExecutionMode::SignedZeroInfNanPreserve:
        t.function.signed_zero_inf_nan_preserve |= word(0) == 32;
        t.function.inexact_off |= static_cast<std::uint8_t>(word(0) & (16 | 64));
        break;
      case spv::ExecutionMode::DenormFlushToZero:
        t.function.denorm_flush_to_zero |= word(0) == 32;
        t.function.inexact_off |= static_cast<std::uint8_t>(word(0) & (16 | 64));
        break;
      case spv::ExecutionMode::SubgroupUniformControlFlowKHR:  // invocations always meet again where constructs end
      case spv::ExecutionMode::PixelInterlockOrderedEXT:       // fragments that write memory run in order
      case spv::ExecutionMode::PixelInterlockUnorderedEXT:
      case spv::ExecutionMode::SampleInterlockOrderedEXT:
      case spv::ExecutionMode::SampleInterlockUnorderedEXT:
      case spv::ExecutionMode::OriginUpperLeft:
      case spv::ExecutionMode::DepthReplacing:
      case spv::ExecutionMode::StencilRefReplacingEXT:
      case spv::ExecutionMode::DepthGreater:
      case spv::ExecutionMode::DepthLess:
      case spv::ExecutionMode::DepthUnchanged:
      case spv::ExecutionMode::DenormPreserve:
      case spv::ExecutionMode::RoundingModeRTE:
        break;
      default:
        if (read_stage_mode(interface.modes, static_cast<spv::ExecutionMode>(mode.operand(1)),
                            mode.has(2) ? word(0) : 0, t.options.stage))
          break;
        fail(mode, "execution mode " + std::to_string(mode.operand(1)) + " is not supported");
    }
  }
  check_stage_modes(interface.modes);
  read_fast_math(t);
  // A constant decorated WorkgroupSize overrides the execution mode (Vulkan, Built-In Variables).
  for (const DecorationRow& row : t.module.decorations)
    if (row.kind == Decoration::BuiltIn && row.value == static_cast<std::uint32_t>(spv::BuiltIn::WorkgroupSize))
      if (const Constant* size = t.module.constant(row.id); size != nullptr && size->words.size() == 3)
        set_local_size(t, size->words.data());
  check_local_size(interface);
}

}  // namespace vitrine::spirv::front
