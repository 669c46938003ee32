// Vertex fetch: addresses per lane, then a copy for 32-bit channels or a channel-wise conversion for the rest.
#include "raster/front/vertex_fetch.h"

#include <algorithm>
#include <cstring>

#include "base/as_reference.h"
#include "base/numeric.h"
#include "raster/front/records.h"
#include "texel/codec.h"
#include "texel/format.h"

namespace vitrine::raster {
namespace {

using base::WaveRegister;
using texel::Channel;
using texel::FormatDesc;
using texel::Numeric;

/// deviations.md, vertex-format-numbers: the formats that the lower eight bits of the reference's numbers name.
const FormatDesc& fetched_format(VkFormat format) {
  if (!base::as_reference(base::Deviation::kVertexFormatNumbers)) return texel::format_desc(format);
  static const FormatDesc luminance = [] {
    FormatDesc desc = texel::format_desc(VK_FORMAT_R8_UNORM);
    desc.rgba = {0, 0, 0, -1};
    return desc;
  }();
  switch (format) {
    case VK_FORMAT_B4G4R4A4_UNORM_PACK16:
      return luminance;
    case VK_FORMAT_R5G5B5A1_UNORM_PACK16:
      return texel::format_desc(VK_FORMAT_A4R4G4B4_UNORM_PACK16);
    case VK_FORMAT_B5G5R5A1_UNORM_PACK16:
      return texel::format_desc(VK_FORMAT_A4B4G4R4_UNORM_PACK16);
    default:
      return texel::format_desc(format);
  }
}

struct Addresses {
  const std::byte* at[base::kWaveWidth];  ///< null: out of bounds
  bool whole;                             ///< none is
  bool four_words;                        ///< so many can be read at each, whatever the attribute has
};

void compute_addresses(const DrawRecord& draw, const VertexAttribute& attribute, std::uint32_t bytes,
                       const VertexLanes& lanes, Addresses& out) {
  const VertexBinding& binding = draw.call.vertex_binding[attribute.binding];
  if (!binding.data || binding.size < std::uint64_t{attribute.offset} + bytes) {
    std::fill_n(out.at, lanes.count, nullptr);
    out.whole = out.four_words = false;
    return;
  }
  const std::uint64_t last = binding.size - attribute.offset - bytes;  // highest offset that may be read
  const std::byte* data = binding.data + attribute.offset;
  std::uint64_t highest = 0;
  out.whole = true;
  for (std::uint32_t i = 0; i < lanes.count; ++i) {
    std::uint32_t element = lanes.vertex[i];
    if (binding.per_instance)
      element = draw.call.first_instance + (binding.divisor ? lanes.instance[i] / binding.divisor : 0);
    const std::uint64_t offset = std::uint64_t{element} * binding.stride;
    out.at[i] = offset <= last ? data + offset : nullptr;
    out.whole &= offset <= last;
    highest = std::max(highest, offset);
  }
  out.four_words = out.whole && highest + 16 <= binding.size - attribute.offset;
}

std::uint32_t missing_value(const FormatDesc& format, std::uint32_t component) {
  if (component < 3) return 0;
  return format.is_integer() ? 1u : base::bits_of(1.0f);
}

std::uint64_t read_bits(const std::byte* block, const Channel& channel) {
  std::uint64_t word = 0;
  const std::uint32_t first = channel.offset / 8u;
  const std::uint32_t end = (channel.offset + channel.bits + 7u) / 8u;
  std::memcpy(&word, block + first, end - first);
  word >>= channel.offset % 8u;
  return channel.bits >= 64 ? word : word & ((std::uint64_t{1} << channel.bits) - 1);
}

std::int32_t sign_extend(std::uint32_t value, std::uint32_t bits) {
  const std::uint32_t shift = 32 - bits;
  return static_cast<std::int32_t>(value << shift) >> shift;
}

/// 10.3: normalised integers are multiplied by the rounded reciprocal.
std::uint32_t convert(const Channel& channel, std::uint32_t raw) {
  using base::bits_of;
  const std::uint32_t bits = channel.bits;
  switch (channel.numeric) {
    case Numeric::kUnorm: {
      const float scale = 1.0f / static_cast<float>((std::uint64_t{1} << bits) - 1);
      return bits_of(static_cast<float>(raw) * scale);
    }
    case Numeric::kSnorm: {
      const float scale = 1.0f / static_cast<float>((std::uint64_t{1} << (bits - 1)) - 1);
      return bits_of(std::max(-1.0f, static_cast<float>(sign_extend(raw, bits)) * scale));
    }
    case Numeric::kUscaled:
      return bits_of(static_cast<float>(raw));
    case Numeric::kSscaled:
      return bits_of(static_cast<float>(sign_extend(raw, bits)));
    case Numeric::kSint:
      return static_cast<std::uint32_t>(sign_extend(raw, bits));
    case Numeric::kSfloat:
      return bits == 16 ? bits_of(base::half_to_float(static_cast<std::uint16_t>(raw))) : raw;
    // Small unsigned floats are the upper bits of a half: 11 bits lack 4 low ones, 10 bits 5.
    case Numeric::kUfloat:
      return bits_of(base::half_to_float(static_cast<std::uint16_t>(raw << (15 - bits))));
    default:
      return raw;
  }
}

/// 32 bits of each element; 0 out of bounds.
void fetch_words(const Addresses& addresses, std::uint32_t count, std::uint32_t offset, WaveRegister& out) {
  for (std::uint32_t i = 0; addresses.whole && i < count; ++i) std::memcpy(&out.lane[i], addresses.at[i] + offset, 4);
  if (addresses.whole) return;
  for (std::uint32_t i = 0; i < count; ++i) {
    out.lane[i] = 0;
    if (addresses.at[i]) std::memcpy(&out.lane[i], addresses.at[i] + offset, 4);
  }
}

/// deviations.md, wide-attributes: four words, of signed numbers one for each component, as if they had 32 bits.
void fetch_narrowed_component(const FormatDesc& format, const Addresses& addresses, std::uint32_t count,
                              std::uint32_t word, WaveRegister& out) {
  const bool is_signed = format.channel[0].numeric == Numeric::kSint;
  const std::uint32_t first = is_signed ? word * 8u : word * 4u;
  const bool there = word < 4 && first < format.block_bytes;
  std::fill_n(out.lane, count, is_signed && !there && word == 3 ? 1u : 0u);
  if (!there) return;
  if (!is_signed) return fetch_words(addresses, count, first, out);
  for (std::uint32_t i = 0; i < count; ++i) {
    std::int64_t value = 0;
    if (addresses.at[i]) std::memcpy(&value, addresses.at[i] + first, 8);
    out.lane[i] = static_cast<std::uint32_t>(std::clamp<std::int64_t>(value, INT32_MIN, INT32_MAX));
  }
}

/// `word`: half of a 64-bit component. Components that the format lacks are undefined (Vulkan 1.3.239, Vertex Input
/// Extraction): zero.
void fetch_wide_component(const FormatDesc& format, const Addresses& addresses, std::uint32_t count, std::uint32_t word,
                          WaveRegister& out) {
  if (base::as_reference(base::Deviation::kWideAttributes))
    return fetch_narrowed_component(format, addresses, count, word, out);
  if (word * 4u < format.block_bytes) return fetch_words(addresses, count, word * 4u, out);
  std::fill_n(out.lane, count, 0u);
}

/// Formats whose channels depend on each other.
void fetch_decoded(const FormatDesc& format, const Addresses& addresses, std::uint32_t count, std::uint32_t component,
                   WaveRegister& out) {
  for (std::uint32_t i = 0; i < count; ++i) {
    texel::Texel value{};
    if (addresses.at[i]) texel::decode_row(format, addresses.at[i], 1, &value);
    out.lane[i] = value[component];
  }
}

void fetch_component(const FormatDesc& format, const Addresses& addresses, std::uint32_t count, std::uint32_t component,
                     WaveRegister& out) {
  if (format.channel[0].bits == 64) return fetch_wide_component(format, addresses, count, component, out);
  component &= 3u;
  if (format.format == VK_FORMAT_E5B9G9R9_UFLOAT_PACK32) return fetch_decoded(format, addresses, count, component, out);
  const int index = format.rgba[component];
  if (index < 0) {
    std::fill_n(out.lane, count, missing_value(format, component));
    return;
  }
  const Channel& channel = format.channel[static_cast<std::size_t>(index)];
  if (channel.bits == 32 && channel.offset % 8 == 0) {
    return fetch_words(addresses, count, channel.offset / 8u, out);
  }
  for (std::uint32_t i = 0; i < count; ++i)
    out.lane[i] =
        addresses.at[i] ? convert(channel, static_cast<std::uint32_t>(read_bits(addresses.at[i], channel))) : 0;
}

/// Component c is word c of an element.
bool has_plain_words(const FormatDesc& format) {
  for (std::size_t c = 0; c < 4; ++c) {
    const int index = format.rgba[c];
    if (index < 0) continue;
    const Channel& channel = format.channel[static_cast<std::size_t>(index)];
    if (channel.bits != 32 || channel.offset != 32 * c) return false;
  }
  return format.format != VK_FORMAT_E5B9G9R9_UFLOAT_PACK32;
}

/// Several components of plain words at once, from input `first` on, as many as are of one attribute: how many.
std::uint32_t fetch_record(const PipelinePlan& plan, std::uint32_t first, const FormatDesc& format,
                           const Addresses& addresses, std::uint32_t count, StageRunner& runner) {
  std::uint32_t* to[4] = {};
  std::uint32_t inputs = 0;
  for (; first + inputs < plan.vertex_input_count; ++inputs) {
    const VertexInput& input = plan.vertex_input[first + inputs];
    if (input.source != VertexInput::Source::kAttribute || input.attribute != plan.vertex_input[first].attribute ||
        input.component > 3 || format.rgba[input.component] < 0 || to[input.component] != nullptr)
      break;
    to[input.component] = runner.input(input.reg).lane;
  }
  if (inputs > 1) load_records(addresses.at, count, to);
  return inputs > 1 ? inputs : 0;
}

void fill_built_in(const DrawRecord& draw, const VertexInput& input, const VertexLanes& lanes, std::uint32_t view,
                   WaveRegister& out) {
  using Source = VertexInput::Source;
  const DrawCall& call = draw.call;
  const auto splat = [&](std::uint32_t value) { std::fill_n(out.lane, lanes.count, value); };
  switch (input.source) {
    case Source::kVertexIndex:
      std::copy_n(lanes.vertex, lanes.count, out.lane);
      break;
    case Source::kInstanceIndex:
      for (std::uint32_t i = 0; i < lanes.count; ++i) out.lane[i] = call.first_instance + lanes.instance[i];
      break;
    case Source::kBaseVertex:
      splat(call.index_data ? static_cast<std::uint32_t>(call.vertex_offset) : call.first);
      break;
    case Source::kBaseInstance:
      splat(call.first_instance);
      break;
    case Source::kDrawIndex:
      splat(call.draw_index);
      break;
    case Source::kViewIndex:
      splat(view);
      break;
    default:
      splat(0);
      break;
  }
}

}  // namespace

void fetch_vertices(const DrawRecord& draw, const VertexLanes& lanes, std::uint32_t view, StageRunner& runner) {
  const PipelinePlan& plan = *draw.plan;
  Addresses addresses;
  std::uint32_t addressed = ~0u;
  for (std::uint32_t i = 0; i < plan.vertex_input_count; ++i) {
    const VertexInput& input = plan.vertex_input[i];
    WaveRegister& out = runner.input(input.reg);
    if (input.source != VertexInput::Source::kAttribute) {
      fill_built_in(draw, input, lanes, view, out);
      continue;
    }
    const VertexAttribute& attribute = plan.state->attribute[input.attribute];
    const FormatDesc& format = fetched_format(attribute.format);
    if (addressed != input.attribute) compute_addresses(draw, attribute, format.block_bytes, lanes, addresses);
    addressed = input.attribute;
    if (addresses.four_words && has_plain_words(format)) {
      const std::uint32_t fetched = fetch_record(plan, i, format, addresses, lanes.count, runner);
      if (fetched != 0) {
        i += fetched - 1;
        continue;
      }
    }
    fetch_component(format, addresses, lanes.count, input.component, out);
  }
}

}  // namespace vitrine::raster
