// The table of steps: each can be run by its name, and rewrite() is all of them.
#include "spirv/rewrite/passes.h"

#include <gtest/gtest.h>

#include "spirv/ir_passes.h"
#include "spirv/rewrite/rewrite.h"
#include "tests/spirv/rewrite/expression.h"

namespace vitrine::spirv {
namespace {

TEST(Passes, RunByName) {
  ir::Function function = test::shader_of("FAdd(FMul(a,0.5),FMul(2.0,3.0))");
  rewriting::Graph graph(function);
  const rewriting::Pass* fold = rewriting::find_pass("opt_constant_folding");
  ASSERT_NE(fold, nullptr);
  EXPECT_TRUE(fold->run(graph));
  EXPECT_FALSE(fold->run(graph));
  graph.write_back();
  EXPECT_EQ(test::expression_of(function), "FAdd(FMul(a,0.5),6.0)");
  EXPECT_EQ(rewriting::find_pass("no_such_step"), nullptr);
}

TEST(Passes, SnapshotsAreWhatIsWrittenBack) {
  ir::Function function = test::shader_of("FMul(FMul(a,b),FExp2(2.0))");
  rewriting::Graph graph(function);
  rewriting::run_passes(graph);
  const std::string text = ir::dump(rewriting::snapshot(graph));
  EXPECT_EQ(ir::verify(rewriting::snapshot(graph)), "");
  graph.write_back();
  EXPECT_EQ(ir::dump(function), text);
}

}  // namespace
}  // namespace vitrine::spirv
