// What the tool sanitize finds of reads of memory and images that nothing has written: every way to write has a case in
// which nothing is found, every way to leave something undefined one in which the read is.
#include <cstring>

#include "tests/icd/written_memory_fixture.h"

namespace vitrine::icd::test {
namespace {

using Found = std::vector<std::string>;

const Found kNothing;
const Found kBuffer{"uninitialized-memory"};
const Found kImage{"uninitialized-image"};

TEST_F(WrittenMemory, FreshBuffersAreRead) {
  EXPECT_EQ(found_by([&](VkCommandBuffer c) { read_buffer(c); }), kBuffer);
  EXPECT_NE(
      text.find("load of 4 bytes at offset 0, which nothing has written, of storage buffer (set 0, binding 0, 256 "
                "bytes)"),
      std::string::npos)
      << text;
  EXPECT_NE(text.find("64 times"), std::string::npos) << text;
}

TEST_F(WrittenMemory, WhatHasBeenToldCountsAsWritten) {
  EXPECT_EQ(found_by([&](VkCommandBuffer c) { read_buffer(c); }), kBuffer);
  EXPECT_EQ(found_by([&](VkCommandBuffer c) { read_buffer(c); }), kNothing);
}

TEST_F(WrittenMemory, FilledBuffersAreNoFault) {
  EXPECT_EQ(found_by([&](VkCommandBuffer c) {
              VK_CALL(CmdFillBuffer)(c, input.buffer, 0, VK_WHOLE_SIZE, 7);
              read_buffer(c);
            }),
            kNothing);
}

TEST_F(WrittenMemory, BuffersFilledInPartAreOne) {
  EXPECT_EQ(found_by([&](VkCommandBuffer c) {
              VK_CALL(CmdFillBuffer)(c, input.buffer, 0, 252, 7);
              read_buffer(c);
            }),
            kBuffer);
  EXPECT_NE(text.find("at offset 252"), std::string::npos) << text;
}

TEST_F(WrittenMemory, UpdatesWrite) {
  const std::array<std::uint32_t, 64> words{};
  EXPECT_EQ(found_by([&](VkCommandBuffer c) {
              VK_CALL(CmdUpdateBuffer)(c, input.buffer, 0, sizeof words, words.data());
              read_buffer(c);
            }),
            kNothing);
}

TEST_F(WrittenMemory, CopiesHandOnWhatIsWritten) {
  const VkBufferCopy all{0, 0, kBytes};
  EXPECT_EQ(found_by([&](VkCommandBuffer c) {
              VK_CALL(CmdFillBuffer)(c, other.buffer, 0, VK_WHOLE_SIZE, 7);
              VK_CALL(CmdCopyBuffer)(c, other.buffer, input.buffer, 1, &all);
              read_buffer(c);
            }),
            kNothing);
}

TEST_F(WrittenMemory, CopiesHandOnWhatIsNot) {
  const VkBufferCopy all{0, 0, kBytes};
  EXPECT_EQ(found_by([&](VkCommandBuffer c) {
              VK_CALL(CmdFillBuffer)(c, input.buffer, 0, VK_WHOLE_SIZE, 7);
              VK_CALL(CmdCopyBuffer)(c, other.buffer, input.buffer, 1, &all);
              read_buffer(c);
            }),
            kBuffer);
}

TEST_F(WrittenMemory, MappedMemoryCountsAsWritten) {
  void* mapped = nullptr;
  ASSERT_EQ(VK_CALL(MapMemory)(device, input.memory, 0, VK_WHOLE_SIZE, 0, &mapped), VK_SUCCESS);
  EXPECT_EQ(found_by([&](VkCommandBuffer c) { read_buffer(c); }), kNothing);
}

TEST_F(WrittenMemory, MappedMemoryIsWrittenWhereItIsCopied) {
  void* mapped = nullptr;
  ASSERT_EQ(VK_CALL(MapMemory)(device, other.memory, 0, VK_WHOLE_SIZE, 0, &mapped), VK_SUCCESS);
  const VkBufferCopy all{0, 0, kBytes};
  EXPECT_EQ(found_by([&](VkCommandBuffer c) {
              VK_CALL(CmdCopyBuffer)(c, other.buffer, input.buffer, 1, &all);
              read_buffer(c);
            }),
            kNothing);
}

TEST_F(WrittenMemory, OnlyTheMappedPartCountsAsWritten) {
  void* mapped = nullptr;
  ASSERT_EQ(VK_CALL(MapMemory)(device, input.memory, 0, 128, 0, &mapped), VK_SUCCESS);
  EXPECT_EQ(found_by([&](VkCommandBuffer c) { read_buffer(c); }), kBuffer);
  EXPECT_NE(text.find("at offset 128"), std::string::npos) << text;
}

TEST_F(WrittenMemory, MemoryThatIsAllocatedAgainIsFresh) {
  EXPECT_EQ(found_by([&](VkCommandBuffer c) {
              VK_CALL(CmdFillBuffer)
              (c, input.buffer, 0, VK_WHOLE_SIZE, 7);
            }),
            kNothing);
  remake(input);
  EXPECT_EQ(found_by([&](VkCommandBuffer c) { read_buffer(c); }), kBuffer);
}

TEST_F(WrittenMemory, ShadersWrite) {
  EXPECT_EQ(found_by([&](VkCommandBuffer c) {
              dispatch(c, "a[i] = i;");
              read_buffer(c);
            }),
            kNothing);
}

TEST_F(WrittenMemory, OtherInvocationsOfTheDispatchWrite) {
  // In any order: nothing says that the writer has to come first.
  EXPECT_EQ(found_by([&](VkCommandBuffer c) { dispatch(c, "uint x = a[63u - i]; o[i] = x; a[i] = i;"); }), kNothing);
  remake(input);
  EXPECT_EQ(found_by([&](VkCommandBuffer c) { dispatch(c, "if (i >= 64u) a[i - 64u] = i; else o[i] = a[i];", 128); }),
            kNothing);
  remake(input);
  EXPECT_EQ(
      found_by([&](VkCommandBuffer c) { dispatch(c, "if (i < 64u) a[i] = i; else o[i - 64u] = a[i - 64u];", 128); }),
      kNothing);
}

TEST_F(WrittenMemory, SumsOfWhatIsNotWrittenAreOne) {
  EXPECT_EQ(found_by([&](VkCommandBuffer c) { dispatch(c, "a[i] += 1u;"); }), kBuffer);
}

TEST_F(WrittenMemory, CountersThatNobodyCleared) {
  EXPECT_EQ(found_by([&](VkCommandBuffer c) { dispatch(c, "atomicAdd(a[0], 1u);"); }), kBuffer);
  EXPECT_NE(text.find("atomic operation on 4 bytes at offset 0"), std::string::npos) << text;
  remake(input);
  EXPECT_EQ(found_by([&](VkCommandBuffer c) {
              dispatch(c, "atomicExchange(a[0], 1u);", 1);
              dispatch(c, "atomicAdd(a[0], 1u);");
            }),
            kNothing);
}

TEST_F(WrittenMemory, FreshImagesAreLoaded) {
  EXPECT_EQ(found_by([&](VkCommandBuffer c) {
              transition(c, VK_IMAGE_LAYOUT_UNDEFINED);
              load_image(c);
            }),
            kImage);
  EXPECT_NE(text.find("load of texel (0, 0), which nothing has written, of storage image (set 0, binding 2, 8x8, "
                      "R32_UINT)"),
            std::string::npos)
      << text;
}

TEST_F(WrittenMemory, ClearedImagesAreNoFault) {
  EXPECT_EQ(found_by([&](VkCommandBuffer c) {
              transition(c, VK_IMAGE_LAYOUT_UNDEFINED);
              clear(c);
              load_image(c);
            }),
            kNothing);
}

TEST_F(WrittenMemory, TransitionsFromUndefinedGiveUpContents) {
  EXPECT_EQ(found_by([&](VkCommandBuffer c) {
              transition(c, VK_IMAGE_LAYOUT_UNDEFINED);
              clear(c);
              transition(c, VK_IMAGE_LAYOUT_GENERAL);
              load_image(c);
            }),
            kNothing);
  EXPECT_EQ(found_by([&](VkCommandBuffer c) {
              transition(c, VK_IMAGE_LAYOUT_UNDEFINED);
              load_image(c);
            }),
            kImage);
}

TEST_F(WrittenMemory, ShadersWriteTexels) {
  EXPECT_EQ(found_by([&](VkCommandBuffer c) {
              transition(c, VK_IMAGE_LAYOUT_UNDEFINED);
              dispatch(c, "imageStore(m, ivec2(i % 8u, i / 8u), uvec4(i));");
              load_image(c);
            }),
            kNothing);
}

TEST_F(WrittenMemory, BuffersAreCopiedToImages) {
  const VkBufferImageCopy all{0, 0, 0, {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1}, {}, {kSize, kSize, 1}};
  const auto copy_and_load = [&](bool filled) {
    return found_by([&](VkCommandBuffer c) {
      transition(c, VK_IMAGE_LAYOUT_UNDEFINED);
      if (filled) VK_CALL(CmdFillBuffer)(c, other.buffer, 0, VK_WHOLE_SIZE, 7);
      VK_CALL(CmdCopyBufferToImage)(c, other.buffer, image, VK_IMAGE_LAYOUT_GENERAL, 1, &all);
      load_image(c);
    });
  };
  EXPECT_EQ(copy_and_load(true), kNothing);
  remake(other);
  EXPECT_EQ(copy_and_load(false), kImage);
}

#ifdef VK_EXT_host_image_copy
TEST_F(WrittenMemory, TheHostCopiesIntoImages) {
  EXPECT_EQ(found_by([&](VkCommandBuffer c) { transition(c, VK_IMAGE_LAYOUT_UNDEFINED); }), kNothing);
  const std::array<std::uint32_t, kSize * kSize> texels{};
  auto region = make_struct<VkMemoryToImageCopyEXT>();
  region.pHostPointer = texels.data();
  region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
  region.imageExtent = {kSize, kSize, 1};
  auto info = make_struct<VkCopyMemoryToImageInfoEXT>();
  info.dstImage = image;
  info.dstImageLayout = VK_IMAGE_LAYOUT_GENERAL;
  info.regionCount = 1;
  info.pRegions = &region;
  EXPECT_EQ(VK_CALL(CopyMemoryToImageEXT)(device, &info), VK_SUCCESS);
  EXPECT_EQ(found_by([&](VkCommandBuffer c) { load_image(c); }), kNothing);
}
#endif

TEST_F(WrittenMemory, ImagesAreCopiedToBuffers) {
  const VkBufferImageCopy all{0, 0, 0, {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1}, {}, {kSize, kSize, 1}};
  const auto copy_and_read = [&](bool cleared) {
    return found_by([&](VkCommandBuffer c) {
      transition(c, VK_IMAGE_LAYOUT_UNDEFINED);
      if (cleared) clear(c);
      VK_CALL(CmdCopyImageToBuffer)(c, image, VK_IMAGE_LAYOUT_GENERAL, input.buffer, 1, &all);
      read_buffer(c);
    });
  };
  EXPECT_EQ(copy_and_read(true), kNothing);
  EXPECT_EQ(copy_and_read(false), kBuffer);
}

TEST_F(WrittenMemory, LookupsOfFreshImages) {
  const auto look_up = [&](bool cleared, const char* shader) {
    return found_by([&](VkCommandBuffer c) {
      transition(c, VK_IMAGE_LAYOUT_UNDEFINED);
      if (cleared) clear(c);
      dispatch(c, shader);
    });
  };
  for (const char* shader : {"o[i] = texelFetch(t, ivec2(i % 8u, i / 8u), 0).x;",
                             "o[i] = textureLod(t, vec2(0.3), 0.0).x;", "o[i] = textureGather(t, vec2(0.4)).y;"}) {
    EXPECT_EQ(look_up(true, shader), kNothing) << shader;
    EXPECT_EQ(look_up(false, shader), kImage) << shader;
  }
}

TEST_F(WrittenMemory, LoadAndStoreOps) {
  const auto render = [&](VkAttachmentLoadOp load, VkAttachmentStoreOp store) {
    return found_by([&](VkCommandBuffer c) {
      transition(c, VK_IMAGE_LAYOUT_UNDEFINED);
      clear(c);
      begin_rendering(c, load, store);
      VK_CALL(CmdEndRendering)(c);
      load_image(c);
    });
  };
  EXPECT_EQ(render(VK_ATTACHMENT_LOAD_OP_LOAD, VK_ATTACHMENT_STORE_OP_STORE), kNothing);
  EXPECT_EQ(render(VK_ATTACHMENT_LOAD_OP_CLEAR, VK_ATTACHMENT_STORE_OP_STORE), kNothing);
  EXPECT_EQ(render(VK_ATTACHMENT_LOAD_OP_DONT_CARE, VK_ATTACHMENT_STORE_OP_STORE), kImage);
  EXPECT_EQ(render(VK_ATTACHMENT_LOAD_OP_CLEAR, VK_ATTACHMENT_STORE_OP_DONT_CARE), kImage);
}

TEST_F(WrittenMemory, RenderPassesLoadAndStore) {
  const auto render = [&](VkAttachmentLoadOp load, VkAttachmentStoreOp store, VkImageLayout initial) {
    return found_by([&](VkCommandBuffer c) {
      transition(c, VK_IMAGE_LAYOUT_UNDEFINED);
      clear(c);
      run_render_pass(c, load, store, initial);
      load_image(c);
    });
  };
  constexpr VkImageLayout kGeneral = VK_IMAGE_LAYOUT_GENERAL;
  EXPECT_EQ(render(VK_ATTACHMENT_LOAD_OP_LOAD, VK_ATTACHMENT_STORE_OP_STORE, kGeneral), kNothing);
  EXPECT_EQ(render(VK_ATTACHMENT_LOAD_OP_CLEAR, VK_ATTACHMENT_STORE_OP_STORE, VK_IMAGE_LAYOUT_UNDEFINED), kNothing);
  EXPECT_EQ(render(VK_ATTACHMENT_LOAD_OP_DONT_CARE, VK_ATTACHMENT_STORE_OP_STORE, kGeneral), kImage);
  EXPECT_EQ(render(VK_ATTACHMENT_LOAD_OP_CLEAR, VK_ATTACHMENT_STORE_OP_DONT_CARE, kGeneral), kImage);
}

TEST_F(WrittenMemory, DrawsAndClearsOfAttachmentsWrite) {
  const VkClearAttachment clear_it{VK_IMAGE_ASPECT_COLOR_BIT, 0, {}};
  const VkClearRect all{{{0, 0}, {kSize, kSize}}, 0, 1};
  for (const bool draws : {false, true}) {
    EXPECT_EQ(found_by([&](VkCommandBuffer c) {
                transition(c, VK_IMAGE_LAYOUT_UNDEFINED);
                begin_rendering(c, VK_ATTACHMENT_LOAD_OP_DONT_CARE, VK_ATTACHMENT_STORE_OP_STORE);
                if (draws) {
                  draw(c);
                } else {
                  VK_CALL(CmdClearAttachments)(c, 1, &clear_it, 1, &all);
                }
                VK_CALL(CmdEndRendering)(c);
                load_image(c);
              }),
              kNothing);
  }
}

}  // namespace
}  // namespace vitrine::icd::test
