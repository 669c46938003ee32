// What a case gives a device, as two hashes: a record tells by them whether the case is still the one that was
// recorded. In: what the functions of Run are called with. Not seen: commands that a case records by itself (draws,
// copies, dynamic state), whose change shows as a change of the case's source file only (revision.py).
#pragma once

#include <vulkan/vulkan.h>

#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "harness/hash.h"

namespace vitrine::cts {

struct Binding;
struct Buffer;
struct GraphicsSpec;
struct ImageSpec;

class Inputs {
 public:
  /// A shader's text, and the module that the installed compiler makes of it.
  void shader(int stage, const std::string& text) { given_.numbers(stage), given_.text(text); }
  void module(const std::vector<uint32_t>& words, bool from_text);
  void special(const VkSpecializationInfo* constants);
  void image(const ImageSpec& spec);
  void sampler(const VkSamplerCreateInfo& info);
  /// `has_address`: contents and push constants may be addresses from here on, which differ from run to run.
  void buffer(const Buffer& buffer, bool has_address);
  void push_constants(std::span<const std::byte> bytes);
  void bindings(const std::vector<Binding>& bindings, uint32_t push_bytes);
  void pipeline(const GraphicsSpec& spec);
  /// Contents of the buffers that are new since the last submission: what the host has written.
  void submission();

  Hash& given() { return given_; }
  uint32_t of_case() const { return given_.half(); }
  uint32_t of_modules() const { return modules_.half(); }

 private:
  Hash given_, modules_;
  std::vector<std::pair<const unsigned char*, size_t>> unseen_;  // buffers, until the next submission
  bool has_addresses_ = false;
};

}  // namespace vitrine::cts
