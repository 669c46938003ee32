// Vertex attributes and indices that draws fetch from outside of what is bound (Vulkan 1.3.239, Vertex Input Address
// Calculation; Programmable Primitive Shading).
#include <algorithm>
#include <string>

#include "glass/indices.h"
#include "glass/sanitize/checks.h"
#include "raster/draw.h"
#include "texel/format.h"

namespace vitrine::glass::sanitize {
namespace {

using raster::DrawCall;
using raster::VertexAttribute;
using raster::VertexBinding;

// What tells places of a program apart: instructions have small numbers.
constexpr std::uint64_t kIndices = std::uint64_t{1} << 40, kAttributes = kIndices + 1;

/// Elements of a binding that lie wholly inside: [0, count).
std::uint64_t elements_in(const VertexBinding& binding, std::uint32_t offset, std::uint32_t bytes) {
  const std::uint64_t end = std::uint64_t{offset} + bytes;
  if (!binding.data || binding.size < end) return 0;
  return binding.stride == 0 ? ~std::uint64_t{0} : (binding.size - end) / binding.stride + 1;
}

/// Vertices or instances whose element lies outside: how many, and the first of them.
struct Outside {
  std::uint64_t count = 0;
  std::uint32_t vertex = 0, instance = 0;  ///< VertexIndex, InstanceIndex
  std::uint32_t element = 0;
};

/// One draw.
class DrawCheck {
 public:
  DrawCheck(ProgramPlaces& program, const DrawCall& call)
      : program_(program), call_(call), command_(*call.vertex_resources.command) {}

  void run() {
    if (call_.count == 0 || call_.instance_count == 0 || command_.robust_vertices) return;
    if (call_.index_data) check_indices();
    for (std::uint32_t i = 0; i < call_.state->attribute_count; ++i)
      if (is_read(call_.state->attribute[i])) check_attribute(call_.state->attribute[i]);
  }

 private:
  bool is_read(const VertexAttribute& attribute) const {
    const bool two = texel::format_desc(attribute.format).block_bytes > 16;
    const auto& inputs = call_.vertex->interface().inputs;
    return std::any_of(inputs.begin(), inputs.end(), [&](const spirv::InterfaceSlot& slot) {
      return slot.built_in == spirv::BuiltIn::kNone &&
             (slot.location == attribute.location || (two && slot.location == attribute.location + 1));
    });
  }

  void check_indices() {
    if (call_.index_bytes == 0 && command_.null_descriptors) return;  // they are 0 (VK_KHR_maintenance6)
    const std::uint32_t bytes = index_bytes(call_);
    const std::uint64_t end = std::uint64_t{call_.first} + call_.count, there = call_.index_bytes / bytes;
    if (end <= there) return;
    const std::uint64_t first = std::max<std::uint64_t>(call_.first, there);
    Outside outside{end - first, static_cast<std::uint32_t>(first), call_.first_instance, 0};
    add(kIndices, "out-of-bounds-index", outside, [&] {
      std::string text = "index " + std::to_string(first) + " of " + std::to_string(bytes);
      text += bytes == 1 ? " byte lies" : " bytes lies";
      if (call_.index_bytes == 0) return text + " outside: no bytes of an index buffer are bound";
      return text + " outside of index buffer " + command_.bytes(call_.index_data, call_.index_bytes);
    });
  }

  Outside instances_outside(const VertexBinding& binding, std::uint64_t limit) const {
    const std::uint32_t step = binding.divisor;
    const std::uint64_t base = call_.first_instance;
    const std::uint64_t last = base + (step ? (call_.instance_count - 1) / step : 0);
    if (last < limit) return {};
    const std::uint64_t first = limit <= base || step == 0 ? 0 : (limit - base) * step;
    const auto number = static_cast<std::uint32_t>(first);
    return {call_.instance_count - first, first_vertex(), call_.first_instance + number,
            static_cast<std::uint32_t>(base + (step ? number / step : 0))};
  }

  std::uint32_t first_vertex() const {
    return call_.index_data ? static_cast<std::uint32_t>(call_.vertex_offset) : call_.first;
  }

  Outside vertices_outside(std::uint64_t limit) const {
    Outside out{0, 0, call_.first_instance, 0};
    if (!call_.index_data) {
      const std::uint64_t end = std::uint64_t{call_.first} + call_.count;
      if (end <= limit) return out;
      out.element = static_cast<std::uint32_t>(std::max<std::uint64_t>(call_.first, limit));
      out.count = end - out.element;
    } else {
      for_each_vertex(call_, [&](std::uint32_t vertex) {
        if (vertex >= limit && out.count++ == 0) out.element = vertex;
      });
    }
    out.vertex = out.element;
    out.count *= call_.instance_count;
    return out;
  }

  void check_attribute(const VertexAttribute& attribute) {
    const VertexBinding& binding = call_.vertex_binding[attribute.binding];
    const texel::FormatDesc& format = texel::format_desc(attribute.format);
    if (!binding.data && command_.null_descriptors) return;
    const std::uint64_t limit = elements_in(binding, attribute.offset, format.block_bytes);
    const Outside outside = binding.per_instance ? instances_outside(binding, limit) : vertices_outside(limit);
    if (outside.count == 0) return;
    const char* const rule = binding.data ? "out-of-bounds-vertex" : "null-descriptor";
    add(kAttributes + attribute.location, rule, outside,
        [&] { return attribute_text(attribute, binding, format.block_bytes, outside.element); });
  }

  std::string attribute_text(const VertexAttribute& attribute, const VertexBinding& binding, std::uint32_t bytes,
                             std::uint32_t element) const {
    std::string text = "attribute at location " + std::to_string(attribute.location);
    text += std::string(" (") + texel::format_desc(attribute.format).name + ") ";
    const std::string where = "binding " + std::to_string(attribute.binding);
    if (!binding.data) return text + "is fetched from " + where + ", where no bytes of a vertex buffer are bound";
    // An index below 0, as vertexOffset may make it, wraps.
    const auto number = static_cast<std::int32_t>(element);
    text += binding.per_instance ? "of instance element " : "of vertex ";
    text += call_.index_data && !binding.per_instance && number < 0 ? std::to_string(number) : std::to_string(element);
    text += " needs " + std::to_string(bytes) + " bytes at offset ";
    text += std::to_string(std::uint64_t{element} * binding.stride + attribute.offset);
    text += ", outside of vertex buffer " + command_.bytes(binding.data, binding.size) + " in " + where;
    return text + " with a stride of " + std::to_string(binding.stride);
  }

  template <class F>
  void add(std::uint64_t place, const char* rule_id, const Outside& outside, F&& message) {
    const Id id{outside.vertex, outside.instance, 0};
    const Order order(command_.submission, command_.command, Id{call_.draw_index, outside.instance, outside.vertex});
    program_.places.add({place, rule_id}, outside.count, order, [&] {
      Finding finding;
      finding.rule = &rule(rule_id);
      finding.message = message();
      finding.address = program_.context.address(&command_, id, 0, 0);
      return finding;
    });
  }

  ProgramPlaces& program_;
  const DrawCall& call_;
  const spirv::ObservedCommand& command_;
};

}  // namespace

void check_draw(ProgramPlaces& program, const DrawCall& call) {
  if (call.vertex_resources.command) DrawCheck(program, call).run();
}

}  // namespace vitrine::glass::sanitize
