// What commands write and what they leave undefined, told to the shadow of device memory (glass/memory_shadow.h).
// Nothing of it is called where no tool keeps one.
#pragma once

#include "glass/range_shadow.h"
#include "icd/replay/observed_replay.h"

namespace vitrine::icd {

inline bool shadows_memory(const ReplayState& state) { return state.observed && state.observed->shadows_memory; }
/// Whether anybody is told of what attachments hold: that shadow, texels that are watched, or the tool sync.
inline bool follows_attachments(const ReplayState& state) {
  return state.observed && (state.observed->shadows_memory || state.observed->pixels || state.observed->hazards);
}

// After a command of that kind has been replayed.
void note_written(ReplayState& state, const CmdCopyBuffer& command);
void note_written(ReplayState& state, const CmdUpdateBuffer& command);
void note_written(ReplayState& state, const CmdFillBuffer& command);
void note_written(ReplayState& state, const CmdCopyImage& command);
void note_written(ReplayState& state, const CmdBlitImage& command);
void note_written(ReplayState& state, const CmdResolveImage& command);
void note_written(ReplayState& state, const CmdCopyBufferToImage& command);
void note_written(ReplayState& state, const CmdCopyImageToBuffer& command);
void note_written(ReplayState& state, const CmdClearColorImage& command);
void note_written(ReplayState& state, const CmdClearDepthStencilImage& command);
void note_written(ReplayState& state, const CmdCopyQueryPoolResults& command);
void note_written(ReplayState& state, const CmdBindTransformFeedbackBuffers& command);
void note_written(ReplayState& state, const CmdEndTransformFeedback& command);
void note_written(ReplayState& state, const CmdDiscardImages& command);
void note_written(ReplayState& state, const CmdDraw& command);
void note_written(ReplayState& state, const CmdDrawIndexed& command);
void note_written(ReplayState& state, const CmdDrawMulti& command);
void note_written(ReplayState& state, const CmdDrawMultiIndexed& command);
void note_written(ReplayState& state, const CmdDrawIndirect& command);
void note_written(ReplayState& state, const CmdDrawByteCount& command);
void note_written(ReplayState& state, const CmdClearAttachments& command);

/// Something else than these commands has written a region.
void fill_region(const Image& image, const VkImageSubresourceLayers& layers, const VkOffset3D& offset,
                 const VkExtent3D& extent);

/// Draws and clears go to these attachments from now on.
void note_pass(ReplayState& state, const raster::PassDesc& desc);
/// Where a draw may leave fragments.
VkRect2D drawn_area(const ObservedPass& pass, const raster::State& state);
bool writes_stencil(const raster::State& state);

/// An attachment and the part of it that a scope has, layers of its view.
struct AttachmentPart {
  const ImageView* view = nullptr;
  VkImageAspectFlags aspects = 0;
  VkRect2D area{};
  std::uint32_t layer = 0, layers = 0;
};
/// "The contents of the attachment will be undefined inside the render area" (VK_ATTACHMENT_LOAD_OP_DONT_CARE, and the
/// store op of that name).
void note_load(const ReplayState& state, const AttachmentPart& part, VkAttachmentLoadOp op);
void note_store(const ReplayState& state, const AttachmentPart& part, VkAttachmentStoreOp op);
/// It holds the resolved texels of `source`.
void note_resolved(const ReplayState& state, const AttachmentPart& part, const texel::ImageView& source);
/// All of a view, from VK_IMAGE_LAYOUT_UNDEFINED.
void note_undefined(const ReplayState& state, const ImageView& view, VkImageAspectFlags aspects);

/// What is left of an image whose contents are given up. The host may write those of a linear one at any time.
glass::ByteState discarded_state(const Image& image);

}  // namespace vitrine::icd
