// See captured_command.h: the command, its stages, its state, and what it draws to. State that is dynamic is taken as
// it is now; descriptors are captured_descriptors.cpp's.
#include "icd/replay/captured_command.h"

#include <algorithm>
#include <cstring>

#include "icd/replay/captured_descriptors.h"
#include "icd/replay/observed_replay.h"

namespace vitrine::icd {
namespace {

using glass::bug::Bug;
using glass::bug::Bytes;
using glass::bug::Command;
using glass::bug::kNone;

// What leads to memory that no descriptor names (SPIR-V 3.31).
constexpr std::uint32_t kOpCapability = 17, kPhysicalStorageBufferAddresses = 5347;

template <class T>
glass::bug::Blob copy_of(const T* first, std::size_t count) {
  const auto* bytes = reinterpret_cast<const std::byte*>(first);
  return std::make_shared<Bytes>(bytes, bytes + count * sizeof(T));
}

bool uses_addresses(std::span<const std::uint32_t> words) {
  for (std::size_t at = 5; at + 1 < words.size() && (words[at] & 0xffff) == kOpCapability; at += 2)
    if (words[at + 1] == kPhysicalStorageBufferAddresses) return true;
  return false;
}

/// False: nothing is known of what it was compiled from.
bool add_stage(const std::shared_ptr<const CompiledShader>& shader, Bug& bug) {
  if (!shader) return true;
  if (!shader->kept) return false;
  const KeptStage& kept = *shader->kept;
  glass::bug::Stage out;
  out.stage = kept.stage;
  out.entry_point = kept.entry_point.c_str();
  out.subgroup_size = kept.subgroup_size;
  out.constants.assign(kept.map.begin(), kept.map.end());
  out.constant_data = copy_of(kept.data.data(), kept.data.size());
  out.words = copy_of(kept.words.data(), kept.words.size());
  bug.stages.push_back(std::move(out));
  return true;
}

std::string add_stages(const Pipeline& pipeline, Bug& bug, bool& follows_addresses) {
  for (const auto& shader : {pipeline.compute, pipeline.vertex, pipeline.control, pipeline.evaluation,
                             pipeline.geometry, pipeline.fragment}) {
    if (!add_stage(shader, bug)) return "its pipeline was made before anything was captured";
    if (shader && uses_addresses(shader->kept->words)) follows_addresses = true;
  }
  return {};
}

void add_push_constants(const ReplayState& state, const Pipeline& pipeline, Bug& bug) {
  std::uint32_t end = 0;
  for (const VkPushConstantRange& range : pipeline.layout->push_ranges) {
    bug.push_ranges.push_back(range);
    end = std::max(end, range.offset + range.size);
  }
  bug.push_constants = copy_of(state.push_constants.data(), std::min(end, spirv::kMaxPushConstantBytes));
  const auto& pushed = state.observed->pushed;
  for (std::size_t i = 0; i < pushed.size(); ++i) bug.pushed |= std::uint64_t{!pushed[i].empty()} << i;
}

/// A buffer that is bound from some byte on.
glass::bug::Stream bound(const BoundBuffer& buffer, CapturedObjects& objects) {
  glass::bug::Stream out;
  const CapturedObjects::Place place = objects.bytes(buffer.data, buffer.size);
  out.buffer = place.buffer;
  out.offset = place.offset;
  out.size = place.buffer == kNone ? 0 : buffer.size;
  return out;
}

void add_streams(const ReplayState& state, const Pipeline& pipeline, CapturedObjects& objects, Bug& bug) {
  const bool dynamic_input = pipeline.dynamic.test(DynamicState::kVertexInput);
  const bool dynamic_stride = dynamic_input || pipeline.dynamic.test(DynamicState::kVertexStride);
  const VertexStreams& streams = dynamic_input ? state.dynamic.streams : pipeline.streams;
  for (std::uint32_t i = 0; i < raster::kMaxVertexBindings; ++i) {
    if (!streams[i].used) continue;
    glass::bug::Stream out = bound(state.vertex_buffers[i], objects);
    out.binding = i;
    out.stride = dynamic_stride ? state.dynamic.streams[i].stride : streams[i].stride;
    out.divisor = streams[i].divisor;
    out.per_instance = streams[i].per_instance;
    bug.streams.push_back(out);
  }
}

std::uint32_t attachment(const ImageView* view, CapturedObjects& objects) { return view ? objects.view(*view) : kNone; }

void add_subpass(const ReplayState& state, CapturedObjects& objects, glass::bug::Rendering& out) {
  const Subpass& subpass = state.instance->render_pass->subpasses[state.subpass];
  const auto view = [&](std::uint32_t number) {
    const auto& views = state.instance->attachments;
    return attachment(number < views.size() ? views[number] : nullptr, objects);
  };
  for (const std::uint32_t color : subpass.colors) out.colors.push_back(view(color));
  out.rate = view(subpass.shading_rate);
  if (out.rate != kNone) out.rate_texel = subpass.shading_rate_texel;
  const std::uint32_t both = view(subpass.depth_stencil);
  if (both == kNone) return;
  const VkImageAspectFlags aspects =
      texel::format_desc(state.instance->render_pass->attachments[subpass.depth_stencil].format).aspects;
  if (aspects & VK_IMAGE_ASPECT_DEPTH_BIT) out.depth = both;
  if (aspects & VK_IMAGE_ASPECT_STENCIL_BIT) out.stencil = both;
}

/// By location, as the state has its blending.
void add_colors(const CmdBeginRendering& dynamic, const ColorLocations& locations, CapturedObjects& objects,
                glass::bug::Rendering& out) {
  for (std::uint32_t i = 0; i < dynamic.colors.size(); ++i) {
    const std::uint32_t at = locations.location(i);
    if (at == ColorLocations::kNone) continue;
    if (at >= out.colors.size()) out.colors.resize(at + 1, kNone);
    out.colors[at] = attachment(dynamic.colors[i].view, objects);
  }
}

std::string add_rendering(const ReplayState& state, CapturedObjects& objects, Bug& bug) {
  glass::bug::Rendering& out = bug.rendering;
  out.area = state.scope.area;
  out.layers = state.scope.layers;
  out.view_mask = state.scope.view_mask;
  const CmdBeginRendering* dynamic = state.observed->captured_rendering;
  if (state.instance) {
    if (state.instance->render_pass->subpasses[state.subpass].forced_samples > 1)
      return "it draws samples to attachments of one sample";
    add_subpass(state, objects, out);
  } else if (dynamic) {
    if (dynamic->forced_samples > 1) return "it draws samples to attachments of one sample";
    add_colors(*dynamic, state.graphics.pipeline->locations, objects, out);
    out.depth = attachment(dynamic->depth.view, objects);
    out.stencil = attachment(dynamic->stencil.view, objects);
    out.rate = attachment(dynamic->shading_rate, objects);
    if (out.rate != kNone) out.rate_texel = dynamic->shading_rate_texel;
  }
  return {};
}

// ---- the command's own arguments

void fill(const CmdDispatch& c, CapturedObjects&, Command& out) {
  std::copy_n(c.base, 3, out.base.begin());
  std::copy_n(c.groups, 3, out.groups.begin());
}
void fill(const CmdDispatchIndirect& c, CapturedObjects& objects, Command& out) {
  out.arguments = objects.buffer(*c.buffer, c.offset, sizeof(VkDispatchIndirectCommand));
  out.arguments_offset = c.offset;
}
void fill(const CmdDraw& c, CapturedObjects&, Command& out) {
  out.draws.push_back({c.vertex_count, c.first_vertex, 0});
  out.instances = c.instance_count;
  out.first_instance = c.first_instance;
}
void fill(const CmdDrawIndexed& c, CapturedObjects&, Command& out) {
  out.indexed = true;
  out.draws.push_back({c.index_count, c.first_index, c.vertex_offset});
  out.instances = c.instance_count;
  out.first_instance = c.first_instance;
}
void fill(const CmdDrawMulti& c, CapturedObjects&, Command& out) {
  for (const VkMultiDrawInfoEXT& draw : c.draws) out.draws.push_back({draw.vertexCount, draw.firstVertex, 0});
  out.instances = c.instance_count;
  out.first_instance = c.first_instance;
}
void fill(const CmdDrawMultiIndexed& c, CapturedObjects&, Command& out) {
  out.indexed = true;
  for (const VkMultiDrawIndexedInfoEXT& draw : c.draws)
    out.draws.push_back({draw.indexCount, draw.firstIndex, draw.vertexOffset});
  out.instances = c.instance_count;
  out.first_instance = c.first_instance;
}
void fill(const CmdDrawIndirect& c, CapturedObjects& objects, Command& out) {
  const std::uint64_t one = c.indexed ? sizeof(VkDrawIndexedIndirectCommand) : sizeof(VkDrawIndirectCommand);
  out.indexed = c.indexed;
  const std::uint64_t last = c.draw_count ? std::uint64_t{c.draw_count - 1} * c.stride : 0;
  out.arguments = objects.buffer(*c.buffer, c.offset, last + one);
  out.arguments_offset = c.offset;
  out.draw_count = c.draw_count;
  out.stride = c.stride;
  if (!c.count_buffer) return;
  out.count_buffer = objects.buffer(*c.count_buffer, c.count_offset, sizeof(std::uint32_t));
  out.count_offset = c.count_offset;
}

/// As a draw of as many vertices as the counter says.
void fill(const CmdDrawByteCount& c, CapturedObjects&, Command& out) {
  std::uint32_t bytes = 0;
  if (!read_counter(c.counter, bytes) || c.stride == 0) return;
  out.draws.push_back({bytes > c.subtracted ? (bytes - c.subtracted) / c.stride : 0, 0, 0});
  out.instances = c.instance_count;
  out.first_instance = c.first_instance;
}

template <class T>
void fill_erased(const void* command, CapturedObjects& objects, Command& out) {
  if constexpr (requires(const T& typed) { fill(typed, objects, out); })
    fill(*static_cast<const T*>(command), objects, out);
}

constexpr void (*kFill[])(const void*, CapturedObjects&, Command&) = {
#define VITRINE_COMMAND(name) fill_erased<Cmd##name>,
#include "icd/record/commands.def"
};

bool is_dispatch(CommandType type) { return type == CommandType::kDispatch || type == CommandType::kDispatchIndirect; }

void add_feedback(const raster::TransformFeedback& feedback, CapturedObjects& objects, Bug& bug) {
  for (std::uint32_t i = 0; i < feedback.buffer.size(); ++i) {
    const raster::XfbBuffer& buffer = feedback.buffer[i];
    if (!buffer.data || buffer.offset >= buffer.size) continue;
    glass::bug::Stream out;
    out.binding = i;
    out.size = buffer.size - buffer.offset;
    const CapturedObjects::Place place = objects.bytes(buffer.data + buffer.offset, out.size);
    if (place.buffer == kNone) continue;
    out.buffer = place.buffer;
    out.offset = place.offset;
    bug.feedback.push_back(out);
  }
}

std::string add_graphics(ReplayState& state, const Pipeline& pipeline, CapturedObjects& objects, Bug& bug) {
  if (!state.pass) return "it is in no render pass";
  bug.state = *resolve_state(state);
  add_streams(state, pipeline, objects, bug);
  if (state.draw.feedback) add_feedback(*state.draw.feedback, objects, bug);
  if (bug.command.indexed) bug.command.indices = bound(state.indices, objects);
  bug.command.index_type = state.draw.index_type;
  return add_rendering(state, objects, bug);
}

}  // namespace

bool is_captured(CommandType type) {
  switch (type) {
    case CommandType::kDraw:
    case CommandType::kDrawIndexed:
    case CommandType::kDrawMulti:
    case CommandType::kDrawMultiIndexed:
    case CommandType::kDrawIndirect:
    case CommandType::kDrawByteCount:
    case CommandType::kDispatch:
    case CommandType::kDispatchIndirect:
      return true;
    default:
      return false;
  }
}

std::string describe_captured(ReplayState& state, const CommandHeader& header, CapturedObjects& objects, Bug& bug) {
  const auto type = static_cast<CommandType>(header.type);
  const BindPoint& point = is_dispatch(type) ? state.compute : state.graphics;
  if (!point.pipeline) return "no pipeline is bound";
  const Pipeline& pipeline = *point.pipeline;
  bug.pipeline = names_of(state.device.physical_device.instance, objects_of(pipeline));
  bug.null_descriptors = state.device.features.test(Feature::nullDescriptor);
  bug.robust_access2 = state.device.features.test(Feature::robustBufferAccess2);
  bool follows_addresses = false;
  if (std::string problem = add_stages(pipeline, bug, follows_addresses); !problem.empty()) return problem;
  if (follows_addresses) objects.add_addressed();
  add_push_constants(state, pipeline, bug);
  add_descriptors(point, objects, bug);
  kFill[header.type](header.command(), objects, bug.command);
  if (!is_dispatch(type))
    if (std::string problem = add_graphics(state, pipeline, objects, bug); !problem.empty()) return problem;
  return objects.problem();
}

}  // namespace vitrine::icd
