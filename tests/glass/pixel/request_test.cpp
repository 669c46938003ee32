// Texels as VITRINE_PIXEL names them.
#include "glass/pixel/request.h"

#include <gtest/gtest.h>

namespace vitrine::glass::pixel {
namespace {

TEST(PixelRequest, APointIsAllThatIsNeeded) {
  std::string error;
  const auto requests = parse_requests("320,240", error);
  ASSERT_TRUE(requests && requests->size() == 1) << error;
  const Request& one = (*requests)[0];
  EXPECT_EQ(one.image, "swapchain");
  EXPECT_EQ(one.x0, 320);
  EXPECT_EQ(one.y1, 240);
  EXPECT_FALSE(one.sample.has_value());
}

TEST(PixelRequest, EverythingCanBeSaid) {
  std::string error;
  const auto requests =
      parse_requests("1,2-3,4:image=a%3Ab%3Bc%25:aspect=depth:level=5:layer=6:slice=7:sample=8;;9,10:image=#3;", error);
  ASSERT_TRUE(requests && requests->size() == 2) << error;
  const Request& one = (*requests)[0];
  EXPECT_EQ(one.image, "a:b;c%");
  EXPECT_EQ(one.aspect, VkImageAspectFlags{VK_IMAGE_ASPECT_DEPTH_BIT});
  EXPECT_EQ(one.x1, 3);
  EXPECT_EQ(one.level, 5u);
  EXPECT_EQ(one.layer, 6u);
  EXPECT_EQ(one.slice, 7u);
  EXPECT_EQ(one.sample, 8u);
  EXPECT_EQ((*requests)[1].image, "#3");
}

TEST(PixelRequest, NothingElseIsTaken) {
  for (const char* text :
       {"1", "1,", ",1", "a,b", "1,2-", "1,2-3", "-1,2", "1,2:", "1,2:level", "1,2:level=", "1,2:x=1", "1,2:aspect=red",
        "1,2:image=", "1,2 ", "99999999999999999999,1", "1,2:level=-1"}) {
    std::string error;
    EXPECT_FALSE(parse_requests(text, error)) << text;
    EXPECT_NE(error.find("names no texels"), std::string::npos) << text;
  }
}

TEST(PixelRequest, EscapedNamesComeBack) {
  std::string error;
  const std::string name = "x:y;z%20";
  const auto requests = parse_requests("0,0:image=" + escaped(name), error);
  ASSERT_TRUE(requests && requests->size() == 1) << error;
  EXPECT_EQ((*requests)[0].image, name);
}

TEST(PixelRequest, PrimitivesAreOfAllInstancesOrOfOne) {
  const auto all = parse_primitive("7");
  ASSERT_TRUE(all);
  EXPECT_EQ(all->primitive, 7u);
  EXPECT_FALSE(all->instance);
  const auto one = parse_primitive("7@0");
  ASSERT_TRUE(one);
  EXPECT_EQ(one->primitive, 7u);
  EXPECT_EQ(one->instance, 0u);
  for (const char* text : {"", "@", "7@", "@3", "7@x", "7@3@1", "-1", "7 ", "99999999999"})
    EXPECT_FALSE(parse_primitive(text)) << text;
}

}  // namespace
}  // namespace vitrine::glass::pixel
