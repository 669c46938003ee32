// Hands everything on to each of several watches.
#include "raster/draw_watches.h"

#include <algorithm>

namespace vitrine::raster {

void DrawWatches::assembled(std::uint64_t vertices, std::uint64_t primitives) {
  for (const auto& watch : watches_) watch->assembled(vertices, primitives);
}

void DrawWatches::emitted(std::uint64_t primitives) {
  for (const auto& watch : watches_) watch->emitted(primitives);
}

void DrawWatches::primitive(std::uint32_t id, std::optional<std::uint32_t> instance, PrimitiveFate fate) {
  for (const auto& watch : watches_) watch->primitive(id, instance, fate);
}

void DrawWatches::generated(const FragmentGroup& group, SampleLanes lanes) {
  for (const auto& watch : watches_) watch->generated(group, lanes);
}

void DrawWatches::failed(const FragmentGroup& group, FragmentTest test, SampleLanes lost, SampleLanes left) {
  for (const auto& watch : watches_) watch->failed(group, test, lost, left);
}

void DrawWatches::testing(const FragmentGroup& group, std::uint32_t sample, const float* depth) {
  for (const auto& watch : watches_) watch->testing(group, sample, depth);
}

void DrawWatches::shading(const FragmentGroup& group) {
  for (const auto& watch : watches_) watch->shading(group);
}

void DrawWatches::shaded(const FragmentGroup& group, base::LaneMask invocations, base::LaneMask helpers) {
  for (const auto& watch : watches_) watch->shaded(group, invocations, helpers);
}

void DrawWatches::coloring(const FragmentGroup& group, std::uint32_t attachment, const ColorRegisters& color) {
  for (const auto& watch : watches_) watch->coloring(group, attachment, color);
}

bool DrawWatches::takes_numbers() const {
  return std::all_of(watches_.begin(), watches_.end(), [](const auto& watch) { return watch->takes_numbers(); });
}

void DrawWatches::numbers(const FragmentNumbers& numbers) {
  for (const auto& watch : watches_) watch->numbers(numbers);
}

void DrawWatches::shaded_blocks(base::LaneMask places) {
  for (const auto& watch : watches_) watch->shaded_blocks(places);
}

void DrawWatches::passed(const FragmentGroup& group, SampleLanes lanes) {
  for (const auto& watch : watches_) watch->passed(group, lanes);
}

void DrawWatches::written(const FragmentGroup& group, const texel::ImageView& view, SampleLanes lanes) {
  for (const auto& watch : watches_) watch->written(group, view, lanes);
}

}  // namespace vitrine::raster
