// Random shader stages for random fixed-function state: what they must agree on, and their text.
#pragma once

#include <string>

#include "harness/graphics.h"

namespace vitrine::cts {

/// What is rasterized, before the polygon mode.
enum class Drawn { kPoints, kLines, kTriangles };

/// The stages in front of rasterization and what they write. Every vertex has a position, two colours and a point size.
struct Stages {
  VkPrimitiveTopology topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
  std::string tessellation;  ///< layout of the evaluation shader; empty: no tessellation
  std::string geometry;      ///< layout of what the geometry shader gives; empty: no such stage
  Drawn drawn = Drawn::kTriangles;
  uint32_t clip_distances = 0, cull_distances = 0;
  uint32_t layers = 1, viewports = 1;  ///< more than one: the last stage chooses
  bool primitive_id = false;           ///< the geometry shader writes it
  bool captured = false;               ///< the last stage's outputs are: position and smooth colour in buffer 0, the
                                       ///< others in buffer 1
  bool views = false;                  ///< stages read gl_ViewIndex
};

/// Counters of a row of pixels (FragmentNeeds::counts).
constexpr uint32_t kCountedRow = 128;

/// What the fragment shader may read and write.
struct FragmentNeeds {
  bool multisampled = false, writes_depth = false, writes_stencil = false, writes_mask = false, reads_mask = false;
  bool early = false, facing = false, dual = false, discards = false, primitive_id = true;
  bool per_sample = false;  ///< may run once per sample
  bool counts = false;      ///< counts the invocations of every pixel in storage buffer 0 (see kCountedRow)
};

Stages random_stages(Run& run, bool short_lines_allowed);
void write_stages(const Stages& stages, GraphicsSpec& spec);
std::string random_fragment(Random& random, const TargetSpec& target, const Stages& stages, const FragmentNeeds& needs);

}  // namespace vitrine::cts
