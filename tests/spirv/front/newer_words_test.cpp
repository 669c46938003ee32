// Words that came after SPIR-V 1.6 and that no installed assembler need know: composites of one repeated part
// (SPV_EXT_replicated_composites), instructions without meaning that look ahead (SPV_KHR_relaxed_extended_instruction),
// and offsets of lookups that are no constants (VK_KHR_maintenance8).
#include <bit>
#include <cstring>
#include <string>
#include <vector>

#include "spirv/front/translate.h"
#include "spirv/newer_numbers.h"
#include "tests/spirv/buffers.h"
#include "tests/spirv/compute_text.h"
#include "tests/spirv/front/glsl.h"
#include "texel/view.h"

namespace vitrine::spirv::test {
namespace {

constexpr std::uint32_t kLanes = 64;
constexpr char kFixed[] = "%fixed = OpCopyObject %uint %n\n";
constexpr auto kCompute = VK_SHADER_STAGE_COMPUTE_BIT;

/// A number as the assembler takes words that it does not know. Instructions that begin so stand behind one whose
/// operands are of a fixed number, or they are taken for more of them.
std::string raw(std::uint32_t number) { return std::string("!").append(std::to_string(number)); }
std::string raw(std::uint32_t words, spv::Op op) { return raw(words << 16 | static_cast<std::uint32_t>(op)); }

std::vector<std::uint32_t> run_compute(const ComputeText& module,
                                       const CompileOptions& options = options_for(kCompute)) {
  std::vector<std::uint32_t> words(kLanes, 77);
  dispatch_over(words, assemble(module.text()), options, 1);
  return words;
}

// ---- OpConstantCompositeReplicateEXT, OpSpecConstantCompositeReplicateEXT, OpCompositeConstructReplicateEXT

/// "%id = " a composite of `count` times `part`, by the instruction that lists them or by the one that repeats it.
std::string composite(bool repeats, spv::Op newer, const char* older, const std::string& id, const std::string& type,
                      const std::string& part, int count) {
  if (repeats) return raw(4, newer) + " " + type + " " + id + " " + part + "\n";
  std::string text = id + " = " + older + " " + type;
  for (int i = 0; i < count; ++i) text += " " + part;
  return text + "\n";
}

ComputeText composites(bool repeats) {
  const auto constant = [&](const std::string& id, const std::string& type, const std::string& part, int count) {
    return composite(repeats, newer::kConstantCompositeReplicate, "OpConstantComposite", id, type, part, count);
  };
  const auto specialized = [&](const std::string& id, const std::string& type, const std::string& part, int count) {
    return composite(repeats, newer::kSpecConstantCompositeReplicate, "OpSpecConstantComposite", id, type, part, count);
  };
  const auto built = [&](const std::string& id, const std::string& type, const std::string& part, int count) {
    return composite(repeats, newer::kCompositeConstructReplicate, "OpCompositeConstruct", id, type, part, count);
  };
  ComputeText module;
  module.capabilities = repeats ? "OpCapability !6024\nOpExtension \"SPV_EXT_replicated_composites\"\n" : "";
  module.buffers = {"buffer"};
  module.annotations = "OpDecorate %given SpecId 3\n";
  module.declarations =
      "%pair = OpTypeStruct %uint %uint\n%u3 = OpConstant %uint 3\n%u5 = OpConstant %uint 5\n%given = OpSpecConstant "
      "%uint 9\n%float = OpTypeFloat 32\n"
      "%half = OpConstant %float 0.5\n%v2float = OpTypeVector %float 2\n%mat = OpTypeMatrix %v2float 3\n"
      "%three = OpTypeArray %v3uint %u3\n%nested = OpTypeArray %three %u3\n" +
      constant("%fives", "%v3uint", "%u5", 3) + constant("%rows", "%three", "%fives", 3) +
      constant("%column", "%v2float", "%half", 2) + constant("%halves", "%mat", "%column", 3) +
      specialized("%givens", "%v3uint", "%given", 3) + specialized("%table", "%three", "%givens", 3);
  module.body = kFixed + built("%own", "%v3uint", "%n", 3) + built("%owns", "%three", "%own", 3) +
                built("%all", "%nested", "%owns", 3) + built("%both", "%pair", "%n", 2) +
                "%xf = OpConvertUToF %float %n\n" + built("%xs", "%v2float", "%xf", 2) +
                built("%xm", "%mat", "%xs", 3) +
                "%a = OpCompositeExtract %uint %rows 2 1\n%b = OpCompositeExtract %uint %table 1 2\n"
                "%c = OpCompositeExtract %uint %all 2 0 1\n%d = OpCompositeExtract %uint %both 1\n"
                "%e = OpCompositeExtract %float %halves 2 1\n%f = OpCompositeExtract %float %xm 1 0\n"
                "%g = OpFMul %float %e %f\n%h = OpBitcast %uint %g\n"
                "%ab = OpIMul %uint %a %b\n%cd = OpIMul %uint %c %d\n%abcd = OpIAdd %uint %ab %cd\n"
                "%r = OpBitwiseXor %uint %abcd %h\n" +
                store_word("%r", "buffer");
  return module;
}

TEST(ReplicatedComposites, AreThoseThatListTheirParts) {
  const std::uint32_t value = 11;
  for (const bool specializes : {false, true}) {
    CompileOptions options = options_for(kCompute);
    if (specializes) {
      SpecializationConstant constant{3, std::vector<std::byte>(4)};
      std::memcpy(constant.bytes.data(), &value, 4);
      options.specialization.push_back(constant);
    }
    const auto listed = run_compute(composites(false), options);
    EXPECT_EQ(run_compute(composites(true), options), listed);
    for (std::uint32_t x = 0; x < kLanes; ++x) {
      const float half = 0.5f * static_cast<float>(x);
      ASSERT_EQ(listed[x], (5 * (specializes ? value : 9u) + x * x) ^ std::bit_cast<std::uint32_t>(half));
    }
  }
}

TEST(ReplicatedComposites, PartsMustFillTheComposite) {
  const auto refused = [](const std::string& declarations, const std::string& body) {
    ComputeText module;
    module.capabilities = "OpCapability !6024\n";
    module.declarations = declarations;
    module.body = kFixed + body;
    return !compile(assemble(module.text()), options_for(kCompute));
  };
  const auto words = [](spv::Op op, const std::string& rest) { return raw(4, op) + " " + rest + "\n"; };
  EXPECT_FALSE(refused("", words(newer::kCompositeConstructReplicate, "%v3uint %good %n")));
  EXPECT_TRUE(refused("", words(newer::kCompositeConstructReplicate, "%v3uint %bad %gid")));
  EXPECT_TRUE(refused("", words(newer::kCompositeConstructReplicate, "%uint %bad %n")));
  EXPECT_TRUE(refused(words(newer::kConstantCompositeReplicate, "%uint %bad %u1"), ""));
  EXPECT_TRUE(
      refused("%wide = OpTypeArray %v3uint %u1\n" + words(newer::kConstantCompositeReplicate, "%wide %bad %u1"), ""));
  EXPECT_TRUE(refused("%many = OpConstant %uint 2000000000\n%huge = OpTypeArray %uint %many\n",
                      words(newer::kCompositeConstructReplicate, "%huge %bad %n")));
}

// ---- OpExtInstWithForwardRefsKHR

std::string with_forward_references(const std::string& id, std::uint32_t instruction,
                                    const std::vector<std::string>& operands) {
  std::string text = raw(static_cast<std::uint32_t>(5 + operands.size()), newer::kExtInstWithForwardRefs);
  text += " %void " + id + " %set " + raw(instruction);
  for (const std::string& operand : operands) text += " " + operand;
  return text + "\n";
}

TEST(ForwardReferences, OfInstructionsWithoutMeaningAreIgnored) {
  ComputeText module;
  module.capabilities =
      "OpExtension \"SPV_KHR_non_semantic_info\"\nOpExtension \"SPV_KHR_relaxed_extended_instruction\"\n"
      "%set = OpExtInstImport \"NonSemantic.Nobody.Knows\"\n";
  module.buffers = {"buffer"};
  module.declarations = with_forward_references("%early", 3, {"%late", "%main"});
  module.body = kFixed + with_forward_references("%ignored", 1, {"%r", "%n"}) + "%r = OpIAdd %uint %n %u1\n" +
                "%late = OpExtInst %void %set 77 %r %u1\n" + store_word("%r", "buffer");
  const auto got = run_compute(module);
  for (std::uint32_t x = 0; x < kLanes; ++x) ASSERT_EQ(got[x], x + 1);
}

/// A method knows its class and the class its method: places are told as without, and nothing goes round for ever.
TEST(ForwardReferences, OfDebugInformationMayGoRound) {
  ComputeText module;
  module.capabilities =
      "OpExtension \"SPV_KHR_non_semantic_info\"\nOpExtension \"SPV_KHR_relaxed_extended_instruction\"\n"
      "%set = OpExtInstImport \"NonSemantic.Shader.DebugInfo.100\"\n";
  module.buffers = {"buffer"};
  module.annotations = "";
  std::string strings = "%file = OpString \"shape.hlsl\"\n%name = OpString \"area\"\n%class = OpString \"Shape\"\n";
  module.declarations =
      "%u30 = OpConstant %uint 30\n%source = OpExtInst %void %set DebugSource %file\n" +
      with_forward_references(
          "%shape", 10, {"%class", "%u1", "%source", "%u1", "%u1", "%method", "%class", "%u0", "%u0", "%method"}) +
      "%type = OpExtInst %void %set DebugTypeFunction %u0 %void\n"
      "%method = OpExtInst %void %set DebugFunction %name %type %source %u30 %u1 %shape %name %u0 %u30\n";
  module.body =
      "%scope = OpExtInst %void %set DebugScope %method\n"
      "%at = OpExtInst %void %set DebugLine %source %u30 %u30 %u1 %u1\n"
      "%r = OpIAdd %uint %n %u1\n" +
      store_word("%r", "buffer");
  std::string text = module.text();
  const std::string modes = "OpExecutionMode %main LocalSize 64 1 1\n";
  text.insert(text.find(modes) + modes.size(), strings);
  const Words words = assemble(text);
  std::vector<std::uint32_t> got(kLanes);
  ASSERT_TRUE(dispatch_over(got, words, options_for(kCompute), 1));
  EXPECT_EQ(got[5], 6u);
  auto function = translate(words, options_for(kCompute), {});
  ASSERT_TRUE(function) << function.message();
  const ir::Function translated = function.take();
  const SourceInfo& sources = *translated.sources;
  bool found = false;
  for (const SourcePlace& place : sources.places)
    found |= place.line == 30 && sources.functions[sources.scopes[place.scope].function].name == "area";
  EXPECT_TRUE(found);
}

// ---- Offset as an operand of every lookup

/// A picture with a sampler at binding 1.
struct Lookup {
  explicit Lookup(VkFormat format, VkFilter filter) {
    texel::ImageDesc desc;
    desc.format = format;
    desc.extent = {16, 16, 1};
    EXPECT_TRUE(texel::make_image_layout(desc, layout));
    bytes.resize(layout.size + 64);
    for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::byte>(i * 2654435761u >> 13 & 0x3f);
    texel::ImageViewDesc view_desc;
    view_desc.format = format;
    view = texel::make_image_view(layout, bytes.data(), view_desc);
    sampler.mag_filter = sampler.min_filter = filter;
    descriptors.resize(8);
    descriptors[4].image = &view;
    descriptors[4].sampler = &sampler;
  }
  std::vector<std::uint32_t> run(const Words& words) {
    std::vector<std::uint32_t> out(kLanes, 77);
    descriptors[0].data = reinterpret_cast<std::byte*>(out.data());
    descriptors[0].size = out.size() * 4;
    ResourceTable table;
    table.set[0] = descriptors.data();
    table.set_size[0] = 8;
    const auto shader = compile(words, options_for(kCompute));
    EXPECT_TRUE(shader) << shader.message();
    if (!shader) return out;
    Fault fault;
    const BoundShader bound(*shader.value(), table, fault);
    const std::uint32_t base[3] = {0, 0, 0}, counts[3] = {1, 1, 1};
    dispatch(bound, base, counts);
    EXPECT_FALSE(fault.raised) << fault.message;
    return out;
  }
  texel::ImageLayout layout;
  std::vector<std::byte> bytes;
  texel::ImageView view;
  texel::Sampler sampler;
  std::vector<Descriptor> descriptors;
};

/// A shader that looks up with `lookup`, whose offset %offset is of the lane, or the constant of these two numbers.
Words looks_up(const std::string& lookup, const int* constant) {
  ComputeText module;
  module.capabilities = "OpCapability ImageGatherExtended\n";
  module.buffers = {"buffer"};
  module.annotations = "OpDecorate %picture DescriptorSet 0\nOpDecorate %picture Binding 1\n";
  module.declarations =
      "%float = OpTypeFloat 32\n%int = OpTypeInt 32 1\n%v2int = OpTypeVector %int 2\n%v2float = OpTypeVector %float 2\n"
      "%v4float = OpTypeVector %float 4\n%image = OpTypeImage %float 2D 0 0 0 1 Unknown\n"
      "%sampled = OpTypeSampledImage %image\n%ptr = OpTypePointer UniformConstant %sampled\n"
      "%picture = OpVariable %ptr UniformConstant\n%zero = OpConstant %float 0\n%i0 = OpConstant %int 0\n"
      "%i4 = OpConstant %int 4\n%u15 = OpConstant %uint 15\n%u4 = OpConstant %uint 4\n%i8 = OpConstant %int 8\n"
      "%sixteenth = OpConstant %float 0.0611\n%half = OpConstant %float 0.5\n";
  if (constant != nullptr)
    module.declarations += "%ox = OpConstant %int " + std::to_string(constant[0]) + "\n%oy = OpConstant %int " +
                           std::to_string(constant[1]) + "\n%offset = OpConstantComposite %v2int %ox %oy\n";
  module.body =
      "%t = OpLoad %sampled %picture\n%low = OpBitwiseAnd %uint %n %u15\n%high = OpShiftRightLogical %uint %n %u4\n"
      "%u = OpConvertUToF %float %low\n%v = OpConvertUToF %float %high\n%us = OpFMul %float %u %sixteenth\n"
      "%vs = OpFMul %float %v %sixteenth\n%uc = OpFAdd %float %us %half\n%at = OpCompositeConstruct %v2float %uc %vs\n"
      "%xi = OpBitcast %int %low\n%yi = OpBitcast %int %high\n%ten = OpIAdd %int %yi %i8\n"
      "%eight = OpCompositeConstruct %v2int %i8 %ten\n";
  if (constant == nullptr)
    module.body +=
        "%ox = OpISub %int %xi %i8\n%oy = OpISub %int %yi %i4\n%offset = OpCompositeConstruct %v2int %ox %oy\n";
  std::string text = lookup;
  if (constant != nullptr)
    for (std::size_t at; (at = text.find("Offset ")) != std::string::npos && (at == 0 || text[at - 1] != 't');)
      text.replace(at, 7, "ConstOffset ");
  module.body += text +
                 "%x0 = OpCompositeExtract %float %texel 0\n%x1 = OpCompositeExtract %float %texel 1\n"
                 "%w0 = OpBitcast %uint %x0\n%w1 = OpBitcast %uint %x1\n%w = OpIMul %uint %w1 %u15\n"
                 "%r = OpBitwiseXor %uint %w0 %w\n" +
                 store_word("%r", "buffer");
  return assemble(module.text());
}

TEST(OffsetsOfLookups, NeedNotBeConstants) {
  const std::string lookups[] = {
      "%texel = OpImageSampleExplicitLod %v4float %t %at Lod|Offset %zero %offset\n",
      "%texel = OpImageGather %v4float %t %at %i0 Offset %offset\n",
      "%i = OpImage %image %t\n%texel = OpImageFetch %v4float %i %eight Lod|Offset %i0 %offset\n"};
  for (const VkFormat format : {VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_R32G32B32A32_SFLOAT})
    for (const VkFilter filter : {VK_FILTER_NEAREST, VK_FILTER_LINEAR})
      for (const std::string& lookup : lookups) {
        Lookup picture(format, filter);
        const auto got = picture.run(looks_up(lookup, nullptr));
        std::uint32_t distinct = 0;
        for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
          const int offset[2] = {static_cast<int>(lane & 15) - 8, static_cast<int>(lane >> 4) - 4};
          const auto expected = picture.run(looks_up(lookup, offset));
          ASSERT_EQ(got[lane], expected[lane]) << lookup << format << ", lane " << lane;
          distinct += got[lane] != got[(lane + 1) % kLanes];
        }
        EXPECT_GT(distinct, 10u) << lookup;
      }
}

}  // namespace
}  // namespace vitrine::spirv::test
