// The checks of the sanitizer, one file each.
#pragma once

#include "glass/sanitize/reporter.h"

namespace vitrine::glass::sanitize {

/// An instruction that accesses memory is about to run: outside of what it may access? (memory.cpp)
void check_memory(Reporter& reporter, const spirv::Wave& wave, const spirv::Instruction* i,
                  const spirv::InstructionNote& note);

/// An image instruction is about to run: texels that the view has? (images.cpp)
void check_image(Reporter& reporter, const spirv::Wave& wave, const spirv::Instruction* i,
                 const spirv::InstructionNote& note);

/// An instruction that loads push constants is about to run: are they in the layout, have they been set?
/// (push_constants.cpp)
void check_push_constants(Reporter& reporter, const spirv::Wave& wave, const spirv::Instruction* i,
                          const spirv::InstructionNote& note);

class SharedShadow;
/// An instruction that accesses shared memory is about to run: has what it reads been written? (shared.cpp)
void check_shared(Reporter& reporter, const spirv::Wave& wave, const spirv::Instruction* i,
                  const spirv::InstructionNote& note, SharedShadow& shadow);

/// The active lanes come by a probe of an operation with operands for which it may be undefined. (arithmetic.cpp)
void check_operation(Reporter& reporter, const spirv::Wave& wave, const spirv::ProbeOp& op, const spirv::Probe& probe);

/// The same of an operation whose result is a floating-point number: a NaN or infinity made of numbers? (numbers.cpp)
void check_number(Reporter& reporter, const spirv::Wave& wave, const spirv::ProbeOp& op, const spirv::Probe& probe);

/// A derivative, a barrier or what must not be reached comes next. (control.cpp)
void check_control(Reporter& reporter, const spirv::Wave& wave, const spirv::ProbeOp& op, const spirv::Probe& probe);

/// An access comes next to an address that must be a multiple of something. (alignment.cpp)
void check_alignment(Reporter& reporter, const spirv::Wave& wave, const spirv::ProbeOp& op, const spirv::Probe& probe);

/// An access comes next to descriptors on which the invocations must agree. (uniformity.cpp)
void check_uniformity(Reporter& reporter, const spirv::Wave& wave, const spirv::ProbeOp& op, const spirv::Probe& probe);

/// Waves of a workgroup wait at a barrier, as this one does, that others do not reach. (control.cpp)
void check_apart(Reporter& reporter, const spirv::Wave& wave);

/// A draw with the program as its vertex shader comes next: are vertices and indices inside of what is bound?
/// (vertices.cpp)
void check_draw(ProgramPlaces& program, const raster::DrawCall& call);

struct VariableShadow;
/// The active lanes write, read or use parts of variables. (variables.cpp)
void check_variable(Reporter& reporter, const spirv::Wave& wave, const spirv::ProbeOp& op, const spirv::Probe& probe,
                    VariableShadow& shadow);

}  // namespace vitrine::glass::sanitize
