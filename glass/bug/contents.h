// What buffers and bindings of a bug hold.
#pragma once

#include "glass/bug/bug.h"

namespace vitrine::glass::bug {

/// The bytes of a buffer before the command, or behind it; what the bug does not know of it is zero.
Bytes contents_of(const Bug& bug, const Buffer& buffer, bool after);

/// The type of a binding; of a mutable one the type that all of its descriptors have taken on, or
/// VK_DESCRIPTOR_TYPE_MUTABLE_EXT if they are of several.
VkDescriptorType plain_type(const Bug& bug, std::uint32_t set, const Binding& binding);

}  // namespace vitrine::glass::bug
