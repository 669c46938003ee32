// The translator functions named by opcodes.def, and helpers they share. Internal to front/.
#pragma once

#include "spirv/front/context.h"

namespace vitrine::spirv::front {

#define VITRINE_OPCODE(name, function, op, effect) void function(Translator& t, const Inst& inst, ir::Op op_column);
#define VITRINE_NUMBERED_OPCODE(name, number, function, op, effect) VITRINE_OPCODE(name, function, op, effect)
#include "spirv/opcodes.def"
#undef VITRINE_OPCODE
#undef VITRINE_NUMBERED_OPCODE

/// A probe where a block begins (spirv/probe.h).
void probe_block(Translator& t, const Block& block);
/// Counts the instructions of a block: Probe::costs, Probe::instructions (costs.cpp).
void count_costs(const Module& module, const Block& block, Probe& probe);
/// What observers want to know before an instruction, and of its operands and its result when it has been translated
/// (checks.cpp).
void probe_before(Translator& t, const Inst& inst);
void probe_after(Translator& t, const Inst& inst);
/// What observers want to know before an access to memory or an image (access_checks.cpp).
void probe_access(Translator& t, const Inst& inst);
/// What orders accesses is told where it is (memory_order.cpp).
void probe_order(Translator& t, const Inst& inst);
/// Appends the words of a number, boolean or vector to `words` and says what they are.
ProbeValue probe_value(Translator& t, const Inst& inst, std::uint32_t id, std::vector<ir::Src>& words);
/// Appends a probe that reads `words`.
void emit_probe(Translator& t, Probe probe, std::vector<ir::Src> words);
/// NonSemantic.DebugPrintf: a probe with its arguments, if somebody listens.
void debug_printf(Translator& t, const Inst& inst);

/// Follows one step of an access chain.
void step_into(Translator& t, const Inst& inst, Pointer& pointer, const Step& step);
/// The descriptors of a resource variable. Fails if the pipeline layout has none of its kind there.
Binding find_binding(const Translator& t, const Inst& variable);
/// Whether a variable in storage class Uniform or StorageBuffer is a storage buffer.
bool is_storage_buffer(const Translator& t, const Inst& variable);
/// Bytes from one component of the vector or scalar in memory to the next.
std::uint32_t component_bytes(const Translator& t, const Pointer& pointer);
/// Type of the vector whose component a local pointer points to.
std::uint32_t vector_type_of(const Translator& t, const Pointer& pointer);
/// Value of a built-in of subgroups (their sizes, numbers and masks).
ir::ValueId subgroup_built_in(Translator& t, spv::BuiltIn built_in);
/// An input of fixed function, loaded before the body.
ir::ValueId built_in_input(Translator& t, BuiltIn built_in, std::uint8_t component = 0);

/// Integer framebuffer coordinates (x, y) and the view index of a fragment, loaded before the body.
ir::ValueId fragment_position(Translator& t);

/// Descriptors and dimensions of an image: everything but what is done with it.
ir::ImageInfo image_info(Translator& t, const ImageHandle& handle);

/// Fails where the image or the operands are not what the instruction works on. `components`: of the result.
void check_image(const Inst& inst, const ir::ImageInfo& info, std::uint32_t components);

/// Collects the sources of an image instruction in the order of ir::ImageOperand.
class ImageSources {
 public:
  explicit ImageSources(ir::ImageInfo& info) : info_(info) {}
  /// kNoValue: absent.
  void add(ir::ImageOperand operand, ir::ValueId value);
  void add(ir::ImageOperand operand, ir::Src src);
  std::vector<ir::Src> take();

 private:
  ir::ImageInfo& info_;
  std::array<ir::Src, static_cast<std::size_t>(ir::ImageOperand::kCount)> src_{};
};

/// Chooses the array elements of image and sampler: constants move into `info`, others become sources.
void add_elements(Translator& t, const ImageHandle& handle, ir::ImageInfo& info, ImageSources& sources);

}  // namespace vitrine::spirv::front
