// The text form of the tests is read and printed alike.
#include "tests/spirv/ir_text.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "spirv/ir_passes.h"

namespace vitrine::spirv::test {
namespace {

TEST(IrText, IsWhatDumpPrints) {
  const char* const text = R"(%0:2 = Vec %b, %b
%1:2 = FAdd@64! %0, %0
%2:1b = FLt %b, %1.y
If %2 -> %3:2
  Yield %1
Else
  %4:2 = Const 0x3f800000 0
  Yield %4
Loop params %5:2 init %3 -> %6
  If %2
    Break %5.xx
  Else
    Yield
  Yield %5
Continuing %7:2
  Yield %7
StoreStorage %b, 16, %6 [0 3 1 16] {1 0}
StoreOutput %6
)";
  const ir::Function function = parse_ir(text);
  EXPECT_EQ(ir::verify(function), "");
  EXPECT_EQ(text_of(function), text);
}

TEST(IrText, OperationsMayStandWhereValuesAreRead) {
  EXPECT_EQ(text_of(parse_ir("StoreOutput Select(FLt(%a, 1.0), %a, -2)")),
            "%0:1b = FLt %a, 1.0\n%1 = Select %0, %a, -2\nStoreOutput %1\n");
}

TEST(IrText, SaysWhatItDoesNotUnderstand) {
  EXPECT_THROW(parse_ir("%a = Nothing"), std::runtime_error);
  EXPECT_THROW(parse_ir("StoreOutput %x"), std::runtime_error);
  EXPECT_THROW(parse_ir("%a = LoadInput\nIf %a\n  Yield"), std::runtime_error);
}

}  // namespace
}  // namespace vitrine::spirv::test
