// The handlers that are not arithmetic: control flow, moves under a mask, memory, images, environment. The lowering
// chooses among them; Instruction fields are described here. "Target" is extra[0]: a distance in instructions.
#pragma once

#include "spirv/program.h"

namespace vitrine::spirv::exec {

// ---- control flow: masks (spirv/exec/control.cpp)

const Instruction* end_program(Wave&, const Instruction*);
/// To the target.
const Instruction* jump(Wave&, const Instruction*);
/// To the target if the uniform word src[0] is 0 / is not 0.
const Instruction* jump_unless(Wave&, const Instruction*);
const Instruction* jump_if(Wave&, const Instruction*);
/// To the target if the integer comparison `test` of the words src[0] and src[1] gives `holds`.
Handler jump_compare(ir::Op test, bool holds);
/// To the target if no lane is active.
const Instruction* skip_if_empty(Wave&, const Instruction*);
/// Mask dst = active & ~src[0]; active &= src[0]; to the target if none is left.
const Instruction* if_mask(Wave&, const Instruction*);
/// Swaps active and mask dst; to the target if no lane is active then.
const Instruction* else_mask(Wave&, const Instruction*);
/// active |= mask src[0].
const Instruction* endif_mask(Wave&, const Instruction*);
/// Mask dst = 0.
const Instruction* clear_mask(Wave&, const Instruction*);
/// Lanes of mask src[0] move from active to mask dst; to the target if no lane is active then.
const Instruction* leave_if(Wave&, const Instruction*);
/// All active lanes move to mask dst; to the target.
const Instruction* leave_all(Wave&, const Instruction*);
/// A leave_if around moves: mask dst = lanes that stay, active = those that leave; to the target (behind leave_end) if
/// none leaves.
const Instruction* leave_begin(Wave&, const Instruction*);
/// Mask dst |= active; active = mask src[0]; to the target if no lane is active then.
const Instruction* leave_end(Wave&, const Instruction*);
/// active |= mask dst, which becomes 0; to the target if no lane is active.
const Instruction* rejoin(Wave&, const Instruction*);
/// To the target (top of the loop) if a lane is active, else active = mask src[0] and on. A turn takes extra[1] from
/// the budget; when it is spent: fault.
const Instruction* loop_back_mask(Wave&, const Instruction*);
/// To the target. A turn takes extra[1] from the budget; when it is spent: fault.
const Instruction* loop_back(Wave&, const Instruction*);
/// Lanes of mask src[0] end; to the target if no lane is active then.
const Instruction* return_if(Wave&, const Instruction*);
/// All active lanes end; to the target.
const Instruction* return_all(Wave&, const Instruction*);
/// Active lanes (of mask src[0]) become helpers. Ends the wave when nothing but helpers is left.
const Instruction* demote_all(Wave&, const Instruction*);
const Instruction* demote_if(Wave&, const Instruction*);
/// Suspends the wave until all waves of the workgroup are here.
const Instruction* barrier(Wave&, const Instruction*);

// ---- moves of masks and words (spirv/exec/control.cpp), of registers (spirv/exec/moves.cpp)

/// Mask dst = mask src[0] / uniform word src[0] ? all : none. The masked forms keep inactive lanes.
const Instruction* move_mask(Wave&, const Instruction*);
const Instruction* move_mask_active(Wave&, const Instruction*);
const Instruction* broadcast_mask(Wave&, const Instruction*);
const Instruction* broadcast_mask_active(Wave&, const Instruction*);
/// Register dst = register src[0] / uniform word src[0], in active lanes.
Handler move_active();
Handler broadcast_active();

// ---- probes (spirv/exec/observe.cpp)

/// Tells the wave's watch of row extra[0] of Program::probe_ops.
const Instruction* probe(Wave&, const Instruction*);
/// The same of a block, for who counts (Watch::cells()). The only condition, if there is one, is src[0].
Handler block_probe(const ProbeOp& op);

// ---- environment (spirv/exec/environment.cpp)

/// Mask dst = helper or demoted lanes / lowest active lane.
const Instruction* helper_invocation(Wave&, const Instruction*);
const Instruction* elect(Wave&, const Instruction*);
/// Uniform word dst = register (mask) src[0] of the lowest active lane.
const Instruction* read_first(Wave&, const Instruction*);
const Instruction* read_first_mask(Wave&, const Instruction*);
/// Uniform word dst = component extra[0] of the time in nanoseconds.
const Instruction* read_clock(Wave&, const Instruction*);
/// Uniform word dst = component extra[0].
const Instruction* workgroup_id(Wave&, const Instruction*);
const Instruction* num_workgroups(Wave&, const Instruction*);
const Instruction* subgroup_id(Wave&, const Instruction*);
/// Register dst = per lane: component extra[0] of LocalInvocationId, LocalInvocationIndex, lane.
const Instruction* local_invocation_id(Wave&, const Instruction*);
const Instruction* local_invocation_index(Wave&, const Instruction*);
const Instruction* subgroup_invocation(Wave&, const Instruction*);

// ---- subgroups: extra[0] = invocations of a subgroup or cluster (spirv/exec/subgroups.cpp)

/// Word extra[1] of the participating lanes of the subgroup that are in mask src[0]: register dst, uniform word dst.
const Instruction* ballot(Wave&, const Instruction*);
const Instruction* ballot_uniform(Wave&, const Instruction*);
/// Register dst = register src[0] of the lane of the subgroup that register src[1] names.
const Instruction* shuffle(Wave&, const Instruction*);
/// Register dst (`uniform`: word dst) = register src[0] over the participating lanes.
Handler reduce(ir::GroupOp op, ir::GroupMode mode, bool uniform);
/// The same on pairs of words: registers dst (low) and extra[1] (high), either may be kNoOperand; src[0], src[1].
Handler reduce_wide(ir::GroupOp op, ir::GroupMode mode);

// ---- memory: extra[0] = row of Program::memory_ops, src[0] = byte offset (spirv/exec/memory*.cpp)

/// Uniform words data[] = words at the uniform offset.
const Instruction* load_buffer_uniform(Wave&, const Instruction*);
const Instruction* load_push_uniform(Wave&, const Instruction*);
const Instruction* load_shared_uniform(Wave&, const Instruction*);
/// Uniform word dst.
const Instruction* array_length_uniform(Wave&, const Instruction*);
const Instruction* array_length(Wave&, const Instruction*);
/// Registers data[] = words at per-lane offsets (`uniform`: src[0] is a uniform word).
Handler load_buffer(bool uniform);
Handler load_push();
Handler load_shared();
Handler store_buffer(bool uniform);
Handler store_shared(bool uniform);
/// The same for components of one or two bytes (spirv/exec/memory_narrow.cpp). kGlobal: behind a pointer, see below.
enum class Space : std::uint8_t { kBuffer, kPush, kShared, kGlobal };
Handler load_narrow(Space space, bool uniform);
Handler load_narrow_uniform(Space space);
Handler store_narrow(Space space, bool uniform);
/// Register dst: the old values; kNoOperand: not wanted.
Handler atomic_buffer(bool uniform);
Handler atomic_shared(bool uniform);
/// Atomics of 64 bits (spirv/exec/atomics_wide.cpp): operand in data[0], [1], comparator in data[2], [3]; the old
/// values go to registers dst and extra[1].
Handler atomic_wide(Space space, bool uniform);
/// The same behind a pointer: registers src[0], src[1] = low and high words of addresses, src[2] = signed byte offsets.
Handler load_global();
Handler store_global();
const Instruction* atomic_global(Wave&, const Instruction*);
/// Local arrays: src[0] = element (register or uniform word), register dst / src[1].
const Instruction* clear_arrays(Wave&, const Instruction*);
Handler load_array(bool uniform);
/// An element of a table; `uniform`: to a uniform word.
Handler load_table(bool uniform);
/// `whole`: of all lanes, also those that do not run; the element is shared by all.
Handler store_array(bool uniform, bool whole);

// ---- images: extra[0] = row of Program::image_ops (spirv/exec/image.cpp)

const Instruction* image(Wave&, const Instruction*);

}  // namespace vitrine::spirv::exec
