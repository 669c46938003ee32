// What memory holds after each command, and what the first byte is that differs from another run.
#include "icd/replay/digested_replay.h"

#include "glass/digest.h"
#include "icd/object/address_book.h"
#include "icd/record/command_buffer.h"
#include "icd/replay/observed_replay.h"
#include "icd/replay/timed_replay.h"

namespace vitrine::icd {
namespace {

glass::Address here(const ReplayState& state) {
  const ObservedReplay& observed = *state.observed;
  glass::Address point = address_of(observed);
  if (!observed.objects.empty() && observed.objects.back().command == observed.command)
    point.pipeline = names_of(state.device.physical_device.instance, observed.objects.back().shaders);
  return point;
}

std::string describe(const Device& device, const glass::Difference& difference) {
  const ObjectRef object = device.addresses ? device.addresses->find(difference.at, 1) : ObjectRef{};
  if (object.handle == 0) return "memory at offset " + std::to_string(difference.offset) + " of its allocation";
  if (object.type == VK_OBJECT_TYPE_BUFFER) return "buffer " + describe_bytes(device, difference.at, 4);
  const std::string name = name_of(device.physical_device.instance, object);
  return name.empty() ? "an image" : "image '" + name + "'";
}

void digest(ReplayState& state) {
  const glass::Address point = here(state);
  if (const auto difference = glass::digest_command(point))
    glass::report_difference(point, *difference, describe(state.device, *difference));
}

}  // namespace

void replay_digested(ReplayState& state, const CommandBuffer& buffer, void (*run)(ReplayState&, const CommandHeader&)) {
  for (const CommandHeader* header = buffer.arena.first(); header; header = header->next) {
    run(state, *header);
    if (is_for_observers(static_cast<CommandType>(header->type)) || !is_work(state.observed->name)) continue;
    if (state.pass) flush_pass(state);
    digest(state);
    if (state.fault.raised.load(std::memory_order_relaxed)) return;
  }
}

void digest_submission(ReplayState& state) noexcept {
  try {
    digest(state);
  } catch (const std::bad_alloc&) {
    // Left out.
  }
}

}  // namespace vitrine::icd
