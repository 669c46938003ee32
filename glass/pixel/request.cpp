// See request.h.
#include "glass/pixel/request.h"

#include <charconv>
#include <iterator>

namespace vitrine::glass::pixel {
namespace {

struct AspectName {
  VkImageAspectFlags aspect;
  std::string_view name;
};
constexpr AspectName kAspects[] = {
    {VK_IMAGE_ASPECT_COLOR_BIT, "color"},     {VK_IMAGE_ASPECT_DEPTH_BIT, "depth"},
    {VK_IMAGE_ASPECT_STENCIL_BIT, "stencil"}, {VK_IMAGE_ASPECT_PLANE_0_BIT, "plane0"},
    {VK_IMAGE_ASPECT_PLANE_1_BIT, "plane1"},  {VK_IMAGE_ASPECT_PLANE_2_BIT, "plane2"},
};

template <class T>
bool parse_number(std::string_view text, T& number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size();
}

/// "X,Y".
bool parse_point(std::string_view text, std::int64_t& x, std::int64_t& y) {
  const std::size_t comma = text.find(',');
  return comma != std::string_view::npos && parse_number(text.substr(0, comma), x) &&
         parse_number(text.substr(comma + 1), y) && x >= 0 && y >= 0;
}

bool parse_rectangle(std::string_view text, Request& out) {
  const std::size_t to = text.find('-');
  if (!parse_point(text.substr(0, to), out.x0, out.y0)) return false;
  out.x1 = out.x0, out.y1 = out.y0;
  return to == std::string_view::npos || parse_point(text.substr(to + 1), out.x1, out.y1);
}

std::string unescaped(std::string_view text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    int code = 0;
    if (text[i] == '%' && i + 2 < text.size() &&
        std::from_chars(text.data() + i + 1, text.data() + i + 3, code, 16).ptr == text.data() + i + 3) {
      result += static_cast<char>(code);
      i += 2;
    } else {
      result += text[i];
    }
  }
  return result;
}

bool set_value(std::string_view key, std::string_view value, Request& out) {
  if (key == "image") {
    out.image = unescaped(value);
    return !out.image.empty();
  }
  if (key == "aspect") {
    for (const auto& [aspect, name] : kAspects)
      if (value == name) out.aspect = aspect;
    return out.aspect != 0;
  }
  if (key == "sample") return parse_number(value, out.sample.emplace());
  if (key == "level") return parse_number(value, out.level);
  if (key == "layer") return parse_number(value, out.layer);
  return key == "slice" && parse_number(value, out.slice);
}

bool parse_entry(std::string_view text, Request& out) {
  std::size_t end = std::min(text.find(':'), text.size());
  if (!parse_rectangle(text.substr(0, end), out)) return false;
  while (end < text.size()) {
    text.remove_prefix(end + 1);
    end = std::min(text.find(':'), text.size());
    const std::string_view pair = text.substr(0, end);
    const std::size_t equal = pair.find('=');
    if (equal == std::string_view::npos || !set_value(pair.substr(0, equal), pair.substr(equal + 1), out)) return false;
  }
  return true;
}

}  // namespace

std::optional<std::vector<Request>> parse_requests(std::string_view text, std::string& error) {
  std::vector<Request> requests;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(';'), text.size());
    const std::string_view entry = text.substr(0, end);
    if (!entry.empty() && !parse_entry(entry, requests.emplace_back())) {
      std::string message(1, '\'');
      message.append(entry).append("' names no texels");
      error = std::move(message);
      return std::nullopt;
    }
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return requests;
}

std::optional<PrimitiveRequest> parse_primitive(std::string_view text) {
  PrimitiveRequest request;
  const std::size_t at = text.find('@');
  if (!parse_number(text.substr(0, at), request.primitive)) return std::nullopt;
  if (at != std::string_view::npos && !parse_number(text.substr(at + 1), request.instance.emplace()))
    return std::nullopt;
  return request;
}

std::string_view aspect_name(VkImageAspectFlags aspect) {
  for (const AspectName& row : kAspects)
    if (aspect == row.aspect) return row.name;
  return {};
}

std::string escaped(std::string_view name) {
  static constexpr char kHex[] = "0123456789ABCDEF";
  std::string result;
  for (const char c : name) {
    if (c == ':' || c == ';' || c == '%') {
      result += '%';
      result += kHex[static_cast<unsigned char>(c) >> 4];
      result += kHex[static_cast<unsigned char>(c) & 15];
    } else {
      result += c;
    }
  }
  return result;
}

}  // namespace vitrine::glass::pixel
