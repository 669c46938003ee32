// Which texels are watched, as VITRINE_PIXEL names them (docs/glass/pixel.md).
#pragma once

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vitrine::glass::pixel {

/// Texels of a rectangle, both corners included, of one level and layer.
struct Request {
  std::string image = "swapchain";  ///< "swapchain", "#3" (number), "*" (all), or the name that the application gave
  VkImageAspectFlags aspect = 0;    ///< 0: colour, or depth, or stencil where it is alone
  std::int64_t x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  std::uint32_t level = 0, layer = 0, slice = 0;
  std::optional<std::uint32_t> sample;  ///< none: all
};

/// "X,Y" or "X,Y-X,Y", then ":KEY=VALUE" for image, aspect, level, layer, slice and sample; entries are separated by
/// semicolons, and what would separate is written as "%3A", "%3B" or "%25". Nothing, and `error`, for anything else.
std::optional<std::vector<Request>> parse_requests(std::string_view text, std::string& error);

/// Primitives whose fate is wanted.
struct PrimitiveRequest {
  std::uint32_t primitive = 0;            ///< gl_PrimitiveID
  std::optional<std::uint32_t> instance;  ///< gl_InstanceIndex; none: all
};

/// "PRIMITIVE" or "PRIMITIVE@INSTANCE"; nothing for anything else.
std::optional<PrimitiveRequest> parse_primitive(std::string_view text);

/// "color", "depth", "stencil", "plane 0"...; empty: none of them alone.
std::string_view aspect_name(VkImageAspectFlags aspect);

/// Of an image's name in parse_requests().
std::string escaped(std::string_view name);

}  // namespace vitrine::glass::pixel
