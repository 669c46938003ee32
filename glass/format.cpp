// See format.h.
#include "glass/format.h"

#include <bit>
#include <cstdio>

#include "base/numeric.h"

namespace vitrine::glass {
namespace {

/// One conversion: "%" flags, width, precision, a vector's size, length, letter.
struct Conversion {
  std::string flags;  ///< up to and with the precision
  std::uint32_t components = 1;
  char letter = 0;         ///< 0: not a conversion
  std::size_t length = 0;  ///< characters of the format
};

bool is_one_of(char c, std::string_view set) { return set.find(c) != std::string_view::npos; }

Conversion parse(std::string_view text) {
  Conversion result;
  std::size_t at = 1;
  while (at < text.size() && is_one_of(text[at], "-+ #0123456789.")) result.flags += text[at++];
  constexpr std::size_t kLongest = 16;
  if (result.flags.size() > kLongest) return {};
  if (at + 1 < text.size() && text[at] == 'v' && is_one_of(text[at + 1], "234")) {
    result.components = static_cast<std::uint32_t>(text[at + 1] - '0');
    at += 2;
  }
  while (at < text.size() && text[at] == 'l') ++at;
  if (at >= text.size() || !is_one_of(text[at], "diouxXaAeEfFgGcp")) return {};
  result.letter = text[at++];
  if (is_one_of(result.letter, "ux") && at < text.size() && text[at] == 'l') ++at;  // the layer's "%ul", "%lx"
  result.length = at;
  return result;
}

/// A component as the kinds of numbers that conversions take.
struct Number {
  double real = 0;
  std::uint64_t whole = 0;  ///< sign-extended
};

Number number_of(const spirv::ProbeValue& value, const std::uint32_t* words) {
  const std::uint64_t bits = value.width == 64 ? std::uint64_t{words[1]} << 32 | words[0] : words[0];
  if (value.type == 'F') {
    const double real = value.width == 64 ? std::bit_cast<double>(bits)
                        : value.width == 16
                            ? static_cast<double>(base::half_to_float(static_cast<std::uint16_t>(words[0])))
                            : static_cast<double>(base::float_of(words[0]));
    return {real, bits};
  }
  if (value.type == 'I') {
    const unsigned shift = 64u - value.width;
    const auto whole = static_cast<std::int64_t>(bits << shift) >> shift;
    return {static_cast<double>(whole), static_cast<std::uint64_t>(whole)};
  }
  return {static_cast<double>(bits), bits};
}

template <class T>
std::string print(const std::string& format, T value) {
  char text[512];
  std::snprintf(text, sizeof text, format.c_str(), value);
  return text;
}

std::string print_number(const Conversion& conversion, const spirv::ProbeValue& value, const std::uint32_t* words) {
  const Number number = number_of(value, words);
  const std::string head = "%" + conversion.flags;
  if (is_one_of(conversion.letter, "aAeEfFgG")) return print(head + conversion.letter, number.real);
  if (conversion.letter == 'c') return print(head + 'c', static_cast<int>(number.whole & 0x7f));
  const char letter = conversion.letter == 'p' ? 'x' : conversion.letter;
  if (is_one_of(letter, "di")) return print(head + "lld", static_cast<long long>(number.whole));
  const std::uint64_t mask = value.width == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << value.width) - 1;
  return print(head + "ll" + letter, static_cast<unsigned long long>(number.whole & mask));
}

std::string print_value(const Conversion& conversion, const spirv::ProbeValue& value, const std::uint32_t* words) {
  std::string text;
  const std::uint32_t stride = value.width == 64 ? 2 : 1;
  for (std::uint32_t c = 0; c < conversion.components && c < value.components; ++c) {
    if (c != 0) text += ", ";
    text += print_number(conversion, value, words + c * stride);
  }
  return text;
}

}  // namespace

std::string format_text(std::string_view format, std::span<const spirv::ProbeValue> values,
                        std::span<const std::uint32_t> words) {
  std::string text;
  std::size_t next = 0;
  while (!format.empty()) {
    if (format[0] != '%') {
      const std::size_t plain = std::min(format.find('%'), format.size());
      text += format.substr(0, plain);
      format.remove_prefix(plain);
      continue;
    }
    if (format.size() > 1 && format[1] == '%') {
      text += '%';
      format.remove_prefix(2);
      continue;
    }
    const Conversion conversion = parse(format);
    if (conversion.letter == 0 || next == values.size()) {
      text += '%';
      format.remove_prefix(1);
      continue;
    }
    const spirv::ProbeValue& value = values[next++];
    text += print_value(conversion, value, words.data() + value.first_word);
    format.remove_prefix(conversion.length);
  }
  return text;
}

}  // namespace vitrine::glass
