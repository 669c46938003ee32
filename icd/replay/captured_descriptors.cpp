// See captured_descriptors.h.
#include "icd/replay/captured_descriptors.h"

#include <algorithm>
#include <bit>

#include "glass/bug/declared.h"
#include "icd/object/address_book.h"

namespace vitrine::icd {
namespace {

using glass::bug::Bug;
using glass::bug::kNone;

/// Where elements of a binding are found.
struct Slots {
  const DescriptorSet* set = nullptr;  ///< null: nothing is bound
  const spirv::Descriptor* first = nullptr;
  std::uint32_t count = 0;
  const std::uint64_t* written = nullptr;  ///< when (AddressBook::clock()); null: nobody knows
};

Slots slots_of(const BindPoint& point, std::uint32_t number, const SetBinding& binding) {
  const DescriptorSet* set = point.sets[number];
  if (!set) return {};
  if (!is_dynamic(binding.type)) {
    if (binding.first_slot >= set->slot_count) return {};
    return {set, set->slots + binding.first_slot, std::min(binding.count, set->slot_count - binding.first_slot),
            set->written ? set->written + binding.first_slot : nullptr};
  }
  const std::uint32_t first = point.pipeline->layout->first_dynamic[number] + binding.first_slot;
  if (first >= point.dynamic.size()) return {};
  return {set, point.dynamic.data() + first,
          std::min<std::uint32_t>(binding.count, static_cast<std::uint32_t>(point.dynamic.size()) - first),
          set->written ? set->written + set->slot_count + binding.first_slot : nullptr};
}

/// Whether one of the resources of a descriptor that was written at `time` is gone (as in departed_descriptors.cpp).
bool is_gone(const spirv::Descriptor& bound, const SetBinding& binding, std::uint64_t time, const Device& device) {
  const auto gone = [&](const void* first, std::uint64_t bytes) {
    return first && bytes != 0 && !device.addresses->is_alive(first, bytes, time);
  };
  return device.addresses && (gone(bound.data, bound.size) || gone(bound.texels, sizeof *bound.texels) ||
                              gone(bound.image, sizeof *bound.image) ||
                              (!binding.immutable_samplers && gone(bound.sampler, sizeof *bound.sampler)));
}

/// Says why nothing is bound.
void note(const glass::bug::Descriptor& at, const char* what, Bug& bug) {
  bug.notes.push_back("set " + std::to_string(at.set) + ", binding " + std::to_string(at.binding) + ", element " +
                      std::to_string(at.element) + ": " + what);
}

constexpr std::uint32_t bit(VkDescriptorType type) { return 1u << type; }

/// All that a mutable descriptor may be if its layout does not say (VK_EXT_mutable_descriptor_type).
constexpr std::uint32_t kTakenOn =
    (bit(VK_DESCRIPTOR_TYPE_INPUT_ATTACHMENT) << 1) - 1 -
    (bit(VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC) | bit(VK_DESCRIPTOR_TYPE_STORAGE_BUFFER_DYNAMIC));

std::uint32_t listed(const SetBinding& binding) {
  return binding.types & kTakenOn ? binding.types & kTakenOn : kTakenOn;
}

/// The types that what a slot holds may have; of nothing any.
std::uint32_t fitting(const spirv::Descriptor& bound) {
  if (bound.data) return bit(VK_DESCRIPTOR_TYPE_STORAGE_BUFFER) | bit(VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER);
  if (bound.texels) return bit(VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER) | bit(VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER);
  if (bound.image && bound.sampler) return bit(VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER);
  if (bound.sampler) return bit(VK_DESCRIPTOR_TYPE_SAMPLER);
  return bound.image ? bit(VK_DESCRIPTOR_TYPE_STORAGE_IMAGE) | bit(VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE) |
                           bit(VK_DESCRIPTOR_TYPE_INPUT_ATTACHMENT)
                     : ~0u;
}

/// The type that a mutable descriptor has taken on. Slots do not know which of two that look alike it is; shaders take
/// it for one of those that they declare.
VkDescriptorType type_of(std::uint32_t fitting, const SetBinding& binding, std::uint32_t declared) {
  std::uint32_t types = fitting;
  for (const std::uint32_t among : {listed(binding), declared})
    if (types & among) types &= among;
  return static_cast<VkDescriptorType>(std::countr_zero(types));
}

/// What a descriptor of this type points to, if it is of that type: applications may have written another.
void add_resource(const spirv::Descriptor& bound, VkDescriptorType type, const SetBinding& binding,
                  CapturedObjects& objects, glass::bug::Descriptor& at) {
  using glass::bug::ResourceKind;
  const ResourceKind kind = glass::bug::kind_of(type);
  if (kind == ResourceKind::kBuffer && bound.data) {
    const CapturedObjects::Place place = objects.bytes(bound.data, bound.size);
    at.buffer = place.buffer;
    at.offset = place.offset;
    at.range = bound.size;
  }
  if (kind == ResourceKind::kImage && bound.image) at.view = objects.view(*bound.image);
  if (kind == ResourceKind::kTexels && bound.texels) at.texels = objects.texels(*bound.texels);
  const bool samples = type == VK_DESCRIPTOR_TYPE_SAMPLER || type == VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
  if (samples && bound.sampler && !binding.immutable_samplers) at.sampler = objects.sampler(*bound.sampler);
}

void add_element(const spirv::Descriptor& bound, const SetBinding& binding, glass::bug::Descriptor at,
                 CapturedObjects& objects, Bug& bug) {
  const bool there = bound.data || bound.image || bound.texels;
  const VkDescriptorType type = is_mutable(binding.type) ? at.type : binding.type;
  add_resource(bound, type, binding, objects, at);
  const bool incomplete =
      type == VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER && at.sampler == kNone && !binding.immutable_samplers;
  if (glass::bug::is_complete(at, type) && !incomplete) return bug.descriptors.push_back(std::move(at));
  if (there) note(at, "what is bound is of another type; nothing is bound here", bug);
}

glass::bug::Descriptor at(std::uint32_t set, const SetBinding& binding, std::uint32_t element) {
  glass::bug::Descriptor out;
  out.set = set;
  out.binding = binding.binding;
  out.element = element;
  return out;
}

/// `declared`: the types that shaders declare there, as glass::bug::Declared has them.
void add_elements(const BindPoint& point, std::uint32_t set, const SetBinding& binding, std::uint32_t declared,
                  CapturedObjects& objects, Bug& bug) {
  const Slots slots = slots_of(point, set, binding);
  if (is_inline_block(binding.type)) {
    if (!slots.first || !slots.first->data) return;
    glass::bug::Descriptor block = at(set, binding, 0);
    block.bytes = std::make_shared<glass::bug::Bytes>(slots.first->data, slots.first->data + slots.first->size);
    bug.descriptors.push_back(std::move(block));
    return;
  }
  for (std::uint32_t i = 0; i < slots.count; ++i) {
    const std::uint64_t time = slots.written ? slots.written[i] : ~std::uint64_t{0};
    glass::bug::Descriptor element = at(set, binding, i);
    if (is_mutable(binding.type)) element.type = type_of(fitting(slots.first[i]), binding, declared);
    element.gone = is_gone(slots.first[i], binding, time, objects.device());
    if (element.gone)
      bug.descriptors.push_back(std::move(element));
    else
      add_element(slots.first[i], binding, std::move(element), objects, bug);
  }
}

glass::bug::Binding layout_of(const BindPoint& point, std::uint32_t set, const SetBinding& binding,
                              CapturedObjects& objects) {
  glass::bug::Binding out{binding.binding, binding.type, binding.stages, binding.count, 0, {}, {}};
  const bool variable = binding.flags & VK_DESCRIPTOR_BINDING_VARIABLE_DESCRIPTOR_COUNT_BIT;
  if (variable && point.sets[set]) out.count = std::min(out.count, point.sets[set]->variable_count);
  out.flags = binding.flags & VK_DESCRIPTOR_BINDING_PARTIALLY_BOUND_BIT;
  for (std::uint32_t i = 0; binding.immutable_samplers && i < binding.count; ++i)
    out.samplers.push_back(objects.sampler(*binding.immutable_samplers[i]));
  for (std::uint32_t i = 0; is_mutable(binding.type) && i <= VK_DESCRIPTOR_TYPE_INPUT_ATTACHMENT; ++i)
    if (listed(binding) >> i & 1) out.types.push_back(static_cast<VkDescriptorType>(i));
  return out;
}

bool has_mutable(const PipelineLayoutShape& layout) {
  return std::ranges::any_of(layout.sets, [](const std::shared_ptr<const SetShape>& set) {
    return set && std::ranges::any_of(set->bindings, is_mutable, &SetBinding::type);
  });
}

}  // namespace

void add_descriptors(const BindPoint& point, CapturedObjects& objects, Bug& bug) {
  const PipelineLayoutShape& layout = *point.pipeline->layout;
  glass::bug::Declared declared;
  if (has_mutable(layout)) declared = glass::bug::declared_in(bug);
  for (std::uint32_t set = 0; set < layout.sets.size() && set < spirv::kMaxSets; ++set) {
    glass::bug::SetLayout out;
    out.used = layout.sets[set] != nullptr;
    if (out.used) {
      for (const SetBinding& binding : layout.sets[set]->bindings) {
        out.bindings.push_back(layout_of(point, set, binding, objects));
        const auto types = declared.find({set, binding.binding});
        add_elements(point, set, binding, types == declared.end() ? 0 : types->second, objects, bug);
      }
    }
    bug.sets.push_back(std::move(out));
  }
}

}  // namespace vitrine::icd
