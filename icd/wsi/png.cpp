// Writes PNG (ISO/IEC 15948) with the fixed codes of DEFLATE (RFC 1951): each row as its difference from the row above,
// whose runs of equal bytes are matches of distance 1.
#include "icd/wsi/png.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace vitrine::icd::wsi {
namespace {

constexpr std::array<std::uint32_t, 256> make_crc_table() {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t i = 0; i < 256; ++i) {
    std::uint32_t c = i;
    for (int bit = 0; bit < 8; ++bit) c = (c >> 1) ^ ((c & 1) ? 0xEDB88320u : 0u);
    table[i] = c;
  }
  return table;
}
constexpr std::array<std::uint32_t, 256> kCrcTable = make_crc_table();

void put(std::vector<std::byte>& out, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) out.push_back(static_cast<std::byte>(value >> shift));
}

void put_chunk(std::vector<std::byte>& out, std::string_view type, std::span<const std::byte> data) {
  put(out, static_cast<std::uint32_t>(data.size()));
  const std::size_t first = out.size();
  for (const char c : type) out.push_back(static_cast<std::byte>(c));
  out.insert(out.end(), data.begin(), data.end());
  std::uint32_t crc = ~0u;
  for (std::size_t i = first; i < out.size(); ++i)
    crc = (crc >> 8) ^ kCrcTable[(crc ^ static_cast<std::uint32_t>(out[i])) & 255];
  put(out, ~crc);
}

/// RFC 1951, 3.1.1: bits from the least significant of each byte on.
class Bits {
 public:
  explicit Bits(std::vector<std::byte>& out) : out_(out) {}
  void add(std::uint32_t value, std::uint32_t count) {
    pending_ |= std::uint64_t{value} << held_;
    for (held_ += count; held_ >= 8; held_ -= 8) {
      out_.push_back(static_cast<std::byte>(pending_));
      pending_ >>= 8;
    }
  }
  /// Codes go in from their most significant bit on.
  void add_code(std::uint32_t code, std::uint32_t count) {
    std::uint32_t turned = 0;
    for (std::uint32_t i = 0; i < count; ++i) turned |= (code >> i & 1) << (count - 1 - i);
    add(turned, count);
  }
  void finish() {
    if (held_ != 0) add(0, 8 - held_);
  }

 private:
  std::vector<std::byte>& out_;
  std::uint64_t pending_ = 0;
  std::uint32_t held_ = 0;
};

/// RFC 1951, 3.2.6.
void add_symbol(Bits& bits, std::uint32_t symbol) {
  if (symbol < 144) return bits.add_code(0x30 + symbol, 8);
  if (symbol < 256) return bits.add_code(0x190 + symbol - 144, 9);
  if (symbol < 280) return bits.add_code(symbol - 256, 7);
  bits.add_code(0xC0 + symbol - 280, 8);
}

/// RFC 1951, 3.2.5: lengths from 3 to 258, of distance 1.
void add_match(Bits& bits, std::uint32_t length) {
  if (length == 258) {
    add_symbol(bits, 285);
  } else if (length < 11) {
    add_symbol(bits, 254 + length);
  } else {
    std::uint32_t extra = 1;
    while (length - 3 >= 8u << extra) ++extra;
    const std::uint32_t rest = length - 3 - (4u << extra);
    add_symbol(bits, 261 + 4 * extra + (rest >> extra));
    bits.add(rest & ((1u << extra) - 1), extra);
  }
  bits.add_code(0, 5);
}

void deflate(std::span<const std::byte> data, std::vector<std::byte>& out) {
  Bits bits(out);
  bits.add(1, 1);  // the last block
  bits.add(1, 2);  // fixed codes
  for (std::size_t i = 0; i < data.size();) {
    std::size_t run = 0;
    if (i > 0)
      while (run < 258 && i + run < data.size() && data[i + run] == data[i - 1]) ++run;
    if (run >= 3) {
      add_match(bits, static_cast<std::uint32_t>(run));
      i += run;
    } else {
      add_symbol(bits, static_cast<std::uint32_t>(data[i++]));
    }
  }
  add_symbol(bits, 256);
  bits.finish();
}

std::uint32_t adler(std::span<const std::byte> data) {
  std::uint32_t a = 1, b = 0;
  for (std::size_t i = 0; i < data.size();) {
    for (const std::size_t end = std::min(i + 5552, data.size()); i < end; ++i) {
      a += static_cast<std::uint32_t>(data[i]);
      b += a;
    }
    a %= 65521;
    b %= 65521;
  }
  return b << 16 | a;
}

/// Each row behind the number of its filter, "Up".
std::vector<std::byte> filter_rows(std::span<const std::byte> rgb, std::uint32_t width, std::uint32_t height) {
  const std::size_t pitch = std::size_t{width} * 3;
  std::vector<std::byte> out;
  out.reserve((pitch + 1) * height);
  for (std::size_t y = 0; y < height; ++y) {
    const std::byte* const row = rgb.data() + y * pitch;
    out.push_back(std::byte{2});
    for (std::size_t x = 0; x < pitch; ++x) {
      const std::uint32_t above = y > 0 ? static_cast<std::uint32_t>(*(row + x - pitch)) : 0;
      out.push_back(static_cast<std::byte>(static_cast<std::uint32_t>(row[x]) - above));
    }
  }
  return out;
}

}  // namespace

std::vector<std::byte> encode_png(std::span<const std::byte> rgb, std::uint32_t width, std::uint32_t height) {
  std::vector<std::byte> out;
  for (const char c : std::string_view("\x89PNG\r\n\x1a\n")) out.push_back(static_cast<std::byte>(c));
  std::vector<std::byte> header;
  put(header, width);
  put(header, height);
  for (const int c : {8, 2, 0, 0, 0}) header.push_back(static_cast<std::byte>(c));  // 8 bits, RGB, not interlaced
  put_chunk(out, "IHDR", header);
  const std::vector<std::byte> rows = filter_rows(rgb, width, height);
  std::vector<std::byte> packed{std::byte{0x78}, std::byte{1}};  // RFC 1950
  deflate(rows, packed);
  put(packed, adler(rows));
  put_chunk(out, "IDAT", packed);
  put_chunk(out, "IEND", {});
  return out;
}

}  // namespace vitrine::icd::wsi
