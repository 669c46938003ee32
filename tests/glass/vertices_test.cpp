// What sanitize says of vertices and indices that a draw fetches from outside of its buffers, and what it does not.
#include <cstring>

#include "raster/draw.h"
#include "spirv/observed_command.h"
#include "tests/glass/observed.h"

namespace vitrine::glass::test {
namespace {

using Texts = std::vector<std::string>;

class Command : public spirv::ObservedCommand {
 public:
  std::string resource(std::uint32_t, std::uint32_t) const override { return {}; }
};

/// A draw of vertices with a position at location 0 (binding 0, 12 bytes, stride 16) and a colour a vertex or instance
/// at location 2 (binding 1, 4 bytes). The buffers have room for 4 of each.
class Vertices : public ::testing::Test {
 protected:
  void SetUp() override {
    static const std::string kShader =
        "#version 450\n"
        "layout(location = 0) in vec3 position;\n"
        "layout(location = 2) in vec4 color;\n"
        "layout(location = 0) out vec4 result;\n"
        "void main() { gl_Position = vec4(position, 1); result = color; }\n";
    std::string log;
    module_ = vitrine::test::compile_glsl(VK_SHADER_STAGE_VERTEX_BIT, kShader, vitrine::test::VulkanVersion::k12, log);
    ASSERT_FALSE(module_.empty()) << log;
    spirv::CompileOptions options;
    options.stage = VK_SHADER_STAGE_VERTEX_BIT;
    observer_ = std::make_shared<ToolObserver>(*tool_, ShaderIdentity{options.stage, "main", module_});
    options.observer = observer_;
    auto compiled = spirv::compile(module_, options);
    ASSERT_TRUE(compiled) << compiled.message();
    shader_ = std::move(compiled.value());
    state.attribute_count = 3;
    state.attribute[0] = {0, 0, VK_FORMAT_R32G32B32_SFLOAT, 0};
    state.attribute[1] = {2, 1, VK_FORMAT_R8G8B8A8_UNORM, 0};
    state.attribute[2] = {1, 2, VK_FORMAT_R32_SFLOAT, 0};  // bound to nothing, and not read
    call.state = &state;
    call.vertex = shader_.get();
    call.vertex_resources.command = &command;
    call.vertex_binding[0] = {bytes, 60, 16, false, 1};
    call.vertex_binding[1] = {bytes, 16, 4, false, 1};
    call.count = 4;
  }

  /// What is found in the draw.
  Texts found() {
    observer_->draw(call);
    return texts_of(*tool_);
  }
  template <class T>
  void use_indices(const std::vector<T>& indices, VkIndexType type) {
    std::memcpy(index_bytes, indices.data(), indices.size() * sizeof(T));
    call.index_data = index_bytes;
    call.index_bytes = indices.size() * sizeof(T);
    call.index_type = type;
    call.count = static_cast<std::uint32_t>(indices.size());
  }

  std::byte bytes[64] = {}, index_bytes[64] = {};
  Command command;
  raster::State state;
  raster::DrawCall call;

 private:
  std::unique_ptr<Tool> tool_ = make_sanitize();
  std::vector<std::uint32_t> module_;
  std::shared_ptr<const ToolObserver> observer_;
  std::shared_ptr<const spirv::Shader> shader_;
};

TEST_F(Vertices, AreFineUpToTheLastByte) {
  EXPECT_EQ(found(), Texts{});
  call.first = 1, call.count = 3;
  EXPECT_EQ(found(), Texts{});
  use_indices<std::uint16_t>({0, 3, 2, 1}, VK_INDEX_TYPE_UINT16);
  call.first = 0;
  EXPECT_EQ(found(), Texts{});
}

TEST_F(Vertices, OfWhichTheLastByteIsMissing) {
  call.vertex_binding[0].size = 59;
  EXPECT_EQ(found(),
            Texts{"out-of-bounds-vertex x1 at 3: attribute at location 0 (R32G32B32_SFLOAT) of vertex 3 needs "
                  "12 bytes at offset 48, outside of vertex buffer 59 bytes in binding 0 with a stride of 16"});
}

TEST_F(Vertices, BehindTheBufferCountForEachInstance) {
  call.first = 3, call.count = 3, call.instance_count = 2;
  const Texts texts = found();
  ASSERT_EQ(texts.size(), 2u);
  EXPECT_EQ(texts[0].substr(0, 30), "out-of-bounds-vertex x4 at 4: ");
  EXPECT_EQ(texts[1].substr(0, 56), "out-of-bounds-vertex x4 at 4: attribute at location 2 (R");
  EXPECT_EQ(found(), Texts{}) << "a place is told once";
}

TEST_F(Vertices, OfStrideZeroAreAllTheSame) {
  call.vertex_binding[0].stride = call.vertex_binding[1].stride = 0;
  call.count = 1000;
  EXPECT_EQ(found(), Texts{});
}

TEST_F(Vertices, OfInstancesGoByTheDivisor) {
  call.vertex_binding[1].per_instance = true;
  call.vertex_binding[1].divisor = 2;
  call.instance_count = 8;
  EXPECT_EQ(found(), Texts{});
  call.vertex_binding[1].divisor = 0;
  call.instance_count = 1000;
  EXPECT_EQ(found(), Texts{});
  call.vertex_binding[1].divisor = 2;
  call.first_instance = 1;
  call.instance_count = 9;
  EXPECT_EQ(found(),
            Texts{"out-of-bounds-vertex x3 at 0: attribute at location 2 (R8G8B8A8_UNORM) of instance element 4 "
                  "needs 4 bytes at offset 16, outside of vertex buffer 16 bytes in binding 1 with a stride of "
                  "4"});
}

TEST_F(Vertices, OfIndicesAreLookedUp) {
  use_indices<std::uint8_t>({0, 1, 9, 1, 7}, VK_INDEX_TYPE_UINT8_EXT);
  const Texts texts = found();
  ASSERT_EQ(texts.size(), 2u);
  EXPECT_EQ(texts[0].substr(0, 30), "out-of-bounds-vertex x2 at 9: ");
}

TEST_F(Vertices, WithAnOffsetBelowZeroWrap) {
  use_indices<std::uint32_t>({3, 2, 1}, VK_INDEX_TYPE_UINT32);
  call.vertex_offset = -1;
  EXPECT_EQ(found(), Texts{});
  call.vertex_offset = -2;
  const Texts texts = found();
  ASSERT_EQ(texts.size(), 2u);
  EXPECT_NE(texts[0].find("of vertex -1 needs 12 bytes"), std::string::npos) << texts[0];
}

TEST_F(Vertices, RestartIsNoVertex) {
  use_indices<std::uint16_t>({0, 1, 2, 0xffff, 1, 2, 3}, VK_INDEX_TYPE_UINT16);
  state.primitive_restart = true;
  EXPECT_EQ(found(), Texts{});
  state.primitive_restart = false;
  EXPECT_EQ(found().size(), 2u);
}

TEST_F(Vertices, IndicesUpToTheLastByteAreFine) {
  use_indices<std::uint16_t>({0, 1, 2}, VK_INDEX_TYPE_UINT16);
  EXPECT_EQ(found(), Texts{});
  call.first = 2, call.count = 1;
  EXPECT_EQ(found(), Texts{});
}

TEST_F(Vertices, IndicesOutsideAreTold) {
  use_indices<std::uint16_t>({0, 1, 2}, VK_INDEX_TYPE_UINT16);
  call.first = 1, call.count = 6;
  EXPECT_EQ(found(), Texts{"out-of-bounds-index x4 at 3: index 3 of 2 bytes lies outside of index buffer 6 bytes"});
  call.first = 7, call.count = 2;
  call.index_bytes = 0;
  EXPECT_EQ(found(), Texts{}) << "a place is told once";
}

TEST_F(Vertices, WithoutABufferAreTold) {
  call.vertex_binding[1] = {};
  EXPECT_EQ(found(), Texts{"null-descriptor x4 at 0: attribute at location 2 (R8G8B8A8_UNORM) is fetched from binding "
                           "1, where no bytes of a vertex buffer are bound"});
}

TEST_F(Vertices, MayBeMissingWhereFeaturesSaySo) {
  call.vertex_binding[1] = {};
  command.null_descriptors = true;
  EXPECT_EQ(found(), Texts{});
  command.robust_vertices = true;
  call.count = 1000;
  EXPECT_EQ(found(), Texts{});
}

TEST_F(Vertices, IndicesMayBeMissingWhereFeaturesSaySo) {
  use_indices<std::uint16_t>({0, 1, 2}, VK_INDEX_TYPE_UINT16);
  call.index_bytes = 0;
  command.null_descriptors = true;
  EXPECT_EQ(found(), Texts{}) << "each is 0";
  command.null_descriptors = false;
  EXPECT_EQ(found().size(), 1u);
}

TEST_F(Vertices, OfNothingNeedNothing) {
  call.first = 1000;
  call.count = 0;
  EXPECT_EQ(found(), Texts{});
  call.count = 1;
  call.instance_count = 0;
  EXPECT_EQ(found(), Texts{});
}

}  // namespace
}  // namespace vitrine::glass::test
