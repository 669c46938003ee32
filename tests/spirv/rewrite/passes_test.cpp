// The table of steps: each can be run by its name, and rewrite() is all of them.
#include "spirv/rewrite/passes.h"

#include <gtest/gtest.h>

#include "spirv/ir_passes.h"
#include "spirv/ir_walk.h"
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

TEST(Passes, LowerWhatProgramsDoNotHaveWithoutTheRules) {
  for (const char* expression :
       {"FMod(a,b)", "LdExp(a,3)", "FSat(FRem(a,b))", "FDot2(Vec(a,b),Vec(c,d))", "FDot4(Vec(a,b,c,d),Vec(d,c,b,a))",
        "BitfieldInsert(a,b,c,d)", "FLrp(a,b,c)", "PackUnorm4x8(Vec(a,b,c,d))", "PackHalf2x16(Vec(a,b))"}) {
    ir::Function function = test::shader_of(expression);
    rewriting::Graph graph(function);
    for (const rewriting::Pass& pass : rewriting::passes())
      if (pass.needed == rewriting::Needed::kNeeded) pass.run(graph);
    graph.write_back();
    EXPECT_EQ(ir::verify(function), "") << expression;
    ir::each_node(function.body, [&](const ir::Node& node) {
      const ir::Op op = node.instr.op;
      EXPECT_FALSE(op >= ir::Op::kExecutedCount && op < ir::Op::kAluCount) << expression << ": " << ir::op_name(op);
    });
  }
}

}  // namespace
}  // namespace vitrine::spirv
