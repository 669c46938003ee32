// Pipeline stages and kinds of access as numbers, and what masks of them mean (Vulkan 1.3.239, Synchronization and
// Cache Control: Pipeline Stages, Access Types).
#pragma once

#include <vulkan/vulkan_core.h>

#include <cstddef>
#include <cstdint>
#include <string>

namespace vitrine::glass::sync {

/// In an order in which those of the graphics pipeline are logically earlier and later.
enum class Stage : std::uint8_t {
  kIndirect,
  kConditional,
  kIndex,
  kAttribute,
  kVertex,
  kControl,
  kEvaluation,
  kGeometry,
  kFeedback,
  kShadingRate,
  kEarlyTests,
  kFragment,
  kLateTests,
  kColor,
  kCompute,
  kCopy,
  kResolve,
  kBlit,
  kClear,
  kHost,
  kTransition,  ///< of image layouts: in no stage, but before what waits for all commands
};
inline constexpr std::size_t kStages = 21;
using Stages = std::uint32_t;  ///< a bit each

enum class Access : std::uint8_t {
  kIndirectRead,
  kIndexRead,
  kAttributeRead,
  kUniformRead,
  kInputAttachmentRead,
  kSampledRead,
  kStorageRead,
  kStorageWrite,
  kColorRead,
  kColorWrite,
  kDepthRead,
  kDepthWrite,
  kTransferRead,
  kTransferWrite,
  kHostRead,
  kHostWrite,
  kFeedbackWrite,
  kCounterRead,
  kCounterWrite,
  kConditionalRead,
  kShadingRateRead,
  kTransitionWrite,
};
inline constexpr std::size_t kAccesses = 22;
using Accesses = std::uint32_t;  ///< a bit each

constexpr Stages bit(Stage stage) { return Stages{1} << static_cast<unsigned>(stage); }
constexpr Accesses bit(Access access) { return Accesses{1} << static_cast<unsigned>(access); }

/// VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT.
inline constexpr Stages kAllCommands = ((Stages{1} << kStages) - 1) & ~bit(Stage::kHost);

/// How a command uses bytes.
struct Use {
  Stage stage = Stage::kCopy;
  Access access = Access::kTransferRead;
  bool atomic = false;  ///< an atomic operation whose scope holds the device
  bool operator==(const Use&) const = default;
};
bool writes(Access access);
/// Whether a stage writes in this way.
bool is_write_of(Stage stage, Access access);
/// Of an attachment: such uses inside of one subpass come in rasterization order.
bool is_attachment(Access access);

/// One side of a dependency.
struct Scope {
  Stages executed = 0;  ///< of its synchronization scope: with those that are logically earlier, or later
  Stages accessed = 0;  ///< of its access scope
  Accesses accesses = 0;
  bool empty() const { return executed == 0; }
};
Scope first_scope(VkPipelineStageFlags2 stages, VkAccessFlags2 accesses);
Scope second_scope(VkPipelineStageFlags2 stages, VkAccessFlags2 accesses);

Stage shader_stage(VkShaderStageFlagBits stage);

/// "VK_PIPELINE_STAGE_2_COPY_BIT".
std::string stage_text(Stage stage);
/// "VK_ACCESS_2_TRANSFER_READ_BIT".
std::string access_text(Access access);

}  // namespace vitrine::glass::sync
