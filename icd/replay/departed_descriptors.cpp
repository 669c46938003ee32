// Descriptors whose resources are gone (Vulkan 1.3.239, Resource Descriptors: Descriptor Set Updates): observed
// commands see nulls in their place, so that nobody reads memory that was given back.
#include <algorithm>

#include "icd/object/address_book.h"
#include "icd/replay/observed_replay.h"

namespace vitrine::icd {
namespace {

// Sets with more slots are looked at once, until something goes.
constexpr std::uint32_t kLargeSet = 64;

/// Looks for descriptors of one draw or dispatch that name what is gone.
class Search {
 public:
  Search(ReplayState& state, const BindPoint& point) : state_(state), point_(point), book_(*state.device.addresses) {}

  /// What lies in a ResourceTable for set `number`.
  void look_at_slots(std::uint32_t number, spirv::ResourceTable& table) {
    const DescriptorSet& set = *point_.sets[number];
    auto& alive = state_.observed->alive;
    const std::uint64_t departures = book_.departures();
    if (set.slot_count > kLargeSet && alive[&set] == departures + 1) return;
    spirv::Descriptor* copy = nullptr;
    for_each_slot(set, false, [&](const SetBinding& binding, std::uint32_t slot) {
      const std::string text = departed(set.slots[slot], binding, set.written ? set.written[slot] : kNow);
      if (text.empty()) return;
      if (!copy) copy = copy_of(set.slots, set.slot_count);
      hide(copy[slot], text);
    });
    if (copy) table.set[number] = copy;
    if (!copy && set.slot_count > kLargeSet) alive[&set] = departures + 1;
  }

  void look_at_dynamic(std::uint32_t number, std::uint32_t first, spirv::Descriptor* dynamic, std::uint32_t count) {
    const DescriptorSet& set = *point_.sets[number];
    for_each_slot(set, true, [&](const SetBinding& binding, std::uint32_t slot) {
      if (first + slot >= count) return;
      spirv::Descriptor& descriptor = dynamic[first + slot];
      const std::string text = departed(descriptor, binding, set.written ? set.written[set.slot_count + slot] : kNow);
      if (!text.empty()) hide(descriptor, text);
    });
  }

  /// Descriptors in the arena, where others may have been before.
  void forget(const spirv::Descriptor* first, std::size_t count) {
    auto& known = state_.observed->departed;
    known.erase(known.lower_bound(first), known.lower_bound(first + count));
  }

 private:
  static constexpr std::uint64_t kNow = ~std::uint64_t{0};

  template <class F>
  static void for_each_slot(const DescriptorSet& set, bool dynamic, F&& f) {
    for (const SetBinding& binding : set.shape->bindings) {
      if (is_inline_block(binding.type) || is_dynamic(binding.type) != dynamic) continue;
      for (std::uint32_t i = 0; i < set.count_of(binding); ++i) f(binding, binding.first_slot + i);
    }
  }

  std::string departed(const void* first, std::uint64_t bytes, std::uint64_t time) const {
    if (!first || bytes == 0 || book_.is_alive(first, bytes, time)) return {};
    const std::string text = book_.departed(first, bytes, time);
    return text.empty() ? "a resource that was destroyed" : text;
  }
  std::string departed(const spirv::Descriptor& descriptor, const SetBinding& binding, std::uint64_t time) const {
    std::string text = departed(descriptor.data, descriptor.size, time);
    if (text.empty()) text = departed(descriptor.texels, sizeof *descriptor.texels, time);
    if (text.empty()) text = departed(descriptor.image, sizeof *descriptor.image, time);
    if (text.empty() && !binding.immutable_samplers)
      text = departed(descriptor.sampler, sizeof *descriptor.sampler, time);
    return text;
  }

  spirv::Descriptor* copy_of(const spirv::Descriptor* slots, std::uint32_t count) {
    auto* copy = state_.arena.take<spirv::Descriptor>(count);
    std::uninitialized_copy_n(slots, count, copy);
    forget(copy, count);
    return copy;
  }
  void hide(spirv::Descriptor& descriptor, const std::string& text) {
    descriptor = {};
    state_.observed->departed[&descriptor] = text;
  }

  ReplayState& state_;
  const BindPoint& point_;
  const AddressBook& book_;
};

}  // namespace

void hide_departed(ReplayState& state, const BindPoint& point, spirv::ResourceTable& table) {
  if (!state.device.addresses) return;
  const PipelineLayoutShape& layout = *point.pipeline->layout;
  Search search(state, point);
  const std::uint32_t dynamic_count = table.set_size[spirv::kDynamicSet];
  auto* dynamic = const_cast<spirv::Descriptor*>(table.set[spirv::kDynamicSet]);  // fill_resources()'s own copy
  search.forget(dynamic, dynamic_count);
  if (state.device.addresses->departures() == 0) return;
  for (std::uint32_t i = 0; i < layout.sets.size() && i < spirv::kMaxSets; ++i) {
    if (!point.sets[i]) continue;
    search.look_at_slots(i, table);
    search.look_at_dynamic(i, layout.first_dynamic[i], dynamic, dynamic_count);
  }
}

}  // namespace vitrine::icd
