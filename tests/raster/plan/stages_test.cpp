// What a draw's plan takes from its stages together.
#include "raster/plan/stages.h"

#include <gtest/gtest.h>

#include <memory>

#include "raster/plan/make_plan.h"
#include "raster/stage.h"
#include "spirv/program.h"

namespace vitrine::raster {
namespace {

spirv::StageModes tessellation_modes(const spirv::StageModes& control, const spirv::StageModes& evaluation) {
  const auto stage = [](VkShaderStageFlagBits bit, const spirv::StageModes& modes) {
    spirv::ShaderInterface interface;
    interface.stage = bit;
    interface.modes = modes;
    return spirv::Shader(interface, std::make_unique<const spirv::Program>());
  };
  const spirv::Shader first = stage(VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT, control);
  const spirv::Shader second = stage(VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT, evaluation);
  NativeShader vertex;
  State state;
  state.topology = VK_PRIMITIVE_TOPOLOGY_PATCH_LIST;
  state.patch_control_points = 3;
  DrawCall draw;
  draw.state = &state;
  draw.native_vertex = &vertex;
  draw.control = &first;
  draw.evaluation = &second;
  const auto plan = std::make_unique<PipelinePlan>();
  EXPECT_TRUE(make_plan(draw, PassDesc(), *plan));
  return plan->stages.tessellation;
}

TEST(Plan, TessellationModesOfEitherStageHold) {
  spirv::StageModes control, evaluation;
  control.control_points = 3;
  control.has_spacing = control.has_order = true;
  control.spacing = spirv::TessSpacing::kFractionalOdd;
  EXPECT_EQ(tessellation_modes(control, evaluation).spacing, spirv::TessSpacing::kFractionalOdd);
  EXPECT_FALSE(tessellation_modes(control, evaluation).clockwise);
  evaluation.has_spacing = evaluation.has_order = evaluation.clockwise = true;
  EXPECT_EQ(tessellation_modes(control, evaluation).spacing, spirv::TessSpacing::kEqual);
  EXPECT_TRUE(tessellation_modes(control, evaluation).clockwise);
}

/// Those of the reference.
TEST(Plan, TessellationModesThatNoStageNames) {
  spirv::StageModes control;
  control.control_points = 3;
  const spirv::StageModes modes = tessellation_modes(control, {});
  EXPECT_EQ(modes.spacing, spirv::TessSpacing::kFractionalEven);
  EXPECT_TRUE(modes.clockwise);
}

}  // namespace
}  // namespace vitrine::raster
