// What this room can do with a format; the manifest's format claims must not exceed it.
#pragma once

#include "texel/format.h"

namespace vitrine::texel {

bool can_decode(const FormatDesc& format);          ///< plain formats: fetch, vertex attributes, texel buffers
bool can_fetch_vertices(const FormatDesc& format);  ///< these and 64-bit integers
bool can_encode(const FormatDesc& format);          ///< plain formats: clears, blit and resolve destinations
bool can_sample(const FormatDesc& format);          ///< sampled images: plain formats, BC, ETC2, EAC, ASTC
bool can_filter(const FormatDesc& format);          ///< linear filtering: sampled formats that are not integers
bool can_store(const FormatDesc& format);           ///< storage images and storage texel buffers
bool can_atomic(const FormatDesc& format);          ///< image atomics: R32_UINT, R32_SINT, R32_SFLOAT
bool can_copy(const FormatDesc& format);            ///< copies of any kind: every single-plane format and depth/stencil

}  // namespace vitrine::texel
