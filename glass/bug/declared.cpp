// See declared.h. Variables of several types may share a binding; arrays are as their elements.
#include "glass/bug/declared.h"

#include <cstring>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "spirv/newer_numbers.h"

namespace vitrine::glass::bug {
namespace {

constexpr std::size_t kHeaderWords = 5;

constexpr std::uint32_t bit(VkDescriptorType type) { return 1u << type; }
constexpr std::uint32_t kUniform =
                            bit(VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER) | bit(VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC),
                        kStorage =
                            bit(VK_DESCRIPTOR_TYPE_STORAGE_BUFFER) | bit(VK_DESCRIPTOR_TYPE_STORAGE_BUFFER_DYNAMIC);

using Words = std::span<const std::uint32_t>;

/// What the instructions in front of functions say.
class Scan {
 public:
  explicit Scan(Words words) {
    for (std::size_t at = kHeaderWords; at < words.size();) {
      const std::size_t length = words[at] >> 16;
      if (length == 0 || length > words.size() - at) break;
      const auto op = static_cast<spv::Op>(words[at] & 0xffff);
      if (op == spv::Op::OpFunction) break;
      look(op, words.subspan(at, length));
      at += length;
    }
  }

  void add_to(Declared& declared) const {
    for (const auto& [id, place] : places_) {
      const auto variable = variables_.find(id);
      declared[place] |= variable == variables_.end() ? 0 : types_of(variable->second);
    }
  }

 private:
  void look(spv::Op op, Words i) {
    switch (op) {
      case spv::Op::OpDecorate:
        if (i.size() == 4 && i[2] == static_cast<std::uint32_t>(spv::Decoration::DescriptorSet))
          places_[i[1]].first = i[3];
        if (i.size() == 4 && i[2] == static_cast<std::uint32_t>(spv::Decoration::Binding)) places_[i[1]].second = i[3];
        if (i.size() == 3 && i[2] == static_cast<std::uint32_t>(spv::Decoration::BufferBlock)) stored_.insert(i[1]);
        return;
      case spv::Op::OpVariable:
        if (i.size() >= 4) variables_[i[2]] = i;
        return;
      case spv::Op::OpTypePointer:
      case spv::Op::OpTypeArray:
      case spv::Op::OpTypeRuntimeArray:
      case spv::Op::OpTypeStruct:
      case spv::Op::OpTypeImage:
      case spv::Op::OpTypeSampledImage:
      case spv::Op::OpTypeSampler:
        if (i.size() >= 2) types_[i[1]] = i;
        return;
      default:
        return;
    }
  }

  /// An empty instruction if there is none.
  Words type(std::uint32_t id) const {
    const auto found = types_.find(id);
    return found == types_.end() ? Words{} : found->second;
  }
  static spv::Op op_of(Words i) { return i.empty() ? spv::Op::OpNop : static_cast<spv::Op>(i[0] & 0xffff); }

  /// What a pointer leads to, arrays taken off; bad modules may have arrays of themselves.
  Words pointee(Words pointer) const {
    if (op_of(pointer) != spv::Op::OpTypePointer || pointer.size() < 4) return {};
    Words at = type(pointer[3]);
    for (int depth = 0; depth < 16; ++depth) {
      if (op_of(at) != spv::Op::OpTypeArray && op_of(at) != spv::Op::OpTypeRuntimeArray) return at;
      at = at.size() < 3 ? Words{} : type(at[2]);
    }
    return {};
  }

  static std::uint32_t types_of_image(Words image) {
    if (image.size() < 8) return 0;
    const bool stored = image[7] == 2;
    switch (static_cast<spv::Dim>(image[3])) {
      case spv::Dim::Buffer:
        return bit(stored ? VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER : VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER);
      case spv::Dim::SubpassData:
        return bit(VK_DESCRIPTOR_TYPE_INPUT_ATTACHMENT);
      default:
        return stored ? bit(VK_DESCRIPTOR_TYPE_STORAGE_IMAGE)
                      : bit(VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE) | bit(VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER);
    }
  }

  std::uint32_t types_of(Words variable) const {
    const Words what = pointee(type(variable[1]));
    switch (op_of(what)) {
      case spv::Op::OpTypeStruct: {
        const bool storage = static_cast<spv::StorageClass>(variable[3]) == spv::StorageClass::StorageBuffer;
        return storage || stored_.contains(what[1]) ? kStorage : kUniform;
      }
      case spv::Op::OpTypeImage:
        return types_of_image(what);
      case spv::Op::OpTypeSampledImage: {
        // Of a texel buffer, too.
        const std::uint32_t image = what.size() < 3 ? 0 : types_of_image(type(what[2]));
        return image & bit(VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER) ? image
                                                                    : bit(VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER);
      }
      case spv::Op::OpTypeSampler:
        return bit(VK_DESCRIPTOR_TYPE_SAMPLER) | bit(VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER);
      default:
        return 0;
    }
  }

  std::map<std::uint32_t, std::pair<std::uint32_t, std::uint32_t>> places_;
  std::unordered_map<std::uint32_t, Words> variables_, types_;
  std::unordered_set<std::uint32_t> stored_;  ///< types that are BufferBlock
};

}  // namespace

void add_declared(std::span<const std::uint32_t> words, Declared& declared) { Scan(words).add_to(declared); }

Declared declared_in(const Bug& bug) {
  Declared declared;
  for (const Stage& stage : bug.stages) {
    std::vector<std::uint32_t> words(size_of(stage.words) / 4);
    if (words.empty()) continue;
    std::memcpy(words.data(), stage.words->data(), words.size() * 4);
    add_declared(words, declared);
  }
  return declared;
}

}  // namespace vitrine::glass::bug
