// Accesses to memory that the specification does not allow: outside of buffers, shared memory, push constants, local
// arrays and live memory.
#include <algorithm>
#include <string>

#include "glass/sanitize/accesses.h"
#include "glass/sanitize/checks.h"
#include "glass/sanitize/descriptors.h"
#include "glass/sanitize/image_lanes.h"

namespace vitrine::glass::sanitize {
namespace {

using spirv::Instruction;
using spirv::InstructionNote;
using spirv::MemorySpace;
using spirv::Wave;

const char* buffer_rule(Access access) {
  return access == Access::kLoad    ? "out-of-bounds-load"
         : access == Access::kStore ? "out-of-bounds-store"
                                    : "out-of-bounds-atomic";
}

/// Checks one access.
class MemoryCheck {
 public:
  explicit MemoryCheck(Reporter& reporter) : reporter_(reporter) {}

  void access(const Wave& wave, const Instruction* i, const InstructionNote& note) {
    const base::LaneMask lanes = wave.active & wave.live;
    if (lanes == 0) return;
    const MemoryOp& row = wave.program->memory_ops[i->extra[0]];
    const spirv::OperandPlace address{note.files[1], i->src[0]};
    switch (note.space) {
      case MemorySpace::kUniformBuffer:
      case MemorySpace::kStorageBuffer:
        return check_buffer(wave, i, note, row, address, lanes);
      case MemorySpace::kShared:
        if (reporter_.stage() != VK_SHADER_STAGE_COMPUTE_BIT) return;  // memory of the stage, not the shader's
        return check_range(wave, i, note, row, address, lanes, wave.shared_size, "out-of-bounds-shared",
                           [&] { return shared_text(wave); });
      case MemorySpace::kPush:
        return check_range(wave, i, note, row, address, lanes, push_bytes(wave), "out-of-bounds-push-constant",
                           [&] { return push_text(wave); });
      case MemorySpace::kArray:
        return check_array(wave, i, note, row, address, lanes);
      case MemorySpace::kGlobal:
        return check_global(wave, i, note, row, lanes);
    }
  }

 private:
  static std::uint32_t push_bytes(const Wave& wave) { return wave.program->observation->interface.push_bytes; }

  static std::string push_text(const Wave& wave) {
    return "the block of push constants (" + std::to_string(push_bytes(wave)) + " bytes)";
  }

  static std::string shared_text(const Wave& wave) {
    std::string text = "shared memory (";
    text += std::to_string(wave.shared_size);
    return text += " bytes)";
  }

  /// Lanes of `lanes` whose access lies outside of [0, size).
  static base::LaneMask outside(const Wave& wave, const MemoryOp& row, Extent extent, spirv::OperandPlace address,
                                base::LaneMask lanes, std::uint64_t size) {
    const auto is_outside = [&](std::uint32_t offset) {
      return std::uint64_t{offset + row.added + extent.first} + (extent.end - extent.first) > size;
    };
    if (address.file != 'r') return is_outside(spirv::exec::word_of(wave, address, 0)) ? lanes : 0;
    const auto& offsets = *reinterpret_cast<const base::WaveRegister*>(wave.registers + address.offset);
    std::uint32_t highest = 0;
    if (extent.end - extent.first <= size) {
      // An offset from where the extent begins, so that it wraps as the access does.
      const std::uint32_t added = row.added + extent.first;
      for (std::size_t lane = 0; lane < base::kWaveWidth; ++lane)
        highest = std::max(highest, (lanes >> lane & 1) != 0 ? offsets.lane[lane] + added : 0u);
      if (highest + std::uint64_t{extent.end - extent.first} <= size) return 0;
    }
    base::LaneMask result = 0;
    base::for_each_lane(lanes, [&](std::size_t lane) {
      if (is_outside(offsets.lane[lane])) result |= base::LaneMask{1} << lane;
    });
    return result;
  }

  template <class F>
  void check_range(const Wave& wave, const Instruction* i, const InstructionNote& note, const MemoryOp& row,
                   spirv::OperandPlace address, base::LaneMask lanes, std::uint64_t size, const char* rule, F&& what) {
    const Extent extent = extent_of(row, note.access);
    if (extent.end == 0) return;
    const base::LaneMask wrong = outside(wave, row, extent, address, lanes, size);
    if (wrong == 0) return;
    reporter_.report(wave, i, note, rule, wrong, [&](std::size_t lane) {
      const std::uint32_t offset = spirv::exec::word_of(wave, address, lane) + row.added + extent.first;
      std::string text = verb_of(note.access);
      text += bytes_text(extent.end - extent.first, offset);
      return text += ", outside of " + what();
    });
  }

  void check_buffer(const Wave& wave, const Instruction* i, const InstructionNote& note, const MemoryOp& row,
                    spirv::OperandPlace address, base::LaneMask lanes) {
    spirv::exec::for_each_buffer(
        const_cast<Wave&>(wave), row, lanes, [&](const spirv::exec::Bytes& bytes, base::LaneMask same) {
          const std::uint32_t element = element_of(wave, row.index, static_cast<std::size_t>(std::countr_zero(same)));
          if (bytes.data == nullptr)
            return report_descriptor(reporter_, wave, i, note, row.set, row.slot, element, row.count, same);
          check_range(wave, i, note, row, address, same, bytes.size, buffer_rule(note.access), [&] {
            return resource_text(wave, row.set, row.slot + element,
                                 "a buffer of " + std::to_string(bytes.size) + " bytes");
          });
        });
  }

  void check_array(const Wave& wave, const Instruction* i, const InstructionNote& note, const MemoryOp& row,
                   spirv::OperandPlace address, base::LaneMask lanes) {
    base::LaneMask wrong = 0;
    base::for_each_lane(lanes, [&](std::size_t lane) {
      if (spirv::exec::word_of(wave, address, lane) + row.added >= row.array_elements)
        wrong |= base::LaneMask{1} << lane;
    });
    if (wrong == 0) return;
    reporter_.report(wave, i, note, "out-of-bounds-array", wrong, [&](std::size_t lane) {
      std::string text = note.access == Access::kLoad ? "load of word " : "store of word ";
      text += std::to_string(static_cast<std::int32_t>(spirv::exec::word_of(wave, address, lane) + row.added));
      text += " of an array variable of ";
      text += std::to_string(row.array_elements);
      return text += " words";
    });
  }

  void check_global(const Wave& wave, const Instruction* i, const InstructionNote& note, const MemoryOp& row,
                    base::LaneMask lanes) {
    const Extent extent = extent_of(row, note.access);
    if (extent.end == 0) return;
    const auto address_of = [&](std::size_t lane) {
      const auto word = [&](std::size_t k) { return spirv::exec::word_of(wave, {note.files[k + 1], i->src[k]}, lane); };
      const auto distance = static_cast<std::int32_t>(word(2) + row.added + extent.first);
      return (std::uint64_t{word(1)} << 32 | word(0)) + static_cast<std::uint64_t>(std::int64_t{distance});
    };
    const spirv::ObservedCommand* command = wave.resources->command;
    spirv::AddressRange range;
    base::LaneMask wrong = 0, departed = 0;
    base::for_each_lane(lanes, [&](std::size_t lane) {
      const std::uint64_t address = address_of(lane), bytes = extent.end - extent.first;
      if (address - range.begin >= range.end - range.begin)
        range = command != nullptr ? command->buffers_at(address) : spirv::find_addresses(address);
      if (range.begin != range.end && range.end - address >= bytes) return;
      const bool gone = command != nullptr && range.begin == range.end && !command->departed(address).empty();
      (gone ? departed : wrong) |= base::LaneMask{1} << lane;
    });
    const auto access_text = [&](std::size_t lane) {
      char address[32];
      std::snprintf(address, sizeof address, "0x%llx", static_cast<unsigned long long>(address_of(lane)));
      return verb_of(note.access) + std::to_string(extent.end - extent.first) + " bytes at address " + address;
    };
    if (departed != 0)
      reporter_.report(wave, i, note, "freed-device-address", departed, [&](std::size_t lane) {
        return access_text(lane) + ", inside of " + command->departed(address_of(lane));
      });
    if (wrong != 0)
      reporter_.report(wave, i, note, "bad-device-address", wrong,
                       [&](std::size_t lane) { return access_text(lane) + ", which is not inside of a live buffer"; });
  }

  Reporter& reporter_;
};

}  // namespace

void check_memory(Reporter& reporter, const Wave& wave, const Instruction* i, const InstructionNote& note) {
  MemoryCheck(reporter).access(wave, i, note);
}

}  // namespace vitrine::glass::sanitize
