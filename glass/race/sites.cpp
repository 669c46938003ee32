// See sites.h.
#include "glass/race/sites.h"

#include <algorithm>
#include <span>

namespace vitrine::glass::race {
namespace {

using spirv::Access;
using spirv::MemoryOrder;
using spirv::MemorySpace;
using spirv::ir::ImageAccess;

constexpr std::uint32_t kOpSource = 3, kOpMemoryModel = 14, kOpMemoryBarrier = 225;
constexpr std::uint32_t kHlsl = 5, kVulkan = 3;

/// What a module says of itself: the language, the memory model, and whether it has barriers of memory alone.
void read_module(std::span<const std::uint32_t> words, Sites& sites, bool& fences) {
  for (std::size_t at = 5; at < words.size();) {
    const std::uint32_t length = words[at] >> 16, op = words[at] & 0xffff;
    if (length == 0 || length > words.size() - at) return;
    if (op == kOpSource && length > 1) sites.hlsl = words[at + 1] == kHlsl;
    if (op == kOpMemoryModel && length > 2) sites.vulkan_model = words[at + 2] == kVulkan;
    if (op == kOpMemoryBarrier) fences = true;
    at += length;
  }
}

bool is_private(const Sites& sites, const MemoryOrder& order) {
  if (sites.hlsl) return false;
  return sites.vulkan_model ? (order.bits & MemoryOrder::kNonPrivate) == 0 : !order.coherent;
}

/// What tells an access apart (as sanitize/reporter.h): the instruction of SPIR-V, or its line and what it stores to.
std::uint64_t place_of(const spirv::ir::Origin& origin, std::uint32_t target, std::size_t index) {
  if (origin.place == 0 && origin.spirv_id == 0) return index;
  const std::uint32_t which = origin.spirv_id != 0 ? origin.spirv_id : target | 1u << 31;
  return std::uint64_t{1} << 63 | std::uint64_t{origin.place} << 32 | which;
}

bool memory_site(const spirv::Program& program, const spirv::Instruction& i, const spirv::InstructionNote& note,
                 Site& site) {
  const spirv::MemoryOp& row = program.memory_ops[i.extra[0]];
  const bool compute = program.observation->interface.stage == VK_SHADER_STAGE_COMPUTE_BIT;
  if (note.space == MemorySpace::kPush || note.space == MemorySpace::kArray) return false;
  if (note.space == MemorySpace::kShared && !compute) return false;  // memory of the stage, not the shader's
  site.memory = note.space == MemorySpace::kShared ? Memory::kShared : Memory::kBuffer;
  site.action = note.access;
  // An exchange reads, too: what sanitize says is about values that are used.
  site.atomic_reads = note.access == Access::kAtomic && row.atomic != spirv::ir::AtomicOp::kStore;
  site.atomic_writes = note.access == Access::kAtomic && sanitize::writes(row, note.access);
  const sanitize::Extent extent = sanitize::extent_of(row, note.access);
  if (extent.end == 0) return false;
  site.bytes = extent.end - extent.first;
  site.touched = sanitize::touched_by(row, note.access);
  site.element_bytes = row.element_bytes;
  site.first = row.added + extent.first;
  site.end = row.added + extent.end;
  for (std::uint32_t c = 0; c < site.touched.count; ++c)
    site.component[c] = std::min((site.touched.at[c] - row.added) / row.element_bytes, 3u);
  site.set = row.set;
  site.slot = row.slot;
  return true;
}

bool image_site(const spirv::Program& program, const spirv::Instruction& i, Site& site) {
  const spirv::ir::ImageInfo& info = program.image_ops[i.extra[0]].info;
  using spirv::ir::AtomicOp;
  switch (info.access) {
    case ImageAccess::kFetch:
    case ImageAccess::kRead:
      site.action = Access::kLoad;
      break;
    case ImageAccess::kWrite:
      site.action = Access::kStore;
      break;
    case ImageAccess::kAtomic:
      site.action = Access::kAtomic;
      site.atomic_reads = info.atomic != AtomicOp::kStore;
      site.atomic_writes = info.atomic != AtomicOp::kLoad;
      break;
    default:
      return false;
  }
  site.memory = Memory::kImage;
  site.is_texel = true;
  site.set = info.set;
  site.slot = info.slot;
  return true;
}

}  // namespace

Sites::Sites(const ShaderIdentity& shader, const spirv::Program& program) {
  bool fences = false;
  read_module(shader.words, *this, fences);
  by_instruction.assign(program.code.size(), kNone);
  bool orders = false, unlike = false;
  for (std::size_t index = 0; index < program.code.size(); ++index) {
    const spirv::InstructionNote& note = program.notes[index];
    Site site;
    const bool image = note.access == Access::kImage;
    if (note.access == Access::kNone) continue;
    if (image ? !image_site(program, program.code[index], site)
              : !memory_site(program, program.code[index], note, site))
      continue;
    site.origin = note.origin;
    site.order = MemoryOrder::of(note.origin.order);
    site.place =
        place_of(note.origin, static_cast<std::uint32_t>(site.memory) << 28 ^ site.set << 16 ^ site.slot, index);
    site.is_private = site.memory != Memory::kShared && !site.is_atomic() && is_private(*this, site.order);
    const bool device = site.memory != Memory::kShared;
    if (!device) (site.order.alike ? alike : unlike) = true;
    alike_if_given |= !device && site.order.given;
    has_private |= site.is_private;
    has_atomics |= site.is_atomic();
    orders_shared |= site.is_atomic() && (site.order.acquires() || site.order.releases());
    has_narrow_scope |= site.is_atomic() && !covers_device(site.order.memory);
    writes_device |= device && site.writes();
    writes_images |= image && site.writes();
    writes_global |= !image && note.space == MemorySpace::kGlobal && site.writes();
    const bool fenced = fences || site.order.acquires() || site.order.releases();
    orders |= device && site.is_atomic() && fenced && covers_device(site.order.memory);
    by_instruction[index] = static_cast<std::uint32_t>(all.size());
    all.push_back(site);
  }
  orders_device = orders && writes_device && shader.stage == VK_SHADER_STAGE_COMPUTE_BIT;
  alike &= !unlike && !orders_device && program.groups_per_wave == 1;
  orders_waves = orders && shader.stage != VK_SHADER_STAGE_COMPUTE_BIT;
}

std::string what_text(const Site& site) {
  std::string text = site.action == Access::kLoad    ? "load of "
                     : site.action == Access::kStore ? "store to "
                                                     : "atomic operation on ";
  if (site.is_texel) return text + "a texel";
  if (site.action == Access::kStore) text = "store of ";
  return text + std::to_string(site.bytes) + (site.bytes == 1 ? " byte" : " bytes");
}

}  // namespace vitrine::glass::race
