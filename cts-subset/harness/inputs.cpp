// Hashes what a case gives a device.
#include "harness/inputs.h"

#include "harness/graphics.h"
#include "harness/run.h"

namespace vitrine::cts {
namespace {

/// Lists of structures whose members all have four bytes.
template <typename T>
void plain(Hash& hash, const std::vector<T>& list) {
  hash.bytes(list.data(), list.size() * sizeof(T));
}

}  // namespace

void Inputs::module(const std::vector<uint32_t>& words, bool from_text) {
  constexpr size_t kHeader = 5;  // with the compiler's own version
  if (words.size() < kHeader) return;
  // Words that were compiled before the case runs differ with the compiler as those of its own text do.
  constexpr uint32_t kGlslang = 8;  // SPIR-V's registry of generators
  const bool compiled = from_text || words[2] >> 16 == kGlslang;
  (compiled ? modules_ : given_).bytes(words.data() + kHeader, (words.size() - kHeader) * 4);
}

void Inputs::image(const ImageSpec& s) {
  given_.numbers(s.format, s.extent.width, s.extent.height, s.extent.depth, s.levels, s.layers, s.samples, s.view);
  given_.numbers(s.tiling, s.flags, s.components.r, s.components.g, s.components.b, s.components.a);
}

void Inputs::special(const VkSpecializationInfo* constants) {
  if (constants) given_.bytes(constants->pData, constants->dataSize);
}

void Inputs::sampler(const VkSamplerCreateInfo& s) {
  given_.numbers(s.flags, s.magFilter, s.minFilter, s.mipmapMode, s.addressModeU, s.addressModeV, s.addressModeW);
  given_.numbers(s.mipLodBias, s.anisotropyEnable, s.maxAnisotropy, s.compareEnable, s.compareOp, s.minLod, s.maxLod);
  given_.numbers(s.borderColor, s.unnormalizedCoordinates);
}

void Inputs::buffer(const Buffer& buffer, bool has_address) {
  given_.numbers(buffer.size);
  has_addresses_ |= has_address;
  unseen_.emplace_back(buffer.data, buffer.size);
}

void Inputs::push_constants(std::span<const std::byte> bytes) {
  given_.numbers(bytes.size());
  if (!has_addresses_) given_.bytes(bytes.data(), bytes.size());
}

void Inputs::bindings(const std::vector<Binding>& bindings, uint32_t push_bytes) {
  given_.numbers(push_bytes);
  for (const Binding& b : bindings)
    given_.numbers(b.binding, b.type, b.buffers.size(), b.images.size(), b.views.size(), b.immutable_samplers);
}

void Inputs::pipeline(const GraphicsSpec& s) {
  plain(given_, s.bindings), plain(given_, s.attributes), plain(given_, s.viewports), plain(given_, s.scissors);
  plain(given_, s.blends), plain(given_, s.dynamic);
  special(s.vertex_special), special(s.fragment_special);
  given_.numbers(s.assembly.topology, s.assembly.primitiveRestartEnable, s.tessellation.patchControlPoints);
  const auto& r = s.raster;
  given_.numbers(r.depthClampEnable, r.rasterizerDiscardEnable, r.polygonMode, r.cullMode, r.frontFace);
  given_.numbers(r.depthBiasEnable, r.depthBiasConstantFactor, r.depthBiasClamp, r.depthBiasSlopeFactor, r.lineWidth);
  const auto& m = s.multisample;
  given_.numbers(m.sampleShadingEnable, m.minSampleShading, m.alphaToCoverageEnable, m.alphaToOneEnable);
  given_.numbers(m.pSampleMask ? *m.pSampleMask : 0u);
  const auto& d = s.depth;
  given_.numbers(d.depthTestEnable, d.depthWriteEnable, d.depthCompareOp, d.depthBoundsTestEnable, d.stencilTestEnable);
  given_.numbers(d.minDepthBounds, d.maxDepthBounds);
  given_.bytes(&d.front, sizeof d.front);
  given_.bytes(&d.back, sizeof d.back);
  given_.numbers(s.blend.logicOpEnable, s.blend.logicOp);
  given_.bytes(s.blend.blendConstants, sizeof s.blend.blendConstants);
}

void Inputs::submission() {
  if (!has_addresses_)
    for (const auto& [data, size] : unseen_) given_.bytes(data, size);
  unseen_.clear();
}

}  // namespace vitrine::cts
