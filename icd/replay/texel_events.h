// What commands do to watched texels (glass/pixel/pixels.h). Nothing of it is called where none is watched.
#pragma once

#include "icd/replay/written.h"

namespace vitrine::icd {

inline bool watches_texels(const ReplayState& state) { return state.observed && state.observed->pixels; }

// After a command of that kind has been replayed.
void note_texels(ReplayState& state, const CmdCopyImage& command);
void note_texels(ReplayState& state, const CmdBlitImage& command);
void note_texels(ReplayState& state, const CmdResolveImage& command);
void note_texels(ReplayState& state, const CmdCopyBufferToImage& command);
void note_texels(ReplayState& state, const CmdCopyImageToBuffer& command);
void note_texels(ReplayState& state, const CmdCopyBuffer& command);
void note_texels(ReplayState& state, const CmdClearColorImage& command);
void note_texels(ReplayState& state, const CmdClearDepthStencilImage& command);
void note_texels(ReplayState& state, const CmdDiscardImages& command);
void note_texels(ReplayState& state, const CmdClearAttachments& command);

/// The host has copied, without a command buffer, from its memory or between images. `command`: what it called.
void note_host_upload(const Image& to, const VkBufferImageCopy& region, const char* command);
void note_host_copy(const Image& from, const Image& to, const VkImageCopy& region, const char* command);

/// A pass with these attachments begins; its load ops come next.
void begin_watched_pass(ReplayState& state, const raster::PassDesc& desc);
/// Load ops, as note_load() and the others (icd/replay/written.h) are told of them: events when finish_loads() is
/// called, behind the clears that they are.
void note_texels_loaded(const ReplayState& state, const AttachmentPart& part, VkAttachmentLoadOp op);
void note_texels_undefined(const ReplayState& state, const AttachmentPart& part);
void finish_loads(ReplayState& state);
/// The end of a scope.
void note_texels_stored(const ReplayState& state, const AttachmentPart& part, VkAttachmentStoreOp op);
void note_texels_resolved(const ReplayState& state, const AttachmentPart& part, const texel::ImageView& source);

/// Something that the command at hand does.
glass::pixel::Event texel_event(const ReplayState& state, glass::pixel::EventKind kind, std::string text);

}  // namespace vitrine::icd
