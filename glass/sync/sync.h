// The tool `sync` as icd/ sees it: who holds the accesses of a device's commands against each other. Nothing of it
// exists where the tool is off.
#pragma once

#include "glass/sync/hazards.h"

namespace vitrine::glass::sync {

/// Whether the tool is on.
bool is_on();
/// Those of a device, told apart as spirv::ObservedCommand::owner has it; null: the tool is off.
Hazards* hazards_of(const void* owner);
/// The device is gone.
void forget_owner(const void* owner);
/// Others see the memory of one of the owner's images, too.
void share_image(const void* owner, const void* image);
/// An image is gone, which was a part of the owner's.
void forget_image(const void* owner, const void* image);
/// Memory is gone.
void forget_memory(const std::byte* data, std::uint64_t size);

}  // namespace vitrine::glass::sync
