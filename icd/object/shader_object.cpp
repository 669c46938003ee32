// See shader_object.h: how shader objects become pipelines.
#include "icd/object/shader_object.h"

#include <algorithm>
#include <atomic>
#include <cstring>

#ifdef VK_EXT_shader_object
namespace vitrine::icd {
namespace {

constexpr std::size_t kVertex = 0, kControl = 1, kEvaluation = 2, kGeometry = 3, kFragment = 4;
constexpr std::size_t kLiveOutputs = kGraphicsStages, kLocations = kGraphicsStages + 1;

/// "All bound graphics shader objects must have been created with identical or identically defined" set layouts and
/// push constant ranges (vkCmdDraw): where they were not, those of the one that sees most.
std::shared_ptr<const PipelineLayoutShape> common_layout(const BoundStages& stages) {
  std::shared_ptr<const PipelineLayoutShape> layout;
  for (const ShaderObject* shader : stages)
    if (shader && (!layout || shader->layout->sets.size() > layout->sets.size())) layout = shader->layout;
  return layout;
}

/// The fragment shader without the color outputs that reach no attachment, as pipelines have it.
std::shared_ptr<const CompiledShader> fragment_with(Device& device, const ShaderObject& fragment,
                                                    std::uint32_t live_outputs) {
  if ((fragment.color_outputs & ~live_outputs) == 0) return fragment.shader;
  const StageInfo stage(fragment.source);
  StageRequest request;
  request.stage = &stage.info();
  request.layout = fragment.layout;
  request.live_color_outputs = live_outputs;
  const StageResult result = compile_stage(device, nullptr, request);
  return result.shader ? result.shader : fragment.shader;
}

void fill_pipeline(Device& device, const BoundStages& stages, const LinkKey& key, const ColorLocations& locations,
                   Pipeline& pipeline) {
  std::shared_ptr<const CompiledShader>* const places[] = {&pipeline.vertex, &pipeline.control, &pipeline.evaluation,
                                                           &pipeline.geometry, &pipeline.fragment};
  std::size_t named = 0;
  for (std::size_t i = 0; i < kGraphicsStages; ++i) {
    if (!stages[i]) continue;
    *places[i] = stages[i]->shader;
    pipeline.shader_objects[named++] = ref(*stages[i]);
  }
  if (const ShaderObject* fragment = stages[kFragment])
    pipeline.fragment = fragment_with(device, *fragment, static_cast<std::uint32_t>(key[kLiveOutputs]));
  pipeline.layout = common_layout(stages);
  pipeline.dynamic = DynamicStates::all();
  pipeline.live_colors = kAllColorWrites;
  pipeline.locations = locations;
  // "If the depthClipEnable feature is not enabled", nobody can set it (Vulkan 1.4.309, vkCmdSetDepthClipEnableEXT).
  pipeline.clip_follows_clamp = !device.features.test(Feature::depthClipEnable);
  pipeline.state.discard_count = raster::kMaxDiscardRectangles;
  pipeline.state.unrestricted_depth = device.extensions.test(Extension::EXT_depth_range_unrestricted);
}

void remove_link(const ShaderLink& link) {
  for (ShaderObject* shader : link.stages)
    if (shader) std::erase(shader->links, &link);
}

void add_link(ShaderLinks& table, const std::shared_ptr<ShaderLink>& link) {
  try {
    for (ShaderObject* shader : link->stages)
      if (shader) shader->links.push_back(link.get());
    table.links.emplace(link->key, link);
  } catch (...) {
    remove_link(*link);
    throw;
  }
}

}  // namespace

std::uint64_t ShaderObject::next_number() {
  static std::atomic<std::uint64_t> made{0};
  return ++made;
}

ShaderObject::~ShaderObject() {
  const std::lock_guard lock(device.shader_links.mutex);
  const Vector<ShaderLink*> ended = std::move(links);
  for (const ShaderLink* link : ended) {
    remove_link(*link);
    device.shader_links.links.erase(LinkKey(link->key));
  }
}

std::size_t stage_index(VkShaderStageFlagBits stage) {
  switch (stage) {
    case VK_SHADER_STAGE_VERTEX_BIT:
      return kVertex;
    case VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT:
      return kControl;
    case VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT:
      return kEvaluation;
    case VK_SHADER_STAGE_GEOMETRY_BIT:
      return kGeometry;
    case VK_SHADER_STAGE_FRAGMENT_BIT:
      return kFragment;
    case VK_SHADER_STAGE_COMPUTE_BIT:
      return kGraphicsStages;
    default:
      return kGraphicsStages + 1;
  }
}

LinkKey link_key(const BoundStages& stages, std::uint32_t live_outputs, const ColorLocations& locations) {
  LinkKey key{};
  for (std::size_t i = 0; i < kGraphicsStages; ++i) key[i] = stages[i] ? stages[i]->number : 0;
  const ShaderObject* fragment = stages[kFragment];
  if (fragment && (fragment->color_outputs & ~live_outputs) != 0)
    key[kLiveOutputs] = live_outputs;
  else
    key[kLiveOutputs] = kAllColorWrites;
  static_assert(sizeof locations.of == sizeof key[kLocations]);
  std::memcpy(&key[kLocations], locations.of.data(), sizeof locations.of);
  return key;
}

const Pipeline* link_stages(Device& device, const BoundStages& stages, const LinkKey& key,
                            const ColorLocations& locations) {
  if (!stages[kVertex] || !stages[kControl] != !stages[kEvaluation]) return nullptr;
  ShaderLinks& table = device.shader_links;
  {
    const std::lock_guard lock(table.mutex);
    if (const auto found = table.links.find(key); found != table.links.end()) return &found->second->pipeline;
  }
  // Nobody else adds links meanwhile: one command buffer of a device runs at a time.
  const auto link = std::allocate_shared<ShaderLink>(HostAllocator<ShaderLink>(device.memory), device.memory);
  link->key = key;
  link->stages = stages;
  fill_pipeline(device, stages, key, locations, link->pipeline);
  const std::lock_guard lock(table.mutex);
  add_link(table, link);
  return &link->pipeline;
}

std::shared_ptr<const Pipeline> make_compute_pipeline(const ShaderObject& shader) {
  const auto pipeline = std::allocate_shared<Pipeline>(HostAllocator<Pipeline>(shader.memory), shader.memory);
  pipeline->bind_point = VK_PIPELINE_BIND_POINT_COMPUTE;
  pipeline->layout = shader.layout;
  pipeline->compute = shader.shader;
  pipeline->shader_objects[0] = ref(shader);
  return pipeline;
}

}  // namespace vitrine::icd
#endif
