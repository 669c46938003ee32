// See bug_files.h.
#include "glass/cli/bug_files.h"

#include <new>

#include "glass/bug/file.h"
#include "glass/cli/application.h"
#include "glass/cli/files.h"
#include "glass/cli/say.h"

namespace vitrine::glass::cli {
namespace fs = std::filesystem;
namespace {

fs::path own_path() {
  std::error_code error;
  return fs::read_symlink("/proc/self/exe", error);
}

/// The module without what the compiler noted for people.
bool strip(bug::Blob& words, const fs::path& folder) {
  const std::string from = folder / "named.spv", to = folder / "nameless.spv";
  if (!write_file(from, {reinterpret_cast<const char*>(words->data()), words->size()})) return false;
  const Ending ending = run_to_end({"spirv-opt", "--strip-debug", "--strip-nonsemantic", "--preserve-bindings",
                                    "--preserve-spec-constants", from, "-o", to},
                                   {});
  const std::optional<std::string> stripped = ending.error.empty() && ending.code == 0 ? read_file(to) : std::nullopt;
  if (!stripped || stripped->size() % 4 != 0) {
    say(std::string("names in shaders cannot be removed: spirv-opt (Debian package spirv-tools) ") +
        (ending.error.empty() ? "failed" : "is not there"));
    return false;
  }
  const auto* first = reinterpret_cast<const std::byte*>(stripped->data());
  words = std::make_shared<bug::Bytes>(first, first + stripped->size());
  return true;
}

template <class T>
void forget_names(std::vector<T>& objects) {
  for (T& object : objects) object.name.clear();
}

}  // namespace

fs::path replayer() { return own_path().parent_path() / "vitrine-replay"; }

std::optional<bug::Bug> read_bug(const std::string& file) {
  const std::optional<std::string> contents = read_file(file);
  if (!contents) {
    say(file + " cannot be read");
    return std::nullopt;
  }
  try {
    base::Result<bug::Bug> bug = bug::from_file(*contents);
    if (bug) return bug.take();
    say(file + ": " + bug.message());
  } catch (const std::bad_alloc&) {
    say(file + ": it needs more memory than there is");
  }
  return std::nullopt;
}

bool write_bug(const std::string& file, const bug::Bug& bug) { return write_file(file, bug::to_file(bug)); }

Ending run_quietly(const std::vector<std::string>& command, Environment environment) {
  const fs::path manifest = driver_manifest(own_path());
  environment["VK_DRIVER_FILES"] = manifest;
  environment["VK_ICD_FILENAMES"] = manifest;
  std::vector<std::string> words{"sh", "-c", "exec \"$@\" >/dev/null 2>&1", "sh"};
  words.insert(words.end(), command.begin(), command.end());
  return run_to_end(words, environment);
}

bool remove_names(bug::Bug& bug) {
  const TemporaryFolder folder;
  if (folder.path().empty()) return false;
  for (bug::Stage& stage : bug.stages)
    if (!strip(stage.words, folder.path())) return false;
  forget_names(bug.buffers);
  forget_names(bug.images);
  forget_names(bug.views);
  forget_names(bug.buffer_views);
  forget_names(bug.samplers);
  bug.pipeline.clear();
  bug.labels.clear();
  // They quote names and sources.
  for (bug::Found& found : bug.findings) found.message = found.place = found.function = "";
  return true;
}

}  // namespace vitrine::glass::cli
