// Keeping track of the application's commands for observers.
#include "icd/replay/observed_replay.h"

#include <algorithm>
#include <atomic>

#include "glass/bug/capture.h"
#include "glass/session.h"
#include "icd/object/address_book.h"
#include "icd/object/memory.h"
#include "icd/record/command_buffer.h"

namespace vitrine::icd {
namespace {

/// A binding of a pipeline layout and an element of it.
struct LayoutPlace {
  std::uint32_t set = 0;
  const SetBinding* binding = nullptr;  ///< null: the layout has no such slot
  std::uint32_t element = 0;
};

std::uint32_t slots_of(const SetBinding& binding) { return is_inline_block(binding.type) ? 1 : binding.count; }

LayoutPlace find_in_set(const SetShape& shape, std::uint32_t set, std::uint32_t slot, bool dynamic) {
  for (const SetBinding& b : shape.bindings) {
    const bool here = is_dynamic(b.type) == dynamic && slot >= b.first_slot && slot - b.first_slot < slots_of(b);
    if (here) return {set, &b, slot - b.first_slot};
  }
  return {};
}

/// What lies at a slot of a ResourceTable: dynamic buffers of all sets are a set of their own there.
LayoutPlace find_slot(const PipelineLayoutShape& layout, std::uint32_t set, std::uint32_t slot) {
  if (set != spirv::kDynamicSet) {
    if (set >= layout.sets.size() || !layout.sets[set]) return {};
    return find_in_set(*layout.sets[set], set, slot, false);
  }
  for (std::uint32_t s = 0; s < layout.sets.size(); ++s) {
    if (!layout.sets[s] || slot < layout.first_dynamic[s]) continue;
    const LayoutPlace found = find_in_set(*layout.sets[s], s, slot - layout.first_dynamic[s], true);
    if (found.binding) return found;
  }
  return {};
}

bool same_ranges(std::span<const VkPushConstantRange> a, std::span<const VkPushConstantRange> b) {
  return std::ranges::equal(a, b, [](const VkPushConstantRange& x, const VkPushConstantRange& y) {
    return x.offset == y.offset && x.size == y.size && x.stageFlags == y.stageFlags;
  });
}

/// Words that have been set with a layout "compatible for push constants": one with the same ranges (Vulkan 1.3.239,
/// Pipeline Layout Compatibility).
std::uint64_t pushed_words(const ObservedReplay& observed, const PipelineLayoutShape& layout) {
  std::uint64_t words = 0;
  for (std::size_t i = 0; i < observed.pushed.size(); ++i)
    words |= std::uint64_t{!observed.pushed[i].empty() && same_ranges(observed.pushed[i], layout.push_ranges)} << i;
  return words;
}

ObservedReplay* observed_of(const Device& device) { return device.replay ? device.replay->observed.get() : nullptr; }

}  // namespace

ReplayedCommand::ReplayedCommand(const Device& device, const Pipeline& bound, const spirv::ResourceTable& resources)
    : device_(device), layout_(bound.layout), resources_(resources) {}

const spirv::Descriptor* ReplayedCommand::find(std::uint32_t set, std::uint32_t slot) const {
  return resources_.set[set] && slot < resources_.set_size[set] ? &resources_.set[set][slot] : nullptr;
}

std::string ReplayedCommand::resource(std::uint32_t set, std::uint32_t slot) const {
  const LayoutPlace place = find_slot(*layout_, set, slot);
  if (!place.binding) return {};
  return describe_descriptor(device_, place.set, *place.binding, place.element, find(set, slot), departed(set, slot));
}

std::string ReplayedCommand::departed(std::uint32_t set, std::uint32_t slot) const {
  const auto& departed = observed_of(device_)->departed;
  const auto at = departed.find(find(set, slot));
  return at == departed.end() ? std::string() : at->second;
}

std::string ReplayedCommand::departed(std::uint64_t address) const {
  return device_.addresses ? device_.addresses->departed(reinterpret_cast<const void*>(address), 1) : std::string();
}

spirv::AddressRange ReplayedCommand::buffers_at(std::uint64_t address) const {
  if (!device_.addresses) return spirv::find_addresses(address);
  std::call_once(looked_up_, [&] { buffers_ = device_.addresses->buffers(); });
  const auto after =
      std::upper_bound(buffers_.begin(), buffers_.end(), address,
                       [](std::uint64_t wanted, const spirv::AddressRange& range) { return wanted < range.begin; });
  if (after == buffers_.begin() || address >= std::prev(after)->end) return {};
  return *std::prev(after);
}

std::string ReplayedCommand::bytes(const std::byte* first, std::uint64_t size) const {
  return describe_bytes(device_, first, size);
}

std::uint64_t ReplayedCommand::push_range(VkShaderStageFlagBits stage) const {
  std::uint64_t words = 0;
  for (const VkPushConstantRange& range : layout_->push_ranges)
    for (std::uint32_t i = range.offset / 4; i < std::min((range.offset + range.size) / 4, 64u); ++i)
      words |= std::uint64_t{(range.stageFlags & stage) != 0} << i;
  return words;
}

std::vector<std::string> open_labels(const ObservedReplay& observed) {
  std::vector<std::string> labels = observed.queue_labels;
  labels.insert(labels.end(), observed.labels.open().begin(), observed.labels.open().end());
  return labels;
}

glass::Address address_of(const ObservedReplay& observed) {
  glass::Address address;
  address.submission = observed.submission;
  address.command = observed.command;
  address.command_name = observed.name;
  address.labels = open_labels(observed);
  return address;
}

const spirv::ObservedCommand* observe_command(ReplayState& state, const Pipeline& pipeline,
                                              const spirv::ResourceTable& resources) {
  ObservedReplay& observed = *state.observed;
  // The draws of an indirect command, say, share what is bound.
  if (!observed.commands.empty() && observed.commands.back()->command == observed.command)
    return observed.commands.back().get();
  auto made = std::make_unique<ReplayedCommand>(state.device, pipeline, resources);
  made->owner = &state.device;
  made->submission = observed.submission;
  made->command = observed.command;
  made->name = observed.name;
  made->labels = open_labels(observed);
  made->null_descriptors = state.device.features.test(Feature::nullDescriptor);
  made->robust_vertices = state.device.features.test(Feature::robustBufferAccess2);
  made->pushed = pushed_words(observed, *pipeline.layout);
  made->pipeline = names_of(state.device.physical_device.instance, objects_of(pipeline));
  made->pipeline_number = pipeline.number;
  made->pass = state.pass ? observed.pass_number : 0;
  observed.commands.push_back(std::move(made));
  observed.objects.push_back({observed.command, observed.command_buffer, objects_of(pipeline)});
  return observed.commands.back().get();
}

void report_arguments(ReplayState& state, const BindPoint& bind_point, const Buffer& buffer, std::uint64_t offset,
                      std::uint64_t size, const char* what) {
  if (!bind_point.pipeline || state.suppressed) return;
  const spirv::ObservedCommand* command = observe_command(state, *bind_point.pipeline, {});
  std::string text = what;
  text.append(": ").append(std::to_string(size)).append(" bytes at offset ").append(std::to_string(offset));
  text.append(buffer.data ? ", outside of buffer " : ", of a buffer without memory ");
  glass::session().broken(*command, "out-of-bounds-arguments",
                          text + describe_bytes(state.device, buffer.data, buffer.size));
}

void note_push_constants(ReplayState& state, const CmdPushConstants& command) {
  auto& pushed = state.observed->pushed;
  const auto end = std::min((command.offset + command.bytes.size()) / 4, pushed.size());
  for (std::size_t i = command.offset / 4; i < end; ++i) pushed[i] = command.ranges;
}

void forget_push_constants(ReplayState& state) {
  if (state.observed) state.observed->pushed.fill({});
}

void begin_observed_submission(Device& device, std::vector<std::string> queue_labels, std::uint64_t host) {
  ObservedReplay* observed = observed_of(device);
  if (!observed) return;
  ++observed->submission;
  observed->command = 0;
  observed->name = "";
  observed->queue_labels = std::move(queue_labels);
  observed->objects.clear();
  observed->departed.clear();
  if (device.addresses) device.addresses->begin_submission();
  if (observed->pixels) observed->pixels->submission_begins(observed->submission);
  if (observed->hazards) observed->hazards->begin_submission(observed->submission, host);
}

void end_observed_submission(Device& device) noexcept {
  ObservedReplay* observed = observed_of(device);
  if (!observed) return;
  try {
    glass::session().commands_done(&device);
    observed->commands.clear();
    if (observed->hazards) observed->hazards->end_submission();
    if (observed->pixels) observed->pixels->submission_ends();
    glass::bug::Captures* const captures = glass::bug::captures();
    glass::session().end_submission([&](const glass::Finding& f) {
      send_finding(device, *observed, f);
      if (captures) captures->found(&device, f);
    });
    if (captures) captures->end_submission(&device);
    observed->snapshots.clear();
  } catch (...) {
    report_error(device, ref(device), "tools", "out of host memory while findings were delivered");
  }
}

void begin_observed_pass(ReplayState& state) {
  static std::atomic<std::uint64_t> begun{0};
  if (state.observed) state.observed->pass_number = ++begun;
}

void execute(ReplayState& state, const CmdMark& command) {
  if (!state.observed) return;
  ++state.observed->command;
  state.observed->name = command.name;
}

void execute(ReplayState&, const CmdDependency&) {}

void execute(ReplayState& state, const CmdBeginLabel& command) {
  if (state.observed) state.observed->labels.begin({command.name.data(), command.name.size()});
}

void execute(ReplayState& state, const CmdEndLabel&) {
  if (state.observed) state.observed->labels.end();
}

void execute(ReplayState& state, const CmdInsertLabel& command) {
  if (state.observed) state.observed->labels.insert({command.name.data(), command.name.size()});
}

}  // namespace vitrine::icd
