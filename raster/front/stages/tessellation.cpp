// Tessellation (Vulkan 1.3.239, Tessellation): control shaders over waves of whole patches, the tessellator, evaluation
// shaders over waves of domain points.
#include "raster/front/stages/tessellation.h"

#include <algorithm>
#include <cstring>

#include "base/numeric.h"
#include "raster/front/gather.h"
#include "raster/front/stages/geometry.h"
#include "raster/front/vertices.h"
#include "spirv/stage_memory.h"

namespace vitrine::raster {
namespace {

using spirv::BuiltIn;
using spirv::InterfaceSlot;

/// Patches that are worked on together: one wave of the control shader, or all of the chunk. Words in stage memory.
struct Batch {
  std::size_t first = 0;  ///< patch
  std::uint32_t count = 0;
  std::size_t input_table = 0, output_table = 0, patches = 0;
  std::uint32_t patch_stride = 0;
};

std::uint32_t byte_offset(std::size_t word) { return static_cast<std::uint32_t>(word * 4); }

/// Offsets of the vertices that both stages read.
void fill_tables(const StageContext& c, const Batch& batch) {
  StageScratch& s = c.stages;
  const spirv::StageModes& modes = c.plan.stages.tessellation;
  const std::uint32_t points = c.plan.shape.step;
  for (std::uint32_t p = 0; p < batch.count; ++p) {
    std::copy_n(s.patch_vertices.data() + (batch.first + p) * points, points,
                s.memory.data() + batch.input_table + p * kMaxPatchVertices);
    const std::size_t vertices = batch.patches + std::size_t{p} * batch.patch_stride + modes.patch_words;
    for (std::uint32_t v = 0; v < modes.control_points; ++v)
      s.memory[batch.output_table + p * kMaxPatchVertices + v] = byte_offset(vertices + v * modes.vertex_words);
  }
}

/// What tells invocations of a patch apart (spirv/exec/invocation.h), of which `number` is one.
std::uint32_t identity_of(const StageContext& c, std::size_t patch, std::uint32_t component, std::uint32_t number) {
  return component == 0 ? number : component == 1 ? c.stages.patch_ids[patch] : c.stages.patch_instances[patch];
}

/// One wave: `count` patches of the batch.
void run_control_wave(const StageContext& c, const Batch& batch, std::uint32_t first, std::uint32_t count) {
  StageScratch& s = c.stages;
  const std::uint32_t invocations = c.plan.stages.tessellation.control_points;
  const std::uint32_t lanes = count * invocations;
  for (const InterfaceSlot& slot : c.plan.stages.control->inputs) {
    std::uint32_t* lane = s.control.input(slot.reg).lane;
    for (std::uint32_t i = 0; i < lanes; ++i) {
      const std::uint32_t patch = first + i / invocations;
      switch (slot.built_in) {
        case BuiltIn::kInvocationId:
          lane[i] = i % invocations;
          break;
        case BuiltIn::kPrimitiveId:
          lane[i] = s.patch_ids[batch.first + patch];
          break;
        case BuiltIn::kPatchVertices:
          lane[i] = c.plan.shape.step;
          break;
        case BuiltIn::kIdentity:
          lane[i] = identity_of(c, batch.first + patch, slot.component, i % invocations);
          break;
        case BuiltIn::kVertexTable:
          lane[i] = byte_offset(batch.input_table + patch * kMaxPatchVertices);
          break;
        case BuiltIn::kPatchOffset:
          lane[i] = byte_offset(batch.patches + std::size_t{patch} * batch.patch_stride);
          break;
        case BuiltIn::kViewIndex:
          lane[i] = c.chunk.view;
          break;
        default:
          lane[i] = 0;
          break;
      }
    }
  }
  s.control.set_stage_memory(s.memory.data(), s.used);
  s.control.run(base::first_lanes(lanes), 0);
  c.queries().count(Statistic::kTessellationControlPatches, count);
}

/// Patches of one wave of the control shader.
std::uint32_t patches_of_wave(const StageContext& c) {
  return static_cast<std::uint32_t>(base::kWaveWidth) / c.plan.stages.tessellation.control_points;
}

void run_control(const StageContext& c, const Batch& batch) {
  const std::uint32_t most = patches_of_wave(c);
  for (std::uint32_t first = 0; first < batch.count; first += most)
    run_control_wave(c, batch, first, std::min(batch.count - first, most));
}

/// Corners of what the tessellator makes.
std::uint32_t tessellated_corners(const spirv::StageModes& modes) {
  return modes.point_mode ? 1 : modes.domain == spirv::TessDomain::kIsolines ? 2 : 3;
}

/// Domain points and primitives (slots are numbers of points) of all patches of the batch.
void tessellate(const StageContext& c, const Batch& batch) {
  StageScratch& s = c.stages;
  const spirv::StageModes& modes = c.plan.stages.tessellation;
  const bool flip = c.plan.state->domain_origin_lower_left;
  const std::uint32_t corners = tessellated_corners(modes);
  const ReferenceWays& ways = c.plan.as_reference;
  s.points.clear();
  s.listed.clear();
  for (std::uint32_t p = 0; p < batch.count; ++p) {
    TessLevels levels;
    const std::uint32_t* words = s.memory.data() + batch.patches + std::size_t{p} * batch.patch_stride;
    std::memcpy(levels.outer, words, sizeof(levels.outer));
    std::memcpy(levels.inner, words + 4, sizeof(levels.inner));
    s.tessellator.run({modes.domain, modes.spacing, modes.clockwise != flip, modes.point_mode}, levels);
    const auto first = static_cast<std::uint32_t>(s.points.size());
    for (const DomainPoint& point : s.tessellator.points())
      s.points.push_back({point.u, point.v, p, static_cast<std::uint32_t>(s.points.size()) - first});
    const std::vector<std::uint32_t>& indices = s.tessellator.indices();
    for (std::size_t i = 0; i + corners <= indices.size(); i += corners) {
      ListedPrimitive& primitive = s.listed.emplace_back();
      primitive.id = ways.evaluated_ids ? 0 : s.patch_ids[batch.first + p];
      primitive.instance = s.patch_instances[batch.first + p];
      for (std::uint32_t k = 0; k < 3; ++k)
        primitive.slot[k] = (first + indices[i + (k < corners ? k : 0)]) & ways.tessellated_mask;
    }
  }
}

/// "w = 1 - u - v" of triangles; other domains have none (Vulkan 1.3.239, Tessellation: Tessellation Evaluation).
float tess_coord(const PatchPoint& point, std::uint32_t component, spirv::TessDomain domain) {
  if (component == 0) return point.u;
  if (component == 1) return point.v;
  return domain == spirv::TessDomain::kTriangles ? 1.0f - point.u - point.v : 0.0f;
}

void run_evaluation_wave(const StageContext& c, const Batch& batch, std::uint32_t base, std::uint32_t lanes) {
  StageScratch& s = c.stages;
  const spirv::StageModes& modes = c.plan.stages.tessellation;
  for (const InterfaceSlot& slot : c.plan.stages.evaluation->inputs) {
    std::uint32_t* lane = s.evaluation.input(slot.reg).lane;
    for (std::uint32_t i = 0; i < lanes; ++i) {
      const PatchPoint& point = s.points[base + i];
      switch (slot.built_in) {
        case BuiltIn::kTessCoord:
          lane[i] = base::bits_of(tess_coord(point, slot.component, modes.domain));
          break;
        case BuiltIn::kPrimitiveId:
          lane[i] = s.patch_ids[batch.first + point.patch];
          break;
        case BuiltIn::kPatchVertices:
          lane[i] = modes.control_points;
          break;
        case BuiltIn::kIdentity:
          lane[i] = identity_of(c, batch.first + point.patch, slot.component, point.number);
          break;
        case BuiltIn::kVertexTable:
          lane[i] = byte_offset(batch.output_table + point.patch * kMaxPatchVertices);
          break;
        case BuiltIn::kPatchOffset:
          lane[i] = byte_offset(batch.patches + std::size_t{point.patch} * batch.patch_stride);
          break;
        case BuiltIn::kViewIndex:
          lane[i] = c.chunk.view;
          break;
        default:
          lane[i] = 0;
          break;
      }
    }
  }
  s.evaluation.run(base::first_lanes(lanes), 0);
}

/// Calls f(first point, number) after each wave of evaluation shaders.
template <class F>
void run_evaluation(const StageContext& c, const Batch& batch, F&& f) {
  StageScratch& s = c.stages;
  const auto count = static_cast<std::uint32_t>(s.points.size());
  s.evaluation.set_stage_memory(s.memory.data(), s.used);
  for (std::uint32_t base = 0; base < count; base += base::kWaveWidth) {
    const std::uint32_t lanes = std::min<std::uint32_t>(count - base, base::kWaveWidth);
    run_evaluation_wave(c, batch, base, lanes);
    f(base, lanes);
  }
  c.queries().count(Statistic::kTessellationEvaluationInvocations, count);
}

void evaluate_for_geometry(const StageContext& c, const Batch& batch) {
  StageScratch& s = c.stages;
  const std::uint32_t words = c.plan.stages.evaluation_words;
  const std::size_t first = s.take(s.points.size() * words);
  run_evaluation(c, batch, [&](std::uint32_t base, std::uint32_t lanes) {
    store_stage_outputs(c.plan.stages.evaluation->outputs, s.evaluation, lanes, s, first + std::size_t{base} * words,
                        words);
  });
  s.inputs.clear();
  std::uint32_t patch = 0, number = 0;
  for (const ListedPrimitive& primitive : s.listed) {
    GeometryInput& input = s.inputs.emplace_back();
    if (const std::uint32_t from = s.points[primitive.slot[0]].patch; from != patch) patch = from, number = 0;
    for (std::uint32_t v = 0; v < 6; ++v)
      input.vertex[v] = byte_offset(first + std::size_t{primitive.slot[v < 3 ? v : 0]} * words);
    input.id = c.chunk.primitive_count ? (*c.chunk.primitive_count)++ : primitive.id;
    input.source = s.patch_ids[batch.first + patch];
    input.instance = s.patch_instances[batch.first + patch];
    input.number = number++;
  }
  run_geometry(c, s.inputs);
}

void evaluate_and_assemble(const StageContext& c, const Batch& batch) {
  StageScratch& s = c.stages;
  const auto count = static_cast<std::uint32_t>(s.points.size());
  reserve_vertices(c.vertices, count);
  c.vertices.records = c.arena.take<Vertex>(std::size_t{count} * c.plan.vertex_stride);
  run_evaluation(c, batch, [&](std::uint32_t base, std::uint32_t lanes) {
    store_wave(c.plan, {&s.evaluation, nullptr}, base, lanes, c.vertices);
    if (c.capture.active) capture_wave(c.plan, {&s.evaluation, nullptr}, base, lanes, c.capture);
  });
  if (c.capture.active)
    for (const ListedPrimitive& primitive : s.listed) capture_primitive(c.plan, primitive.slot, c.capture);
  if (!c.plan.state->rasterizer_discard) process_listed(c.primitive_context(), s.listed);
}

}  // namespace

void run_tessellation(const StageContext& c) {
  StageScratch& s = c.stages;
  const spirv::StageModes& modes = c.plan.stages.tessellation;
  bind_stage(s.control, s.bound_control, c.chunk.draw->control);
  bind_stage(s.evaluation, s.bound_evaluation, c.chunk.draw->evaluation);
  Batch batch;
  batch.patch_stride = modes.patch_words + modes.control_points * modes.vertex_words;
  const std::size_t mark = s.used;
  const bool whole = c.plan.as_reference.tessellated_mask != ~0u;
  const std::size_t most = whole ? std::max<std::size_t>(s.patch_ids.size(), 1) : patches_of_wave(c);
  for (; batch.first < s.patch_ids.size(); batch.first += most) {
    batch.count = static_cast<std::uint32_t>(std::min(s.patch_ids.size() - batch.first, most));
    batch.input_table = s.take(std::size_t{batch.count} * kMaxPatchVertices);
    batch.output_table = s.take(std::size_t{batch.count} * kMaxPatchVertices);
    batch.patches = s.take(std::size_t{batch.count} * batch.patch_stride);
    fill_tables(c, batch);
    run_control(c, batch);
    tessellate(c, batch);
    if (c.plan.stages.geometry)
      evaluate_for_geometry(c, batch);
    else
      evaluate_and_assemble(c, batch);
    s.used = mark;
  }
}

}  // namespace vitrine::raster
