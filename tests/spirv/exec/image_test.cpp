// Image instructions: operands reach texel, descriptors are chosen per lane, null descriptors read 0, atomics count.
#include <functional>

#include "tests/spirv/shader_run.h"
#include "texel/view.h"

namespace vitrine::spirv::test {
namespace {

/// A 4x4 image of 32-bit words with its view.
struct Image {
  explicit Image(VkFormat format, std::uint32_t first) {
    texel::ImageDesc desc;
    desc.format = format;
    desc.extent = {4, 4, 1};
    EXPECT_TRUE(texel::make_image_layout(desc, layout));
    words.resize(layout.size / 4 + 16);
    texel::ImageViewDesc view_desc;
    view_desc.format = format;
    view = texel::make_image_view(layout, reinterpret_cast<std::byte*>(words.data()), view_desc);
    for (std::uint32_t y = 0; y < 4; ++y)
      for (std::uint32_t x = 0; x < 4; ++x) texel(x, y) = first + y * 4 + x;
  }
  std::uint32_t& texel(std::uint32_t x, std::uint32_t y) {
    return *reinterpret_cast<std::uint32_t*>(view.block(0, 0, 0, x, y, 0));
  }
  texel::ImageLayout layout;
  std::vector<std::uint32_t> words;
  texel::ImageView view;
};

constexpr std::uint32_t bit(ir::ImageOperand operand) { return 1u << static_cast<std::uint32_t>(operand); }

ir::Instr& image_instruction(Builder& b, ir::ImageAccess access, std::uint32_t operands, std::uint8_t components,
                             std::vector<Src> sources) {
  ir::Instr& instr = b.append(Op::kImage, components, false, std::move(sources));
  auto info = std::make_shared<ir::ImageInfo>();
  info->access = access;
  info->operands = operands;
  info->count = 2;
  instr.image = std::move(info);
  return instr;
}

TEST(Image, FetchWithAnIndexPerLane) {
  Image first(VK_FORMAT_R32_UINT, 100), second(VK_FORMAT_R32_UINT, 200);
  Descriptor descriptors[2];
  descriptors[0].image = &first.view;
  descriptors[1].image = &second.view;
  ResourceTable table;
  table.set[0] = descriptors;
  table.set_size[0] = 2;
  Builder b;
  const ValueId index = b.input(0), x = b.input(1), y = b.input(2);
  const ValueId coord = b.append(Op::kVec, 2, false, {src(x), src(y)}).result;
  const ValueId texel =
      image_instruction(b, ir::ImageAccess::kFetch, bit(ir::ImageOperand::kImageIndex) | bit(ir::ImageOperand::kCoord),
                        4, {src(index), vec(coord)})
          .result;
  b.output(0, b.append(Op::kMov, 1, false, {src(texel)}).result);
  b.output(1, b.append(Op::kMov, 1, false, {src(texel, 3)}).result);
  ShaderRun run(b, table);
  for (std::uint32_t lane = 0; lane < 64; ++lane) {
    run.input(0)->lane[lane] = lane % 3;
    run.input(1)->lane[lane] = lane % 4;
    run.input(2)->lane[lane] = lane / 16;
  }
  run.wave.run(base::kAllLanes, 0);
  for (std::uint32_t lane = 0; lane < 64; ++lane) {
    const std::uint32_t which = lane % 3;
    const std::uint32_t want = which == 2 ? 0 : (which + 1) * 100 + lane / 16 * 4 + lane % 4;
    EXPECT_EQ(run.output(0).lane[lane], want);
    EXPECT_EQ(run.output(1).lane[lane], which == 2 ? 0u : 1u);
  }
}

TEST(Image, StoreAndAtomicAdd) {
  Image image(VK_FORMAT_R32_UINT, 0);
  Descriptor descriptor;
  descriptor.image = &image.view;
  ResourceTable table;
  table.set[0] = &descriptor;
  table.set_size[0] = 1;
  Builder b;
  const ValueId x = b.input(0), y = b.constant(3);
  const ValueId coord = b.append(Op::kVec, 2, false, {src(x), src(y)}).result;
  const ValueId value = b.append(Op::kVec, 4, false, {src(x), src(x), src(x), src(x)}).result;
  image_instruction(b, ir::ImageAccess::kWrite, bit(ir::ImageOperand::kCoord) | bit(ir::ImageOperand::kValue), 0,
                    {vec(coord), vec(value)});
  const ValueId one = b.constant(1);
  const ValueId corner = b.append(Op::kVec, 2, false, {src(b.constant(0)), src(b.constant(0))}).result;
  const ValueId old =
      image_instruction(b, ir::ImageAccess::kAtomic, bit(ir::ImageOperand::kCoord) | bit(ir::ImageOperand::kValue), 1,
                        {vec(corner), src(one)})
          .result;
  b.output(0, old);
  ShaderRun run(b, table);
  for (std::uint32_t lane = 0; lane < 64; ++lane) run.input(0)->lane[lane] = lane;
  run.wave.run(base::kAllLanes, 0);
  for (std::uint32_t i = 0; i < 4; ++i) EXPECT_EQ(image.texel(i, 3), i);
  EXPECT_EQ(image.texel(0, 0), 64u);
  for (std::uint32_t lane = 0; lane < 64; ++lane) EXPECT_EQ(run.output(0).lane[lane], lane);
}

/// Lanes of `active` do `op` with their own number on texel (`x`[lane], 0): the texels of the row and what lanes got
/// are those of lane after lane.
void expect_in_order(ir::AtomicOp op, base::LaneMask active, const std::function<std::uint32_t(std::uint32_t)>& x) {
  Image image(VK_FORMAT_R32_UINT, 7);
  Descriptor descriptor;
  descriptor.image = &image.view;
  ResourceTable table;
  table.set[0] = &descriptor;
  table.set_size[0] = 1;
  Builder b;
  const ValueId coord = b.append(Op::kVec, 2, false, {src(b.input(0)), src(b.constant(0))}).result;
  ir::Instr& atomic =
      image_instruction(b, ir::ImageAccess::kAtomic, bit(ir::ImageOperand::kCoord) | bit(ir::ImageOperand::kValue), 1,
                        {vec(coord), src(b.input(1))});
  auto info = std::make_shared<ir::ImageInfo>(*atomic.image);
  info->atomic = op;
  atomic.image = std::move(info);
  b.output(0, atomic.result);
  ShaderRun run(b, table);
  for (std::uint32_t lane = 0; lane < 64; ++lane) {
    run.input(0)->lane[lane] = x(lane);
    run.input(1)->lane[lane] = lane;
  }
  run.wave.run(active, 0);
  std::uint32_t want[4] = {7, 8, 9, 10};
  for (std::uint32_t lane = 0; lane < 64; ++lane) {
    if ((active >> lane & 1) == 0) continue;
    std::uint32_t& word = want[x(lane)];
    EXPECT_EQ(run.output(0).lane[lane], word) << lane;
    word = op == ir::AtomicOp::kAdd ? word + lane : word ^ lane;
  }
  for (std::uint32_t i = 0; i < 4; ++i) EXPECT_EQ(image.texel(i, 0), want[i]);
}

TEST(Image, AtomicsOfLanesWithOneTexelAreThoseOfOneLaneAfterTheOther) {
  const auto same = [](std::uint32_t) { return 2u; };
  const auto one_differs = [](std::uint32_t lane) { return lane == 31 ? 1u : 2u; };
  for (const ir::AtomicOp op : {ir::AtomicOp::kAdd, ir::AtomicOp::kXor})
    for (const base::LaneMask active : {base::kAllLanes, base::LaneMask{0x00f0'8000'8000'0f00}, base::LaneMask{2}}) {
      expect_in_order(op, active, same);
      expect_in_order(op, active, one_differs);
    }
}

TEST(Image, SampleNearest) {
  Image image(VK_FORMAT_R32_SFLOAT, 0);
  for (std::uint32_t i = 0; i < 16; ++i) image.texel(i % 4, i / 4) = base::bits_of(static_cast<float>(i));
  texel::Sampler sampler;
  Descriptor descriptor;
  descriptor.image = &image.view;
  descriptor.sampler = &sampler;
  ResourceTable table;
  table.set[0] = &descriptor;
  table.set_size[0] = 1;
  Builder b;
  const ValueId u = b.input(0), v = b.constant_float(0.6f);
  const ValueId coord = b.append(Op::kVec, 2, false, {src(u), src(v)}).result;
  ir::Instr& instr =
      image_instruction(b, ir::ImageAccess::kSample, bit(ir::ImageOperand::kCoord) | bit(ir::ImageOperand::kLod), 4,
                        {vec(coord), src(b.constant(0))});
  auto info = std::make_shared<ir::ImageInfo>(*instr.image);
  info->combined = true;
  const ValueId texel = instr.result;
  instr.image = info;
  b.output(0, b.append(Op::kMov, 1, false, {src(texel)}).result);
  ShaderRun run(b, table);
  for (std::uint32_t lane = 0; lane < 64; ++lane)
    run.input(0)->lane[lane] = base::bits_of((static_cast<float>(lane % 4) + 0.5f) / 4);
  run.wave.run(base::kAllLanes, 0);
  for (std::uint32_t lane = 0; lane < 64; ++lane)
    EXPECT_EQ(base::float_of(run.output(0).lane[lane]), static_cast<float>(8 + lane % 4));
}

}  // namespace
}  // namespace vitrine::spirv::test
