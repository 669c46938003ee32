// VK_EXT_legacy_vertex_attributes, which neither older headers nor the reference know: attributes at any address and
// stride, read as signed or unsigned numbers whatever the format says.
#include <algorithm>

#include "tests/icd/maintenance5_draws_fixture.h"

#ifdef VK_EXT_legacy_vertex_attributes
namespace vitrine::icd::test {
namespace {

#define VK_CALL(name) VK_GET(instance, name)

constexpr std::uint32_t kVertices = 15;

class LegacyVertexAttributes : public Maintenance5Draws {
 protected:
  /// The four components that each vertex has of an attribute, as bits.
  std::vector<std::uint32_t> fetched(const char* type, VkFormat format, const Bytes& bytes, VkDeviceSize offset,
                                     std::uint32_t attribute_offset, std::uint32_t stride) {
    std::memset(results.data, 0x5a, results.size);
    Draw draw;
    draw.vertex = "layout(location = 0) in ";
    draw.vertex.append(type).append(
        " a; layout(set = 0, binding = 0) buffer B { uvec4 r[]; };\nvoid main() { r[gl_VertexIndex] = ");
    draw.vertex.append(*type == 'v' ? "floatBitsToUint(a)" : "uvec4(a)").append("; gl_Position = vec4(0); }");
    draw.topology = VK_PRIMITIVE_TOPOLOGY_POINT_LIST;
    draw.dynamic = {VK_DYNAMIC_STATE_VERTEX_INPUT_EXT};
    render(draw, [&](VkCommandBuffer commands) {
      auto binding = make_struct<VkVertexInputBindingDescription2EXT>();
      binding.stride = stride;
      binding.divisor = 1;
      auto attribute = make_struct<VkVertexInputAttributeDescription2EXT>();
      attribute.format = format;
      attribute.offset = attribute_offset;
      VK_CALL(CmdSetVertexInputEXT)(commands, 1, &binding, 1, &attribute);
      VK_CALL(CmdBindVertexBuffers)(commands, 0, 1, &bytes.buffer, &offset);
      VK_CALL(CmdDraw)(commands, kVertices, 1, 0, 0);
    });
    return words(kVertices * 4);
  }
};

TEST_F(LegacyVertexAttributes, AreOffered) {
  auto features = make_struct<VkPhysicalDeviceLegacyVertexAttributesFeaturesEXT>();
  auto all = make_struct<VkPhysicalDeviceFeatures2>(&features);
  VK_CALL(GetPhysicalDeviceFeatures2)(physical_device, &all);
  EXPECT_TRUE(features.legacyVertexAttributes);
  auto properties = make_struct<VkPhysicalDeviceLegacyVertexAttributesPropertiesEXT>();
  auto whole = make_struct<VkPhysicalDeviceProperties2>(&properties);
  VK_CALL(GetPhysicalDeviceProperties2)(physical_device, &whole);
  EXPECT_TRUE(properties.nativeUnalignedPerformance);
}

/// As from a buffer where the same elements lie aligned.
TEST_F(LegacyVertexAttributes, LieAnywhere) {
  struct Kind {
    const char* type;
    VkFormat format;
    std::uint32_t bytes;
  };
  const Kind kinds[] = {{"uvec4", VK_FORMAT_R32_UINT, 4},          {"vec4", VK_FORMAT_R32G32B32A32_SFLOAT, 16},
                        {"vec4", VK_FORMAT_R16G16_SNORM, 4},       {"vec4", VK_FORMAT_A2B10G10R10_UNORM_PACK32, 4},
                        {"ivec4", VK_FORMAT_R16G16B16A16_SINT, 8}, {"vec4", VK_FORMAT_R8G8B8A8_UNORM, 4}};
  const Bytes apart = make_bytes(1024);
  for (std::size_t i = 0; i < apart.size; ++i) apart.data[i] = static_cast<std::byte>(i * 2654435761u >> 13 & 0x3f);
  for (const Kind& kind : kinds)
    for (const std::uint32_t stride : {1u, 3u, 7u, 17u, 33u})
      for (const std::uint32_t offset : {0u, 1u, 7u}) {
        const Bytes aligned = make_bytes(kVertices * 16);
        for (std::uint32_t i = 0; i < kVertices; ++i)
          std::memcpy(aligned.data + i * 16, apart.data + offset + 5 + i * stride, kind.bytes);
        EXPECT_EQ(fetched(kind.type, kind.format, apart, offset, 5, stride),
                  fetched(kind.type, kind.format, aligned, 0, 0, 16))
            << kind.format << ", stride " << stride << ", offset " << offset;
      }
}

/// Vulkan 1.4.309, VkPhysicalDeviceLegacyVertexAttributesFeaturesEXT: only floats and integers do not mix; of what is
/// signed the bits are those of the format's number in 32 bits.
TEST_F(LegacyVertexAttributes, SignsNeedNotMatch) {
  const Bytes bytes = make_bytes(64);
  for (std::size_t i = 0; i < bytes.size; ++i) bytes.data[i] = static_cast<std::byte>(i * 37 + 100);
  for (const auto& [format, other] : {std::pair{"ivec4", "uvec4"}, std::pair{"uvec4", "ivec4"}}) {
    EXPECT_EQ(fetched(format, VK_FORMAT_R8_UINT, bytes, 0, 0, 1), fetched(other, VK_FORMAT_R8_UINT, bytes, 0, 0, 1));
    EXPECT_EQ(fetched(format, VK_FORMAT_R8_SINT, bytes, 0, 0, 1), fetched(other, VK_FORMAT_R8_SINT, bytes, 0, 0, 1));
  }
  const auto plain = fetched("ivec4", VK_FORMAT_R8_UINT, bytes, 0, 0, 1);
  const auto extended = fetched("uvec4", VK_FORMAT_R8_SINT, bytes, 0, 0, 1);
  for (std::uint32_t i = 0; i < kVertices; ++i) {
    const auto byte = static_cast<std::uint8_t>(i * 37 + 100);
    EXPECT_EQ(plain[i * 4], byte);
    EXPECT_EQ(extended[i * 4], static_cast<std::uint32_t>(static_cast<std::int8_t>(byte)));
  }
}

}  // namespace
}  // namespace vitrine::icd::test
#endif
