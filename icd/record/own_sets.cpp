// See own_sets.h.
#include "icd/record/own_sets.h"

namespace vitrine::icd {

DescriptorSet& add_own_set(CommandBuffer& buffer, const PipelineLayoutShape& layout, std::uint32_t number) {
  const std::shared_ptr<const SetShape>& shape = layout.sets[number];
  buffer.own_sets.reserve(buffer.own_sets.size() + 1);
  void* storage = buffer.arena.add_data(set_bytes(*shape, 0));
  DescriptorSet* set = construct_set(storage, buffer.memory, shape, 0);
  buffer.own_sets.push_back(set);
  return *set;
}

void bind_own_set(CommandBuffer& buffer, VkPipelineBindPoint bind_point, const PipelineLayoutShape& layout,
                  std::uint32_t number, DescriptorSet& set) {
  const auto sets = buffer.arena.add_array<DescriptorSet*>(1);
  sets[0] = &set;
  record(buffer, CmdBindDescriptorSets{
                     bind_point, number, sets, buffer.arena.copy_array(&layout.first_dynamic[number], 1), {}});
}

}  // namespace vitrine::icd
