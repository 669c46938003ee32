// Reads of buffers and images that nothing has written (Vulkan 1.3.239, Device Memory; Resource Creation: "the contents
// of an image in VK_IMAGE_LAYOUT_UNDEFINED are undefined").
#include "glass/sanitize/written.h"

#include "glass/known_shadow.h"
#include "glass/sanitize/accesses.h"
#include "glass/sanitize/descriptors.h"
#include "glass/sanitize/lookups.h"
#include "glass/sanitize/operands.h"
#include "glass/sanitize/texel_address.h"

namespace vitrine::glass::sanitize {
namespace {

using spirv::Descriptor;
using spirv::Instruction;
using spirv::InstructionNote;
using spirv::MemorySpace;
using spirv::Wave;
using spirv::ir::ImageAccess;
using spirv::ir::ImageDim;
using spirv::ir::ImageOperand;

/// Of those that a lane remembers: enough for what one shader does between two barriers.
constexpr std::size_t kMostOwnReads = 1024;

std::uintptr_t number_of(const std::byte* address) { return reinterpret_cast<std::uintptr_t>(address); }

std::string nothing_written(std::string text, const std::string& what) {
  return text.append(", which nothing has written, of ").append(what);
}

std::string texel_text(const ImageLanes& operands, std::uint32_t dimensions, std::size_t lane) {
  std::string text = "texel (";
  for (std::uint32_t c = 0; c < dimensions; ++c)
    text += (c == 0 ? "" : ", ") + std::to_string(operands.coordinate(c, lane));
  text += ")";
  if (const auto level = operands.operand(ImageOperand::kLod, 0, lane); level.value_or(0) != 0)
    text += " of level " + std::to_string(*level);
  if (const auto sample = operands.operand(ImageOperand::kSample, 0, lane); sample.value_or(0) != 0)
    text += ", sample " + std::to_string(*sample);
  return text;
}

std::string point_text(const Lookup& lookup, ImageDim dim) {
  std::string text = "(";
  for (std::uint32_t c = 0; c < spirv::ir::coordinate_components(dim); ++c) {
    char number[32];
    std::snprintf(number, sizeof number, "%s%.6g", c == 0 ? "" : ", ", static_cast<double>(lookup.at[c]));
    text += number;
  }
  return text += ")";
}

}  // namespace

/// One instruction.
class WrittenAccess {
 public:
  WrittenAccess(WrittenCheck& check, const Wave& wave, const Instruction* i, const InstructionNote& note)
      : check_(check), wave_(wave), i_(i), note_(note), lanes_(wave.active & wave.live) {}

  void memory();
  void image();

 private:
  struct Effect {
    bool reads = false, writes = false;
  };

  void buffer(const spirv::MemoryOp& row, Effect effect);
  void global(const spirv::MemoryOp& row, Effect effect);
  void texels(const Descriptor& image, std::uint32_t element, base::LaneMask lanes, Effect effect);
  void lookups(const Descriptor& image, std::uint32_t element, base::LaneMask lanes);

  /// A lane's access to a piece. False: it reads what nothing has written.
  bool touch(std::size_t lane, const Piece& piece, Effect effect) {
    if (effect.reads && !piece.written()) {
      if (check_.own_.size() < kMostOwnReads) check_.own_.push_back({lane, piece.address, piece.bytes});
      return false;  // an atomic operation makes nothing known out of it
    }
    if (effect.writes) piece.region->mark(piece.address, piece.bytes, state_of_write(lane, piece));
    return true;
  }
  ByteState state_of_write(std::size_t lane, const Piece& piece) const {
    for (const WrittenCheck::OwnRead& own : check_.own_) {
      const bool overlaps = own.address < piece.address + piece.bytes && piece.address < own.address + own.bytes;
      if (own.lane == lane && overlaps) return ByteState::kDerived;
    }
    return ByteState::kWritten;
  }
  void keep(const char* rule, std::size_t lane, UnwrittenRead read) {
    Reporter& reporter = check_.reporter_;
    const std::uint64_t number = place_of_access(wave_, i_, note_);
    if (reporter.program().places.is_told({number, rule})) return;
    const Id id = reporter.invocation(wave_, lane);
    check_.reads_->add({&reporter.program(), number, rule, note_.origin}, wave_.resources->command, id,
                       Reporter::order_of(wave_, id), std::move(read));
  }

  WrittenCheck& check_;
  const Wave& wave_;
  const Instruction* const i_;
  const InstructionNote& note_;
  const base::LaneMask lanes_;
};

void WrittenAccess::memory() {
  const spirv::MemoryOp& row = wave_.program->memory_ops[i_->extra[0]];
  const bool reads = sanitize::reads(row, note_.access);
  // An atomic operation leaves known what was: there is nothing to note.
  const Effect effect{reads, writes(row, note_.access) && !reads};
  if (note_.space == MemorySpace::kUniformBuffer || note_.space == MemorySpace::kStorageBuffer) buffer(row, effect);
  if (note_.space == MemorySpace::kGlobal) global(row, effect);
}

void WrittenAccess::buffer(const spirv::MemoryOp& row, Effect effect) {
  const Touched touched = touched_by(row, note_.access);
  const Words address(wave_, {note_.files[1], i_->src[0]});
  const auto access_buffer = [&](const spirv::exec::Bytes& bytes, base::LaneMask same) {
    const ShadowRegion* region = bytes.data ? find_shadow(bytes.data) : nullptr;
    if (region == nullptr || region->is_mapped(number_of(bytes.data), bytes.size)) return;
    if (is_all_written(*region, bytes.data, bytes.size, wave_.resources->command)) return;
    base::for_each_lane(same, [&](std::size_t lane) {
      UnwrittenRead read;
      bool known = true;
      for (std::uint32_t c = 0; c < touched.count; ++c) {
        const std::uint32_t offset = address[lane] + touched.at[c];
        if (std::uint64_t{offset} + row.element_bytes > bytes.size) continue;  // another rule's
        const Piece piece{region, number_of(bytes.data) + offset, row.element_bytes, Contents::kBytes};
        if (touch(lane, piece, effect)) continue;
        known = false;
        read.pieces.push_back(piece);
      }
      if (known) return;
      const Extent extent = extent_of(row, note_.access);
      const std::uint32_t element = element_of(wave_, row.index, lane), set = row.set, slot = row.slot;
      const std::uint64_t size = bytes.size;
      const std::uint32_t first = address[lane] + row.added + extent.first, count = extent.end - extent.first;
      read.message = [=, command = wave_.resources->command, verb = verb_of(note_.access)] {
        return nothing_written(
            verb + bytes_text(count, first),
            resource_text(command, set, slot + element, "a buffer of " + std::to_string(size) + " bytes"));
      };
      keep("uninitialized-memory", lane, std::move(read));
    });
  };
  spirv::exec::for_each_buffer(const_cast<Wave&>(wave_), row, lanes_, access_buffer);
}

void WrittenAccess::global(const spirv::MemoryOp& row, Effect effect) {
  const Touched touched = touched_by(row, note_.access);
  const Addresses addresses(wave_, *i_, note_);
  // What lies outside of live buffers is another rule's.
  const auto in_buffer = [command = wave_.resources->command](std::uintptr_t at, std::uint64_t bytes) {
    const spirv::AddressRange range = command != nullptr ? command->buffers_at(at) : spirv::find_addresses(at);
    return range.begin != range.end && range.end - at >= bytes;
  };
  base::for_each_lane(lanes_, [&](std::size_t lane) {
    UnwrittenRead read;
    std::uintptr_t first = 0;
    for (std::uint32_t c = 0; c < touched.count; ++c) {
      const std::uintptr_t address = addresses(lane, touched.at[c]);
      const ShadowRegion* region = find_shadow(reinterpret_cast<const void*>(address));
      if (region == nullptr) continue;
      const Piece piece{region, address, row.element_bytes, Contents::kBytes};
      if (touch(lane, piece, effect) || !in_buffer(address, row.element_bytes)) continue;
      if (read.pieces.empty()) first = address;
      read.pieces.push_back(piece);
    }
    if (read.pieces.empty()) return;
    const std::size_t bytes = read.pieces.size() * row.element_bytes;
    const std::uintptr_t offset = first - read.pieces[0].region->first();
    const std::uint64_t size = read.pieces[0].region->end() - read.pieces[0].region->first();
    read.message = [=, verb = verb_of(note_.access)] {
      return nothing_written(verb + bytes_text(bytes, offset),
                             "memory at a device address (an allocation of " + std::to_string(size) + " bytes)");
    };
    keep("uninitialized-memory", lane, std::move(read));
  });
}

void WrittenAccess::texels(const Descriptor& image, std::uint32_t element, base::LaneMask lanes, Effect effect) {
  const spirv::ImageOp& op = wave_.program->image_ops[i_->extra[0]];
  const bool buffer = op.info.dim == ImageDim::kBuffer;
  const texel::ImageView* const view = image.image;
  const std::byte* const base = buffer ? image.texels->data : view->base;
  const ShadowRegion* const region = find_shadow(base);
  if (region == nullptr || (!buffer && view->planes != nullptr)) return;
  const spirv::ObservedCommand* const command = wave_.resources->command;
  if (buffer ? is_all_written(*region, base, image.texels->count * image.texels->format->block_bytes, command)
             : is_all_written(*region, *view, command))
    return;
  const ImageLanes operands(wave_, op);
  base::for_each_lane(lanes, [&](std::size_t lane) {
    const TexelBytes texel = texel_bytes(image, op, operands, lane);
    const Piece piece{region, texel.address, texel.bytes, buffer ? Contents::kBytes : Contents::kTexels};
    if (texel.bytes == 0 || touch(lane, piece, effect)) return;
    const std::uint32_t set = op.info.set, slot = op.info.slot + element;
    std::string text = (op.info.access == ImageAccess::kAtomic ? "atomic operation on " : "load of ") +
                       texel_text(operands, std::min(operands.dimensions(), 3u), lane);
    UnwrittenRead read{{piece}, false, [=, command = wave_.resources->command] {
                         return nothing_written(
                             text, resource_text(command, set, slot, buffer ? "a texel buffer" : "an image"));
                       }};
    keep(buffer ? "uninitialized-memory" : "uninitialized-image", lane, std::move(read));
  });
}

void WrittenAccess::lookups(const Descriptor& image, std::uint32_t element, base::LaneMask lanes) {
  const spirv::ImageOp& op = wave_.program->image_ops[i_->extra[0]];
  const texel::ImageView& view = *image.image;
  const ShadowRegion* const region = find_shadow(view.base);
  if (region == nullptr || !has_dimension(op.info.dim, view.type) || op.info.has_gather_offsets) return;
  if (is_all_written(*region, view, wave_.resources->command)) return;
  const ImageLanes operands(wave_, op);
  base::for_each_lane(lanes, [&](std::size_t lane) {
    const texel::Sampler* sampler = sampler_of(wave_, op, image, lane);
    if (sampler == nullptr) return;
    const Lookup lookup = lookup_of(op, operands, lane);
    const auto piece_of = [&](const std::byte* block) {
      return Piece{region, number_of(block), view.format->block_bytes, Contents::kTexels};
    };
    if (!all_of_footprint(view, *sampler, lookup, [&](const std::byte* b) { return !piece_of(b).written(); })) return;
    UnwrittenRead read{{}, true, {}};
    all_of_footprint(view, *sampler, lookup, [&](const std::byte* block) {
      read.pieces.push_back(piece_of(block));
      return true;
    });
    const std::uint32_t set = op.info.set, slot = op.info.slot + element;
    read.message = [=, command = wave_.resources->command] {
      return nothing_written("lookup at " + point_text(lookup, op.info.dim),
                             resource_text(command, set, slot, "an image"));
    };
    keep("uninitialized-image", lane, std::move(read));
  });
}

void WrittenAccess::image() {
  const spirv::ImageOp& op = wave_.program->image_ops[i_->extra[0]];
  Effect effect;
  switch (op.info.access) {
    case ImageAccess::kFetch:
    case ImageAccess::kRead:
    case ImageAccess::kSubpass:
      effect.reads = true;
      break;
    case ImageAccess::kWrite:
      effect.writes = true;
      break;
    case ImageAccess::kAtomic:
      using spirv::ir::AtomicOp;
      (op.info.atomic == AtomicOp::kExchange || op.info.atomic == AtomicOp::kStore ? effect.writes : effect.reads) =
          true;
      break;
    case ImageAccess::kSample:
    case ImageAccess::kGather:
      return for_each_image(wave_, op, [&](const Descriptor* image, std::uint32_t element, base::LaneMask lanes) {
        if (image != nullptr && (lanes & wave_.live) != 0) lookups(*image, element, lanes & wave_.live);
      });
    default:
      return;
  }
  for_each_image(wave_, op, [&](const Descriptor* image, std::uint32_t element, base::LaneMask lanes) {
    if (image != nullptr && (lanes & wave_.live) != 0) texels(*image, element, lanes & wave_.live, effect);
  });
}

void WrittenCheck::access(const Wave& wave, const Instruction* i, const InstructionNote& note) {
  if (reads_ == nullptr || (wave.active & wave.live) == 0) return;
  WrittenAccess access(*this, wave, i, note);
  note.access == spirv::Access::kImage ? access.image() : access.memory();
}

}  // namespace vitrine::glass::sanitize
