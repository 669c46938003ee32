// How the cases of the listed deviations judge and draw.
#include "cases/deviations/deviation.h"

namespace vitrine::cts {

std::string same(const Output& a, const Output& b, const char* what) {
  const Comparison found = compare(a, b);
  return found.first.empty() ? "" : std::string(what) + ": " + found.first;
}
std::string different(const Output& a, const Output& b, const char* what) {
  return compare(a, b).first.empty() ? std::string(what) + " does not show" : "";
}
std::string first_of(std::initializer_list<std::string> messages) {
  for (const std::string& message : messages)
    if (!message.empty()) return message;
  return "";
}

std::string case_against_control(const std::vector<Output>& device, const std::vector<Output>& reference) {
  return first_of({same(device[1], reference[1], "the control"),
                   different(reference[0], reference[1], "the reference's fault"),
                   same(device[0], reference[1], "the device")});
}

void draw(Run& run, const std::string& name, const TargetSpec& target_spec, GraphicsSpec spec,
          const std::vector<float>& values) {
  const Target target = make_target(run, target_spec);
  if (spec.vertex.empty()) spec.vertex = kColorVertex;
  if (spec.fragment.empty()) spec.fragment = kColorFragment;
  if (spec.bindings.empty()) spec.floats({4, 4});
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  const Buffer vertices = run.buffer_of(values);
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    bind_vertices(cmd, vertices);
    vkCmdDraw(cmd, static_cast<uint32_t>(values.size() / 8), 1, 0, 0);
    vkCmdEndRenderPass(cmd);
  });
  run.out(name, target.colors[0]);
  run.outputs.back().may_be_blank = true;
}

std::vector<float> colored(const std::vector<std::array<float, 4>>& positions) {
  std::vector<float> values;
  for (size_t i = 0; i < positions.size(); ++i) {
    values.insert(values.end(), positions[i].begin(), positions[i].end());
    for (const float c : {0.25f + 0.5f * static_cast<float>(i % 2), 0.5f, 0.75f, 1.0f}) values.push_back(c);
  }
  return values;
}

}  // namespace vitrine::cts
