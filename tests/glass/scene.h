// One shader of any stage with resources around it, observed by a tool, without a device. Eight invocations run it: of
// a workgroup, vertices of points, control points of a patch, points of an isoline, points of a geometry shader, pixels
// of a row.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <map>

#include "glass/memory_shadow.h"
#include "glass/tools.h"
#include "raster/pass.h"
#include "spirv/addresses.h"
#include "spirv/observed_command.h"
#include "tests/glass/kept_catalogue.h"
#include "tests/glass/observed.h"

namespace vitrine::glass::test {

/// An image of 4 x 4 words.
struct Image {
  Image(VkImageViewType type, VkFormat format, std::uint32_t levels, std::uint32_t layers) {
    texel::ImageDesc desc;
    desc.format = format;
    desc.extent = {4, 4, 1};
    desc.levels = levels;
    desc.layers = layers;
    EXPECT_TRUE(texel::make_image_layout(desc, layout));
    words.resize(layout.size / 4 + 16);
    texel::ImageViewDesc view_desc;
    view_desc.type = type;
    view_desc.format = format;
    view_desc.level_count = levels;
    view_desc.layer_count = layers;
    view = texel::make_image_view(layout, reinterpret_cast<std::byte*>(words.data()), view_desc);
  }
  texel::ImageLayout layout;
  std::vector<std::uint32_t> words;
  texel::ImageView view;
};

/// Of the push constants five words are in the layout, and the first four have been set. What a descriptor named is
/// gone, and what lay at some addresses.
struct SceneCommand : spirv::ObservedCommand {
  SceneCommand() { pushed = 0xf; }
  std::string resource(std::uint32_t, std::uint32_t) const override { return {}; }
  std::uint64_t push_range(VkShaderStageFlagBits) const override { return 0x1f; }
  std::string departed(std::uint32_t, std::uint32_t slot) const override { return slot == gone_slot ? kGone : ""; }
  std::string departed(std::uint64_t address) const override { return address - gone_address < 256 ? kGone : ""; }
  static constexpr char kGone[] = "buffer 'old', destroyed after submission 3";
  std::uint32_t gone_slot = ~0u;
  std::uint64_t gone_address = 0;  ///< of 256 bytes
};

/// While it lives, nothing has written some memory but its first bytes.
struct Unwritten {
  Unwritten(const void* memory, std::uint64_t size, std::uint64_t written)
      : first(static_cast<const std::byte*>(memory)) {
    add_shadow(first, size);
    find_shadow(first)->fill(reinterpret_cast<std::uintptr_t>(first), written, ByteState::kWritten);
  }
  ~Unwritten() { remove_shadow(first); }
  Unwritten(const Unwritten&) = delete;
  const std::byte* first;
};

/// Set 0: 64 words that hold their numbers (binding 0), a texture with two levels (1), a storage image (2), one with
/// two layers (3), a texel buffer of 8 texels (4), nothing (5), three storage images of which the last is not there
/// (6), four buffers (7), a combined image sampler of floats (8), 64 words of which the first 32 are written (9), a
/// storage image and a texture of which the first row is (10, 11), a buffer that is gone (12). Push constants: the
/// address of 64 words (two words; another buffer was 512 bytes behind), then words that hold 1, 2...
class Scene {
 public:
  Scene() {
    for (std::uint32_t i = 0; i < 64; ++i) words_[i] = i;
    for (std::uint32_t i = 2; i < push_.size(); ++i) push_[i] = i - 1;
    const auto* memory = reinterpret_cast<const std::byte*>(memory_.data());
    spirv::add_addresses(memory, sizeof(memory_));
    const auto address = reinterpret_cast<std::uintptr_t>(memory);
    push_[0] = static_cast<std::uint32_t>(address);
    push_[1] = static_cast<std::uint32_t>(std::uint64_t{address} >> 32);
    add(VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, {buffer(words_)});
    add(VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, {image(flat_)});
    add(VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, {image(flat_)});
    add(VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, {image(layered_)});
    spirv::Descriptor texels;
    texels.texels = &texels_;
    add(VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER, {texels});
    add(VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, {{}});
    add(VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, {image(flat_), image(flat_), {}});
    add(VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, {buffer(other_), buffer(other_), buffer(other_), buffer(other_)});
    spirv::Descriptor sampled = image(floats_);
    sampled.sampler = &sampler_;
    add(VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, {sampled});
    add(VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, {buffer(fresh_)});
    add(VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, {image(fresh_image_)});
    add(VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, {image(fresh_image_)});
    command_.gone_slot = static_cast<std::uint32_t>(descriptors_.size());
    command_.gone_address = address + 512;
    add(VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, {{}});
    table_.set[0] = descriptors_.data();
    table_.set_size[0] = static_cast<std::uint32_t>(descriptors_.size());
    table_.push_constants = reinterpret_cast<const std::byte*>(push_.data());
    table_.command = &command_;
  }
  ~Scene() { spirv::remove_addresses(reinterpret_cast<const std::byte*>(memory_.data())); }
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  std::uint32_t groups = 1;  ///< workgroups of a dispatch

  /// Runs the module as the shader of `stage`, observed by the tool.
  void run(Tool& tool, VkShaderStageFlagBits stage, const std::vector<std::uint32_t>& module) {
    const Unwritten words(fresh_.data(), sizeof(fresh_), sizeof(fresh_) / 2);
    const Unwritten texels(fresh_image_.words.data(), fresh_image_.layout.size, std::uint64_t{4} * 4);
    run_shader(tool, stage, module);
    tool.commands_done(command_.owner);
  }

 private:
  void run_shader(Tool& tool, VkShaderStageFlagBits stage, const std::vector<std::uint32_t>& module) {
    const auto shader =
        compile(stage, module, std::make_shared<ToolObserver>(tool, ShaderIdentity{stage, "main", module}));
    if (!shader) return;
    if (stage != VK_SHADER_STAGE_COMPUTE_BIT) return draw(stage, *shader);
    spirv::Fault fault;
    const spirv::BoundShader bound(*shader, table_, fault);
    const std::uint32_t base[3] = {0, 0, 0}, counts[3] = {groups, 1, 1};
    spirv::dispatch(bound, base, counts);
    EXPECT_FALSE(fault.raised) << fault.message;
  }

  using Words = std::array<std::uint32_t, 64>;

  static spirv::Descriptor buffer(Words& words) {
    spirv::Descriptor descriptor;
    descriptor.data = reinterpret_cast<std::byte*>(words.data());
    descriptor.size = sizeof(words);
    return descriptor;
  }
  static spirv::Descriptor image(const Image& image) {
    spirv::Descriptor descriptor;
    descriptor.image = &image.view;
    return descriptor;
  }
  void add(VkDescriptorType type, std::initializer_list<spirv::Descriptor> descriptors) {
    spirv::BindingInfo info;
    info.binding = static_cast<std::uint32_t>(set_.bindings.size());
    info.first_slot = static_cast<std::uint32_t>(descriptors_.size());
    info.type = type;
    info.count = static_cast<std::uint32_t>(descriptors.size());
    set_.bindings.push_back(info);
    descriptors_.insert(descriptors_.end(), descriptors);
  }

  std::unique_ptr<spirv::Shader> compile(VkShaderStageFlagBits stage, const std::vector<std::uint32_t>& module,
                                         std::shared_ptr<const spirv::exec::Observer> observer) {
    spirv::CompileOptions options;
    options.stage = stage;
    options.sets = {set_};
    options.observer = std::move(observer);
    auto shader = spirv::compile(module, options);
    EXPECT_TRUE(shader) << shader.message();
    return shader ? std::move(shader.value()) : nullptr;
  }

  /// What stands in the other stages: made once.
  const spirv::Shader* plain(VkShaderStageFlagBits stage, const char* text) {
    static std::map<VkShaderStageFlagBits, std::unique_ptr<spirv::Shader>> made;
    std::unique_ptr<spirv::Shader>& shader = made[stage];
    if (shader) return shader.get();
    std::string log;
    const auto module = vitrine::test::compile_glsl(stage, text, vitrine::test::VulkanVersion::k12, log);
    EXPECT_FALSE(module.empty()) << log;
    keep_plain(stage, module);
    shader = compile(stage, module, nullptr);
    return shader.get();
  }

  void draw(VkShaderStageFlagBits stage, const spirv::Shader& shader) {
    const bool tessellates =
        stage == VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT || stage == VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT;
    const bool fragments = stage == VK_SHADER_STAGE_FRAGMENT_BIT;
    raster::State state;
    state.topology = tessellates ? VK_PRIMITIVE_TOPOLOGY_PATCH_LIST
                     : fragments ? VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST
                                 : VK_PRIMITIVE_TOPOLOGY_POINT_LIST;
    state.patch_control_points = tessellates ? 1 : 0;
    state.viewport[0] = {0, 0, kPixels, 1, 0, 1};
    state.scissor[0] = {{0, 0}, {kPixels, 1}};
    spirv::Fault fault;
    raster::DrawCall call;
    const auto stage_of = [&](VkShaderStageFlagBits which, const char* text) {
      return stage == which ? &shader : plain(which, text);
    };
    call.state = &state;
    call.vertex = stage_of(VK_SHADER_STAGE_VERTEX_BIT, kVertex);
    if (tessellates) {
      call.control = stage_of(VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT, kControl);
      call.evaluation = stage_of(VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT, kEvaluation);
    }
    if (stage == VK_SHADER_STAGE_GEOMETRY_BIT) call.geometry = &shader;
    call.fragment = stage_of(VK_SHADER_STAGE_FRAGMENT_BIT, kFragment);
    call.vertex_resources = call.fragment_resources = table_;
    call.fault = &fault;
    call.count = tessellates ? 1 : fragments ? 3 : 8;
    raster::PassDesc desc;
    desc.color[0].base = reinterpret_cast<std::byte*>(color_.data());
    desc.color[0].format = &texel::format_desc(VK_FORMAT_R32G32B32A32_SFLOAT);
    desc.color[0].level[0].extent = {kPixels, 1, 1};
    desc.color[0].level[0].row_pitch = sizeof(color_);
    desc.color_count = 1;
    desc.render_area = {{0, 0}, {kPixels, 1}};
    raster::Pass pass(desc);
    pass.draw(call);
    pass.flush();
    EXPECT_FALSE(fault.raised) << fault.message;
  }

  static constexpr std::uint32_t kPixels = 8;
  static constexpr char kVertex[] = R"(#version 460
void main() {
  gl_Position = vec4(4.0 * vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1 & 1) - 1.0, 0.5, 1.0);
  gl_PointSize = 1.0;
})";
  static constexpr char kControl[] = R"(#version 460
layout(vertices = 8) out;
void main() {
  gl_out[gl_InvocationID].gl_Position = vec4(0.0, 0.0, 0.5, 1.0);
  gl_TessLevelOuter[0] = 1.0;
  gl_TessLevelOuter[1] = 7.0;
})";
  static constexpr char kEvaluation[] = R"(#version 460
layout(isolines) in;
void main() { gl_Position = vec4(0.0, 0.0, 0.5, 1.0); })";
  static constexpr char kFragment[] = R"(#version 460
layout(location = 0) out vec4 color;
void main() { color = vec4(1.0); })";

  alignas(16) Words fresh_{}, words_{}, other_{}, memory_{};
  alignas(16) std::array<std::uint32_t, spirv::kMaxPushConstantBytes / 4> push_{};
  Image flat_{VK_IMAGE_VIEW_TYPE_2D, VK_FORMAT_R32_UINT, 2, 1};
  Image layered_{VK_IMAGE_VIEW_TYPE_2D_ARRAY, VK_FORMAT_R32_UINT, 1, 2};
  Image fresh_image_{VK_IMAGE_VIEW_TYPE_2D, VK_FORMAT_R32_UINT, 1, 1};
  Image floats_{VK_IMAGE_VIEW_TYPE_2D, VK_FORMAT_R32_SFLOAT, 1, 1};
  std::array<std::uint32_t, 8> texel_words_{};
  texel::BufferTexelView texels_{reinterpret_cast<std::byte*>(texel_words_.data()), 8,
                                 &texel::format_desc(VK_FORMAT_R32_UINT)};
  texel::Sampler sampler_;
  std::array<float, 4 * kPixels> color_{};
  SceneCommand command_;
  spirv::SetLayoutInfo set_;
  std::vector<spirv::Descriptor> descriptors_;
  spirv::ResourceTable table_;
};

}  // namespace vitrine::glass::test
