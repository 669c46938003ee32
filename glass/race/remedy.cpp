// See remedy.h. Code is that of GLSL, with HLSL's words where the module was written in it.
#include "glass/race/remedy.h"

namespace vitrine::glass::race {
namespace {

bool same_group(const Conflict& conflict) {
  return conflict.earlier.program->compute() && conflict.earlier.who.group == conflict.later.who.group;
}

const char* barrier_of(Memory memory, bool hlsl) {
  if (hlsl)
    return memory == Memory::kShared ? "GroupMemoryBarrierWithGroupSync();" : "DeviceMemoryBarrierWithGroupSync();";
  switch (memory) {
    case Memory::kShared:
      return "barrier();";
    case Memory::kBuffer:
      return "memoryBarrierBuffer(); barrier();";
    default:
      return "memoryBarrierImage(); barrier();";
  }
}

std::string atomic_of(const Conflict& conflict) {
  const bool hlsl = conflict.later.program->sites.hlsl;
  const bool image = conflict.later.what().memory == Memory::kImage;
  return hlsl ? "InterlockedAdd" : image ? "imageAtomicAdd" : "atomicAdd";
}

}  // namespace

std::string reason_of(const Conflict& conflict) {
  if (conflict.kind == Conflict::Kind::kScope) return ": the scope of one of them does not hold the other invocation";
  if (conflict.kind == Conflict::Kind::kVisibility)
    return ", which is ordered before it but not made available and visible to it";
  if (same_group(conflict)) return ": nothing orders them";
  if (conflict.later.program->compute()) return " of another workgroup: no barrier orders workgroups";
  return ": nothing orders invocations of a draw";
}

std::string remedy_of(const Conflict& conflict) {
  const Site &earlier = conflict.earlier.what(), &later = conflict.later.what();
  const Sites& sites = conflict.later.program->sites;
  if (conflict.kind == Conflict::Kind::kScope) return "a scope of the device: gl_ScopeDevice";
  if (conflict.kind == Conflict::Kind::kVisibility)
    return sites.vulkan_model
               ? "NonPrivatePointer on both, MakePointerAvailable on the write or MakeAvailable in the release, and "
                 "MakePointerVisible on the read or MakeVisible in the acquire"
               : "declare what both access `coherent`";
  if (same_group(conflict)) {
    if (earlier.is_atomic() != later.is_atomic())
      return std::string(barrier_of(later.memory, sites.hlsl)) + " between them, or both atomic";
    return std::string(barrier_of(later.memory, sites.hlsl)) + " between them";
  }
  if (earlier.is_atomic() != later.is_atomic())
    return "both atomic (" + atomic_of(conflict) + "), or two commands with vkCmdPipelineBarrier between them";
  if (earlier.writes() && later.writes())
    return atomic_of(conflict) +
           "(...) instead of the stores, an element for each invocation, or two commands with "
           "vkCmdPipelineBarrier between them";
  return "two commands with vkCmdPipelineBarrier between them, or an atomic release behind the store and an atomic "
         "acquire in front of the load (scope gl_ScopeDevice)";
}

}  // namespace vitrine::glass::race
