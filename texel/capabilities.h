// What this room can do with a format; the manifest's format claims must not exceed it.
#pragma once

#include "texel/format.h"

namespace vitrine::texel {

bool can_decode(const FormatDesc& format);  ///< plain formats: fetch, vertex attributes, texel buffers
bool can_encode(const FormatDesc& format);  ///< plain formats: clears, blit and resolve destinations
bool can_sample(const FormatDesc& format);  ///< sampled images: plain formats, BC, ETC2, EAC, ASTC
bool can_store(const FormatDesc& format);   ///< storage images and storage texel buffers

}  // namespace vitrine::texel
