// See mutate_text.h.
#include "tests/fuzz/mutate_text.h"

#include <algorithm>
#include <cctype>
#include <iterator>

namespace vitrine::fuzz {
namespace {

/// What readers look for, and numbers that they do not expect.
constexpr const char* kTokens[] = {"\"",
                                   "{",
                                   "}",
                                   "[",
                                   "]",
                                   ",",
                                   ":",
                                   "\n",
                                   "\r\n\r\n",
                                   "null",
                                   "true",
                                   "-1",
                                   "0",
                                   "1e999",
                                   "4294967296",
                                   "18446744073709551616",
                                   "9223372036854775807",
                                   "-9223372036854775809",
                                   "NaN",
                                   "\\ud800",
                                   "\xff",
                                   "end_of_record\n",
                                   "DA:",
                                   "BRDA:",
                                   "FN:",
                                   "SF:",
                                   "arguments",
                                   "Content-Length: ",
                                   "(",
                                   ")",
                                   "+",
                                   "?",
                                   "."};

/// Another run of digits for one that is there.
void change_number(std::string& text, Random& random) {
  const std::size_t from = below(random, text.size());
  const auto digit = [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; };
  const auto first = std::find_if(text.begin() + static_cast<std::ptrdiff_t>(from), text.end(), digit);
  if (first == text.end()) return;
  const auto last = std::find_if_not(first, text.end(), digit);
  static constexpr const char* kNumbers[] = {"0",
                                             "1",
                                             "2",
                                             "65535",
                                             "65536",
                                             "2147483648",
                                             "4294967295",
                                             "4294967296",
                                             "18446744073709551615",
                                             "99999999999999999999",
                                             "-1",
                                             "1.5"};
  text.replace(first, last,
               random() % 2 != 0 ? kNumbers[below(random, std::size(kNumbers))] : std::to_string(random() % 300));
}

void mutate_once(std::string& text, const std::vector<std::string>& pool, Random& random) {
  const std::size_t at = below(random, text.size());
  const std::size_t length = std::min(text.size() - at, 1 + below(random, random() % 4 == 0 ? 200 : 8));
  switch (random() % 8) {
    case 0:
      text[at] = static_cast<char>(random());
      return;
    case 1:
      text[at] = static_cast<char>(text[at] ^ 1 << random() % 8);
      return;
    case 2:
      text.erase(at, length);
      return;
    case 3:
      text.insert(below(random, text.size() + 1), text.substr(at, length));
      return;
    case 4:
      text.insert(at, kTokens[below(random, std::size(kTokens))]);
      return;
    case 5:
      text.replace(at, length, kTokens[below(random, std::size(kTokens))]);
      return;
    case 6: {
      const std::string& other = pool[below(random, pool.size())];
      text.insert(at, other.substr(below(random, other.size() + 1), length));
      return;
    }
    default:
      change_number(text, random);
  }
}

}  // namespace

void mutate_text(std::string& text, const std::vector<std::string>& pool, Random& random) {
  for (std::size_t count = 1 + below(random, 4); count > 0 && !text.empty(); --count) mutate_once(text, pool, random);
}

}  // namespace vitrine::fuzz
