// Rows of deviations.md that can be asked for.
#include "base/as_reference.h"

#include <gtest/gtest.h>

namespace vitrine::base {
namespace {

TEST(AsReference, AsksForNothingByItself) {
  const AskedRows asked = parse_rows("");
  EXPECT_EQ(asked.rows, 0u);
  EXPECT_TRUE(asked.unknown.empty());
  EXPECT_FALSE(asked.has("point-clipping"));
}

TEST(AsReference, ReadsNamesBetweenCommas) {
  const AskedRows asked = parse_rows(",multiview-layers,,point-clipping");
  EXPECT_TRUE(asked.has(Deviation::kPointClipping) && asked.has("point-clipping"));
  EXPECT_TRUE(asked.has(Deviation::kMultiviewLayers) && asked.has("multiview-layers"));
  EXPECT_FALSE(asked.has(Deviation::kViewportScissor));
  EXPECT_TRUE(asked.unknown.empty());
}

TEST(AsReference, KeepsWhatItDoesNotKnow) {
  const AskedRows asked = parse_rows("loop-budget,point-clipping,point_clipping");
  EXPECT_EQ(asked.unknown, (std::vector<std::string>{"loop-budget", "point_clipping"}));
  EXPECT_TRUE(asked.has(Deviation::kPointClipping));
  EXPECT_FALSE(asked.has("loop-budget"));
}

TEST(AsReference, AllIsEveryRow) {
  const AskedRows asked = parse_rows("all");
  const std::string names = names_of_rows();
  for (std::size_t at = 0; at < names.size();) {
    const std::size_t comma = std::min(names.find(", ", at), names.size());
    EXPECT_TRUE(asked.has(names.substr(at, comma - at))) << names.substr(at, comma - at);
    at = comma + 2;
  }
}

}  // namespace
}  // namespace vitrine::base
