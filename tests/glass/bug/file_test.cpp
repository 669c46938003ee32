// Bug files: what is written is read again; what was cut off or altered is an error, never a crash.
#include "glass/bug/file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "glass/bug/pack.h"
#include "tests/glass/bug/bugs.h"

namespace vitrine::glass::bug {
namespace {

TEST(BugFile, IsReadAsItWasWritten) {
  const Bug bug = small_bug();
  const base::Result<Bug> read = from_file(to_file(bug));
  ASSERT_TRUE(read.ok()) << read.message();
  EXPECT_EQ(describe(read.value()), describe(bug));
  EXPECT_EQ(*read.value().memories[0].pieces[0].after, *bug.memories[0].pieces[0].after);
  EXPECT_EQ(*read.value().stages[0].words, *bug.stages[0].words);
}

TEST(BugFile, KeepsStateAndNumbersThatAreNoNumbers) {
  Bug bug = small_bug();
  bug.stages[0].stage = VK_SHADER_STAGE_VERTEX_BIT;
  bug.state.viewport[0] = {0, -1.5f, 1e30f, std::numeric_limits<float>::quiet_NaN(), 0, 1};
  bug.state.depth_bias_clamp = -std::numeric_limits<float>::infinity();
  bug.state.blend[2].src_color = VK_BLEND_FACTOR_SRC1_ALPHA;
  bug.state.locations.x[3] = -7;
  bug.rendering.area = {{3, 4}, {5, 6}};
  const base::Result<Bug> read = from_file(to_file(bug));
  ASSERT_TRUE(read.ok()) << read.message();
  const Bug& back = read.value();
  EXPECT_EQ(back.state.viewport[0].y, -1.5f);
  EXPECT_TRUE(std::isnan(back.state.viewport[0].height));
  EXPECT_EQ(back.state.depth_bias_clamp, bug.state.depth_bias_clamp);
  EXPECT_EQ(back.state.blend[2].src_color, VK_BLEND_FACTOR_SRC1_ALPHA);
  EXPECT_EQ(back.state.locations.x[3], -7);
  EXPECT_EQ(back.rendering.area.offset.x, 3);
}

/// VkPipelineRasterizationLineStateCreateInfoEXT: only who stipples has to give a factor.
TEST(BugFile, NeedsAFactorOfStipplesThatThereAre) {
  Bug bug = small_bug();
  bug.stages[0].stage = VK_SHADER_STAGE_VERTEX_BIT;
  bug.rendering.area = {{0, 0}, {1, 1}};
  bug.state.line_stipple_factor = 0;
  EXPECT_TRUE(from_file(to_file(bug)).ok());
  bug.state.line_stipple = true;
  EXPECT_EQ(from_file(to_file(bug)).message(), "it names state that cannot be");
}

TEST(BugFile, ThatEndsEarlyIsAnError) {
  const std::string file = to_file(small_bug());
  for (std::size_t size = 0; size < file.size(); ++size) {
    const base::Result<Bug> read = from_file(std::string_view(file).substr(0, size));
    EXPECT_FALSE(read.ok()) << size;
    EXPECT_FALSE(read.message().empty());
  }
  EXPECT_FALSE(from_file(file + "x").ok());
}

TEST(BugFile, WithAnAlteredBitIsAnErrorOrTheSame) {
  const std::string file = to_file(small_bug()), text = describe(small_bug());
  std::size_t same = 0;
  for (std::size_t i = 0; i < file.size(); ++i) {
    for (int bit = 0; bit < 8; ++bit) {
      std::string altered = file;
      altered[i] = static_cast<char>(altered[i] ^ (1 << bit));
      const base::Result<Bug> read = from_file(altered);
      if (!read.ok()) continue;
      EXPECT_EQ(describe(read.value()), text) << i;
      ++same;
    }
  }
  // Of a time, a system and flags in the header (RFC 1952), and what fills the last byte of data: nothing depends on
  // it.
  EXPECT_LE(same, 8u * 8);
}

TEST(BugFile, OfSomethingElseIsAnError) {
  EXPECT_EQ(from_file("no bug file").message(), "it is no bug file, or was altered");
  EXPECT_EQ(from_file(pack("something else")).message(), "it is no bug file");
  EXPECT_EQ(from_file(pack("vitrine-bug 3\n")).message(), "another version of Vitrine wrote it");
  EXPECT_EQ(from_file(pack("vitrine-bug 2\nabc")).message(), "it ends too early");
}

/// Its one image, and a view of the first level.
void show_image(Bug& bug, VkFormat format, texel::Extent extent, std::uint32_t levels) {
  Image image;
  image.format = format;
  image.extent = extent;
  image.levels = levels;
  bug.images = {image};
  View view;
  view.image = 0;
  view.format = format;
  view.range = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
  bug.views = {view};
}

TEST(BugFile, ThatSaysWhatVulkanDoesNotKnowIsAnError) {
  const auto said = [](const auto& change) {
    Bug bug = small_bug();
    show_image(bug, VK_FORMAT_R8G8B8A8_UNORM, {4, 4, 1}, 3);
    EXPECT_EQ(fault_of(bug), "");
    change(bug);
    return from_file(to_file(bug)).message();
  };
  EXPECT_EQ(said([](Bug& b) { b.images[0].format = static_cast<VkFormat>(12345); }),
            "it names an image that cannot be");
  EXPECT_EQ(said([](Bug& b) { b.images[0].levels = 4; }), "it names an image that cannot be");
  EXPECT_EQ(said([](Bug& b) { b.views[0].range.levelCount = 4; }), "it names a view that cannot be");
  EXPECT_EQ(said([](Bug& b) { b.views[0].range.baseArrayLayer = 1; }), "it names a view that cannot be");
  EXPECT_EQ(said([](Bug& b) { b.views[0].type = VK_IMAGE_VIEW_TYPE_CUBE; }), "it names a view that cannot be");
  EXPECT_EQ(said([](Bug& b) { b.stages.push_back(b.stages[0]); }), "it names a stage twice, or none");
  EXPECT_EQ(said([](Bug& b) { b.command.groups[1] = 65536; }), "it names more workgroups than there can be");
  EXPECT_EQ(said([](Bug& b) { b.stages[0].stage = VK_SHADER_STAGE_FRAGMENT_BIT; }),
            "it names stages that make no pipeline");
  EXPECT_EQ(said([](Bug& b) {
              b.stages[0].stage = VK_SHADER_STAGE_VERTEX_BIT;
              b.rendering.colors = {0};
              b.rendering.area.extent = {5, 4};
            }),
            "it names attachments that do not fit what is drawn");
}

TEST(BugFile, HasRatesForAllThatIsDrawnTo) {
  const auto fault = [](const auto& change) {
    Bug bug = small_bug();
    bug.stages[0].stage = VK_SHADER_STAGE_VERTEX_BIT;
    show_image(bug, VK_FORMAT_R8_UINT, {3, 2, 1}, 1);
    bug.rendering.rate = 0;
    bug.rendering.rate_texel = {16, 8};
    bug.rendering.area = {{8, 0}, {40, 16}};
    change(bug);
    return fault_of(bug);
  };
  const char* const other = "attachments that do not fit what is drawn";
  EXPECT_EQ(fault([](Bug&) {}), "");
  EXPECT_EQ(fault([](Bug& b) { b.rendering.area.extent.width = 41; }), other);
  EXPECT_EQ(fault([](Bug& b) { b.rendering.area.offset.y = 1; }), other);
  EXPECT_EQ(fault([](Bug& b) { b.rendering.rate_texel.height = 0; }), other);
  EXPECT_EQ(fault([](Bug& b) { b.rendering.rate_texel.width = 24; }), other);
  EXPECT_EQ(fault([](Bug& b) { b.rendering.rate_texel.height = 512; }), other);
  EXPECT_EQ(fault([](Bug& b) { b.images[0].format = b.views[0].format = VK_FORMAT_R8_UNORM; }), other);
  EXPECT_EQ(fault([](Bug& b) { b.rendering.rate = 1; }), "an attachment that there is not");
}

TEST(BugFile, ThatWasAlteredAndPackedAgainNeverCrashes) {
  const base::Result<std::string> bytes = unpack(to_file(small_bug()));
  ASSERT_TRUE(bytes.ok());
  std::mt19937 random(1);
  std::size_t good = 0;
  for (int round = 0; round < 3000; ++round) {
    std::string altered = bytes.value();
    for (std::uint32_t i = random() % 3 + 1; i > 0; --i) {
      const std::size_t at = random() % altered.size();
      if (random() % 4 == 0)
        altered.erase(at, random() % 9);
      else
        altered[at] = random() % 2 ? static_cast<char>('0' + random() % 10) : static_cast<char>(random());
      if (altered.empty()) break;
    }
    const base::Result<Bug> read = from_file(pack(altered));
    if (!read.ok()) continue;
    ++good;
    EXPECT_EQ(fault_of(read.value()), "");
    describe(read.value());
  }
  EXPECT_GT(good, 10u);
}

/// Two descriptors of a mutable binding, of which one is a sampler.
Bug bug_with_mutable_binding() {
  Bug bug = small_bug();
  bug.samplers.resize(1);
  Binding& binding = bug.sets[0].bindings[0];
  binding.type = VK_DESCRIPTOR_TYPE_MUTABLE_EXT;
  binding.count = 2;
  binding.types = {VK_DESCRIPTOR_TYPE_SAMPLER, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER};
  bug.descriptors[0].type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
  Descriptor second;
  second.element = 1;
  second.sampler = 0;
  second.type = VK_DESCRIPTOR_TYPE_SAMPLER;
  bug.descriptors.push_back(second);
  return bug;
}

TEST(BugFile, SaysWhatMutableDescriptorsAre) {
  const base::Result<Bug> read = from_file(to_file(bug_with_mutable_binding()));
  ASSERT_TRUE(read.ok()) << read.message();
  EXPECT_EQ(read.value().sets[0].bindings[0].types.size(), 2u);
  EXPECT_EQ(read.value().descriptors[0].type, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER);
  EXPECT_EQ(read.value().descriptors[1].type, VK_DESCRIPTOR_TYPE_SAMPLER);
  const auto fault = [](auto change) {
    Bug bug = bug_with_mutable_binding();
    change(bug, bug.sets[0].bindings[0]);
    return fault_of(bug);
  };
  const char* const other = "a descriptor of another type";
  const char* const none = "a binding that cannot be";
  EXPECT_EQ(fault([](Bug& b, Binding&) { b.descriptors[0].type = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER; }), other);
  EXPECT_EQ(fault([](Bug& b, Binding&) { b.descriptors[1].sampler = kNone; }), other);
  EXPECT_EQ(fault([](Bug&, Binding& b) { b.types.push_back(VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC); }), none);
  EXPECT_EQ(fault([](Bug&, Binding& b) { b.types.push_back(VK_DESCRIPTOR_TYPE_SAMPLER); }), none);
  EXPECT_EQ(fault([](Bug& bug, Binding& b) { b.types.clear(), bug.descriptors.clear(); }), none);
  EXPECT_EQ(fault([](Bug& bug, Binding& b) { b.type = VK_DESCRIPTOR_TYPE_SAMPLER, bug.descriptors.clear(); }), none);
}

TEST(BugFile, OfBeforeThereWereMutableDescriptorsIsRead) {
  std::string bytes = unpack(to_file(small_bug())).value();
  constexpr std::size_t kLengthAt = 14, kHeaderAt = kLengthAt + 8;
  std::uint64_t length = 0;
  std::memcpy(&length, bytes.data() + kLengthAt, sizeof length);
  std::string header = bytes.substr(kHeaderAt, length);
  for (const std::string member : {",\"types\":[]", ",\"type\":1000351000"}) {
    const std::size_t at = header.find(member);
    ASSERT_NE(at, std::string::npos) << member;
    header.erase(at, member.size());
  }
  bytes.replace(kHeaderAt, length, header);
  length = header.size();
  std::memcpy(bytes.data() + kLengthAt, &length, sizeof length);
  const base::Result<Bug> read = from_file(pack(bytes));
  ASSERT_TRUE(read.ok()) << read.message();
  EXPECT_EQ(describe(read.value()), describe(small_bug()));
}

TEST(BugFile, MayNotNameWhatIsNotThere) {
  const auto fault = [](auto change) {
    Bug bug = small_bug();
    change(bug);
    return fault_of(bug);
  };
  EXPECT_EQ(fault([](Bug&) {}), "");
  EXPECT_EQ(fault([](Bug& b) { b.buffers[0].memory = 1; }), "a buffer without memory");
  EXPECT_EQ(fault([](Bug& b) { b.buffers[0].offset = ~std::uint64_t{0}; }), "a buffer outside of its memory");
  EXPECT_EQ(fault([](Bug& b) { b.memories[0].pieces[0].offset = 49; }), "bytes outside of their memory");
  EXPECT_EQ(fault([](Bug& b) { b.memories[0].pieces[0].after = blob({1}); }), "bytes that change their number");
  EXPECT_EQ(fault([](Bug& b) { b.descriptors[0].range = 65; }), "a descriptor outside of its buffer");
  EXPECT_EQ(fault([](Bug& b) { b.descriptors[0].set = 1; }), "a binding that there is not");
  EXPECT_EQ(fault([](Bug& b) { b.descriptors[0].view = 0; }), "a descriptor of something that there is not");
  EXPECT_EQ(fault([](Bug& b) { b.descriptors[0].buffer = kNone; }), "a descriptor of another type");
  EXPECT_EQ(fault([](Bug& b) { b.stages[0].constants[0].offset = 1; }), "a constant without a value");
  EXPECT_EQ(fault([](Bug& b) { b.stages[0].words = blob({1}); }), "a shader that is none");
  EXPECT_EQ(fault([](Bug& b) { b.rendering.colors = {0}; }), "an attachment that there is not");
  EXPECT_EQ(fault([](Bug& b) { b.command.count_buffer = 1; }), "a buffer that there is not");
}

}  // namespace
}  // namespace vitrine::glass::bug
