// Histories as JSON (docs/glass/pixel.md).
#include <nlohmann/json.hpp>

#include "glass/pixel/pixels.h"
#include "glass/report/json.h"

namespace vitrine::glass::pixel {
namespace {

using Json = nlohmann::ordered_json;

/// By EventKind.
constexpr const char* kKinds[] = {"clear", "load", "undefined", "fragment", "store",   "atomic",
                                  "copy",  "blit", "resolve",   "upload",   "present", "unknown"};

/// By raster::PrimitiveFate.
constexpr const char* kFates[] = {"is culled: all corners are outside of a cull distance",
                                  "lies outside of the view volume or of a clip distance",
                                  "is clipped: its parts come next",
                                  "is culled because of where it faces",
                                  "has no area",
                                  "is too far away, or at coordinates that are no numbers",
                                  "lies outside of scissor and framebuffer",
                                  "covers no sample",
                                  "is rasterized"};

Json to_json(const TexelId& id) {
  return {{"image", id.image}, {"aspect", aspect_name(id.aspect)},
          {"level", id.level}, {"layer", id.layer},
          {"slice", id.slice}, {"sample", id.sample},
          {"x", id.x},         {"y", id.y}};
}

Json to_json(const Source& source) {
  Json json{{"texel", to_json(source.texel)}};
  if (source.value.size != 0 && source.format != nullptr) json["value"] = to_text(source.value, *source.format);
  if (source.weight > 0) json["weight"] = source.weight;
  if (source.submission != 0) json["read"] = {source.submission, source.command};
  return json;
}

Json to_json(const Event& event, const texel::FormatDesc& format) {
  Json json{{"kind", kKinds[static_cast<std::size_t>(event.kind)]}, {"frame", event.frame}, {"text", event.text}};
  if (!event.fate.empty()) json["fate"] = event.fate;
  if (event.replaces) json["replaces"] = true;
  json["address"] = glass::to_json(event.address);
  if (event.before.size != 0) json["before"] = to_text(event.before, format);
  if (event.after.size != 0) json["after"] = to_text(event.after, format);
  for (const auto& [name, text] : event.facts) json["facts"].push_back(Json::array({name, text}));
  for (const Source& source : event.sources) json["sources"].push_back(to_json(source));
  return json;
}

Json to_json(const Texel& texel) {
  Json json{{"texel", to_json(texel.id)}, {"format", texel.format->name}};
  if (texel.value.size != 0) json["value"] = to_text(texel.value, *texel.format);
  if (texel.dropped != 0) json["dropped"] = texel.dropped;
  json["events"] = Json::array();
  for (const Event& event : texel.events) json["events"].push_back(to_json(event, *texel.format));
  return json;
}

Json to_json(std::uint64_t number, const ImageNote& note) {
  const texel::ImageDesc& desc = note.desc;
  Json json{{"number", number}, {"format", texel::format_desc(desc.format).name}};
  if (!note.name.empty()) json["name"] = note.name;
  if (note.in_swapchain) json["swapchain"] = true;
  json["extent"] = {desc.extent.width, desc.extent.height, desc.extent.depth};
  json["levels"] = desc.levels;
  json["layers"] = desc.layers;
  json["samples"] = desc.samples;
  return json;
}

Json to_json(const PrimitiveNote& note, std::size_t fate) {
  Json json{{"address", glass::to_json(note.address)}, {"fate", kFates[fate]}, {"count", note.count}};
  if (!note.instances.empty()) json["instances"] = note.instances;
  if (note.more) json["more"] = true;
  return json;
}

}  // namespace

std::string Pixels::to_json() const {
  const std::lock_guard lock(mutex_);
  Json json{{"format", "vitrine-pixel"}, {"version", 1}, {"frames", frame_ - 1}};
  json["images"] = Json::array();
  for (const auto& [number, note] : notes_) json["images"].push_back(pixel::to_json(number, note));
  for (const auto& [key, note] : primitives_) json["primitives"].push_back(pixel::to_json(note, std::get<2>(key)));
  json["texels"] = Json::array();
  for (const auto& texel : texels_) json["texels"].push_back(pixel::to_json(*texel));
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + '\n';
}

}  // namespace vitrine::glass::pixel
