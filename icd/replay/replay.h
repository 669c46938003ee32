// Replay: runs recorded commands, one after the other, on the thread of the queue. ReplayState is what a command
// buffer's commands share while they run.
#pragma once

#include <optional>

#include "icd/object/descriptors.h"
#include "icd/object/pipeline.h"
#include "icd/object/query_pool.h"
#include "icd/object/render_pass.h"
#include "icd/properties.h"
#include "icd/record/commands.h"
#include "icd/replay/descriptor_buffers.h"
#include "icd/replay/transient.h"
#include "raster/pass.h"

namespace vitrine::icd {

inline constexpr std::uint32_t kMaxDynamicBuffers =
    kClaimedPhysicalDeviceProperties.limits.maxDescriptorSetUniformBuffersDynamic +
    kClaimedPhysicalDeviceProperties.limits.maxDescriptorSetStorageBuffersDynamic;

/// What is bound at one bind point.
struct BindPoint {
  const Pipeline* pipeline = nullptr;
  std::array<const DescriptorSet*, spirv::kMaxSets> sets{};
  /// Of sets that lie in buffers (icd/replay/descriptor_buffers.h), else 0.
  std::array<VkDeviceAddress, spirv::kMaxSets> addresses{};
  bool in_buffers = false;                                      ///< there may be such sets
  std::array<spirv::Descriptor, kMaxDynamicBuffers> dynamic{};  ///< offsets applied
};

/// Shader objects of the graphics stages. While they are bound, the pipeline that is bound stands for them.
struct BoundShaders {
  bool any = false;  ///< they are, not the application's pipeline
  std::array<ShaderObject*, kGraphicsStages> stages{};
  ColorLocations locations;  ///< of the rendering instance
  LinkKey key{};             ///< of the pipeline that stands for them
};

/// What is readable of a bound buffer, from the bound offset on.
struct BoundBuffer {
  const std::byte* data = nullptr;
  std::uint64_t size = 0;
};

/// A resolve that is due when a scope ends.
struct PendingResolve {
  const ImageView* source = nullptr;
  const ImageView* target = nullptr;
  VkImageAspectFlagBits aspect = VK_IMAGE_ASPECT_COLOR_BIT;
  VkResolveModeFlagBits mode = VK_RESOLVE_MODE_NONE;
};

/// What draws go to: one subpass of a render pass instance, or a dynamic rendering instance.
struct DrawScope {
  VkRect2D area{};  ///< inside the attachments
  std::uint32_t layers = 1;
  std::uint32_t view_mask = 0;
  std::array<PendingResolve, raster::kMaxColorAttachments + 2> resolve{};
  std::uint32_t resolve_count = 0;
  bool suspended = false;                       ///< a later scope goes on with it
  ColorLocations locations;                     ///< of the colour attachments in the pass
  std::uint32_t live_colors = kAllColorWrites;  ///< bit i: there is a colour attachment i

  void add_resolve(const PendingResolve& r) {
    if (r.source && r.target && r.mode != VK_RESOLVE_MODE_NONE && resolve_count < resolve.size())
      resolve[resolve_count++] = r;
  }
};

/// Parts of `draw` that no longer say what is bound.
enum DirtyBit : std::uint32_t {
  kDirtyState = 1u << 0,
  kDirtyDescriptors = 1u << 1,
  kDirtyPushConstants = 1u << 2,
  kDirtyVertexBuffers = 1u << 3,
  kDirtyShaders = 1u << 4,  ///< the pipeline that stands for shader objects
  kDirtyAll = ~0u,
};

/// A query that has ended, but whose counters are final only after the pass is flushed.
struct PendingQuery {
  QueryPool* pool;
  std::uint32_t query;
  bool timestamp;  ///< gets its value then: the work before it is done when the pass is flushed
};

struct ObservedReplay;  // icd/replay/observed_replay.h

inline constexpr std::size_t kReplayBlockBytes = 256 * 1024;
/// Memory of values that draws point to until their pass is flushed.
using ReplayArena = base::Arena<base::ArenaShape{16, 0, kReplayBlockBytes, kReplayBlockBytes}, HostBlocks>;

struct ReplayState {
  explicit ReplayState(Device& d)
      : device(d),
        arena({d.memory, VK_SYSTEM_ALLOCATION_SCOPE_DEVICE}),
        kept_sets(d.memory),
        transients(d.memory),
        pending_queries(d.memory),
        views_loaded(d.memory) {}

  Device& device;
  ReplayArena arena;
  spirv::Fault fault;
  std::shared_ptr<ObservedReplay> observed;  ///< null: nobody observes

  BindPoint graphics, compute;
  BoundShaders shaders;
  std::array<VkDeviceAddress, kMaxDescriptorBuffers> descriptor_buffers{};
  KeptSets kept_sets;
  alignas(16) std::array<std::byte, spirv::kMaxPushConstantBytes> push_constants{};
  std::array<BoundBuffer, raster::kMaxVertexBindings> vertex_buffers{};
  BoundBuffer indices;
  DynamicValues dynamic;
  bool suppressed = false;  ///< conditional rendering discards draws, dispatches and clears
  std::uint32_t dirty = kDirtyAll;
  raster::TransformFeedback feedback;
  raster::DrawCall draw;  ///< up to date but for `dirty` and the numbers of the draw itself

  // The render pass instance
  const CmdBeginRenderPass* instance = nullptr;  ///< null: outside, or dynamic rendering
  std::uint32_t subpass = 0;
  const CmdBeginRendering* rendering = nullptr;  ///< as it was recorded; null: outside, or a render pass
  DrawScope scope;                               ///< while there is a pass
  std::optional<raster::Pass> pass;              ///< none: outside
  TransientAttachments transients;               ///< of the scope, or of one that was suspended

  raster::QueryCounters counters;              ///< of active queries
  const QueryPool* profiled = nullptr;         ///< of the performance query that is active; null: none is
  std::vector<std::uint64_t> profile_started;  ///< what its counters were when it began
  Vector<PendingQuery> pending_queries;
  Vector<std::uint32_t> views_loaded;  ///< per attachment: views whose load op has happened
};

/// Replays a primary command buffer on the calling thread; one at a time per device. VK_ERROR_DEVICE_LOST if a shader
/// faulted or memory ran out: the device has been marked lost, and a messenger told why.
VkResult replay(Device& device, const CommandBuffer& buffer) noexcept;

/// Makes the device's replay state unless it has one. Throws std::bad_alloc.
void prepare_replay(Device& device);

/// Runs the commands of one buffer in the current state; secondary buffers come here too.
void replay_commands(ReplayState& state, const CommandBuffer& buffer);

/// Ends what the current pass has put off: attachments are in memory, counters of ended queries final, and nothing
/// points into the arena.
void flush_pass(ReplayState& state);

/// Makes a pass of dynamic rendering have its colour attachments at these locations.
void follow_locations(ReplayState& state, const ColorLocations& locations);

/// Nothing points into the arena any more: its memory can be used again.
void reset_arena(ReplayState& state);

/// Where shader objects are bound: binds the pipeline that stands for them. To be called before the graphics pipeline
/// is looked at.
void link_shaders(ReplayState& state);

/// Makes ended queries readable.
void publish_queries(ReplayState& state);

/// The bound pipeline's own state where nothing is dynamic, else a copy of it in the arena with the values that
/// commands have set. Blending is by location.
const raster::State* resolve_state(ReplayState& state);

inline BindPoint& bind_point(ReplayState& state, VkPipelineBindPoint which) {
  return which == VK_PIPELINE_BIND_POINT_COMPUTE ? state.compute : state.graphics;
}

/// Fills the parts of a resource table that the bound pipeline uses. Dynamic buffers and push constants are copied into
/// the arena.
void fill_resources(ReplayState& state, const BindPoint& bind_point, spirv::ResourceTable& table);

/// Reads a counter of transform feedback. False if it is not there.
bool read_counter(const CounterBuffer& counter, std::uint32_t& value);

/// Runs one command: an overload per row of icd/record/commands.def.
#define VITRINE_COMMAND(name) void execute(ReplayState& state, const Cmd##name& command);
#include "icd/record/commands.def"

}  // namespace vitrine::icd
