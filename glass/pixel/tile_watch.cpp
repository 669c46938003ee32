// See tile_watch.h.
#include "glass/pixel/tile_watch.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "glass/pixel/inputs.h"
#include "raster/primitive_instances.h"

namespace vitrine::glass::pixel {
namespace {

using base::LaneMask;
using raster::FragmentGroup;
using raster::SampleLanes;

thread_local TileWatch* tls_current = nullptr;

LaneMask any_of(SampleLanes samples) {
  LaneMask any = 0;
  for (const LaneMask lanes : samples) any |= lanes;
  return any;
}

/// Bit s: the lane is in lanes[s].
std::uint32_t samples_of(SampleLanes lanes, std::size_t lane) {
  std::uint32_t samples = 0;
  for (std::size_t s = 0; s < lanes.size(); ++s) samples |= static_cast<std::uint32_t>(lanes[s] >> lane & 1) << s;
  return samples;
}

}  // namespace

TileWatch* TileWatch::current() { return tls_current; }

TileWatch::TileWatch(Pixels& pixels, const TilePixels& tile, const spirv::ObservedCommand* command,
                     const raster::TilePlace& place)
    : pixels_(pixels), tile_(tile), command_(command), place_(place) {
  tls_current = this;
}

TileWatch::~TileWatch() {
  tls_current = nullptr;
  try {
    std::vector<Pending> pending;
    for (const Fragment& fragment : fragments_)
      std::ranges::move(events_of(fragment, *command_, place_.pass->depth.format), std::back_inserter(pending));
    pixels_.add(std::move(pending));
  } catch (const std::bad_alloc&) {
    // Not told.
  }
}

Fragment* TileWatch::find(const WatchedPixel& pixel, const raster::Primitive* from) {
  const auto at = by_pixel_.find(&pixel);
  if (at == by_pixel_.end()) return nullptr;
  for (auto fragment = at->second.rbegin(); fragment != at->second.rend(); ++fragment)
    if ((*fragment)->from == from) return *fragment;
  return nullptr;
}

template <class F>
void TileWatch::for_each_fragment(const FragmentGroup& group, LaneMask lanes, F&& f) {
  const std::uint32_t width = raster::width_of(group.rate), height = raster::height_of(group.rate);
  base::for_each_lane(lanes, [&](std::size_t lane) {
    const auto q = static_cast<std::uint32_t>(lane / 4);
    const std::uint32_t left = group.position.x[q] + static_cast<std::uint32_t>(lane & 1) * width;
    const std::uint32_t top = group.position.y[q] + static_cast<std::uint32_t>(lane >> 1 & 1) * height;
    for (std::uint32_t pixel = 0; group.from[q] != nullptr && pixel < width * height; ++pixel)
      if (const WatchedPixel* const at = tile_.find(left + pixel % width, top + pixel / width)) f(*at, q, lane);
  });
}

template <class F>
void TileWatch::for_each(const FragmentGroup& group, LaneMask lanes, F&& f) {
  if (group.rate != 0) return for_each_fragment(group, lanes, f);
  for (std::uint32_t q = 0; lanes != 0 && q < base::kQuadsPerWave; ++q) {
    const LaneMask quad = lanes >> 4 * q & 15;
    const std::uint32_t x = group.position.x[q], y = group.position.y[q];
    if (quad == 0 || (tile_.quads[y % 64 / 2] >> x % 64 / 2 & 1) == 0) continue;
    for (std::uint32_t i = 0; i < 4; ++i) {
      const WatchedPixel* const pixel = (quad >> i & 1) != 0 ? tile_.find(x + (i & 1), y + (i >> 1)) : nullptr;
      if (pixel != nullptr) f(*pixel, q, std::size_t{4} * q + i);
    }
  }
}

void TileWatch::generated(const FragmentGroup& group, SampleLanes lanes) {
  for_each(group, any_of(lanes), [&](const WatchedPixel& pixel, std::uint32_t q, std::size_t lane) {
    Fragment& fragment = fragments_.emplace_back();
    fragment.pixel = &pixel;
    fragment.from = group.from[q];
    fragment.primitive = group.primitive[q];
    if (group.instances != nullptr) fragment.instance = group.instances->instance_of(group.from[q]);
    fragment.samples = samples_of(lanes, lane);
    fragment.has_shader = group.inputs != nullptr;
    if (group.inputs != nullptr)
      fragment.inputs = inputs_text(group.inputs->shader().interface(), group.inputs->shader().program(),
                                    [&](std::uint32_t reg) { return group.inputs->word(reg, lane); });
    by_pixel_[&pixel].push_back(&fragment);
  });
}

void TileWatch::failed(const FragmentGroup& group, raster::FragmentTest test, SampleLanes lost, SampleLanes) {
  for_each(group, any_of(lost), [&](const WatchedPixel& pixel, std::uint32_t q, std::size_t lane) {
    if (Fragment* const fragment = find(pixel, group.from[q]))
      fragment->failures.push_back({test, samples_of(lost, lane)});
  });
}

void TileWatch::testing(const FragmentGroup& group, std::uint32_t sample, const float* depth) {
  for_each(group, base::kAllLanes, [&](const WatchedPixel& pixel, std::uint32_t q, std::size_t lane) {
    Fragment* const fragment = find(pixel, group.from[q]);
    if (fragment == nullptr || (fragment->samples >> sample & 1) == 0) return;
    Fragment::Depth tested{sample, depth[lane], {}};
    const texel::ImageView& view = place_.pass->depth;
    if (view.format && place_.layer < view.layer_count && pixel.x < view.level[0].extent.width &&
        pixel.y < view.level[0].extent.height) {
      tested.stored.size = view.format->block_bytes;
      std::memcpy(tested.stored.bytes.data(), view.block(0, place_.layer, sample, pixel.x, pixel.y, 0),
                  tested.stored.size);
    }
    for (Fragment::Depth& before : fragment->depths)
      if (before.sample == sample) return void(before = tested);
    fragment->depths.push_back(tested);
  });
}

void TileWatch::shading(const FragmentGroup& group) {
  running_.fill(nullptr);
  any_running_ = false;
  for_each(group, base::kAllLanes, [&](const WatchedPixel& pixel, std::uint32_t q, std::size_t lane) {
    // Of several watched pixels in one fragment, one is told what the shader does.
    Fragment* const fragment = find(pixel, group.from[q]);
    if (fragment != nullptr) running_[lane] = fragment;
    any_running_ |= fragment != nullptr;
  });
}

void TileWatch::shaded(const FragmentGroup& group, LaneMask invocations, LaneMask) {
  running_.fill(nullptr);
  any_running_ = false;
  for_each(group, invocations, [&](const WatchedPixel& pixel, std::uint32_t q, std::size_t) {
    if (Fragment* const fragment = find(pixel, group.from[q])) fragment->shaded = true;
  });
}

void TileWatch::coloring(const FragmentGroup& group, std::uint32_t attachment, const raster::ColorRegisters& color) {
  for_each(group, base::kAllLanes, [&](const WatchedPixel& pixel, std::uint32_t q, std::size_t lane) {
    Fragment* const fragment = find(pixel, group.from[q]);
    if (fragment == nullptr) return;
    std::erase_if(fragment->colors, [&](const Fragment::Color& c) { return c.slot == attachment; });
    fragment->colors.push_back(
        {attachment, {color[0].lane[lane], color[1].lane[lane], color[2].lane[lane], color[3].lane[lane]}});
  });
}

const texel::ImageView* TileWatch::view_of(std::uint32_t slot) const {
  if (slot == kDepthSlot) return &place_.pass->depth;
  return slot == kStencilSlot ? &place_.pass->stencil : &place_.pass->color[slot];
}

void TileWatch::written(const FragmentGroup& group, const texel::ImageView& view, SampleLanes lanes) {
  for_each(group, any_of(lanes), [&](const WatchedPixel& pixel, std::uint32_t q, std::size_t lane) {
    Fragment* const fragment = find(pixel, group.from[q]);
    if (fragment == nullptr) return;
    const std::uint32_t samples = samples_of(lanes, lane);
    for (const PassTexel& at : pixel.texels) {
      Texel& texel = *at.texel;
      if (view_of(at.slot) != &view || (samples >> texel.id.sample & 1) == 0) continue;
      const Value now = texel.read();
      fragment->writes.push_back({&texel, std::exchange(texel.value, now), now});
    }
  });
}

}  // namespace vitrine::glass::pixel
