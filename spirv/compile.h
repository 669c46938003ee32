// SPIR-V words of one entry point in, an executable Shader out. Invalid or uncovered SPIR-V is an error that names the
// instruction; nothing in here crashes, hangs or prints.
#pragma once

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/result.h"
#include "spirv/shader.h"

namespace vitrine::spirv {

namespace exec {
class Observer;
}

/// Where the descriptors of one binding lie in the ResourceTable.
struct BindingInfo {
  std::uint32_t binding = 0;
  VkDescriptorType type = VK_DESCRIPTOR_TYPE_SAMPLER;
  std::uint32_t set = 0;         ///< index in ResourceTable::set: the set's number, or kDynamicSet
  std::uint32_t first_slot = 0;  ///< of array element 0
  std::uint32_t count = 1;       ///< array elements
  const texel::Sampler* const* immutable_samplers = nullptr;  ///< `count` of them, or null
};

struct SetLayoutInfo {
  std::vector<BindingInfo> bindings;
};

struct SpecializationConstant {
  std::uint32_t id = 0;
  std::vector<std::byte> bytes;
};

/// The shader at one point of its way through the compiler.
struct Representation {
  std::string name;         ///< no two of a shader have the same
  std::string description;  ///< what it is, in a sentence
  std::string text;
};

struct CompileOptions {
  VkShaderStageFlagBits stage = VK_SHADER_STAGE_VERTEX_BIT;
  std::string entry_point = "main";
  std::vector<SpecializationConstant> specialization;
  std::vector<SetLayoutInfo> sets;
  /// Fragment stage: locations that reach an attachment; outputs elsewhere are dead. Bit i = location i.
  std::uint32_t live_color_outputs = 0xff;
  std::uint32_t subgroup_size = 64;  ///< invocations: 8, 16, 32 or 64; a wave holds one subgroup or several
  /// Whom the program tells what it does (spirv/exec/observe.h). Null: whom VITRINE_TRACE asks for, mostly nobody.
  std::shared_ptr<const exec::Observer> observer;
  /// Gets the module as text, the shader after the front end and after each step that changes it, and the program, in
  /// this order. Null: they are not made.
  std::vector<Representation>* representations = nullptr;
};

/// Specialises, optimises structurally, applies the reference's rewrites, analyses and lowers.
base::Result<std::unique_ptr<Shader>> compile(std::span<const std::uint32_t> words, const CompileOptions& options);

/// Checks the words without a pipeline (vkCreateShaderModule): magic, version, word counts. Empty string: acceptable.
std::string check_module(std::span<const std::uint32_t> words);

}  // namespace vitrine::spirv
