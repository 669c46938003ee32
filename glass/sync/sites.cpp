// See sites.h.
#include "glass/sync/sites.h"

#include "glass/sanitize/accesses.h"
#include "spirv/memory_order.h"

namespace vitrine::glass::sync {
namespace {

using spirv::MemorySpace;
using spirv::ir::AtomicOp;
using spirv::ir::ImageAccess;

/// Tells shaders apart, in every run in the same way.
std::uint64_t hash_of(const ShaderIdentity& shader) {
  std::uint64_t hash = 0xcbf29ce484222325;
  const auto add = [&](std::uint64_t word) { hash = (hash ^ word) * 0x100000001b3; };
  for (const std::uint32_t word : shader.words) add(word);
  for (const char c : shader.entry_point) add(static_cast<unsigned char>(c));
  return hash;
}

bool memory_site(const spirv::Program& program, const spirv::Instruction& i, const spirv::InstructionNote& note,
                 Site& site) {
  const spirv::MemoryOp& row = program.memory_ops[i.extra[0]];
  const bool uniform = note.space == MemorySpace::kUniformBuffer;
  if (!uniform && note.space != MemorySpace::kStorageBuffer && note.space != MemorySpace::kGlobal) return false;
  const sanitize::Extent extent = sanitize::extent_of(row, note.access);
  if (extent.end == 0) return false;
  if (sanitize::reads(row, note.access)) site.read = uniform ? Access::kUniformRead : Access::kStorageRead;
  if (sanitize::writes(row, note.access)) site.write = Access::kStorageWrite;
  const std::uint32_t bytes = extent.end - extent.first;
  site.what = sanitize::verb_of(note.access) + std::to_string(bytes) + (bytes == 1 ? " byte" : " bytes");
  site.set = row.set;
  site.slot = row.slot;
  return true;
}

bool image_site(const spirv::Program& program, const spirv::Instruction& i, Site& site) {
  const spirv::ir::ImageInfo& info = program.image_ops[i.extra[0]].info;
  site.set = info.set;
  site.slot = info.slot;
  switch (info.access) {
    case ImageAccess::kSample:
    case ImageAccess::kGather:
      site.read = Access::kSampledRead;
      site.what = "lookup in texels";
      return true;
    case ImageAccess::kFetch:
      site.read = Access::kSampledRead;
      site.what = "fetch of texels";
      return true;
    case ImageAccess::kRead:
      site.read = Access::kStorageRead;
      site.what = "load of texels";
      return true;
    case ImageAccess::kSubpass:
      site.read = Access::kInputAttachmentRead;
      site.what = "load of texels";
      return true;
    case ImageAccess::kWrite:
      site.write = Access::kStorageWrite;
      site.what = "store of texels";
      return true;
    case ImageAccess::kAtomic:
      if (info.atomic != AtomicOp::kStore && info.atomic != AtomicOp::kExchange) site.read = Access::kStorageRead;
      if (info.atomic != AtomicOp::kLoad) site.write = Access::kStorageWrite;
      site.what = "atomic operation on texels";
      return true;
    default:
      return false;
  }
}

bool is_atomic(const spirv::Program& program, const spirv::Instruction& i, const spirv::InstructionNote& note) {
  if (!covers_device(spirv::MemoryOrder::of(note.origin.order).memory)) return false;
  if (note.access != spirv::Access::kImage) return note.access == spirv::Access::kAtomic;
  return program.image_ops[i.extra[0]].info.access == ImageAccess::kAtomic;
}

/// As race has it: the instruction of SPIR-V, or its line and what it touches.
std::string place_of(std::uint64_t hash, const Site& site, std::size_t index) {
  std::string text = std::to_string(hash) + ":";
  if (site.origin.place == 0 && site.origin.spirv_id == 0) return text + "i" + std::to_string(index);
  text += std::to_string(site.origin.place) + ":" + std::to_string(site.origin.spirv_id);
  return site.origin.spirv_id != 0 ? text : text + ":" + std::to_string(site.set) + "." + std::to_string(site.slot);
}

}  // namespace

Sites::Sites(const ShaderIdentity& shader, const spirv::Program& program) : context(shader, program) {
  by_instruction.assign(program.code.size(), kNone);
  const std::uint64_t hash = hash_of(shader);
  for (std::size_t index = 0; index < program.code.size(); ++index) {
    const spirv::InstructionNote& note = program.notes[index];
    if (note.access == spirv::Access::kNone) continue;
    Site site;
    if (!(note.access == spirv::Access::kImage ? image_site(program, program.code[index], site)
                                               : memory_site(program, program.code[index], note, site)))
      continue;
    site.atomic = is_atomic(program, program.code[index], note);
    site.origin = note.origin;
    site.place = place_of(hash, site, index);
    by_instruction[index] = static_cast<std::uint32_t>(all.size());
    all.push_back(std::move(site));
  }
}

}  // namespace vitrine::glass::sync
