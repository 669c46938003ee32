// What a pipeline consists of: an executable for each stage, its numbers and its forms on the way through the compiler
// (Vulkan 1.3.239, Pipelines: Pipeline Executables).
#include <algorithm>
#include <array>
#include <cstring>
#include <string_view>
#include <vector>

#include "icd/edge/util.h"
#include "icd/entry_points.h"
#include "icd/object/pipeline.h"
#include "spirv/program.h"

namespace vitrine::icd {
namespace {

struct Executable {
  VkShaderStageFlagBits stage;
  const CompiledShader* compiled;
};

/// In the order of the pipeline. None of a library, whose stages are compiled when it is linked.
std::vector<Executable> executables_of(const Pipeline& pipeline) {
  const Executable all[] = {
      {VK_SHADER_STAGE_VERTEX_BIT, pipeline.vertex.get()},
      {VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT, pipeline.control.get()},
      {VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT, pipeline.evaluation.get()},
      {VK_SHADER_STAGE_GEOMETRY_BIT, pipeline.geometry.get()},
      {VK_SHADER_STAGE_FRAGMENT_BIT, pipeline.fragment.get()},
      {VK_SHADER_STAGE_COMPUTE_BIT, pipeline.compute.get()},
  };
  std::vector<Executable> present;
  std::copy_if(std::begin(all), std::end(all), std::back_inserter(present),
               [](const Executable& e) { return e.compiled != nullptr; });
  return present;
}

/// Null: the pipeline has no executable of this index.
const CompiledShader* executable_of(const VkPipelineExecutableInfoKHR& info) {
  const std::vector<Executable> all = executables_of(from_handle<Pipeline>(info.pipeline));
  return info.executableIndex < all.size() ? all[info.executableIndex].compiled : nullptr;
}

/// As much of the text as fits, ended by a zero.
void copy_text(std::string_view text, char (&to)[VK_MAX_DESCRIPTION_SIZE]) {
  const std::size_t size = std::min(text.size(), sizeof to - 1);
  std::memcpy(to, text.data(), size);
  to[size] = 0;
}

using spirv::Access;
using spirv::InstructionNote;
using spirv::Program;

/// How many instructions of the program, preamble included, do this with memory.
std::uint64_t count_accesses(const Program& program, std::initializer_list<Access> wanted) {
  const auto matches = [&](const InstructionNote& note) {
    return std::find(wanted.begin(), wanted.end(), note.access) != wanted.end();
  };
  return static_cast<std::uint64_t>(
      std::count_if(program.preamble_notes.begin(), program.preamble_notes.end(), matches) +
      std::count_if(program.notes.begin(), program.notes.end(), matches));
}

struct Statistic {
  const char* name;
  const char* description;
  std::uint64_t (*value)(const Program&);
};

/// All are counts or bytes.
constexpr Statistic kStatistics[] = {
    {"instructions", "instructions of the program, which a wave of 64 invocations runs together",
     [](const Program& p) -> std::uint64_t { return p.code.size(); }},
    {"preamble instructions", "instructions that run once per draw or dispatch, for all invocations",
     [](const Program& p) -> std::uint64_t { return p.preamble.size(); }},
    {"registers", "registers of a wave, 64 values of 32 bits each",
     [](const Program& p) -> std::uint64_t { return p.register_count; }},
    {"mask registers", "registers of a wave for booleans, 64 bits each",
     [](const Program& p) -> std::uint64_t { return p.mask_count; }},
    {"uniform words", "values of 32 bits that are equal for all invocations of a wave, constants included",
     [](const Program& p) -> std::uint64_t { return p.uniform_words; }},
    {"constants", "those of the uniform words that are known when the pipeline is made",
     [](const Program& p) -> std::uint64_t { return p.constants.size(); }},
    {"loads", "instructions that read buffers, push constants, shared memory or local arrays",
     [](const Program& p) { return count_accesses(p, {Access::kLoad}); }},
    {"stores", "instructions that write buffers, shared memory or local arrays",
     [](const Program& p) { return count_accesses(p, {Access::kStore}); }},
    {"atomics", "instructions that change buffers or shared memory atomically",
     [](const Program& p) { return count_accesses(p, {Access::kAtomic}); }},
    {"image operations", "instructions that sample, fetch, load, store or query images and texel buffers",
     [](const Program& p) { return count_accesses(p, {Access::kImage}); }},
    {"local array bytes", "memory of a wave for arrays that an index selects from",
     [](const Program& p) -> std::uint64_t { return p.array_bytes; }},
    {"shared bytes", "memory that the invocations of a workgroup share",
     [](const Program& p) -> std::uint64_t { return p.shared_bytes; }},
};

/// Writes a text with its final zero, or as much as there is room for, also ended by a zero. False: not all of it.
bool write_text(const std::string& text, VkPipelineExecutableInternalRepresentationKHR& out) {
  const std::size_t needed = text.size() + 1;
  if (!out.pData) {
    out.dataSize = needed;
    return true;
  }
  out.dataSize = std::min(out.dataSize, needed);
  if (!out.dataSize) return false;
  std::memcpy(out.pData, text.c_str(), out.dataSize);
  static_cast<char*>(out.pData)[out.dataSize - 1] = 0;
  return out.dataSize == needed;
}

}  // namespace

namespace entry {

VKAPI_ATTR VkResult VKAPI_CALL GetPipelineExecutablePropertiesKHR(VkDevice, const VkPipelineInfoKHR* info,
                                                                  std::uint32_t* count,
                                                                  VkPipelineExecutablePropertiesKHR* properties) {
  OutArray<VkPipelineExecutablePropertiesKHR> array(count, properties);
  for (const Executable& executable : executables_of(from_handle<Pipeline>(info->pipeline))) {
    VkPipelineExecutablePropertiesKHR* out = array.next();
    if (!out) continue;
    const std::string name = stage_name(executable.stage);
    out->stages = executable.stage;
    copy_text(name, out->name);
    copy_text("the " + name + " shader as a program for waves of 64 invocations", out->description);
    out->subgroupSize = executable.compiled->subgroup_size;
  }
  return array.result();
}

VKAPI_ATTR VkResult VKAPI_CALL GetPipelineExecutableStatisticsKHR(VkDevice, const VkPipelineExecutableInfoKHR* info,
                                                                  std::uint32_t* count,
                                                                  VkPipelineExecutableStatisticKHR* statistics) {
  OutArray<VkPipelineExecutableStatisticKHR> array(count, statistics);
  const CompiledShader* compiled = executable_of(*info);
  if (!compiled) return array.result();
  for (const Statistic& statistic : kStatistics) {
    VkPipelineExecutableStatisticKHR* out = array.next();
    if (!out) continue;
    copy_text(statistic.name, out->name);
    copy_text(statistic.description, out->description);
    out->format = VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_UINT64_KHR;
    out->value.u64 = statistic.value(compiled->shader->program());
  }
  return array.result();
}

/// "If dataSize is less than the size of the representation, at most dataSize bytes are written, and VK_INCOMPLETE is
/// returned."
VKAPI_ATTR VkResult VKAPI_CALL
GetPipelineExecutableInternalRepresentationsKHR(VkDevice, const VkPipelineExecutableInfoKHR* info, std::uint32_t* count,
                                                VkPipelineExecutableInternalRepresentationKHR* representations) {
  OutArray<VkPipelineExecutableInternalRepresentationKHR> array(count, representations);
  const CompiledShader* compiled = executable_of(*info);
  if (!compiled) return array.result();
  bool complete = true;
  for (const spirv::Representation& representation : compiled->representations) {
    VkPipelineExecutableInternalRepresentationKHR* out = array.next();
    if (!out) continue;
    copy_text(representation.name, out->name);
    copy_text(representation.description, out->description);
    out->isText = VK_TRUE;
    complete &= write_text(representation.text, *out);
  }
  const VkResult result = array.result();
  return complete ? result : VK_INCOMPLETE;
}

}  // namespace entry
}  // namespace vitrine::icd
