// Places of shaders as frames with the text of their lines.
#include "glass/place.h"

#include <gtest/gtest.h>

namespace vitrine::glass {
namespace {

spirv::SourceInfo two_lines(const char* text) {
  spirv::SourceInfo sources;
  sources.files.push_back({"a.comp", text});
  sources.scopes.push_back({});
  sources.places.push_back({.file = 1, .line = 1, .column = 0, .scope = 1});
  sources.places.push_back({.file = 1, .line = 2, .column = 0, .scope = 1});
  return sources;
}

TEST(Place, LinesHaveNoEnds) {
  for (const char* text : {"x = 1;\ny = 2;\n", "x = 1;\r\ny = 2;\r\n", "x = 1;\r\ny = 2;"}) {
    const spirv::SourceInfo sources = two_lines(text);
    ASSERT_EQ(frames_of(&sources, 1).size(), 1u);
    EXPECT_EQ(frames_of(&sources, 1)[0].text, "x = 1;");
    EXPECT_EQ(frames_of(&sources, 2)[0].text, "y = 2;");
  }
}

TEST(Place, EmptyLinesHaveNoText) {
  const spirv::SourceInfo sources = two_lines("\r\n\n");
  EXPECT_EQ(frames_of(&sources, 1)[0].text, "");
  EXPECT_EQ(frames_of(&sources, 2)[0].text, "");
}

}  // namespace
}  // namespace vitrine::glass
