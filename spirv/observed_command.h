// What observers are told of the draw or dispatch that runs a shader: its place among the application's commands and
// the names that the application gave. Made by icd/, which keeps it until the command's work is done.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace vitrine::spirv {

class ObservedCommand {
 public:
  virtual ~ObservedCommand() = default;

  std::uint64_t submission = 0;     ///< of the device's queues, counted from 1
  std::uint32_t command = 0;        ///< recorded commands before it in the submission, counted from 1
  const char* name = "";            ///< "vkCmdDraw"...
  std::vector<std::string> labels;  ///< VK_EXT_debug_utils: those that are open, outermost first
  std::string pipeline;             ///< name of the pipeline; empty: it has none
  bool null_descriptors = false;    ///< descriptors may be null (nullDescriptor): accesses through them are defined

  /// Name of what is bound at a descriptor ("buffer 'particles' (4096 bytes)"); empty: nothing is known.
  virtual std::string resource(std::uint32_t set, std::uint32_t slot) const = 0;
};

}  // namespace vitrine::spirv
