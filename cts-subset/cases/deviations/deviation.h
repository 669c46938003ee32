// One case per row of deviations.md: the devices differ exactly as the row says, so that the row cannot rot.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "harness/case.h"
#include "harness/graphics.h"

namespace vitrine::cts {

/// Empty, or a message with the first difference.
std::string same(const Output& a, const Output& b, const char* what);
/// Empty, or a message that the outputs are the same.
std::string different(const Output& a, const Output& b, const char* what);
/// The first message that is not empty.
std::string first_of(std::initializer_list<std::string> messages);

/// Output 0 is the case; output 1 is the same picture made in a way that the reference gets right.
std::string case_against_control(const std::vector<Output>& device, const std::vector<Output>& reference);

/// Draws vertices (vec4 position, vec4 colour) into a fresh target and puts its colour out.
void draw(Run& run, const std::string& name, const TargetSpec& target_spec, GraphicsSpec spec,
          const std::vector<float>& values);
/// Vertices of greys that alternate.
std::vector<float> colored(const std::vector<std::array<float, 4>>& positions);

/// A vertex shader of points 11 pixels large.
inline constexpr char kBigPoint[] = R"(
layout(location = 0) in vec4 position;
layout(location = 1) in vec4 color;
layout(location = 0) out vec4 passed;
void main() { passed = color; gl_Position = position; gl_PointSize = 11.0; })";

}  // namespace vitrine::cts
