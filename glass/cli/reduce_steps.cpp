// See reduce_steps.h. What can be cut is cut in halves, then in halves of what is left.
#include "glass/cli/reduce_steps.h"

#include <algorithm>
#include <cstring>

namespace vitrine::glass::cli {
namespace {

using bug::Bug;
using bug::kNone;

/// Pieces of memory are not cut smaller.
constexpr std::size_t kLeastBytes = 64;

/// Takes the candidate that `change` makes if it still does it.
template <class F>
bool attempt(Bug& bug, const StillFound& still, const F& change) {
  Bug candidate = bug;
  change(candidate);
  if (!still(candidate)) return false;
  bug = std::move(candidate);
  return true;
}

/// A range [first, first + count) of something, in steps of `unit`: the half that suffices, again and again.
template <class Number>
void halve(Bug& bug, const StillFound& still, const std::function<std::pair<Number&, std::uint32_t&>(Bug&)>& range,
           std::uint32_t unit = 1) {
  for (;;) {
    const std::uint32_t count = range(bug).second, half = count / 2 / unit * unit;
    if (half == 0) return;
    const bool front = attempt(bug, still, [&](Bug& b) { range(b).second = half; });
    if (front) continue;
    const bool back = attempt(bug, still, [&](Bug& b) {
      range(b).first += static_cast<Number>(half);
      range(b).second = count - half;
    });
    if (!back) return;
  }
}

/// Leaves out elements of a list, in chunks that become smaller.
template <class T>
void thin_out(Bug& bug, const StillFound& still, const std::function<std::vector<T>&(Bug&)>& list) {
  for (std::size_t chunk = std::max<std::size_t>(list(bug).size() / 2, 1); chunk > 0; chunk /= 2) {
    for (std::size_t at = 0; at < list(bug).size();) {
      const bool gone = attempt(bug, still, [&](Bug& b) {
        std::vector<T>& elements = list(b);
        const auto first = elements.begin() + static_cast<std::ptrdiff_t>(at);
        elements.erase(first, first + static_cast<std::ptrdiff_t>(std::min(chunk, elements.size() - at)));
      });
      if (!gone) at += chunk;
    }
  }
}

std::uint32_t vertices_of(const raster::State& state) {
  switch (state.topology) {
    case VK_PRIMITIVE_TOPOLOGY_LINE_LIST:
      return 2;
    case VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST:
      return 3;
    case VK_PRIMITIVE_TOPOLOGY_LINE_LIST_WITH_ADJACENCY:
      return 4;
    case VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST_WITH_ADJACENCY:
      return 6;
    case VK_PRIMITIVE_TOPOLOGY_PATCH_LIST:
      return std::max(state.patch_control_points, 1u);
    default:
      return 1;
  }
}

/// Two pieces where there was one.
void cut(std::vector<bug::Piece>& pieces, std::size_t number) {
  const bug::Piece whole = pieces[number];
  const auto half = static_cast<std::ptrdiff_t>(whole.before->size() / 2 / 16 * 16);
  const auto middle = whole.before->begin() + half;
  pieces[number].before = std::make_shared<bug::Bytes>(whole.before->begin(), middle);
  bug::Piece second{whole.offset + static_cast<std::uint64_t>(half), whole.unwritten,
                    std::make_shared<bug::Bytes>(middle, whole.before->end()), nullptr};
  pieces.insert(pieces.begin() + static_cast<std::ptrdiff_t>(number) + 1, std::move(second));
}

/// As the device allocates it.
template <class Content>
void empty(Content& content) {
  content.unwritten = true;
  content.before = std::make_shared<bug::Bytes>(content.before->size());
}

/// Empties pieces; of what is needed the halves.
void reduce_pieces(Bug& bug, const StillFound& still, std::size_t memory) {
  const auto pieces = [memory](Bug& b) -> std::vector<bug::Piece>& { return b.memories[memory].pieces; };
  for (std::size_t i = 0; i < pieces(bug).size();) {
    const bool gone = pieces(bug)[i].unwritten || attempt(bug, still, [&](Bug& b) { empty(pieces(b)[i]); });
    if (!gone && pieces(bug)[i].before->size() >= 2 * kLeastBytes)
      cut(pieces(bug), i);
    else
      ++i;
  }
}

}  // namespace

void reduce_invocations(Bug& bug, const StillFound& still) {
  for (std::size_t i = 0; i < 3 && bug.command.arguments == kNone; ++i)
    halve<std::uint32_t>(bug, still, [i](Bug& b) -> std::pair<std::uint32_t&, std::uint32_t&> {
      return {b.command.base[i], b.command.groups[i]};
    });
  if (bug.dispatches()) return;
  thin_out<bug::Draw>(bug, still, [](Bug& b) -> std::vector<bug::Draw>& { return b.command.draws; });
  halve<std::uint32_t>(bug, still, [](Bug& b) -> std::pair<std::uint32_t&, std::uint32_t&> {
    return {b.command.first_instance, b.command.instances};
  });
  for (std::size_t i = 0; i < bug.command.draws.size(); ++i)
    halve<std::uint32_t>(
        bug, still,
        [i](Bug& b) -> std::pair<std::uint32_t&, std::uint32_t&> {
          return {b.command.draws[i].first, b.command.draws[i].count};
        },
        vertices_of(bug.state));
}

void reduce_descriptors(Bug& bug, const StillFound& still) {
  thin_out<std::uint32_t>(bug, still, [](Bug& b) -> std::vector<std::uint32_t>& { return b.addressed; });
  thin_out<bug::Descriptor>(bug, still, [](Bug& b) -> std::vector<bug::Descriptor>& { return b.descriptors; });
  // Memory that nothing else is left in goes, too.
  attempt(bug, still, [](Bug& b) { drop_unused(b); });
}

void reduce_memory(Bug& bug, const StillFound& still) {
  for (std::size_t i = 0; i < bug.memories.size(); ++i) reduce_pieces(bug, still, i);
  for (std::size_t i = 0; i < bug.images.size(); ++i)
    for (std::size_t k = 0; k < bug.images[i].texels.size(); ++k)
      if (!bug.images[i].texels[k].unwritten) attempt(bug, still, [&](Bug& b) { empty(b.images[i].texels[k]); });
}

void reduce_state(Bug& bug, const StillFound& still) {
  if (bug.dispatches()) return;
  const raster::State usual;
  const auto reset = [&](auto member) {
    if (std::memcmp(&(bug.state.*member), &(usual.*member), sizeof(usual.*member)) != 0)
      attempt(bug, still, [&](Bug& b) { b.state.*member = usual.*member; });
  };
  reset(&raster::State::blend);
  reset(&raster::State::logic_op_enable);
  reset(&raster::State::stencil_test);
  reset(&raster::State::depth_bounds_test);
  reset(&raster::State::depth_test);
  reset(&raster::State::depth_bias);
  reset(&raster::State::depth_clamp);
  reset(&raster::State::cull_mode);
  reset(&raster::State::polygon_mode);
  reset(&raster::State::sample_shading);
  reset(&raster::State::fragment_size);
  reset(&raster::State::rate_combiners);
  if (bug.rendering.rate != kNone) attempt(bug, still, [](Bug& b) { b.rendering.rate = kNone, drop_unused(b); });
  reset(&raster::State::alpha_to_coverage);
  reset(&raster::State::alpha_to_one);
  reset(&raster::State::line_stipple);
  reset(&raster::State::primitive_restart);
  reset(&raster::State::provoking_vertex_last);
}

}  // namespace vitrine::glass::cli
