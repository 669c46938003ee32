// Reads what the tool `pixel` wrote.
#include "glass/cli/pixel_history.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "glass/cli/findings.h"

namespace vitrine::glass::cli {
namespace {

using Json = nlohmann::json;

TexelKey key_of(const Json& json) {
  return {json.at("image"), json.at("aspect"), json.at("level"), json.at("layer"),
          json.at("slice"), json.at("sample"), json.at("x"),     json.at("y")};
}

PixelEvent event_of(const Json& json) {
  PixelEvent event;
  event.kind = json.at("kind");
  event.text = json.at("text");
  event.fate = json.value("fate", "");
  event.before = json.value("before", "");
  event.after = json.value("after", "");
  event.frame = json.at("frame");
  event.replaces = json.value("replaces", false);
  event.address = address_of(json.at("address"));
  for (const Json& fact : json.value("facts", Json::array())) event.facts.emplace_back(fact.at(0), fact.at(1));
  for (const Json& source : json.value("sources", Json::array()))
    event.sources.push_back({key_of(source.at("texel")), source.value("value", ""), source.value("weight", 0.0),
                             source.value("read", std::pair<std::uint64_t, std::uint32_t>())});
  return event;
}

PixelTexel texel_of(const Json& json) {
  PixelTexel texel{key_of(json.at("texel")),
                   json.at("format"),
                   json.value("value", ""),
                   json.value("dropped", std::uint64_t{0}),
                   {}};
  for (const Json& event : json.at("events")) texel.events.push_back(event_of(event));
  return texel;
}

PixelImage image_of(const Json& json) {
  return {json.at("number"), json.value("name", ""),
          json.at("format"), json.value("swapchain", false),
          json.at("extent"), json.at("levels").get<std::uint32_t>(),
          json.at("layers"), json.at("samples")};
}

}  // namespace

const PixelTexel* PixelHistory::find(const TexelKey& key) const {
  const auto at = std::ranges::find(texels, key, &PixelTexel::key);
  return at == texels.end() ? nullptr : &*at;
}

const PixelImage* PixelHistory::image(std::uint64_t number) const {
  const auto at = std::ranges::find(images, number, &PixelImage::number);
  return at == images.end() ? nullptr : &*at;
}

std::optional<PixelHistory> read_history(std::string_view text) {
  const Json json = Json::parse(text, nullptr, false);
  if (!json.is_object() || json.value("format", Json()) != "vitrine-pixel" || json.value("version", Json()) != 1)
    return std::nullopt;
  try {
    PixelHistory history;
    history.frames = json.at("frames");
    for (const Json& image : json.at("images")) history.images.push_back(image_of(image));
    for (const Json& texel : json.at("texels")) history.texels.push_back(texel_of(texel));
    for (const Json& p : json.value("primitives", Json::array()))
      history.primitives.push_back({address_of(p.at("address")), p.at("fate"), p.at("count"),
                                    p.value("instances", std::vector<std::uint32_t>()), p.value("more", false)});
    return history;
  } catch (const Json::exception&) {
    return std::nullopt;
  }
}

}  // namespace vitrine::glass::cli
