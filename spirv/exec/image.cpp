// Image instructions: operands gathered into texel's requests, once per distinct descriptor among the active lanes.
#include <algorithm>
#include <array>

#include "base/lasting.h"
#include "spirv/exec/atomic_ops.h"
#include "spirv/exec/buffers.h"
#include "spirv/exec/handlers.h"
#include "spirv/exec/same_words.h"
#include "texel/load_store/prepared_access.h"
#include "texel/sampler/prepared.h"

namespace vitrine::spirv::exec {
namespace {

using base::WaveRegister;
using ir::ImageAccess;
using ir::ImageOperand;

/// Operands and results of one image instruction in this wave.
struct Call {
  Call(Wave& w, std::uint32_t i) : wave(w), op(w.program->image_ops[i]), index(i) {}

  Wave& wave;
  const ImageOp& op;
  std::uint32_t index;     ///< of the operation in its program
  WaveRegister result[4];  ///< inactive lanes stay unset

  const WaveRegister* operand(ImageOperand which, std::uint32_t component = 0) const {
    const std::uint32_t offset = op.operand[static_cast<std::size_t>(which)][component];
    return offset == kNoOperand ? nullptr : &reg(wave, offset);
  }
  template <std::size_t N>
  std::array<const WaveRegister*, N> operands(ImageOperand which) const {
    std::array<const WaveRegister*, N> all{};
    for (std::uint32_t c = 0; c < N; ++c) all[c] = operand(which, c);
    return all;
  }
};

void zero_result(Call& call, base::LaneMask lanes) {
  for (WaveRegister& component : call.result)
    base::for_each_lane(lanes, [&](std::size_t lane) { component.lane[lane] = 0; });
}

/// For all lanes.
texel::SampleRequest sample_request(const Call& call) {
  const ir::ImageInfo& info = call.op.info;
  texel::SampleRequest request;
  request.op = info.access == ImageAccess::kGather     ? texel::SampleOp::kGather
               : info.access == ImageAccess::kQueryLod ? texel::SampleOp::kQueryLod
                                                       : texel::SampleOp::kSample;
  request.quads = info.in_quads;
  request.coord = call.operands<4>(ImageOperand::kCoord);
  request.dref = call.operand(ImageOperand::kDref);
  request.min_lod = call.operand(ImageOperand::kMinLod);
  request.offset = call.operands<3>(ImageOperand::kOffset);
  request.gather_component = info.gather_component;
  if (info.has_gather_offsets) request.gather_offsets = &info.gather_offsets;
  if (call.operand(ImageOperand::kGradX) != nullptr) {
    request.lod_mode = texel::LodMode::kGrad;
    request.ddx = call.operands<3>(ImageOperand::kGradX);
    request.ddy = call.operands<3>(ImageOperand::kGradY);
  } else if (call.operand(ImageOperand::kLod) != nullptr) {
    request.lod_mode = texel::LodMode::kExplicit;
    request.lod = call.operand(ImageOperand::kLod);
  } else if (info.explicit_lod_zero) {
    request.lod_mode = texel::LodMode::kZero;
  } else if (call.operand(ImageOperand::kBias) != nullptr) {
    request.lod_mode = texel::LodMode::kBias;
    request.lod = call.operand(ImageOperand::kBias);
  }
  return request;
}

/// Whether a view has the dimension that the instruction gives coordinates for, as in every valid use.
bool has_dimension(const Call& call, const texel::ImageView& view) {
  using enum ir::ImageDim;
  static constexpr ir::ImageDim kDimensions[] = {k1D, k2D, k3D, kCube, k1D, k2D, kCube};  // by VkImageViewType
  return call.op.info.dim == kDimensions[view.type];
}

texel::SampleResult sample_result(const Call& call) {
  texel::SampleResult result{};
  for (std::size_t c = 0; c < 4; ++c) {
    if (call.op.result[c] != kNoOperand) result[c] = &reg(call.wave, call.op.result[c]);
  }
  return result;
}

/// Whether what is kept is that of this instruction in this draw.
template <class Kept>
bool is_kept(const Wave& wave, const ImageOp& op, const Kept& entry) {
  return entry.op == &op && entry.serial == wave.resources->serial && entry.serial != 0;
}

/// The view that an instruction reads: of 64-bit texels the words that it asks for. Null: there is none.
const texel::ImageView* viewed(const Call& call, const Descriptor& image) {
  const ir::TexelWord word = call.op.info.word;
  if (word == ir::TexelWord::kAll || image.image == nullptr) return image.image;
  return image.image->words != nullptr ? &image.image->words[word == ir::TexelWord::kHigh] : nullptr;
}

/// A sampler whose border colour is that of 64-bit texels in words. Those that are not custom are 0 and 1.
texel::Sampler sampler_of_words(const texel::Sampler& sampler) {
  texel::Sampler words = sampler;
  if (!sampler.custom_border) words.border[1] = 0;
  return words;
}

/// A sampler made ready for one image instruction and the registers that it works on, kept while the same draw runs on
/// this thread.
struct KeptSampler {
  std::uint64_t serial = 0;
  const ImageOp* op = nullptr;
  const texel::ImageView* view = nullptr;
  const texel::Sampler* sampler = nullptr;
  const std::byte* registers = nullptr;
  texel::Sampler of_words;  ///< what is prepared for 64-bit texels
  texel::PreparedSampler prepared;
  texel::SampleRequest request;  ///< but not which lanes
  texel::SampleResult result{};
};

/// What is kept of an image instruction, if it is not that of another one: filters written out have dozens of them.
template <class Kept>
Kept& kept_of(std::uint32_t index) {
  constexpr std::size_t kKept = 64;
  std::array<Kept, kKept>& kept = base::per_thread<std::array<Kept, kKept>>();
  return kept[index % kKept];
}

KeptSampler& kept_sampler(const Call& call, const texel::ImageView& view, const texel::Sampler& sampler) {
  const std::uint64_t serial = call.wave.resources->serial;
  auto& entry = kept_of<KeptSampler>(call.index);
  const bool same =
      serial != 0 && entry.serial == serial && entry.op == &call.op && entry.view == &view && entry.sampler == &sampler;
  if (same && entry.registers == call.wave.registers) return entry;
  entry.request = sample_request(call);
  entry.result = sample_result(call);
  entry.registers = call.wave.registers;
  if (same) return entry;
  entry.serial = 0;  // until all of it is ready
  const bool words = call.op.info.word != ir::TexelWord::kAll;
  if (words) entry.of_words = sampler_of_words(sampler);
  texel::prepare(view, words ? entry.of_words : sampler, entry.request.op, entry.request.lod_mode, entry.prepared);
  entry.op = &call.op;
  entry.view = &view;
  entry.sampler = &sampler;
  entry.serial = serial;
  return entry;
}

/// Where there is no such image.
void zero_registers(const Call& call, base::LaneMask lanes) {
  for (WaveRegister* component : sample_result(call)) {
    if (component != nullptr) base::for_each_lane(lanes, [&](std::size_t lane) { component->lane[lane] = 0; });
  }
}

/// Straight to the registers of the results.
void sample(Call& call, const Descriptor& image, const texel::Sampler* sampler, base::LaneMask lanes) {
  const texel::ImageView* const view = viewed(call, image);
  if (view == nullptr || sampler == nullptr || !has_dimension(call, *view)) return zero_registers(call, lanes);
  KeptSampler& kept = kept_sampler(call, *view, *sampler);
  kept.request.active = lanes;
  texel::sample(kept.prepared, kept.request, kept.result);
}

/// What an access without a sampler that is kept likewise is one of.
struct KeptAccess {
  std::uint64_t serial = 0;
  const ImageOp* op = nullptr;
  const Descriptor* image = nullptr;
  const std::byte* registers = nullptr;

  bool is_of(const Call& call, const Descriptor& accessed) const {
    return is_kept(call.wave, call.op, *this) && image == &accessed && registers == call.wave.registers;
  }
  void set(const Call& call, const Descriptor& accessed) {
    serial = call.wave.resources->serial;
    op = &call.op;
    image = &accessed;
    registers = call.wave.registers;
  }
};

/// Where an instruction that reads finds its operands and puts its results.
struct KeptFetch : KeptAccess {
  texel::PreparedFetch prepared;
  texel::FetchRequest request;  ///< but not which lanes
  texel::SampleResult result{};
};

texel::FetchRequest fetch_request(const Call& call, base::LaneMask lanes) {
  texel::FetchRequest request;
  request.active = lanes;
  request.coord = call.operands<3>(ImageOperand::kCoord);
  request.lod = call.operand(ImageOperand::kLod);
  request.sample = call.operand(ImageOperand::kSample);
  request.offset = call.operands<3>(ImageOperand::kOffset);
  return request;
}

bool is_buffer(const Call& call) { return call.op.info.dim == ir::ImageDim::kBuffer; }

KeptFetch& kept_fetch(const Call& call, const Descriptor& image) {
  auto& entry = kept_of<KeptFetch>(call.index);
  if (entry.is_of(call, image)) return entry;
  entry.request = fetch_request(call, 0);
  entry.result = sample_result(call);
  entry.prepared = is_buffer(call) ? texel::prepare_fetch(*image.texels, *entry.request.coord[0], entry.result)
                                   : texel::prepare_fetch(*viewed(call, image), entry.request, entry.result);
  entry.set(call, image);
  return entry;
}

/// Whether there is nothing of the kind that the instruction expects.
bool is_null(const Call& call, const Descriptor& image) {
  return is_buffer(call) ? image.texels == nullptr : viewed(call, image) == nullptr;
}

/// Straight to the registers of the results.
void read(Call& call, const Descriptor& image, base::LaneMask lanes) {
  if (is_null(call, image)) return zero_registers(call, lanes);
  KeptFetch& kept = kept_fetch(call, image);
  if (kept.prepared.is_ready()) return texel::fetch(kept.prepared, lanes);
  if (is_buffer(call)) return texel::fetch_buffer(*image.texels, lanes, *kept.request.coord[0], kept.result);
  kept.request.active = lanes;
  texel::fetch(*viewed(call, image), kept.request, kept.result);
}

/// Where an instruction that writes finds its operands.
struct KeptStore : KeptAccess {
  texel::PreparedStore prepared;
};

KeptStore& kept_store(const Call& call, const Descriptor& image) {
  auto& entry = kept_of<KeptStore>(call.index);
  if (entry.is_of(call, image)) return entry;
  const texel::StoredValue value = call.operands<4>(ImageOperand::kValue);
  entry.prepared = is_buffer(call) ? texel::prepare_store(*image.texels, *call.operand(ImageOperand::kCoord), value)
                                   : texel::prepare_store(*image.image, fetch_request(call, 0), value);
  entry.set(call, image);
  return entry;
}

void write(Call& call, const Descriptor& image, base::LaneMask lanes) {
  lanes &= call.wave.live;
  if (is_null(call, image) || lanes == 0) return;
  const KeptStore& kept = kept_store(call, image);
  if (kept.prepared.is_ready()) return texel::store(kept.prepared, lanes);
  const texel::StoredValue value = call.operands<4>(ImageOperand::kValue);
  if (is_buffer(call)) {
    texel::store_buffer(*image.texels, lanes, *call.operand(ImageOperand::kCoord), value);
  } else {
    texel::store(*image.image, fetch_request(call, lanes), value);
  }
}

/// Null where the texel is out of range or no such word.
template <class Word>
Word* texel_word(const Call& call, const Descriptor& image, std::size_t lane) {
  const auto at = [&](ImageOperand which, std::uint32_t c) {
    const WaveRegister* operand = call.operand(which, c);
    return operand ? static_cast<std::int32_t>(operand->lane[lane]) : 0;
  };
  const std::int32_t x = at(ImageOperand::kCoord, 0);
  if (is_buffer(call)) {
    const texel::BufferTexelView& texels = *image.texels;
    const bool fits = texels.format->block_bytes == sizeof(Word);
    if (x < 0 || static_cast<std::uint64_t>(x) >= texels.count || !fits) return nullptr;
    return reinterpret_cast<Word*>(texels.data) + x;
  }
  return reinterpret_cast<Word*>(texel::texel_address(*image.image, sizeof(Word),
                                                      {x, at(ImageOperand::kCoord, 1), at(ImageOperand::kCoord, 2)},
                                                      static_cast<std::uint32_t>(at(ImageOperand::kSample, 0))));
}

/// All lanes act on one texel.
bool have_same_texel(const Call& call, base::LaneMask lanes) {
  for (const WaveRegister* coord : {call.operand(ImageOperand::kCoord, 0), call.operand(ImageOperand::kCoord, 1),
                                    call.operand(ImageOperand::kCoord, 2), call.operand(ImageOperand::kSample)})
    if (coord != nullptr && !have_same_word(*coord, lanes)) return false;
  return true;
}

/// A lane's operand as one number; an absent one is 0.
std::uint64_t wide_operand(const Call& call, ImageOperand which, std::size_t lane) {
  const WaveRegister *const low = call.operand(which, 0), *const high = call.operand(which, 1);
  return (low ? low->lane[lane] : 0) | std::uint64_t{high ? high->lane[lane] : 0} << 32;
}

/// On 64-bit texels. Lanes act in increasing order.
void atomic_wide(Call& call, const Descriptor& image, base::LaneMask lanes) {
  base::for_each_lane(lanes, [&](std::size_t lane) {
    auto* const word = texel_word<std::uint64_t>(call, image, lane);
    if (word == nullptr) return;
    const std::uint64_t old =
        apply_atomic<true>(call.op.info.atomic, word, wide_operand(call, ImageOperand::kValue, lane),
                           wide_operand(call, ImageOperand::kCompare, lane));
    call.result[0].lane[lane] = static_cast<std::uint32_t>(old);
    call.result[1].lane[lane] = static_cast<std::uint32_t>(old >> 32);
  });
}

void atomic(Call& call, const Descriptor& image, base::LaneMask lanes) {
  zero_result(call, lanes);
  lanes &= call.wave.live;
  if (is_null(call, image) || lanes == 0) return;
  if (call.op.info.wide) return atomic_wide(call, image, lanes);
  const ir::AtomicOp op = call.op.info.atomic;
  const WaveRegister* operand = call.operand(ImageOperand::kValue);
  const WaveRegister* compare = call.operand(ImageOperand::kCompare);
  std::uint32_t* const result = call.op.result[0] != kNoOperand ? call.result[0].lane : nullptr;
  if (operand != nullptr && is_several(lanes) && have_same_texel(call, lanes)) {
    auto* const word = texel_word<std::uint32_t>(call, image, first_of(lanes));
    if (word == nullptr || combine_lanes<true>(op, word, operand->lane, lanes, result)) return;
  }
  base::for_each_lane(lanes, [&](std::size_t lane) {
    auto* const word = texel_word<std::uint32_t>(call, image, lane);
    if (word == nullptr) return;
    call.result[0].lane[lane] =
        apply_atomic<true>(op, word, operand ? operand->lane[lane] : 0, compare ? compare->lane[lane] : 0);
  });
}

std::array<std::uint32_t, 3> query_of(const Call& call, const Descriptor& image, std::int32_t lod) {
  switch (call.op.info.access) {
    case ImageAccess::kQueryLevels:
      return {image.image->level_count};
    case ImageAccess::kQuerySamples:
      return {image.image->samples};
    default:
      if (is_buffer(call)) return {static_cast<std::uint32_t>(image.texels->count)};
      return texel::query_size(*image.image, lod);
  }
}

void query(Call& call, const Descriptor& image, base::LaneMask lanes) {
  if (is_null(call, image)) return zero_result(call, lanes);
  const WaveRegister* lod = call.operand(ImageOperand::kLod);
  if (lod == nullptr || have_same_word(*lod, lanes)) {
    const std::int32_t level = lod ? static_cast<std::int32_t>(lod->lane[first_of(lanes)]) : 0;
    const auto value = query_of(call, image, level);
    for (std::uint32_t c = 0; c < 3; ++c) std::fill_n(call.result[c].lane, base::kWaveWidth, value[c]);
    return;
  }
  base::for_each_lane(lanes, [&](std::size_t lane) {
    const auto value = query_of(call, image, static_cast<std::int32_t>(lod->lane[lane]));
    for (std::uint32_t c = 0; c < 3; ++c) call.result[c].lane[lane] = value[c];
  });
}

/// Whether Call::result holds results.
bool has_result(ImageAccess access) {
  switch (access) {
    case ImageAccess::kAtomic:
    case ImageAccess::kQuerySize:
    case ImageAccess::kQueryLevels:
    case ImageAccess::kQuerySamples:
      return true;
    default:
      return false;
  }
}

void run(Call& call, const Descriptor& image, const texel::Sampler* sampler, base::LaneMask lanes) {
  switch (call.op.info.access) {
    case ImageAccess::kSample:
    case ImageAccess::kGather:
    case ImageAccess::kQueryLod:
      return sample(call, image, sampler, lanes);
    case ImageAccess::kFetch:
    case ImageAccess::kRead:
    case ImageAccess::kSubpass:
      return read(call, image, lanes);
    case ImageAccess::kWrite:
      return write(call, image, lanes);
    case ImageAccess::kAtomic:
      return atomic(call, image, lanes);
    case ImageAccess::kQuerySize:
    case ImageAccess::kQueryLevels:
    case ImageAccess::kQuerySamples:
      return query(call, image, lanes);
  }
}

/// texel may write lanes that it was not asked for: those of another descriptor keep their results.
void put_results(Call& call, base::LaneMask lanes) {
  for (std::uint32_t c = 0; c < 4; ++c) {
    if (call.op.result[c] == kNoOperand) continue;
    WaveRegister& to = reg(call.wave, call.op.result[c]);
    if (lanes == call.wave.active) {
      to = call.result[c];
    } else {
      base::for_each_lane(lanes, [&](std::size_t lane) { to.lane[lane] = call.result[c].lane[lane]; });
    }
  }
}

std::uint32_t element_of(Wave& wave, const IndexOperand& index, int lane) {
  switch (index.file) {
    case IndexOperand::File::kConstant:
      return 0;
    case IndexOperand::File::kUniform:
      return uniform_word(wave, index.value);
    case IndexOperand::File::kVarying:
      return reg(wave, index.value).lane[lane];
  }
  return 0;
}

const Descriptor& descriptor(const Wave& wave, std::uint32_t set, std::uint32_t slot, std::uint32_t element,
                             std::uint32_t count) {
  static const Descriptor null{};
  if (element != 0 && element >= count) return null;
  const Descriptor* found = find_descriptor(wave, set, slot + element);
  return found ? *found : null;
}

/// Lanes of `remaining` whose indices equal those of its lowest lane.
base::LaneMask same_elements(Wave& wave, const ImageOp& op, base::LaneMask remaining) {
  for (const IndexOperand* index : {&op.image_index, &op.sampler_index}) {
    if (index->file != IndexOperand::File::kVarying) continue;
    const std::uint32_t first = element_of(wave, *index, std::countr_zero(remaining));
    base::for_each_lane(remaining, [&](std::size_t lane) {
      if (element_of(wave, *index, static_cast<int>(lane)) != first) remaining &= ~(base::LaneMask{1} << lane);
    });
  }
  return remaining;
}

/// Who looks up: in fragment shaders whole quads, as in the reference (lavapipe-shader-math.md 9), because a later
/// lookup may take the differences of coordinates that come of this one, also from those that do not run here.
base::LaneMask lanes_of(const Wave& wave, const ImageOp& op) {
  const bool looks_up = op.info.access == ImageAccess::kSample || op.info.access == ImageAccess::kGather ||
                        op.info.access == ImageAccess::kQueryLod || op.info.access == ImageAccess::kFetch;
  const bool same_for_all =
      op.image_index.file != IndexOperand::File::kVarying && op.sampler_index.file != IndexOperand::File::kVarying;
  if (!op.info.in_quads || !looks_up || !same_for_all || wave.active == wave.launched) return wave.active;
  return base::quads_of_lanes(wave.active) * 15 & wave.launched;
}

[[gnu::noinline]] void run_by_descriptors(Wave& wave, std::uint32_t index) {
  Call call(wave, index);
  const ImageOp& op = call.op;
  const ir::ImageInfo& info = op.info;
  for (base::LaneMask remaining = lanes_of(wave, op); remaining != 0;) {
    const int first = std::countr_zero(remaining);
    const base::LaneMask lanes = same_elements(wave, op, remaining);
    remaining &= ~lanes;
    const Descriptor& image =
        descriptor(wave, info.set, info.slot, element_of(wave, op.image_index, first), info.count);
    const texel::Sampler* sampler = info.immutable_sampler;
    if (sampler == nullptr) {
      sampler = info.combined ? image.sampler
                              : descriptor(wave, info.sampler_set, info.sampler_slot,
                                           element_of(wave, op.sampler_index, first), info.sampler_count)
                                    .sampler;
    }
    run(call, image, sampler, lanes);
    if (has_result(info.access)) put_results(call, lanes);
  }
}

/// What is kept of an instruction on one descriptor, if this one accesses the same registers again and is ready.
template <class Kept>
const Kept* kept_again(const Wave& wave, std::uint32_t index) {
  const auto& entry = kept_of<Kept>(index);
  const bool same = is_kept(wave, wave.program->image_ops[index], entry) && entry.registers == wave.registers;
  return same && entry.prepared.is_ready() ? &entry : nullptr;
}

/// A read or write as it was the last time, at the same descriptor; false: it is another one.
bool access_again(const Wave& wave, std::uint32_t index) {
  const ImageOp& op = wave.program->image_ops[index];
  if (op.image_index.file != IndexOperand::File::kConstant) return false;
  if (op.info.access == ImageAccess::kRead || op.info.access == ImageAccess::kFetch) {
    const auto* const kept = kept_again<KeptFetch>(wave, index);
    if (kept != nullptr) texel::fetch(kept->prepared, lanes_of(wave, op));
    return kept != nullptr;
  }
  if (op.info.access == ImageAccess::kWrite) {
    const auto* const kept = kept_again<KeptStore>(wave, index);
    if (kept != nullptr) texel::store(kept->prepared, wave.active & wave.live);
    return kept != nullptr;
  }
  return false;
}

}  // namespace

const Instruction* image(Wave& wave, const Instruction* i) {
  const std::uint32_t index = i->extra[0];
  if (!access_again(wave, index)) run_by_descriptors(wave, index);
  return i + 1;
}

}  // namespace vitrine::spirv::exec
