// What the tool `sync` (glass/sync/sync.h) is told of commands. Nothing of it is called where the tool is off.
#pragma once

#include "glass/sync/sync.h"
#include "icd/replay/written.h"

namespace vitrine::icd {

inline bool follows_hazards(const ReplayState& state) { return state.observed && state.observed->hazards; }

// After a command of that kind has been replayed.
void note_sync(ReplayState& state, const CmdCopyBuffer& command);
void note_sync(ReplayState& state, const CmdUpdateBuffer& command);
void note_sync(ReplayState& state, const CmdFillBuffer& command);
void note_sync(ReplayState& state, const CmdCopyImage& command);
void note_sync(ReplayState& state, const CmdBlitImage& command);
void note_sync(ReplayState& state, const CmdResolveImage& command);
void note_sync(ReplayState& state, const CmdCopyBufferToImage& command);
void note_sync(ReplayState& state, const CmdCopyImageToBuffer& command);
void note_sync(ReplayState& state, const CmdClearColorImage& command);
void note_sync(ReplayState& state, const CmdClearDepthStencilImage& command);
void note_sync(ReplayState& state, const CmdCopyQueryPoolResults& command);
void note_sync(ReplayState& state, const CmdDrawIndirect& command);
void note_sync(ReplayState& state, const CmdDrawByteCount& command);
void note_sync(ReplayState& state, const CmdDispatchIndirect& command);
void note_sync(ReplayState& state, const CmdBeginConditionalRendering& command);
void note_sync(ReplayState& state, const CmdDependency& command);
void note_sync(ReplayState& state, const CmdUsedLayouts& command);
void note_sync(ReplayState& state, const CmdDraw& command);
void note_sync(ReplayState& state, const CmdDrawIndexed& command);
void note_sync(ReplayState& state, const CmdDrawMulti& command);
void note_sync(ReplayState& state, const CmdDrawMultiIndexed& command);
void note_sync(ReplayState& state, const CmdClearAttachments& command);

/// The subpass of a render pass instance begins, before its load ops; or the last one has ended.
void note_sync_subpass(ReplayState& state);
/// The same of dynamic rendering.
void note_sync_rendering(ReplayState& state, const CmdBeginRendering& command);
void note_sync_end(ReplayState& state);
/// As note_load(), note_store() and note_resolved() (icd/replay/written.h).
void note_sync_load(const ReplayState& state, const AttachmentPart& part, VkAttachmentLoadOp op);
void note_sync_store(const ReplayState& state, const AttachmentPart& part, VkAttachmentStoreOp op);
void note_sync_resolved(const ReplayState& state, const AttachmentPart& part);

/// The command at hand does something to memory.
glass::sync::Tag tag_of(const ReplayState& state, glass::sync::Part part = glass::sync::Part::kWork);
std::shared_ptr<glass::sync::Who> sync_who(const ReplayState& state, std::string what, std::string resource);
std::string sync_name(Device& device, const Image& image);
std::string sync_name(Device& device, const Buffer& buffer);
glass::sync::ImagePart part_of(const Image& image, const VkImageSubresourceRange& range);
std::string layout_text(VkImageLayout layout);
/// A command says that a part of an image has a layout, or gives it one.
void use_layout(const ReplayState& state, const Image& image, const VkImageSubresourceRange& range,
                VkImageLayout layout);
void set_layout(const ReplayState& state, const Image& image, const VkImageSubresourceRange& range,
                VkImageLayout layout);
/// The bytes of a box of texels, added to `ranges`.
void add_texels(const texel::ImageView& view, const glass::TexelBox& box, std::vector<glass::sync::Range>& ranges);
void add_subresources(const Image& image, const VkImageSubresourceRange& range,
                      std::vector<glass::sync::Range>& ranges);

}  // namespace vitrine::icd
