// What became of fragments, as events.
#include <bit>
#include <cstdio>

#include "glass/pixel/tile_watch.h"
#include "raster/primitive.h"

namespace vitrine::glass::pixel {
namespace {

using raster::FragmentTest;

struct TestName {
  const char* fate;
  const char* text;
};
/// By FragmentTest.
constexpr TestName kTests[] = {
    {"discard rectangle", "is discarded by a discard rectangle"},
    {"scissor", "is outside of the scissor"},
    {"sample mask", "is not in the pipeline's sample mask"},
    {"depth bounds", "fails the depth bounds test"},
    {"stencil", "fails the stencil test"},
    {"depth", "fails the depth test"},
    {"discarded", "is discarded by the shader"},
    {"shader mask", "is not in gl_SampleMask"},
    {"alpha to coverage", "is not covered by its alpha"},
};
static_assert(std::size(kTests) == raster::kFragmentTests);

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

std::string corners_of(const raster::Primitive& p) {
  const std::size_t count = raster::is_area(p.kind) ? 3 : p.kind == raster::PrimitiveKind::kLine ? 2 : 1;
  std::string text;
  for (std::size_t i = 0; i < count; ++i) {
    const raster::Vertex* const v = p.v[i];
    const auto at = [&](int c) { return number(static_cast<double>(v[c])); };
    text += (i == 0 ? "(" : " (") + at(0) + ", " + at(1) + ", " + at(2) + ")";
  }
  return text;
}

std::string primitive_text(const Fragment& fragment) {
  const raster::Primitive& p = *fragment.from;
  const char* kind = p.kind == raster::PrimitiveKind::kPoint  ? "point"
                     : p.kind == raster::PrimitiveKind::kLine ? "line"
                     : p.front                                ? "front-facing triangle"
                                                              : "back-facing triangle";
  std::string text = "primitive " + std::to_string(fragment.primitive);
  if (fragment.instance) text.append(" of instance ").append(std::to_string(*fragment.instance));
  return text.append(" (").append(kind).append(")");
}

Address place_of(const spirv::ObservedCommand& command, const Fragment& fragment) {
  Address address = address_of(command);
  address.shader = fragment.discarded.shader;
  address.spirv_id = fragment.discarded.spirv_id;
  address.frames = fragment.discarded.frames;
  address.stage = VK_SHADER_STAGE_FRAGMENT_BIT;
  address.invocation = {Invocation::Kind::kFragment, {fragment.pixel->x, fragment.pixel->y}};
  return address;
}

const Fragment::Failure* failure_of(const Fragment& fragment, std::uint32_t sample) {
  for (const Fragment::Failure& failure : fragment.failures)
    if ((failure.samples >> sample & 1) != 0) return &failure;
  return nullptr;
}

const Fragment::Write* write_of(const Fragment& fragment, const Texel& texel) {
  for (const Fragment::Write& write : fragment.writes)
    if (write.texel == &texel) return &write;
  return nullptr;
}

void add_depth(const Fragment& fragment, std::uint32_t sample, Event& event, const texel::FormatDesc* format) {
  for (const Fragment::Depth& depth : fragment.depths) {
    if (depth.sample != sample) continue;
    event.facts.emplace_back("depth", number(static_cast<double>(depth.value)));
    if (depth.stored.size != 0 && format != nullptr)
      event.facts.emplace_back("stored depth", to_text(depth.stored, *format));
  }
}

void add_colors(const Fragment& fragment, const PassTexel& at, Event& event) {
  for (const Fragment::Color& color : fragment.colors) {
    const bool own = color.slot == at.slot;
    const texel::Kind kind = own ? at.texel->format->kind : texel::Kind::kFloat;
    if (own || at.slot >= kDepthSlot)
      event.facts.emplace_back(own ? "output" : "output " + std::to_string(color.slot),
                               to_text(color.components, 4, kind));
  }
}

}  // namespace

std::vector<Pending> events_of(const Fragment& fragment, const spirv::ObservedCommand& command,
                               const texel::FormatDesc* depth_format) {
  std::vector<Pending> pending;
  for (const PassTexel& at : fragment.pixel->texels) {
    const std::uint32_t sample = at.texel->id.sample;
    if ((fragment.samples >> sample & 1) == 0) continue;
    Event event;
    event.kind = EventKind::kFragment;
    event.address = place_of(command, fragment);
    const Fragment::Failure* const failure = failure_of(fragment, sample);
    const Fragment::Write* const write = write_of(fragment, *at.texel);
    event.text = "fragment of " + primitive_text(fragment) + " ";
    if (failure != nullptr) {
      const TestName& test = kTests[static_cast<std::size_t>(failure->test)];
      event.fate = test.fate;
      event.text += test.text;
      if (failure->test != FragmentTest::kDiscard) event.address.frames.clear();
    } else {
      event.fate = write != nullptr ? "written" : "not written";
      event.text += write != nullptr ? "is written" : "passes, but this attachment is not written";
      event.address.frames.clear();
    }
    if (write != nullptr) event.before = write->before, event.after = write->after;
    event.facts.emplace_back("window coordinates", corners_of(*fragment.from));
    add_depth(fragment, sample, event, depth_format);
    if (!fragment.shaded)
      event.facts.emplace_back("no shader ran", !fragment.has_shader      ? "as the draw has none"
                                                : fragment.inputs.empty() ? "for it"
                                                                          : "for it; its inputs would be");
    event.facts.insert(event.facts.end(), fragment.inputs.begin(), fragment.inputs.end());
    if (fragment.shaded) add_colors(fragment, at, event);
    if (fragment.shaded || failure == nullptr) event.sources = fragment.sources;
    for (const std::string& lookup : fragment.lookups) event.facts.emplace_back("lookup", lookup);
    pending.push_back({command.owner, at.texel, {}, false, std::move(event)});
  }
  return pending;
}

}  // namespace vitrine::glass::pixel
