// What rewrite() makes of single expressions: the rows of lavapipe-shader-math.md sections 4 and 5.3, one by one.
#include "spirv/rewrite/rewrite.h"

#include <gtest/gtest.h>

#include "spirv/rewrite/nir/algebraic/pattern.h"
#include "tests/spirv/rewrite/expression.h"

namespace vitrine::spirv {
namespace {

struct Case {
  const char* in;
  const char* out;
};

std::string rewritten(const char* expression) {
  ir::Function function = test::shader_of(expression);
  rewrite(function);
  return test::expression_of(function);
}

class Rewrite : public ::testing::TestWithParam<Case> {};

TEST_P(Rewrite, GivesTheReferencesExpression) { EXPECT_EQ(rewritten(GetParam().in), GetParam().out) << GetParam().in; }

constexpr Case kChanged[] = {
    {"FAdd(FMul(a,b),FMul(a,c))", "FMul(a,FAdd(b,c))"},
    {"FAdd(FMul(b,a),FMul(c,a))", "FMul(a,FAdd(b,c))"},
    {"FAdd(FAdd(FMul(a,b),FMul(c,c)),c)", "FAdd(FAdd(FMul(a,b),c),FMul(c,c))"},
    {"FAdd(FAdd(FMul(a,b),FMul(b,b)),c)", "FAdd(FAdd(FMul(a,b),c),FMul(b,b))"},
    {"FMul(FMul(a,b),2.0)", "FMul(FMul(a,2.0),b)"},
    {"FMul(FMul(FMul(a,b),c),2.0)", "FMul(FMul(FMul(a,2.0),b),c)"},
    {"FAdd(FAdd(a,b),1.0)", "FAdd(FAdd(a,1.0),b)"},
    {"FAdd(FAdd(FAdd(a,b),c),1.0)", "FAdd(FAdd(FAdd(a,1.0),b),c)"},
    {"FAdd(FAdd(FMul(a,b),FMul(c,b)),1.0)", "FAdd(FAdd(FMul(a,b),1.0),FMul(c,b))"},
    {"FMul(2.0,FMul(a,3.0))", "FMul(6.0,a)"},
    {"FAdd(2.0,FAdd(a,3.0))", "FAdd(5.0,a)"},
    {"FSub(2.0,FAdd(a,3.0))", "FSub(-1.0,a)"},
    {"FAdd(a,0.0)", "a"},
    {"FMul(a,1.0)", "a"},
    {"FMul(a,0.0)", "0.0"},
    {"!FMul(a,0.0)", "0.0"},
    {"FSub(a,a)", "0.0"},
    {"FAdd(FNeg(a),FAdd(a,b))", "b"},
    {"FAdd(FMul(a,FSub(1.0,B2F(FLt(c,d)))),FMul(b,B2F(FLt(c,d))))", "Select(FLt(c,d),b,a)"},
    {"FMin(a,a)", "a"},
    {"FExp2(FLog2(a))", "a"},
    {"FPow(a,2.0)", "FMul(a,a)"},
    {"FPow(a,4.0)", "FMul(FMul(a,a),FMul(a,a))"},
    {"FPow(2.0,a)", "FExp2(a)"},
    {"FMul(FExp2(a),FExp2(b))", "FExp2(FAdd(a,b))"},
    {"FMul(FSqrt(a),FSqrt(a))", "FAbs(a)"},
    {"FDiv(1.0,a)", "FRcp(a)"},
    {"FDiv(1.0,FSqrt(a))", "FRsq(a)"},
    {"FSub(a,FFract(a))", "FFloor(a)"},
    {"FMul(FNeg(a),b)", "FNeg(FMul(a,b))"},
    {"I2F(F2I(a))", "FTrunc(a)"},
    {"FMin(FMax(a,0.0),1.0)", "FMinPlain(FMaxPlain(a,0.0),1.0)"},
    {"FMin(0.5,a)", "FMinPlain(a,0.5)"},
    {"FMax(FDiv(0.0,a),b)", "FMax(0.0,b)"},
    {"!FAdd(a,-0.0)", "a"},
    {"FMul(a,Select(FLt(c,d),b,1.0))", "Select(FLt(c,d),FMul(a,b),a)"},
    {"FLog2(FPow(a,b))", "FMul(b,FLog2(a))"},
    {"FMul(Select(FLt(a,b),-1.0,1.0),c)", "Select(FLt(a,b),FNeg(c),c)"},
    {"IMul(a,8)", "Shl(a,3)"},
    {"FAdd(FMul(0.0,FSub(1.0,b)),FMul(a,b))", "FMul(a,b)"},
    {"FAdd(FMul(a,FSub(1.0,0.5)),FMul(b,0.5))", "FMul(0.5,FAdd(a,b))"},
    {"FSin(FAdd(1.0,2.0))", "0.141120002"},
    {"Select(FEq(FSqrt(FAbs(a)),0.0),3.4028234663852886e+38,FRsq(FAbs(a)))", "FMinPlain(FRsq(FAbs(a)),3.40282347e+38)"},
    // operations of NIR: taken apart, and when the other rules see their parts
    {"FSat(a)", "FMinPlain(FMaxPlain(a,0.0),1.0)"},
    {"SLt(a,b)", "B2F(FLt(a,b))"},
    {"FMod(a,b)", "FSub(a,FMul(b,FFloor(FDiv(a,b))))"},
    {"FRem(a,b)", "FSub(a,FMul(b,FTrunc(FDiv(a,b))))"},
    {"LdExp(a,3)", "FMul(8.0,a)"},
    {"FDot2(Vec(a,b),Vec(c,d))", "FAdd(FMul(a,c),FMul(b,d))"},
    {"FAdd(FDot2(Vec(a,b),Vec(c,d)),e)", "FAdd(FAdd(FMul(a,c),e),FMul(b,d))"},
    {"FDot3(Vec(a,b,c),Vec(d,e,f))", "FAdd(FAdd(FMul(a,d),FMul(b,e)),FMul(c,f))"},
    {"FAdd(FDot3(Vec(a,b,c),Vec(d,e,f)),g)", "FAdd(FAdd(FAdd(FMul(a,d),FMul(b,e)),FMul(c,f)),g)"},
    {"FAdd(FDot3(Vec(a,b,c),Vec(a,d,e)),FMul(a,f))", "FAdd(FAdd(FAdd(FMul(a,a),FMul(b,d)),FMul(c,e)),FMul(a,f))"},
    {"FDot4(Vec(a,b,c,d),Vec(1.0,0.0,2.0,e))", "FAdd(FAdd(FAdd(a,0.0),FMul(c,2.0)),FMul(d,e))"},
    {"FDot4(Vec(a,b,0.0,0.0),Vec(c,d,e,f))", "FAdd(FMul(b,d),FMul(a,c))"},
    {"FDot3(Vec(b,c,d),Vec(a,0.0,0.0))", "FMul(a,b)"},
    {"FDot3(Vec(1.0,2.0,3.0),Vec(4.0,5.0,6.0))", "32.0"},
    {"PackHalf2x16(Vec(a,b))", "Or(Shl(F2Half(b),16),And(F2Half(a),65535))"},
};

constexpr Case kKept[] = {
    {"FSub(FMul(a,b),FMul(c,a))", "FSub(FMul(a,b),FMul(c,a))"},
    {"FAdd(FMul(a,b),a)", "FAdd(FMul(a,b),a)"},
    {"FAdd(a,FMul(b,FSub(c,a)))", "FAdd(a,FMul(b,FSub(c,a)))"},
    {"FMul(a,FSub(1.0,b))", "FMul(a,FSub(1.0,b))"},
    {"FDiv(a,3.0)", "FDiv(a,3.0)"},
    {"FSqrt(FMul(a,a))", "FSqrt(FMul(a,a))"},
    {"FMul(FMul(a,a),a)", "FMul(FMul(a,a),a)"},
    {"FAdd(FAdd(a,b),c)", "FAdd(FAdd(a,b),c)"},
    {"FSub(FMul(a,2.0),1.0)", "FAdd(FMul(a,2.0),-1.0)"},
    {"FAdd(FMul(a,0.5),0.5)", "FAdd(FMul(a,0.5),0.5)"},
    {"FMul(FAdd(a,b),0.5)", "FMul(FAdd(a,b),0.5)"},
    {"FAdd(FMul(FNeg(a),b),c)", "FSub(c,FMul(a,b))"},
    {"FMul(FMax(a,0.0),b)", "FMul(FMaxPlain(a,0.0),b)"},
    {"!FAdd(!FMul(a,b),!FMul(a,c))", "FAdd(FMul(a,b),FMul(a,c))"},
    {"FAdd(!FMul(a,b),FMul(a,c))", "FAdd(FMul(a,b),FMul(a,c))"},
    {"FPow(a,3.0)", "FPow(a,3.0)"},
};

std::string name_of(const ::testing::TestParamInfo<Case>& info) {
  std::string name;
  for (const char* c = info.param.in; *c; ++c)
    name += (*c >= '0' && *c <= '9') || (*c >= 'A' && *c <= 'Z') || (*c >= 'a' && *c <= 'z') ? *c : '_';
  return name;
}

INSTANTIATE_TEST_SUITE_P(Changed, Rewrite, ::testing::ValuesIn(kChanged), name_of);
INSTANTIATE_TEST_SUITE_P(Kept, Rewrite, ::testing::ValuesIn(kKept), name_of);

TEST(RuleTable, EveryRuleParses) {
  EXPECT_EQ(rewriting::main_rules().ill_formed, std::vector<std::string>());
  EXPECT_EQ(rewriting::late_rules().ill_formed, std::vector<std::string>());
  EXPECT_GT(rewriting::main_rules().rules.size(), 400u);
  EXPECT_GT(rewriting::late_rules().rules.size(), 30u);
  for (const auto& shapes : rewriting::main_rules().shapes) EXPECT_LE(shapes.size(), rewriting::kMaxShapes);
}

TEST(Rewrite, InexactRulesAreOffUnderSignedZeroInfNanPreserve) {
  ir::Function function = test::shader_of("FAdd(FMul(a,b),FMul(a,c))");
  function.signed_zero_inf_nan_preserve = true;
  rewrite(function);
  EXPECT_EQ(test::expression_of(function), "FAdd(FMul(a,b),FMul(a,c))");
}

}  // namespace
}  // namespace vitrine::spirv
