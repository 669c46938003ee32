// See stages.h.
#include "glass/sync/stages.h"

#include <array>

namespace vitrine::glass::sync {
namespace {

struct StageRow {
  VkPipelineStageFlags2 flag;
  const char* name;
};

constexpr std::array<StageRow, kStages> kStageRows{{
    {VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT, "DRAW_INDIRECT_BIT"},
    {VK_PIPELINE_STAGE_2_CONDITIONAL_RENDERING_BIT_EXT, "CONDITIONAL_RENDERING_BIT_EXT"},
    {VK_PIPELINE_STAGE_2_INDEX_INPUT_BIT, "INDEX_INPUT_BIT"},
    {VK_PIPELINE_STAGE_2_VERTEX_ATTRIBUTE_INPUT_BIT, "VERTEX_ATTRIBUTE_INPUT_BIT"},
    {VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT, "VERTEX_SHADER_BIT"},
    {VK_PIPELINE_STAGE_2_TESSELLATION_CONTROL_SHADER_BIT, "TESSELLATION_CONTROL_SHADER_BIT"},
    {VK_PIPELINE_STAGE_2_TESSELLATION_EVALUATION_SHADER_BIT, "TESSELLATION_EVALUATION_SHADER_BIT"},
    {VK_PIPELINE_STAGE_2_GEOMETRY_SHADER_BIT, "GEOMETRY_SHADER_BIT"},
    {VK_PIPELINE_STAGE_2_TRANSFORM_FEEDBACK_BIT_EXT, "TRANSFORM_FEEDBACK_BIT_EXT"},
    {VK_PIPELINE_STAGE_2_FRAGMENT_SHADING_RATE_ATTACHMENT_BIT_KHR, "FRAGMENT_SHADING_RATE_ATTACHMENT_BIT_KHR"},
    {VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT, "EARLY_FRAGMENT_TESTS_BIT"},
    {VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, "FRAGMENT_SHADER_BIT"},
    {VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT, "LATE_FRAGMENT_TESTS_BIT"},
    {VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, "COLOR_ATTACHMENT_OUTPUT_BIT"},
    {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, "COMPUTE_SHADER_BIT"},
    {VK_PIPELINE_STAGE_2_COPY_BIT, "COPY_BIT"},
    {VK_PIPELINE_STAGE_2_RESOLVE_BIT, "RESOLVE_BIT"},
    {VK_PIPELINE_STAGE_2_BLIT_BIT, "BLIT_BIT"},
    {VK_PIPELINE_STAGE_2_CLEAR_BIT, "CLEAR_BIT"},
    {VK_PIPELINE_STAGE_2_HOST_BIT, "HOST_BIT"},
    {VK_PIPELINE_STAGE_2_NONE, "ALL_COMMANDS_BIT"},
}};

struct AccessRow {
  VkAccessFlags2 flags;  ///< any of which names it
  const char* name;
};

constexpr VkAccessFlags2 kRead = VK_ACCESS_2_MEMORY_READ_BIT, kWrite = VK_ACCESS_2_MEMORY_WRITE_BIT;
constexpr VkAccessFlags2 kShaderRead = VK_ACCESS_2_SHADER_READ_BIT | kRead;

constexpr std::array<AccessRow, kAccesses> kAccessRows{{
    {VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT | kRead, "INDIRECT_COMMAND_READ_BIT"},
    {VK_ACCESS_2_INDEX_READ_BIT | kRead, "INDEX_READ_BIT"},
    {VK_ACCESS_2_VERTEX_ATTRIBUTE_READ_BIT | kRead, "VERTEX_ATTRIBUTE_READ_BIT"},
    {VK_ACCESS_2_UNIFORM_READ_BIT | kShaderRead, "UNIFORM_READ_BIT"},
    {VK_ACCESS_2_INPUT_ATTACHMENT_READ_BIT | kRead, "INPUT_ATTACHMENT_READ_BIT"},
    {VK_ACCESS_2_SHADER_SAMPLED_READ_BIT | kShaderRead, "SHADER_SAMPLED_READ_BIT"},
    {VK_ACCESS_2_SHADER_STORAGE_READ_BIT | kShaderRead, "SHADER_STORAGE_READ_BIT"},
    {VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT | VK_ACCESS_2_SHADER_WRITE_BIT | kWrite, "SHADER_STORAGE_WRITE_BIT"},
    {VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT | kRead, "COLOR_ATTACHMENT_READ_BIT"},
    {VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT | kWrite, "COLOR_ATTACHMENT_WRITE_BIT"},
    {VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT | kRead, "DEPTH_STENCIL_ATTACHMENT_READ_BIT"},
    {VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT | kWrite, "DEPTH_STENCIL_ATTACHMENT_WRITE_BIT"},
    {VK_ACCESS_2_TRANSFER_READ_BIT | kRead, "TRANSFER_READ_BIT"},
    {VK_ACCESS_2_TRANSFER_WRITE_BIT | kWrite, "TRANSFER_WRITE_BIT"},
    {VK_ACCESS_2_HOST_READ_BIT | kRead, "HOST_READ_BIT"},
    {VK_ACCESS_2_HOST_WRITE_BIT | kWrite, "HOST_WRITE_BIT"},
    {VK_ACCESS_2_TRANSFORM_FEEDBACK_WRITE_BIT_EXT | kWrite, "TRANSFORM_FEEDBACK_WRITE_BIT_EXT"},
    {VK_ACCESS_2_TRANSFORM_FEEDBACK_COUNTER_READ_BIT_EXT | kRead, "TRANSFORM_FEEDBACK_COUNTER_READ_BIT_EXT"},
    {VK_ACCESS_2_TRANSFORM_FEEDBACK_COUNTER_WRITE_BIT_EXT | kWrite, "TRANSFORM_FEEDBACK_COUNTER_WRITE_BIT_EXT"},
    {VK_ACCESS_2_CONDITIONAL_RENDERING_READ_BIT_EXT | kRead, "CONDITIONAL_RENDERING_READ_BIT_EXT"},
    {VK_ACCESS_2_FRAGMENT_SHADING_RATE_ATTACHMENT_READ_BIT_KHR | kRead,
     "FRAGMENT_SHADING_RATE_ATTACHMENT_READ_BIT_KHR"},
    {kWrite, "MEMORY_WRITE_BIT"},
}};

constexpr Stages kGraphics = (bit(Stage::kColor) << 1) - 1;
constexpr Stages kTransfer = bit(Stage::kCopy) | bit(Stage::kResolve) | bit(Stage::kBlit) | bit(Stage::kClear);
constexpr Stages kPreRasterization =
    bit(Stage::kVertex) | bit(Stage::kControl) | bit(Stage::kEvaluation) | bit(Stage::kGeometry);
/// Conditional rendering is a pipeline of its own.
constexpr Stages kOrdered = kGraphics & ~bit(Stage::kConditional);

/// The stages that bits name. TOP_OF_PIPE and BOTTOM_OF_PIPE are their callers' business.
Stages named(VkPipelineStageFlags2 flags) {
  Stages stages = 0;
  for (std::size_t i = 0; i < kStages; ++i)
    if ((flags & kStageRows[i].flag) != 0) stages |= Stages{1} << i;
  if ((flags & VK_PIPELINE_STAGE_2_VERTEX_INPUT_BIT) != 0) stages |= bit(Stage::kIndex) | bit(Stage::kAttribute);
  if ((flags & VK_PIPELINE_STAGE_2_PRE_RASTERIZATION_SHADERS_BIT) != 0) stages |= kPreRasterization;
  if ((flags & VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT) != 0) stages |= kTransfer;
  if ((flags & VK_PIPELINE_STAGE_2_ALL_GRAPHICS_BIT) != 0) stages |= kGraphics;
  if ((flags & VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT) != 0) stages |= kAllCommands;
  return stages;
}

Accesses named_accesses(VkAccessFlags2 flags) {
  Accesses accesses = 0;
  for (std::size_t i = 0; i < kAccesses; ++i)
    if ((flags & kAccessRows[i].flags) != 0) accesses |= Accesses{1} << i;
  return accesses;
}

Stages with_earlier(Stages stages) {
  Stages all = stages;
  for (std::size_t i = 0; i < kStages; ++i) {
    const Stages one = Stages{1} << i;
    if ((stages & one & kOrdered) != 0) all |= (one - 1) & kOrdered;
  }
  if ((stages & bit(Stage::kCompute)) != 0) all |= bit(Stage::kIndirect);
  return all;
}

Stages with_later(Stages stages) {
  Stages all = stages;
  for (std::size_t i = 0; i < kStages; ++i) {
    const Stages one = Stages{1} << i;
    if ((stages & one & kOrdered) != 0) all |= ~(one - 1) & kOrdered;
  }
  if ((stages & bit(Stage::kIndirect)) != 0) all |= bit(Stage::kCompute);
  return all;
}

}  // namespace

bool writes(Access access) {
  constexpr Accesses kWrites = bit(Access::kTransitionWrite) | bit(Access::kStorageWrite) | bit(Access::kColorWrite) |
                               bit(Access::kDepthWrite) | bit(Access::kTransferWrite) | bit(Access::kHostWrite) |
                               bit(Access::kFeedbackWrite) | bit(Access::kCounterWrite);
  return (bit(access) & kWrites) != 0;
}

bool is_write_of(Stage stage, Access access) {
  switch (stage) {
    case Stage::kFeedback:
      return access == Access::kFeedbackWrite || access == Access::kCounterWrite;
    case Stage::kEarlyTests:
    case Stage::kLateTests:
      return access == Access::kDepthWrite;
    case Stage::kColor:
      return access == Access::kColorWrite;
    case Stage::kHost:
      return access == Access::kHostWrite;
    case Stage::kTransition:
      return access == Access::kTransitionWrite;
    default:
      return access == ((kTransfer & bit(stage)) != 0 ? Access::kTransferWrite : Access::kStorageWrite);
  }
}

bool is_attachment(Access access) {
  return access == Access::kColorRead || access == Access::kColorWrite || access == Access::kDepthRead ||
         access == Access::kDepthWrite;
}

Scope first_scope(VkPipelineStageFlags2 stages, VkAccessFlags2 accesses) {
  const Stages accessed = named(stages);
  const bool bottom = (stages & VK_PIPELINE_STAGE_2_BOTTOM_OF_PIPE_BIT) != 0;
  return {with_earlier(bottom ? accessed | kAllCommands : accessed), accessed, named_accesses(accesses)};
}

Scope second_scope(VkPipelineStageFlags2 stages, VkAccessFlags2 accesses) {
  const Stages accessed = named(stages);
  const bool top = (stages & VK_PIPELINE_STAGE_2_TOP_OF_PIPE_BIT) != 0;
  return {with_later(top ? accessed | kAllCommands : accessed), accessed, named_accesses(accesses)};
}

Stage shader_stage(VkShaderStageFlagBits stage) {
  switch (stage) {
    case VK_SHADER_STAGE_VERTEX_BIT:
      return Stage::kVertex;
    case VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT:
      return Stage::kControl;
    case VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT:
      return Stage::kEvaluation;
    case VK_SHADER_STAGE_GEOMETRY_BIT:
      return Stage::kGeometry;
    case VK_SHADER_STAGE_FRAGMENT_BIT:
      return Stage::kFragment;
    default:
      return Stage::kCompute;
  }
}

std::string stage_text(Stage stage) {
  return std::string("VK_PIPELINE_STAGE_2_") + kStageRows[static_cast<std::size_t>(stage)].name;
}

std::string access_text(Access access) {
  return std::string("VK_ACCESS_2_") + kAccessRows[static_cast<std::size_t>(access)].name;
}

}  // namespace vitrine::glass::sync
