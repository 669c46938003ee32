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
  void made(const spirv::Program& program) const override { program_ = tool_.attach(shader_, program); }
  std::unique_ptr<spirv::exec::Watch> watch(const spirv::Wave& wave, const spirv::Instruction* start) const override {
    return program_ ? program_->watch(wave, start) : nullptr;
  }

 private:
  Tool& tool_;
  ShaderIdentity shader_;
  mutable std::shared_ptr<ProgramTool> program_;
};

/// Runs `groups` workgroups of a compute shader over `words`, binding 0 of set 0; with `tool`, if there is one.
inline void run_observed(Tool* tool, const std::string& glsl, std::vector<std::uint32_t>& words, std::uint32_t groups) {
  std::string log;
  const std::vector<std::uint32_t> module =
      vitrine::test::compile_glsl(VK_SHADER_STAGE_COMPUTE_BIT, glsl, vitrine::test::VulkanVersion::k12, log);
  ASSERT_FALSE(module.empty()) << log;
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

}  // namespace vitrine::glass::test
