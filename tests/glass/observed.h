// Compute shaders that tools observe, without a device around them.
#pragma once

#include <gtest/gtest.h>

#include "glass/tools.h"
#include "tests/glsl/compile.h"
#include "tests/spirv/buffers.h"

namespace vitrine::glass::test {

/// One tool as the observer of one shader.
class ToolObserver : public spirv::exec::Observer {
 public:
  ToolObserver(Tool& tool, ShaderIdentity shader) : tool_(tool), shader_(shader) {}
  spirv::exec::Interest interest() const override { return tool_.interest(); }
  spirv::exec::Interest rehearsed() const override { return tool_.rehearsed(); }
  void made(const spirv::Program& program) const override { program_ = tool_.attach(shader_, program); }
  void draw(const raster::DrawCall& call) const { program_->draw(call); }
  bool in_order() const override { return program_ && program_->in_order(); }
  spirv::exec::Watch* lasting_watch() const override { return program_ ? program_->lasting_watch() : nullptr; }
  std::unique_ptr<spirv::exec::Watch> watch(const spirv::Wave& wave, const spirv::Instruction* start) const override {
    return program_ ? program_->watch(wave, start) : nullptr;
  }

 private:
  Tool& tool_;
  ShaderIdentity shader_;
  mutable std::shared_ptr<ProgramTool> program_;
};

/// Runs `groups` workgroups of a compute shader over `words`, binding 0 of set 0; with `tool`, if there is one.
inline void run_observed(Tool* tool, const std::vector<std::uint32_t>& module, std::vector<std::uint32_t>& words,
                         std::uint32_t groups) {
  spirv::CompileOptions options;
  options.stage = VK_SHADER_STAGE_COMPUTE_BIT;
  spirv::SetLayoutInfo set;
  spirv::BindingInfo buffer;
  buffer.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
  set.bindings = {buffer};
  options.sets = {set};
  if (tool != nullptr)
    options.observer = std::make_shared<ToolObserver>(*tool, ShaderIdentity{options.stage, "main", module});
  ASSERT_TRUE(spirv::test::dispatch_over(words, module, options, groups));
}

/// The same with a shader in GLSL.
inline void run_observed(Tool* tool, const std::string& glsl, std::vector<std::uint32_t>& words, std::uint32_t groups) {
  std::string log;
  const std::vector<std::uint32_t> module =
      vitrine::test::compile_glsl(VK_SHADER_STAGE_COMPUTE_BIT, glsl, vitrine::test::VulkanVersion::k12, log);
  ASSERT_FALSE(module.empty()) << log;
  run_observed(tool, module, words, groups);
}

/// "rule xCOUNT at INVOCATION: message" of each finding.
inline std::vector<std::string> texts_of(Tool& tool) {
  std::vector<std::string> texts;
  for (const Finding& finding : tool.take_findings())
    texts.push_back(std::string(finding.rule->id) + " x" + std::to_string(finding.count) + " at " +
                    std::to_string(finding.address.invocation.id[0]) + ": " + finding.message);
  return texts;
}

/// What sanitize finds in one workgroup of a compute shader with these resources, whose set 0 is laid out so.
inline std::vector<std::string> found_with(const spirv::ResourceTable& resources, const spirv::SetLayoutInfo& set,
                                           const std::string& glsl) {
  std::string log;
  const auto module =
      vitrine::test::compile_glsl(VK_SHADER_STAGE_COMPUTE_BIT, glsl, vitrine::test::VulkanVersion::k12, log);
  EXPECT_FALSE(module.empty()) << log;
  const auto tool = make_sanitize();
  spirv::CompileOptions options;
  options.stage = VK_SHADER_STAGE_COMPUTE_BIT;
  options.sets = {set};
  options.observer = std::make_shared<ToolObserver>(*tool, ShaderIdentity{options.stage, "main", module});
  const auto shader = spirv::compile(module, options);
  EXPECT_TRUE(shader) << shader.message();
  if (!shader) return {};
  spirv::Fault fault;
  const spirv::BoundShader bound(*shader.value(), resources, fault);
  const std::uint32_t base[3] = {0, 0, 0}, counts[3] = {1, 1, 1};
  spirv::dispatch(bound, base, counts);
  return texts_of(*tool);
}

}  // namespace vitrine::glass::test
