// Addresses as text, as far as they are known.
#include "glass/finding.h"

#include <gtest/gtest.h>

namespace vitrine::glass {
namespace {

TEST(Finding, AddressNamesEverythingThatIsKnown) {
  Address address;
  EXPECT_EQ(to_text(address), "");
  address.stage = VK_SHADER_STAGE_FRAGMENT_BIT;
  EXPECT_EQ(to_text(address), "fragment shader");
  address.invocation = {Invocation::Kind::kFragment, {3, 7, 0}};
  EXPECT_EQ(to_text(address), "fragment shader, pixel (3, 7)");
  address = {1, 3, "vkCmdDispatch", {"blur", "horizontal"}, "gauss", "main", VK_SHADER_STAGE_COMPUTE_BIT, {}, 0, {}};
  address.invocation = {Invocation::Kind::kCompute, {5, 0, 0}};
  EXPECT_EQ(to_text(address),
            "submission 1, command 3 (vkCmdDispatch) in 'blur' > 'horizontal', pipeline 'gauss', compute shader main, "
            "invocation (5, 0, 0)");
}

TEST(Finding, AddressLeavesOutWhatIsUnknown) {
  Address address;
  address.labels = {"frame"};
  EXPECT_EQ(to_text(address), "in 'frame'");
  address.command_name = "vkCmdDraw";
  EXPECT_EQ(to_text(address), "vkCmdDraw in 'frame'");
  address.labels.clear();
  address.shader = "main";
  EXPECT_EQ(to_text(address), "vkCmdDraw, shader main");
}

TEST(Finding, InvocationsAreNumbersOfTheirStage) {
  EXPECT_EQ(to_text(Invocation{Invocation::Kind::kVertex, {9, 2, 0}}), "vertex 9 of instance 2");
  EXPECT_EQ(to_text(Invocation{Invocation::Kind::kControl, {4, 7, 0}}), "vertex 4 of patch 7");
  EXPECT_EQ(to_text(Invocation{Invocation::Kind::kEvaluation, {4, 7, 2}}), "domain point 4 of patch 7 of instance 2");
  EXPECT_EQ(to_text(Invocation{Invocation::Kind::kGeometry, {0, 7, 0}}), "invocation 0 of primitive 7");
}

TEST(Finding, FramesEndWhereKnowledgeDoes) {
  EXPECT_EQ(to_text(Frame{"main", "a.comp", 3, 5, ""}), "a.comp:3:5");
  EXPECT_EQ(to_text(Frame{"main", "a.comp", 3, 0, ""}), "a.comp:3");
  EXPECT_EQ(to_text(Frame{"main", "a.comp", 0, 5, ""}), "a.comp");
}

}  // namespace
}  // namespace vitrine::glass
