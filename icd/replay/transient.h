// Samples of single-sampled attachments (VK_EXT_multisampled_render_to_single_sampled): a scope draws to a multisampled
// image of its own, which begins with the attachment's texels in every sample and is resolved to the attachment.
#pragma once

#include <list>

#include "icd/object/image.h"

namespace vitrine::icd {

struct TransientAttachment {
  explicit TransientAttachment(const HostMemory& m) : image(m), view(m), texels(m) {}

  const ImageView* single = nullptr;  ///< what it stands for
  Image image;
  ImageView view;
  Vector<std::byte> texels;
};

/// They stay until the scope is over, or, when it is suspended, until the one that resumes it is.
using TransientAttachments = std::list<TransientAttachment, HostAllocator<TransientAttachment>>;

/// The multisampled image that stands for `single`, made unless it is there. `single` itself if it is null or
/// multisampled, or `samples` is 1. Throws std::bad_alloc.
const ImageView* transient_of(TransientAttachments& all, const ImageView* single, std::uint32_t samples);

}  // namespace vitrine::icd
