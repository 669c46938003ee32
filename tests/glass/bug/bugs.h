// A small bug for the tests: a dispatch with a buffer of 64 bytes, of which 16 were captured.
#pragma once

#include <cstring>

#include "glass/bug/bug.h"

namespace vitrine::glass::bug {

inline Blob blob(std::initializer_list<std::uint32_t> words) {
  Bytes bytes(words.size() * 4);
  std::memcpy(bytes.data(), words.begin(), bytes.size());
  return std::make_shared<Bytes>(std::move(bytes));
}

inline Bug small_bug() {
  Bug bug;
  bug.device = "Vitrine";
  bug.command_name = "vkCmdDispatch";
  bug.pipeline = "blur";
  bug.submission = 2;
  bug.command_number = 7;
  bug.labels = {"frame", "\xff not UTF-8"};
  bug.findings = {{"out-of-bounds-store", "store of 4 bytes", "a.comp:8", "main"}};
  Stage stage;
  stage.entry_point = "main";
  stage.constants = {{3, 0, 4}};
  stage.constant_data = blob({5});
  stage.words = blob({0x07230203, 0x00010300, 0, 1, 0});
  bug.stages = {stage};
  bug.memories = {{64, 0x7f0000001000, {{16, false, blob({1, 2, 3, 4}), blob({1, 2, 3, 5})}}}};
  bug.buffers = {{"particles", 64, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, 0, 0}};
  Binding binding;
  binding.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
  binding.count = 1;
  bug.sets = {{true, {binding}}};
  Descriptor descriptor;
  descriptor.buffer = 0;
  descriptor.range = 64;
  bug.descriptors = {descriptor};
  bug.push_constants = blob({9});
  bug.push_ranges = {{VK_SHADER_STAGE_COMPUTE_BIT, 0, 4}};
  bug.pushed = 1;
  bug.command.groups = {4, 2, 1};
  return bug;
}

}  // namespace vitrine::glass::bug
