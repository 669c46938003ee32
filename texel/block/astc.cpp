// Block modes, integer sequences, partitions, endpoints and weights of ASTC.
#include "texel/block/astc.h"

#include <algorithm>
#include <cstring>

namespace vitrine::texel {
namespace {

using Color = std::array<std::int32_t, 4>;

/// Bits of a block, least significant first.
struct Bits {
  std::array<std::uint64_t, 2> word{};

  std::uint32_t get(std::uint32_t first, std::uint32_t count) const {
    if (count == 0 || first >= 128) return 0;
    std::uint64_t value = word[first / 64] >> (first % 64);
    if (first % 64 + count > 64 && first < 64) value |= word[1] << (64 - first % 64);
    return static_cast<std::uint32_t>(value & ((std::uint64_t{1} << count) - 1));
  }
};

std::uint64_t reversed(std::uint64_t v) {
  v = (v >> 1 & 0x5555555555555555u) | (v & 0x5555555555555555u) << 1;
  v = (v >> 2 & 0x3333333333333333u) | (v & 0x3333333333333333u) << 2;
  v = (v >> 4 & 0x0F0F0F0F0F0F0F0Fu) | (v & 0x0F0F0F0F0F0F0F0Fu) << 4;
  return __builtin_bswap64(v);
}

// ---- integer sequences

/// A range of integers: `bits` plain bits under at most one trit or quint.
struct Range {
  std::uint8_t bits, trits, quints;
};

constexpr Range kRanges[21] = {{1, 0, 0}, {0, 1, 0}, {2, 0, 0}, {0, 0, 1}, {1, 1, 0}, {3, 0, 0}, {1, 0, 1},
                               {2, 1, 0}, {4, 0, 0}, {2, 0, 1}, {3, 1, 0}, {5, 0, 0}, {3, 0, 1}, {4, 1, 0},
                               {6, 0, 0}, {4, 0, 1}, {5, 1, 0}, {7, 0, 0}, {5, 0, 1}, {6, 1, 0}, {8, 0, 0}};
constexpr std::uint32_t kSmallestColorRange = 4;  // 6 values

std::uint32_t sequence_bits(std::uint32_t count, const Range& range) {
  std::uint32_t bits = count * range.bits;
  if (range.trits != 0) bits += (8 * count + 4) / 5;
  if (range.quints != 0) bits += (7 * count + 2) / 3;
  return bits;
}

void unpack_trits(std::uint32_t t, std::uint32_t out[5]) {
  const auto bit = [](std::uint32_t v, int i) { return v >> i & 1; };
  std::uint32_t c = 0;
  if ((t >> 2 & 7) == 7) {
    c = (t >> 5 & 7) << 2 | (t & 3);
    out[4] = out[3] = 2;
  } else {
    c = t & 31;
    if ((t >> 5 & 3) == 3) {
      out[4] = 2;
      out[3] = bit(t, 7);
    } else {
      out[4] = bit(t, 7);
      out[3] = t >> 5 & 3;
    }
  }
  if ((c & 3) == 3) {
    out[2] = 2;
    out[1] = bit(c, 4);
    out[0] = bit(c, 3) << 1 | (bit(c, 2) & ~bit(c, 3) & 1);
  } else if ((c >> 2 & 3) == 3) {
    out[2] = out[1] = 2;
    out[0] = c & 3;
  } else {
    out[2] = bit(c, 4);
    out[1] = c >> 2 & 3;
    out[0] = bit(c, 1) << 1 | (bit(c, 0) & ~bit(c, 1) & 1);
  }
}

void unpack_quints(std::uint32_t q, std::uint32_t out[3]) {
  const auto bit = [](std::uint32_t v, int i) { return v >> i & 1; };
  if ((q >> 1 & 3) == 3 && (q >> 5 & 3) == 0) {
    const std::uint32_t clear = ~bit(q, 0) & 1;
    out[2] = bit(q, 0) << 2 | (bit(q, 4) & clear) << 1 | (bit(q, 3) & clear);
    out[1] = out[0] = 4;
    return;
  }
  std::uint32_t c = 0;
  if ((q >> 1 & 3) == 3) {
    out[2] = 4;
    c = (q >> 3 & 3) << 3 | (~(q >> 5) & 3) << 1 | bit(q, 0);
  } else {
    out[2] = q >> 5 & 3;
    c = q & 31;
  }
  if ((c & 7) == 5) {
    out[1] = 4;
    out[0] = c >> 3 & 3;
  } else {
    out[1] = c >> 3 & 3;
    out[0] = c & 7;
  }
}

/// A value of a sequence: its plain bits and its trit or quint.
struct Element {
  std::uint32_t bits = 0, high = 0;
};

/// Reads `count` values from bit `position` on; what lies behind `end` is 0.
void read_sequence(const Bits& source, std::uint32_t position, std::uint32_t end, std::uint32_t count,
                   const Range& range, Element* out) {
  const auto take = [&](std::uint32_t n) {
    const std::uint32_t available = position >= end ? 0 : std::min(n, end - position);
    const std::uint32_t value = source.get(position, available);
    position += n;
    return value;
  };
  constexpr std::uint32_t kTritBits[5] = {2, 2, 1, 2, 1}, kQuintBits[3] = {3, 2, 2};
  const std::uint32_t group = range.trits != 0 ? 5 : range.quints != 0 ? 3 : 1;
  for (std::uint32_t first = 0; first < count; first += group) {
    std::uint32_t packed = 0, shift = 0, high[5] = {};
    const std::uint32_t n = std::min(group, count - first);
    for (std::uint32_t i = 0; i < n; ++i) {
      out[first + i].bits = take(range.bits);
      const std::uint32_t extra = range.trits != 0 ? kTritBits[i] : range.quints != 0 ? kQuintBits[i] : 0;
      packed |= take(extra) << shift;
      shift += extra;
    }
    if (range.trits != 0) unpack_trits(packed, high);
    if (range.quints != 0) unpack_quints(packed, high);
    for (std::uint32_t i = 0; i < n; ++i) out[first + i].high = high[i];
  }
}

/// `value` of `from` bits repeated to fill `to` bits.
std::uint32_t replicate(std::uint32_t value, std::uint32_t from, std::uint32_t to) {
  std::uint32_t out = 0;
  for (std::int32_t shift = static_cast<std::int32_t>(to - from); shift > -static_cast<std::int32_t>(from);
       shift -= static_cast<std::int32_t>(from)) {
    out |= shift >= 0 ? value << shift : value >> -shift;
  }
  return out;
}

/// Puts the bits of `value` at the places of the letters of `pattern` ('b' the second bit, 'c' the third, ...).
std::uint32_t spread(std::uint32_t value, const char* pattern) {
  std::uint32_t out = 0;
  for (; *pattern != 0; ++pattern) out = out << 1 | (*pattern == '0' ? 0 : value >> (*pattern - 'a') & 1);
  return out;
}

std::int32_t color_value(const Element& e, const Range& range) {
  if (range.trits == 0 && range.quints == 0) return static_cast<std::int32_t>(replicate(e.bits, range.bits, 8));
  static constexpr const char* kTritPattern[7] = {"",          "000000000", "b000b0bb0", "cb000cbcb",
                                                  "dcb000dcb", "edcb000ed", "fedcb000f"};
  static constexpr const char* kQuintPattern[6] = {"", "000000000", "b0000bb00", "cb0000cbc", "dcb0000dc", "edcb0000e"};
  static constexpr std::uint32_t kTritFactor[7] = {0, 204, 93, 44, 22, 11, 5};
  static constexpr std::uint32_t kQuintFactor[6] = {0, 113, 54, 26, 13, 6};
  const bool trits = range.trits != 0;
  const std::uint32_t a = (e.bits & 1) != 0 ? 0x1FF : 0;
  const std::uint32_t b = spread(e.bits, trits ? kTritPattern[range.bits] : kQuintPattern[range.bits]);
  std::uint32_t t = e.high * (trits ? kTritFactor[range.bits] : kQuintFactor[range.bits]) + b;
  t ^= a;
  return static_cast<std::int32_t>((a & 0x80) | t >> 2);
}

std::int32_t weight_value(const Element& e, const Range& range) {
  std::uint32_t value = 0;
  if (range.trits == 0 && range.quints == 0) {
    value = replicate(e.bits, range.bits, 6);
  } else if (range.bits == 0) {
    constexpr std::uint32_t kTrits[3] = {0, 32, 63}, kQuints[5] = {0, 16, 32, 47, 63};
    value = range.trits != 0 ? kTrits[e.high] : kQuints[e.high];
  } else {
    static constexpr const char* kTritPattern[4] = {"", "0000000", "b000b0b", "cb000cb"};
    static constexpr const char* kQuintPattern[3] = {"", "0000000", "b0000b0"};
    static constexpr std::uint32_t kTritFactor[4] = {0, 50, 23, 11}, kQuintFactor[3] = {0, 28, 13};
    const bool trits = range.trits != 0;
    const std::uint32_t a = (e.bits & 1) != 0 ? 0x7F : 0;
    const std::uint32_t b = spread(e.bits, trits ? kTritPattern[range.bits] : kQuintPattern[range.bits]);
    std::uint32_t t = e.high * (trits ? kTritFactor[range.bits] : kQuintFactor[range.bits]) + b;
    t ^= a;
    value = (a & 0x20) | t >> 2;
  }
  return static_cast<std::int32_t>(value > 32 ? value + 1 : value);
}

// ---- block modes

struct Mode {
  std::uint32_t width = 0, height = 0;  ///< of the grid of weights
  std::uint32_t range = 0;
  bool two_planes = false;
};

bool decode_mode(std::uint32_t bits, Mode& mode) {
  const std::uint32_t a = bits >> 5 & 3;
  std::uint32_t range = bits >> 4 & 1, b = bits >> 7 & 3;
  bool high = (bits >> 9 & 1) != 0;
  mode.two_planes = (bits >> 10 & 1) != 0;
  if ((bits & 3) != 0) {
    range |= (bits & 3) << 1;
    switch (bits >> 2 & 3) {
      case 0:
        mode.width = b + 4, mode.height = a + 2;
        break;
      case 1:
        mode.width = b + 8, mode.height = a + 2;
        break;
      case 2:
        mode.width = a + 2, mode.height = b + 8;
        break;
      default:
        b &= 1;
        mode.width = (bits & 0x100) != 0 ? b + 2 : a + 2;
        mode.height = (bits & 0x100) != 0 ? a + 2 : b + 6;
    }
  } else {
    if ((bits >> 2 & 3) == 0) return false;
    range |= (bits >> 2 & 3) << 1;
    switch (b) {
      case 0:
        mode.width = 12, mode.height = a + 2;
        break;
      case 1:
        mode.width = a + 2, mode.height = 12;
        break;
      case 2:
        mode.width = a + 6, mode.height = (bits >> 9 & 3) + 6;
        mode.two_planes = high = false;
        break;
      default:
        if (a > 1) return false;
        mode.width = a == 0 ? 6 : 10, mode.height = a == 0 ? 10 : 6;
    }
  }
  mode.range = range - 2 + (high ? 6 : 0);
  return true;
}

// ---- partitions

std::uint32_t hash(std::uint32_t p) {
  p ^= p >> 15;
  p -= p << 17;
  p += p << 7;
  p += p << 4;
  p ^= p >> 5;
  p += p << 16;
  p ^= p >> 7;
  p ^= p >> 3;
  p ^= p << 6;
  p ^= p >> 17;
  return p;
}

std::uint32_t partition_of(std::uint32_t index, std::uint32_t count, std::uint32_t x, std::uint32_t y, bool small) {
  if (count == 1) return 0;
  if (small) x <<= 1, y <<= 1;
  const std::uint32_t seed = index + (count - 1) * 1024;
  const std::uint32_t random = hash(seed);
  std::uint32_t part[8];
  for (std::uint32_t i = 0; i < 8; ++i) {
    part[i] = random >> (4 * i) & 15;
    part[i] *= part[i];
  }
  const std::uint32_t wide = count == 3 ? 6 : 5, narrow = (seed & 2) != 0 ? 4 : 5;
  const std::uint32_t shift[2] = {(seed & 1) != 0 ? narrow : wide, (seed & 1) != 0 ? wide : narrow};
  for (std::uint32_t i = 0; i < 8; ++i) part[i] >>= shift[i & 1];
  const std::uint32_t a = (part[0] * x + part[1] * y + (random >> 14)) & 63;
  const std::uint32_t b = (part[2] * x + part[3] * y + (random >> 10)) & 63;
  const std::uint32_t c = count < 3 ? 0 : (part[4] * x + part[5] * y + (random >> 6)) & 63;
  const std::uint32_t d = count < 4 ? 0 : (part[6] * x + part[7] * y + (random >> 2)) & 63;
  if (a >= b && a >= c && a >= d) return 0;
  if (b >= c && b >= d) return 1;
  return c >= d ? 2 : 3;
}

// ---- endpoints

struct EndPoints {
  Color low{}, high{};
};

Color contracted(std::int32_t r, std::int32_t g, std::int32_t b, std::int32_t a) {
  return {(r + b) >> 1, (g + b) >> 1, b, a};
}

void transfer_bit(std::int32_t& offset, std::int32_t& base) {
  base = base >> 1 | (offset & 0x80);
  offset = offset >> 1 & 0x3F;
  if ((offset & 0x20) != 0) offset -= 0x40;
}

Color clamped(Color c) {
  for (std::int32_t& v : c) v = std::clamp(v, 0, 255);
  return c;
}

constexpr EndPoints kError{{255, 0, 255, 255}, {255, 0, 255, 255}};

/// Endpoints of a colour mode; the error colour for those of high dynamic range.
EndPoints decode_end_points(std::uint32_t mode, std::int32_t* v) {
  const auto scaled = [&](std::int32_t a) { return Color{v[0] * v[3] >> 8, v[1] * v[3] >> 8, v[2] * v[3] >> 8, a}; };
  switch (mode) {
    case 0:
      return {{v[0], v[0], v[0], 255}, {v[1], v[1], v[1], 255}};
    case 1: {
      const std::int32_t low = v[0] >> 2 | (v[1] & 0xC0), high = std::min(low + (v[1] & 0x3F), 255);
      return {{low, low, low, 255}, {high, high, high, 255}};
    }
    case 4:
      return {{v[0], v[0], v[0], v[2]}, {v[1], v[1], v[1], v[3]}};
    case 5: {
      transfer_bit(v[1], v[0]);
      transfer_bit(v[3], v[2]);
      const std::int32_t high = v[0] + v[1];
      return {{v[0], v[0], v[0], v[2]}, clamped({high, high, high, v[2] + v[3]})};
    }
    case 6:
      return {scaled(255), {v[0], v[1], v[2], 255}};
    case 10:
      return {scaled(v[4]), {v[0], v[1], v[2], v[5]}};
    case 8:
    case 12: {
      const std::int32_t low = mode == 12 ? v[6] : 255, high = mode == 12 ? v[7] : 255;
      if (v[1] + v[3] + v[5] >= v[0] + v[2] + v[4]) {
        return {{v[0], v[2], v[4], low}, {v[1], v[3], v[5], high}};
      }
      return {contracted(v[1], v[3], v[5], high), contracted(v[0], v[2], v[4], low)};
    }
    case 9:
    case 13: {
      std::int32_t low = 255, offset = 0;
      for (std::uint32_t i = 0; i < 6; i += 2) transfer_bit(v[i + 1], v[i]);
      if (mode == 13) {
        transfer_bit(v[7], v[6]);
        low = v[6], offset = v[7];
      }
      const Color sum{v[0] + v[1], v[2] + v[3], v[4] + v[5], low + offset};
      if (v[1] + v[3] + v[5] >= 0) return {clamped({v[0], v[2], v[4], low}), clamped(sum)};
      return {clamped(contracted(sum[0], sum[1], sum[2], sum[3])), clamped(contracted(v[0], v[2], v[4], low))};
    }
    default:
      return kError;
  }
}

// ---- blocks

/// A block of one colour: 16 bits a component.
bool decode_void_extent(const Bits& bits, std::uint32_t texels, bool srgb, AstcTexels& out) {
  if (bits.get(9, 1) != 0 || bits.get(10, 2) != 3) return false;
  const std::uint32_t s0 = bits.get(12, 13), s1 = bits.get(25, 13), t0 = bits.get(38, 13), t1 = bits.get(51, 13);
  const bool anywhere = s0 == 0x1FFF && s1 == 0x1FFF && t0 == 0x1FFF && t1 == 0x1FFF;
  if (!anywhere && (s0 >= s1 || t0 >= t1)) return false;
  for (std::size_t c = 0; c < 4; ++c) {
    const auto value = static_cast<std::uint16_t>(bits.get(64 + 16 * static_cast<std::uint32_t>(c), 16));
    for (std::uint32_t i = 0; i < texels; ++i) out[i][c] = srgb ? static_cast<std::uint16_t>(value & 0xFF00) : value;
  }
  return true;
}

/// The grid of weights of a block, one or two planes in turn.
struct Weights {
  std::int32_t value[64 + 2 * 13] = {};  // room for the neighbours of the last weights, which have no influence
  Mode mode;

  /// Interpolated at texel (x, y) of a block.
  std::int32_t at(std::uint32_t x, std::uint32_t y, std::uint32_t width, std::uint32_t height,
                  std::uint32_t plane) const {
    const std::uint32_t ds = (1024 + width / 2) / (width - 1), dt = (1024 + height / 2) / (height - 1);
    const std::uint32_t gs = (ds * x * (mode.width - 1) + 32) >> 6, gt = (dt * y * (mode.height - 1) + 32) >> 6;
    const auto fs = static_cast<std::int32_t>(gs & 15), ft = static_cast<std::int32_t>(gt & 15);
    const std::uint32_t first = (gs >> 4) + (gt >> 4) * mode.width, planes = mode.two_planes ? 2 : 1;
    const auto weight = [&](std::uint32_t i) { return value[i * planes + plane]; };
    const std::int32_t w11 = (fs * ft + 8) >> 4, w10 = ft - w11, w01 = fs - w11, w00 = 16 - fs - ft + w11;
    std::int32_t sum = weight(first) * w00 + 8;
    if (w01 != 0) sum += weight(first + 1) * w01;
    if (w10 != 0) sum += weight(first + mode.width) * w10;
    if (w11 != 0) sum += weight(first + mode.width + 1) * w11;
    return sum >> 4;
  }
};

/// Colour modes of the partitions. Returns how many bits below the weights they take in addition.
std::uint32_t read_color_modes(const Bits& bits, std::uint32_t partitions, std::uint32_t below_weights,
                               std::uint32_t modes[4]) {
  if (partitions == 1) {
    modes[0] = bits.get(13, 4);
    return 0;
  }
  std::uint32_t field = bits.get(23, 6);
  if ((field & 3) == 0) {
    for (std::uint32_t i = 0; i < partitions; ++i) modes[i] = field >> 2 & 15;
    return 0;
  }
  const std::uint32_t extra = 3 * partitions - 4;
  field |= bits.get(below_weights - extra, extra) << 6;
  const std::uint32_t base = (field & 3) - 1;
  for (std::uint32_t i = 0; i < partitions; ++i) {
    modes[i] = ((field >> (2 + i) & 1) + base) << 2 | (field >> (2 + partitions + 2 * i) & 3);
  }
  return extra;
}

bool decode_block(const std::byte* block, std::uint32_t width, std::uint32_t height, bool srgb, AstcTexels& out) {
  Bits bits;
  std::memcpy(bits.word.data(), block, 16);
  if (bits.get(0, 9) == 0x1FC) return decode_void_extent(bits, width * height, srgb, out);

  Weights weights;
  Mode& mode = weights.mode;
  if (!decode_mode(bits.get(0, 11), mode) || mode.width > width || mode.height > height) return false;
  const std::uint32_t weight_count = mode.width * mode.height * (mode.two_planes ? 2 : 1);
  if (weight_count > 64) return false;
  const std::uint32_t weight_bits = sequence_bits(weight_count, kRanges[mode.range]);
  const std::uint32_t partitions = bits.get(11, 2) + 1;
  if (weight_bits < 24 || weight_bits > 96 || (mode.two_planes && partitions == 4)) return false;

  // Weights fill the block from its end, bits in reverse.
  const Bits backwards{{reversed(bits.word[1]), reversed(bits.word[0])}};
  Element elements[64];
  read_sequence(backwards, 0, weight_bits, weight_count, kRanges[mode.range], elements);
  for (std::uint32_t i = 0; i < weight_count; ++i) weights.value[i] = weight_value(elements[i], kRanges[mode.range]);

  std::uint32_t end = 128 - weight_bits, modes[4] = {};
  end -= read_color_modes(bits, partitions, end, modes);
  std::uint32_t second_plane = 4;  // the component that has weights of its own
  if (mode.two_planes) {
    end -= 2;
    second_plane = bits.get(end, 2);
  }
  const std::uint32_t start = partitions == 1 ? 17 : 29;
  std::uint32_t value_count = 0;
  for (std::uint32_t i = 0; i < partitions; ++i) value_count += ((modes[i] >> 2) + 1) * 2;
  if (value_count > 18 || end < start) return false;
  std::uint32_t range = 20;
  while (range >= kSmallestColorRange && sequence_bits(value_count, kRanges[range]) > end - start) --range;
  if (range < kSmallestColorRange) return false;
  Element color_elements[18];
  std::int32_t values[18];
  read_sequence(bits, start, end, value_count, kRanges[range], color_elements);
  for (std::uint32_t i = 0; i < value_count; ++i) values[i] = color_value(color_elements[i], kRanges[range]);

  EndPoints points[4];
  std::int32_t* next = values;
  for (std::uint32_t i = 0; i < partitions; ++i) {
    points[i] = decode_end_points(modes[i], next);
    next += ((modes[i] >> 2) + 1) * 2;
  }
  const std::uint32_t index = bits.get(13, 10);
  for (std::uint32_t y = 0; y < height; ++y) {
    for (std::uint32_t x = 0; x < width; ++x) {
      const EndPoints& p = points[partition_of(index, partitions, x, y, width * height < 31)];
      const std::int32_t first = weights.at(x, y, width, height, 0);
      const std::int32_t second = mode.two_planes ? weights.at(x, y, width, height, 1) : first;
      for (std::uint32_t c = 0; c < 4; ++c) {
        const std::int32_t weight = c == second_plane ? second : first;
        const std::int32_t low = srgb ? p.low[c] << 8 | 0x80 : p.low[c] * 257;
        const std::int32_t high = srgb ? p.high[c] << 8 | 0x80 : p.high[c] * 257;
        out[y * width + x][c] = static_cast<std::uint16_t>((low * (64 - weight) + high * weight + 32) >> 6);
      }
    }
  }
  return true;
}

}  // namespace

void decode_astc(const std::byte* block, std::uint32_t width, std::uint32_t height, bool srgb, AstcTexels& out) {
  if (decode_block(block, width, height, srgb, out)) return;
  for (std::uint32_t i = 0; i < width * height; ++i) out[i] = {0xFFFF, 0, 0xFFFF, 0xFFFF};
}

}  // namespace vitrine::texel
