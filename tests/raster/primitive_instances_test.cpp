// Instances are looked up by where primitives lie.
#include "raster/primitive_instances.h"

#include <gtest/gtest.h>

#include "raster/primitive.h"

namespace vitrine::raster {
namespace {

TEST(PrimitiveInstances, AreThoseOfTheLastMarkInFront) {
  std::vector<Primitive> memory(20);
  PrimitiveInstances instances(100, true);
  instances.add(&memory[10], 10, {{0, 3}, {4, 7}});
  instances.add(&memory[0], 5, {{1, 2}});
  EXPECT_EQ(instances.instance_of(&memory[0]), std::nullopt);
  EXPECT_EQ(instances.instance_of(&memory[1]), 102u);
  EXPECT_EQ(instances.instance_of(&memory[4]), 102u);
  EXPECT_EQ(instances.instance_of(&memory[5]), std::nullopt);
  EXPECT_EQ(instances.instance_of(&memory[13]), 103u);
  EXPECT_EQ(instances.instance_of(&memory[14]), 107u);
  EXPECT_EQ(instances.instance_of(&memory[19]), 107u);
}

TEST(PrimitiveInstances, AreForgottenWhereOtherPrimitivesLie) {
  std::vector<Primitive> memory(20);
  PrimitiveInstances instances(0, true);
  instances.add(memory.data(), 12, {{0, 1}});
  instances.add(&memory[4], 4, {{0, 2}});
  EXPECT_EQ(instances.instance_of(&memory[0]), std::nullopt);
  EXPECT_EQ(instances.instance_of(&memory[4]), 2u);
  EXPECT_EQ(instances.instance_of(&memory[8]), std::nullopt);
}

TEST(PrimitiveInstances, AreNotToldOfADrawWithOne) {
  std::vector<Primitive> memory(1);
  PrimitiveInstances instances(0, false);
  instances.add(memory.data(), 1, {{0, 0}});
  EXPECT_EQ(instances.instance_of(memory.data()), std::nullopt);
  PrimitiveInstances later(4, false);
  later.add(memory.data(), 1, {{0, 0}});
  EXPECT_EQ(later.instance_of(memory.data()), 4u);
}

}  // namespace
}  // namespace vitrine::raster
