// Binaries of shader objects (Vulkan 1.4.309, Shaders: Binary Shader Code): 32-bit words of this machine's order,
//
//   shaderBinaryUUID (4 words), version, hash of all that follows (4 words), stage, required subgroup size (0: none),
//   words of SPIR-V, specialization entries, bytes of their data, bytes of the entry point's name;
//   then these: the SPIR-V, each entry's constant, offset and size, data and name, padded with zeros to words.
//
// A binary is nobody's promise: sizes, hash and entries are checked, and the SPIR-V is compiled as any other.
#include <bit>
#include <cstring>

#include "icd/object/shader_object.h"
#include "icd/properties.h"

#ifdef VK_EXT_shader_object
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

Sizes sizes_of(const KeptStage& source) {
  return {static_cast<std::uint32_t>(source.stage),        source.subgroup_size,
          static_cast<std::uint32_t>(source.words.size()), static_cast<std::uint32_t>(source.map.size()),
          static_cast<std::uint32_t>(source.data.size()),  static_cast<std::uint32_t>(source.entry_point.size())};
}

/// Whether a subgroup size can be required; 0: none is.
bool is_subgroup_size(std::uint32_t size) {
  const auto& claimed = kClaimedPhysicalDeviceSubgroupSizeControlProperties;
  return size == 0 || (std::has_single_bit(size) && size >= claimed.minSubgroupSize && size <= claimed.maxSubgroupSize);
}

/// Whether the header is ours and everything has the size that it says.
bool read_sizes(const Vector<std::uint32_t>& words, Sizes& sizes) {
  const auto& claimed = kClaimedPhysicalDeviceShaderObjectPropertiesEXT;
  if (words.size() < kHeaderWords || std::memcmp(words.data(), claimed.shaderBinaryUUID, VK_UUID_SIZE) != 0)
    return false;
  if (words[kVersion] != claimed.shaderBinaryVersion) return false;
  std::memcpy(&sizes, words.data() + kHashed, sizeof sizes);
  if (sizes.total_words() != words.size() || !is_subgroup_size(sizes.subgroup_size)) return false;
  const ShaderKey hash = hash_of(words);
  return std::memcmp(words.data() + kHash, hash.data(), sizeof hash) == 0;
}

}  // namespace

std::size_t shader_binary_bytes(const KeptStage& source) {
  return sizes_of(source).total_words() * sizeof(std::uint32_t);
}

Vector<std::uint32_t> shader_binary(const KeptStage& source) {
  const auto& claimed = kClaimedPhysicalDeviceShaderObjectPropertiesEXT;
  const Sizes sizes = sizes_of(source);
  Vector<std::uint32_t> out(kHeaderWords, 0, source.words.get_allocator());
  out.reserve(sizes.total_words());
  std::memcpy(out.data(), claimed.shaderBinaryUUID, VK_UUID_SIZE);
  out[kVersion] = claimed.shaderBinaryVersion;
  std::memcpy(out.data() + kHashed, &sizes, sizeof sizes);
  out.insert(out.end(), source.words.begin(), source.words.end());
  for (const VkSpecializationMapEntry& entry : source.map)
    out.insert(out.end(), {entry.constantID, entry.offset, static_cast<std::uint32_t>(entry.size)});
  append_bytes(out, source.data.data(), source.data.size());
  append_bytes(out, source.entry_point.data(), source.entry_point.size());
  const ShaderKey hash = hash_of(out);
  std::memcpy(out.data() + kHash, hash.data(), sizeof hash);
  return out;
}

bool read_shader_binary(const void* code, std::size_t bytes, KeptStage& out) {
  if (!code || bytes % sizeof(std::uint32_t) != 0) return false;
  Vector<std::uint32_t> words(out.words.get_allocator());
  append_bytes(words, code, bytes);
  Sizes sizes;
  if (!read_sizes(words, sizes)) return false;
  const std::uint32_t* at = words.data() + kHeaderWords;
  out.stage = static_cast<VkShaderStageFlagBits>(sizes.stage);
  out.subgroup_size = sizes.subgroup_size;
  out.words.assign(at, at + sizes.code_words);
  at += sizes.code_words;
  out.map.clear();
  for (std::uint32_t i = 0; i < sizes.entries; ++i, at += kEntryWords) {
    if (std::uint64_t{at[1]} + at[2] > sizes.data_bytes) return false;
    out.map.push_back({at[0], at[1], at[2]});
  }
  const auto* data = reinterpret_cast<const std::byte*>(at);
  out.data.assign(data, data + sizes.data_bytes);
  const auto* name = reinterpret_cast<const char*>(at + words_for(sizes.data_bytes));
  out.entry_point.assign(name, sizes.name_bytes);
  return true;
}

}  // namespace vitrine::icd
#endif
