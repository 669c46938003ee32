// Compiling the stages of pipelines, once for equal stages (Vulkan 1.3.239, Pipelines: Pipeline Cache).
#include "icd/object/shader_cache.h"

#include <algorithm>
#include <cstring>
#include <string_view>

#include "base/lanes.h"
#include "glass/bug/capture.h"
#include "glass/profile.h"
#include "glass/session.h"
#include "icd/edge/util.h"

namespace vitrine::icd {
namespace {

/// Two multiplicative hashes with different constants over the same bytes.
class KeyBuilder {
 public:
  void add(const void* data, std::size_t size) {
    const auto* bytes = static_cast<const std::byte*>(data);
    for (; size >= 8; size -= 8, bytes += 8) mix(load(bytes, 8));
    if (size) mix(load(bytes, size));
  }
  void add(std::uint64_t value) { mix(value); }
  ShaderKey key() const { return key_; }

 private:
  static std::uint64_t load(const std::byte* bytes, std::size_t size) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes, size);
    return word;
  }
  static std::uint64_t step(std::uint64_t state, std::uint64_t word, std::uint64_t factor) {
    state = (state ^ word) * factor;
    return state ^ (state >> 29);
  }
  void mix(std::uint64_t word) {
    key_[0] = step(key_[0], word, 0x9e3779b97f4a7c15u);
    key_[1] = step(key_[1], word, 0xc2b2ae3d27d4eb4fu);
  }

  ShaderKey key_{0x243f6a8885a308d3u, 0x13198a2e03707344u};
};

/// Everything of the layout that compile() sees. Immutable samplers count by address: they belong to the layout.
void add_layout(const PipelineLayoutShape& layout, KeyBuilder& key) {
  for (std::size_t set = 0; set < layout.sets.size(); ++set) {
    key.add(set);
    key.add(layout.first_dynamic[set]);
    if (!layout.sets[set]) continue;
    for (const SetBinding& b : layout.sets[set]->bindings) {
      key.add(std::uint64_t{b.binding} << 32 | static_cast<std::uint32_t>(b.type));
      key.add(std::uint64_t{b.count} << 32 | b.first_slot);
      key.add(reinterpret_cast<std::uintptr_t>(b.immutable_samplers));
    }
  }
}

/// "If this structure is not chained, the subgroup size is the implementation's" (Pipelines: Required Subgroup Size).
std::uint32_t subgroup_size(const VkPipelineShaderStageCreateInfo& stage) {
  const auto* required = find_in_chain<VkPipelineShaderStageRequiredSubgroupSizeCreateInfo>(stage.pNext);
  return required ? required->requiredSubgroupSize : static_cast<std::uint32_t>(base::kWaveWidth);
}

ShaderKey make_key(const StageRequest& request) {
  const VkPipelineShaderStageCreateInfo& stage = *request.stage;
  KeyBuilder key;
  const ShaderKey words = identifier_of(stage);
  key.add(words.data(), sizeof words);
  key.add(stage.stage);
  key.add(stage.pName, std::strlen(stage.pName));
  key.add(request.live_color_outputs);
  key.add(subgroup_size(stage));
  key.add(std::uint64_t{request.captured});
  if (const VkSpecializationInfo* s = stage.pSpecializationInfo) {
    for (std::uint32_t i = 0; i < s->mapEntryCount; ++i) {
      const VkSpecializationMapEntry& entry = s->pMapEntries[i];
      key.add(entry.constantID);
      key.add(static_cast<const std::byte*>(s->pData) + entry.offset, entry.size);
    }
  }
  add_layout(*request.layout, key);
  return key.key();
}

spirv::CompileOptions make_options(const StageRequest& request, glass::Tool* more = nullptr) {
  const VkPipelineShaderStageCreateInfo& stage = *request.stage;
  spirv::CompileOptions options;
  options.stage = stage.stage;
  options.entry_point = stage.pName;
  options.live_color_outputs = request.live_color_outputs;
  options.subgroup_size = subgroup_size(stage);
  options.sets = set_layout_infos(*request.layout);
  if (glass::Session& session = glass::session(); more || !session.idle())
    options.observer = session.observe({stage.stage, stage.pName, words_of(stage)}, more);
  if (const VkSpecializationInfo* s = stage.pSpecializationInfo) {
    for (std::uint32_t i = 0; i < s->mapEntryCount; ++i) {
      const VkSpecializationMapEntry& entry = s->pMapEntries[i];
      const auto* bytes = static_cast<const std::byte*>(s->pData) + entry.offset;
      options.specialization.push_back({entry.constantID, {bytes, bytes + entry.size}});
    }
  }
  return options;
}

std::shared_ptr<const CompiledShader> find_alive(ShaderTable& table, const ShaderKey& key) {
  const std::lock_guard lock(table.mutex);
  const auto found = table.shaders.find(key);
  return found == table.shaders.end() ? nullptr : found->second.lock();
}

/// Whether somebody may ask what a shader was compiled from: also a pipeline whose modules are named by identifiers,
/// and of which binaries are to be made.
bool keeps_stages(const Device& device) {
#ifdef VK_KHR_pipeline_binary
  if (device.features.test(Feature::pipelineBinaries)) return true;
#endif
  return device.features.test(Feature::performanceCounterQueryPools) || glass::bug::captures();
}

/// Adds a shader, or gives the one that another thread added meanwhile.
std::shared_ptr<const CompiledShader> add_shader(ShaderTable& table, const ShaderKey& key,
                                                 std::shared_ptr<const CompiledShader> shader) {
  const std::lock_guard lock(table.mutex);
  if (table.shaders.size() >= table.sweep_at) {
    std::erase_if(table.shaders, [](const auto& entry) { return entry.second.expired(); });
    table.sweep_at = std::max<std::size_t>(64, table.shaders.size() * 2);
  }
  std::weak_ptr<const CompiledShader>& entry = table.shaders[key];
  if (std::shared_ptr<const CompiledShader> other = entry.lock()) return other;
  entry = shader;
  return shader;
}

/// Whether the cache had it already.
bool keep(PipelineCache& cache, const std::shared_ptr<const CompiledShader>& shader) {
  const std::lock_guard lock(cache.mutex);
  if (std::find(cache.kept.begin(), cache.kept.end(), shader) != cache.kept.end()) return true;
  cache.kept.push_back(shader);
  return false;
}

}  // namespace

std::span<const std::uint32_t> words_of(const VkPipelineShaderStageCreateInfo& stage) {
  if (stage.module) return from_handle<ShaderModule>(stage.module).words;
  const auto* info = find_in_chain<VkShaderModuleCreateInfo>(stage.pNext);
  if (!info) return {};
  return {info->pCode, info->codeSize / sizeof(std::uint32_t)};
}

ShaderKey identifier_of(std::span<const std::uint32_t> words) {
  KeyBuilder key;
  key.add(words.data(), words.size_bytes());
  return key.key();
}

ShaderKey identifier_of(const VkPipelineShaderStageCreateInfo& stage) {
  if (stage.module) return from_handle<ShaderModule>(stage.module).identifier;
  const auto* given = find_in_chain<VkPipelineShaderStageModuleIdentifierCreateInfoEXT>(stage.pNext);
  ShaderKey key{};
  if (!given || given->identifierSize != sizeof key) return identifier_of(words_of(stage));
  std::memcpy(key.data(), given->pIdentifier, sizeof key);
  return key;
}

StageResult compile_stage(Device& device, PipelineCache* cache, const StageRequest& request) {
  StageResult out;
  const ShaderKey key = make_key(request);
  out.shader = find_alive(device.shaders, key);
  if (!out.shader) {
    if (!request.may_compile) return out;
    spirv::CompileOptions options = make_options(request);
    std::vector<spirv::Representation> representations;
    if (request.captured) options.representations = &representations;
    base::Result<std::unique_ptr<spirv::Shader>> result = spirv::compile(words_of(*request.stage), options);
    if (!result) {
      out.problem = result.message();
      return out;
    }
    const auto compiled = std::allocate_shared<CompiledShader>(HostAllocator<CompiledShader>(device.memory));
    compiled->shader = result.take();
    compiled->layout = request.layout;
    compiled->subgroup_size = options.subgroup_size;
    compiled->representations = std::move(representations);
    compiled->live_color_outputs = request.live_color_outputs;
    if (keeps_stages(device)) compiled->kept = keep_stage(*request.stage, device.memory);
    out.shader = add_shader(device.shaders, key, compiled);
  }
  if (cache) out.was_in_cache = keep(*cache, out.shader);
  return out;
}

const spirv::Shader& counted_shader(const CompiledShader& shader, glass::Profile& profile) {
  const std::lock_guard lock(shader.counted_mutex);
  if (!shader.counted && shader.kept) {
    const StageInfo kept(*shader.kept);
    const spirv::CompileOptions options =
        make_options({&kept.info(), shader.layout, shader.live_color_outputs}, &profile);
    if (auto result = spirv::compile(shader.kept->words, options)) shader.counted = result.take();
  }
  return shader.counted ? *shader.counted : *shader.shader;
}

}  // namespace vitrine::icd
