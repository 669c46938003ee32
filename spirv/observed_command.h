// What observers are told of the draw or dispatch that runs a shader: its place among the application's commands and
// the names that the application gave. Made by icd/, which keeps it until the command's work is done.
#pragma once

#include <vulkan/vulkan_core.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "spirv/addresses.h"

namespace vitrine::spirv {

class ObservedCommand {
 public:
  virtual ~ObservedCommand() = default;

  const void* owner = nullptr;        ///< tells the devices apart whose commands run at the same time
  std::uint64_t submission = 0;       ///< of the device's queues, counted from 1
  std::uint32_t command = 0;          ///< recorded commands before it in the submission, counted from 1
  const char* name = "";              ///< "vkCmdDraw"...
  std::vector<std::string> labels;    ///< VK_EXT_debug_utils: those that are open, outermost first
  std::string pipeline;               ///< name of the pipeline; empty: it has none
  std::uint64_t pipeline_number = 0;  ///< of all pipelines that this process made, counted from 1
  std::uint64_t pass = 0;             ///< tells passes of this process apart: one a subpass or rendering scope
  bool null_descriptors = false;      ///< descriptors may be null (nullDescriptor): accesses through them are defined
  bool robust_vertices = false;       ///< vertex data and indices outside of buffers are zeros (robustBufferAccess2)
  std::uint64_t pushed = ~0ull;       ///< push constants, a bit a word: set, with a layout that is compatible

  /// Name of what is bound at a descriptor ("buffer 'particles' (4096 bytes)"); empty: nothing is known.
  virtual std::string resource(std::uint32_t set, std::uint32_t slot) const = 0;
  /// The same of these bytes of a buffer that is bound for vertices or indices: "'mesh' (96 bytes at offset 32)".
  virtual std::string bytes(const std::byte* first, std::uint64_t size) const {
    (void)first;
    return std::to_string(size) + " bytes";
  }
  /// Push constants that ranges of the pipeline layout give a stage, a bit a word.
  virtual std::uint64_t push_range(VkShaderStageFlagBits) const { return ~0ull; }
  /// What a descriptor named and is gone, or what lay at a device address: "buffer 'mesh', destroyed after submission
  /// 2"; empty: nothing is known to be gone. Such a descriptor is null.
  virtual std::string departed(std::uint32_t /*set*/, std::uint32_t /*slot*/) const { return {}; }
  virtual std::string departed(std::uint64_t /*address*/) const { return {}; }
  /// The stretch of live buffers that an address lies in; empty: in none.
  virtual AddressRange buffers_at(std::uint64_t address) const { return find_addresses(address); }
};

}  // namespace vitrine::spirv
