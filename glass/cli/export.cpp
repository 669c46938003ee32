// vitrine export: a bug file as AmberScript, as files for other programs, or without the application's names.
#include <filesystem>

#include "glass/bug/amber.h"
#include "glass/bug/contents.h"
#include "glass/bug/file.h"
#include "glass/cli/bug_commands.h"
#include "glass/cli/bug_files.h"
#include "glass/cli/commands.h"
#include "glass/cli/files.h"
#include "glass/cli/reduce_steps.h"
#include "glass/cli/say.h"

namespace vitrine::glass::cli {
namespace fs = std::filesystem;
namespace {

std::string_view text_of(const bug::Blob& blob) { return {reinterpret_cast<const char*>(blob->data()), blob->size()}; }

const char* extension_of(VkShaderStageFlagBits stage) {
  switch (stage) {
    case VK_SHADER_STAGE_VERTEX_BIT:
      return "vert";
    case VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT:
      return "tesc";
    case VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT:
      return "tese";
    case VK_SHADER_STAGE_GEOMETRY_BIT:
      return "geom";
    case VK_SHADER_STAGE_FRAGMENT_BIT:
      return "frag";
    default:
      return "comp";
  }
}

/// bug.json, a module a stage, the bytes of every buffer before and after.
bool write_files(const bug::Bug& bug, const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  bool good = write_file(folder / "bug.json", bug::describe(bug));
  for (const bug::Stage& stage : bug.stages)
    good &= write_file(folder / (std::string(extension_of(stage.stage)) + ".spv"), text_of(stage.words));
  for (std::size_t i = 0; i < bug.buffers.size(); ++i) {
    for (const bool after : {false, true}) {
      const bug::Bytes bytes = bug::contents_of(bug, bug.buffers[i], after);
      good &= write_file(folder / ("buffer" + std::to_string(i) + (after ? ".after" : ".before")),
                         {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    }
  }
  return good;
}

/// The script names everything that is bound, so that what no shader sees would only stand in the way.
bool write_amber(bug::Bug bug, const std::string& file) {
  drop_undeclared(bug);
  const base::Result<std::string> script = bug::to_amber(bug);
  if (!script) say(script.message());
  return script && write_file(file, script.value());
}

}  // namespace

int export_bug(const ExportOptions& options) {
  if (options.amber.empty() && options.files.empty() && options.output.empty()) {
    say("nothing to write: --amber, --files or --output says what");
    return kCouldNotRun;
  }
  std::optional<bug::Bug> bug = read_bug(options.file);
  if (!bug || (!options.names && !remove_names(*bug))) return kCouldNotRun;
  bool good = options.amber.empty() || write_amber(*bug, options.amber);
  if (!options.files.empty()) good &= write_files(*bug, options.files);
  if (!options.output.empty()) good &= write_bug(options.output, *bug);
  return good ? 0 : kCouldNotRun;
}

}  // namespace vitrine::glass::cli
