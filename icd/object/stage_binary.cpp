// Binaries of stages (Vulkan 1.4.309, Shaders: Binary Shader Code; Pipelines: Pipeline Binaries): 32-bit words of this
// machine's order,
//
//   UUID of the format (4 words), its version, hash of all that follows (4 words), stage, required subgroup size (0:
//   none), words of SPIR-V, specialization entries, bytes of their data, bytes of the entry point's name;
//   then these: the SPIR-V, each entry's constant, offset and size, data and name, padded with zeros to words.
//
// A binary is nobody's promise: sizes, hash and entries are checked, and the SPIR-V is compiled as any other.
#include "icd/object/stage_binary.h"

#include <bit>
#include <cstring>

#include "icd/properties.h"

namespace vitrine::icd {
namespace {

constexpr std::size_t kUuidWords = VK_UUID_SIZE / 4, kHashWords = sizeof(ShaderKey) / 4;
constexpr std::size_t kVersion = kUuidWords, kHash = kVersion + 1, kHashed = kHash + kHashWords;
constexpr std::size_t kHeaderWords = kHashed + 6;
constexpr std::size_t kEntryWords = 3;

std::uint64_t words_for(std::uint64_t bytes) { return (bytes + 3) / 4; }

void append_bytes(Vector<std::uint32_t>& out, const void* data, std::size_t bytes) {
  const std::size_t first = out.size();
  out.resize(first + words_for(bytes));
  if (bytes) std::memcpy(out.data() + first, data, bytes);
}

ShaderKey hash_of(const Vector<std::uint32_t>& binary) {
  return identifier_of(std::span<const std::uint32_t>(binary).subspan(kHashed));
}

/// What the words behind the hash say first.
struct Sizes {
  std::uint32_t stage, subgroup_size, code_words, entries, data_bytes, name_bytes;

  std::uint64_t total_words() const {
    return kHeaderWords + std::uint64_t{code_words} + std::uint64_t{entries} * kEntryWords + words_for(data_bytes) +
           words_for(name_bytes);
  }
};
static_assert(sizeof(Sizes) == (kHeaderWords - kHashed) * sizeof(std::uint32_t));

Sizes sizes_of(const KeptStage& stage) {
  return {static_cast<std::uint32_t>(stage.stage),        stage.subgroup_size,
          static_cast<std::uint32_t>(stage.words.size()), static_cast<std::uint32_t>(stage.map.size()),
          static_cast<std::uint32_t>(stage.data.size()),  static_cast<std::uint32_t>(stage.entry_point.size())};
}

/// Whether it is one stage, and one that this device has.
bool is_stage(std::uint32_t stage) {
  return std::has_single_bit(stage) && (stage & (VK_SHADER_STAGE_ALL_GRAPHICS | VK_SHADER_STAGE_COMPUTE_BIT));
}

/// Whether a subgroup size can be required; 0: none is.
bool is_subgroup_size(std::uint32_t size) {
  const auto& claimed = kClaimedPhysicalDeviceSubgroupSizeControlProperties;
  return size == 0 || (std::has_single_bit(size) && size >= claimed.minSubgroupSize && size <= claimed.maxSubgroupSize);
}

/// Whether the header is of the format and everything has the size that it says. Null, or why not.
const char* read_sizes(const Vector<std::uint32_t>& words, const BinaryFormat& format, Sizes& sizes) {
  if (words.size() < kHeaderWords) return "it is cut off";
  if (std::memcmp(words.data(), format.uuid, VK_UUID_SIZE) != 0 || words[kVersion] != format.version)
    return "it is of another driver, or of another version of this one";
  std::memcpy(&sizes, words.data() + kHashed, sizeof sizes);
  if (sizes.total_words() != words.size()) return "it has not the size that it says";
  const ShaderKey hash = hash_of(words);
  if (std::memcmp(words.data() + kHash, hash.data(), sizeof hash) != 0) return "it is damaged";
  if (!is_stage(sizes.stage)) return "it is of no stage that this device has";
  return is_subgroup_size(sizes.subgroup_size) ? nullptr : "it asks for subgroups that cannot be";
}

}  // namespace

std::size_t stage_binary_bytes(const KeptStage& stage) { return sizes_of(stage).total_words() * sizeof(std::uint32_t); }

Vector<std::uint32_t> stage_binary(const KeptStage& stage, const BinaryFormat& format) {
  const Sizes sizes = sizes_of(stage);
  Vector<std::uint32_t> out(kHeaderWords, 0, stage.words.get_allocator());
  out.reserve(sizes.total_words());
  std::memcpy(out.data(), format.uuid, VK_UUID_SIZE);
  out[kVersion] = format.version;
  std::memcpy(out.data() + kHashed, &sizes, sizeof sizes);
  out.insert(out.end(), stage.words.begin(), stage.words.end());
  for (const VkSpecializationMapEntry& entry : stage.map)
    out.insert(out.end(), {entry.constantID, entry.offset, static_cast<std::uint32_t>(entry.size)});
  append_bytes(out, stage.data.data(), stage.data.size());
  append_bytes(out, stage.entry_point.data(), stage.entry_point.size());
  const ShaderKey hash = hash_of(out);
  std::memcpy(out.data() + kHash, hash.data(), sizeof hash);
  return out;
}

const char* read_stage_binary(const void* data, std::size_t bytes, const BinaryFormat& format, KeptStage& out) {
  if (!data || bytes % sizeof(std::uint32_t) != 0) return "it is cut off";
  Vector<std::uint32_t> words(out.words.get_allocator());
  append_bytes(words, data, bytes);
  Sizes sizes;
  if (const char* problem = read_sizes(words, format, sizes)) return problem;
  const std::uint32_t* at = words.data() + kHeaderWords;
  out.stage = static_cast<VkShaderStageFlagBits>(sizes.stage);
  out.subgroup_size = sizes.subgroup_size;
  out.words.assign(at, at + sizes.code_words);
  at += sizes.code_words;
  out.map.clear();
  for (std::uint32_t i = 0; i < sizes.entries; ++i, at += kEntryWords) {
    if (std::uint64_t{at[1]} + at[2] > sizes.data_bytes) return "its specialization reaches beyond its data";
    out.map.push_back({at[0], at[1], at[2]});
  }
  const auto* constants = reinterpret_cast<const std::byte*>(at);
  out.data.assign(constants, constants + sizes.data_bytes);
  const auto* name = reinterpret_cast<const char*>(at + words_for(sizes.data_bytes));
  out.entry_point.assign(name, sizes.name_bytes);
  return nullptr;
}

}  // namespace vitrine::icd
