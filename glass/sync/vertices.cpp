// What the fixed stages in front of the vertex shader read (Vulkan 1.3.239, Programmable Primitive Shading; Vertex
// Input Address Calculation).
#include <algorithm>

#include "glass/indices.h"
#include "glass/sync/shader_accesses.h"
#include "texel/format.h"

namespace vitrine::glass::sync {
namespace {

using raster::DrawCall;

/// Above so many ranges what lies between them counts as read, too.
constexpr std::size_t kMostRanges = 4096;

/// The bytes of an element that attributes of a binding read: [first, end).
struct Element {
  std::uint32_t first = ~0u, end = 0;
};

Element element_of(const DrawCall& call, std::uint32_t binding) {
  Element element;
  for (std::uint32_t i = 0; i < call.state->attribute_count; ++i) {
    const raster::VertexAttribute& attribute = call.state->attribute[i];
    if (attribute.binding != binding) continue;
    element.first = std::min(element.first, attribute.offset);
    element.end = std::max(element.end, attribute.offset + texel::format_desc(attribute.format).block_bytes);
  }
  return element;
}

class Vertices {
 public:
  Vertices(Hazards& hazards, const DrawCall& call)
      : hazards_(hazards), call_(call), command_(*call.vertex_resources.command) {}

  void indices() {
    const std::uint32_t bytes = index_bytes(call_);
    const auto base = reinterpret_cast<std::uintptr_t>(call_.index_data);
    const std::uint64_t end = std::min((std::uint64_t{call_.first} + call_.count) * bytes, call_.index_bytes);
    const std::uint64_t first = std::uint64_t{call_.first} * bytes;
    if (first >= end) return;
    touch({Stage::kIndex, Access::kIndexRead}, {{base + first, base + end}}, "read of indices", "index buffer ",
          call_.index_data, call_.index_bytes);
  }

  void binding(std::uint32_t number) {
    const raster::VertexBinding& binding = call_.vertex_binding[number];
    const Element element = element_of(call_, number);
    if (element.end == 0 || !binding.data) return;
    ByteSet bytes;
    const auto add = [&](std::uint64_t n) {
      const std::uint64_t first = n * binding.stride + element.first, end = n * binding.stride + element.end;
      if (end <= binding.size) bytes.add(reinterpret_cast<std::uintptr_t>(binding.data) + first, end - first);
    };
    if (binding.per_instance) {
      const std::uint64_t step = binding.divisor;
      const std::uint64_t last = step != 0 ? (call_.instance_count - 1) / step : 0;
      for (std::uint64_t n = 0; n <= last; ++n) add(call_.first_instance + n);
    } else if (call_.index_data) {
      for_each_vertex(call_, add);
    } else {
      for (std::uint64_t n = 0; n < call_.count; ++n) add(call_.first + n);
    }
    std::vector<Range> ranges = bytes.ranges();
    if (ranges.size() > kMostRanges) ranges = {{ranges.front().first, ranges.back().end}};
    touch({Stage::kAttribute, Access::kAttributeRead}, std::move(ranges), "read of vertex attributes", "vertex buffer ",
          binding.data, binding.size);
  }

 private:
  void touch(Use use, std::vector<Range> ranges, const char* what, const char* kind, const std::byte* data,
             std::uint64_t size) {
    auto who = std::make_shared<Who>();
    who->what = what;
    who->resource = kind + command_.bytes(data, size);
    who->place = who->what + who->resource + command_.pipeline;
    who->base = reinterpret_cast<std::uintptr_t>(data);
    who->address.submission = command_.submission;
    who->address.command = command_.command;
    who->address.command_name = command_.name;
    who->address.labels = command_.labels;
    who->address.pipeline = command_.pipeline;
    hazards_.touch(make_tag(command_.submission, command_.command, Part::kWork),
                   {use, 0, std::move(ranges), std::move(who)});
  }

  Hazards& hazards_;
  const DrawCall& call_;
  const spirv::ObservedCommand& command_;
};

}  // namespace

void touch_vertices(Hazards& hazards, const DrawCall& call) {
  if (!call.vertex_resources.command || call.count == 0 || call.instance_count == 0) return;
  Vertices vertices(hazards, call);
  if (call.index_data) vertices.indices();
  for (std::uint32_t i = 0; i < call.vertex_binding.size(); ++i) vertices.binding(i);
}

}  // namespace vitrine::glass::sync
