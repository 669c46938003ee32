// Images whose texels are numbers of 64 bits (SPV_EXT_shader_image_int64): what modules may not do is told.
#include "tests/spirv/compute_text.h"
#include "tests/spirv/front/glsl.h"

namespace vitrine::spirv::test {
namespace {

/// The message of a refused module, or that it is not. `texel` is the image's Sampled Type, %p an atomic's pointer to
/// `pointee`, %at a coordinate.
std::string message_of(const std::string& texel, const std::string& pointee, const std::string& body) {
  ComputeText module;
  module.capabilities =
      "OpCapability Int64\nOpCapability Float64\nOpCapability Int64Atomics\nOpCapability Int64ImageEXT\n"
      "OpCapability StorageImageReadWithoutFormat\nOpCapability StorageImageWriteWithoutFormat\n"
      "OpExtension \"SPV_EXT_shader_image_int64\"\n";
  module.annotations = "OpDecorate %image DescriptorSet 1\nOpDecorate %image Binding 0\n";
  module.buffers = {"buffer"};
  module.declarations =
      "%ulong = OpTypeInt 64 0\n%double = OpTypeFloat 64\n%v4uint = OpTypeVector %uint 4\n"
      "%v4ulong = OpTypeVector %ulong 4\n%v2uint = OpTypeVector %uint 2\n"
      "%l5 = OpConstant %ulong 5\n%l5555 = OpConstantComposite %v4ulong %l5 %l5 %l5 %l5\n%d5 = OpConstant %double 5\n"
      "%at = OpConstantComposite %v2uint %u1 %u1\n%image_type = OpTypeImage " +
      texel +
      " 2D 0 0 0 2 Unknown\n%image_ptr = OpTypePointer UniformConstant %image_type\n"
      "%image = OpVariable %image_ptr UniformConstant\n%pointer = OpTypePointer Image " +
      pointee + "\n";
  module.body = "%p = OpImageTexelPointer %pointer %image %at %u0\n%img = OpLoad %image_type %image\n" + body;
  const auto shader = compile(assemble(module.text()), options_for(VK_SHADER_STAGE_COMPUTE_BIT));
  return shader ? "compiles" : shader.message();
}

TEST(WideTexels, WidthsHaveToAgree) {
  const std::string add = "%old = OpAtomicIAdd %ulong %p %u1 %u0 %l5\n";
  EXPECT_EQ(message_of("%ulong", "%ulong", add), "compiles");
  EXPECT_NE(message_of("%uint", "%ulong", add).find("64-bit atomics on this image are not supported"),
            std::string::npos);
  const std::string narrow = "%old = OpAtomicIAdd %uint %p %u1 %u0 %u1\n";
  EXPECT_EQ(message_of("%uint", "%uint", narrow), "compiles");
  EXPECT_NE(message_of("%ulong", "%uint", narrow).find("32-bit atomics on this image are not supported"),
            std::string::npos);
  EXPECT_EQ(message_of("%ulong", "%ulong", "%v = OpImageRead %v4ulong %img %at\nOpImageWrite %img %at %l5555\n"),
            "compiles");
  for (const char* const body : {"%v = OpImageRead %v4uint %img %at\n", "OpImageWrite %img %at %at\n"})
    EXPECT_NE(message_of("%ulong", "%ulong", body), "compiles") << body;
  for (const char* const body : {"%v = OpImageRead %v4ulong %img %at\n", "OpImageWrite %img %at %l5555\n"})
    EXPECT_NE(message_of("%uint", "%uint", body), "compiles") << body;
}

TEST(WideTexels, AreNoFloats) {
  EXPECT_NE(message_of("%double", "%double", "%old = OpAtomicExchange %double %p %u1 %u0 %d5\n"), "compiles");
}

}  // namespace
}  // namespace vitrine::spirv::test
