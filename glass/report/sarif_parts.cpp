// What SARIF demands of names, columns and addresses of files (SARIF 2.1.0, 3.10, 3.27.17, 3.30.2).
#include "glass/report/sarif_parts.h"

#include <algorithm>
#include <cctype>

namespace vitrine::glass {
namespace {

constexpr char kHex[] = "0123456789ABCDEF";

/// Characters of a path that need no escape (RFC 3986: unreserved, sub-delims, "/" and "@"; a colon could end a
/// scheme).
bool is_plain(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) ||
         std::string_view("-._~/@!$&'()*+,;=").find(c) != std::string_view::npos;
}

std::string escaped(std::string_view path) {
  std::string result;
  for (const char c : path) {
    const auto byte = static_cast<unsigned char>(c);
    if (is_plain(c))
      result += c;
    else
      ((result += '%') += kHex[byte >> 4]) += kHex[byte & 15];
  }
  return result;
}

/// FNV-1a, 64 bits.
class Hash {
 public:
  Hash& operator<<(std::string_view text) {
    for (const char c : text) add(static_cast<unsigned char>(c));
    add(0x100);
    return *this;
  }
  std::string text() const {
    std::string result(16, '0');
    for (std::size_t i = 0; i < 16; ++i) result[i] = kHex[(value_ >> (60 - 4 * i)) & 15];
    return result;
  }

 private:
  void add(std::uint64_t part) { value_ = (value_ ^ part) * 0x100000001b3; }
  std::uint64_t value_ = 0xcbf29ce484222325;
};

std::string_view trimmed(std::string_view line) {
  const std::size_t first = line.find_first_not_of(" \t\r"), last = line.find_last_not_of(" \t\r");
  return first == std::string_view::npos ? "" : line.substr(first, last - first + 1);
}

}  // namespace

std::string sarif_rule_id(const Rule& rule) { return std::string("vitrine/") + rule.id; }

std::string sarif_rule_name(const Rule& rule) {
  std::string name;
  bool begins = true;
  for (const char c : std::string_view(rule.id)) {
    if (c != '-') name += begins ? static_cast<char>(std::toupper(static_cast<unsigned char>(c))) : c;
    begins = c == '-';
  }
  return name;
}

std::string sarif_uri(std::string_view file) {
  std::string path(file);
  const bool drive = path.size() > 2 && std::isalpha(static_cast<unsigned char>(path[0])) && path[1] == ':' &&
                     (path[2] == '\\' || path[2] == '/');
  if (drive) {
    std::replace(path.begin(), path.end(), '\\', '/');
    return "file:///" + path.substr(0, 2) + escaped(std::string_view(path).substr(2));
  }
  return (path.starts_with('/') ? "file://" : "") + escaped(path);
}

std::size_t sarif_column(const Frame& frame) {
  if (frame.column == 0 || frame.column > frame.text.size()) return frame.column;
  const auto end = frame.text.begin() + (frame.column - 1);
  return 1 +
         static_cast<std::size_t>(std::count_if(frame.text.begin(), end, [](char c) { return (c & 0xc0) != 0x80; }));
}

std::string sarif_fingerprint(const Finding& finding) {
  Hash hash;
  hash << finding.rule->id << stage_name(finding.address.stage) << finding.address.shader;
  if (finding.address.frames.empty()) return (hash << std::to_string(finding.address.spirv_id)).text();
  const Frame& frame = finding.address.frames[0];
  hash << frame.file << frame.function;
  const std::string_view line = trimmed(frame.text);
  if (line.empty()) return (hash << std::to_string(frame.line) << std::to_string(frame.column)).text();
  // The column behind the indentation: lines that are laid out anew stay the same.
  return (hash << line << std::to_string(frame.column - (line.data() - frame.text.data()))).text();
}

}  // namespace vitrine::glass
