// vitrine reduce: replays smaller and smaller bugs under the tools that found something, and keeps what still has it.
#include <algorithm>
#include <cstdlib>

#include "glass/cli/application.h"
#include "glass/cli/bug_commands.h"
#include "glass/cli/bug_files.h"
#include "glass/cli/files.h"
#include "glass/cli/findings.h"
#include "glass/cli/reduce_steps.h"
#include "glass/cli/say.h"

namespace vitrine::glass::cli {
namespace {

namespace fs = std::filesystem;

const char kLost[] = "device-lost";

// Lines of the disassembly, which stands for a source where a module names none, move when the module is reduced.
constexpr std::string_view kDisassembly = ".spvasm:";

/// What is to stay.
struct Wanted {
  std::string rule;
  std::string place;     ///< of the source; empty: any
  std::string function;  ///< that the place is in; empty: any
};

bool is_there(const Finding& finding, const Wanted& wanted) {
  const Frame place = finding.address.frames.empty() ? Frame{} : finding.address.frames.front();
  return finding.rule->id == wanted.rule && (wanted.place.empty() || to_text(place) == wanted.place) &&
         (wanted.function.empty() || place.function == wanted.function);
}

/// Replays candidates, as long as there are runs left.
class Candidates {
 public:
  Candidates(const ReduceOptions& options, Wanted wanted) : options_(options), wanted_(std::move(wanted)) {}

  bool still_found(const bug::Bug& bug) {
    if (runs_ >= options_.runs) return false;
    ++runs_;
    const TemporaryFolder folder;
    const std::string file = folder.path() / "candidate.vitrine";
    if (folder.path().empty() || !write_bug(file, bug)) return false;
    Environment environment{{"VITRINE_TOOLS", options_.tools}, {"VITRINE_REPORT", folder.path() / "%p.json"}};
    if (wanted_.rule == kLost) environment = {};
    const Ending ending = run_quietly({replayer(), file}, environment);
    if (wanted_.rule == kLost) return ending.error.empty() && ending.code == 0;
    for (const fs::path& path : folder.files(".json"))
      if (has_wanted(path)) return true;
    return false;
  }

  std::uint64_t runs() const { return runs_; }
  /// A shader becomes smaller.
  void let_lines_move() {
    if (wanted_.place.find(kDisassembly) != std::string::npos) wanted_.place.clear();
  }

 private:
  bool has_wanted(const fs::path& report) const {
    std::vector<Finding> findings;
    std::string error;
    const std::optional<std::string> text = read_file(report);
    if (!text || !read_findings(*text, findings, error)) return false;
    return std::any_of(findings.begin(), findings.end(), [&](const Finding& f) { return is_there(f, wanted_); });
  }

  const ReduceOptions& options_;
  Wanted wanted_;
  std::uint64_t runs_ = 0;
};

/// What was found and is to stay; says so if there is nothing.
std::optional<Wanted> choose(const bug::Bug& bug, const ReduceOptions& options) {
  const std::string& rule = options.rule;
  for (const bug::Found& found : bug.findings) {
    if (!rule.empty() && found.rule != rule) continue;
    return options.any_place ? Wanted{found.rule, {}, {}} : Wanted{found.rule, found.place, found.function};
  }
  if (!rule.empty()) return Wanted{rule, {}, {}};
  say("nothing was found in the command when it was captured: --rule says what is to stay");
  return std::nullopt;
}

void forget_results(bug::Bug& bug) {
  for (bug::Memory& memory : bug.memories)
    for (bug::Piece& piece : memory.pieces) piece.after = nullptr;
  for (bug::Image& image : bug.images)
    for (bug::Texels& texels : image.texels) texels.after = nullptr;
}

/// The stage by spirv-reduce, which asks this command about each candidate.
void reduce_stage(bug::Bug& bug, std::size_t number, const ReduceOptions& options, const std::string& rule) {
  const TemporaryFolder folder;
  const std::string base = folder.path() / "base.vitrine", from = folder.path() / "from.spv",
                    to = folder.path() / "to.spv";
  const bug::Blob& words = bug.stages[number].words;
  if (folder.path().empty() || !write_bug(base, bug)) return;
  if (!write_file(from, {reinterpret_cast<const char*>(words->data()), words->size()})) return;
  std::error_code error;
  const std::string self = fs::read_symlink("/proc/self/exe", error);
  std::vector<std::string> words_of_command{"spirv-reduce",
                                            "--step-limit=" + std::to_string(options.runs),
                                            "--temp-file-prefix=" + (folder.path() / "step").string(),
                                            from,
                                            "-o",
                                            to,
                                            "--",
                                            self,
                                            "reduce",
                                            base,
                                            "--rule",
                                            rule,
                                            "--tools",
                                            options.tools,
                                            "--stage",
                                            std::to_string(number)};
  if (options.any_place) words_of_command.emplace_back("--any-place");
  const Ending ending = run_quietly(words_of_command, {});
  if (ending.code == 127) say("shaders stay as they are: spirv-reduce (Debian package spirv-tools) is not there");
  const std::optional<std::string> reduced = read_file(to);
  if (!reduced || reduced->size() % 4 != 0 || reduced->size() >= words->size()) return;
  const auto* first = reinterpret_cast<const std::byte*>(reduced->data());
  bug.stages[number].words = std::make_shared<bug::Bytes>(first, first + reduced->size());
}

/// For spirv-reduce: 0 if it is still found with these words.
int try_stage(bug::Bug bug, const ReduceOptions& options, Candidates& candidates) {
  const std::optional<std::string> words = read_file(options.words);
  const std::size_t number = std::strtoul(options.stage.c_str(), nullptr, 10);
  if (!words || number >= bug.stages.size()) return kCouldNotRun;
  const auto* first = reinterpret_cast<const std::byte*>(words->data());
  bug.stages[number].words = std::make_shared<bug::Bytes>(first, first + words->size());
  candidates.let_lines_move();
  return candidates.still_found(bug) ? 0 : kFound;
}

std::uint64_t shader_bytes(const bug::Bug& bug) {
  std::uint64_t bytes = 0;
  for (const bug::Stage& stage : bug.stages) bytes += bug::size_of(stage.words);
  return bytes;
}

void reduce_all(bug::Bug& bug, const ReduceOptions& options, Candidates& candidates, const std::string& rule) {
  const StillFound still = [&](const bug::Bug& candidate) { return candidates.still_found(candidate); };
  for (const auto step : {reduce_invocations, reduce_descriptors, reduce_state, reduce_memory}) step(bug, still);
  if (!options.shaders) return;
  for (std::size_t i = 0; i < bug.stages.size(); ++i) reduce_stage(bug, i, options, rule);
}

/// Runs it once more, for what memory holds behind it.
bool write_with_results(const bug::Bug& bug, const std::string& output) {
  const TemporaryFolder folder;
  const std::string file = folder.path() / "reduced.vitrine";
  return !folder.path().empty() && write_bug(file, bug) && run_quietly({replayer(), file, output}, {}).code == 0;
}

}  // namespace

int reduce(const ReduceOptions& options) {
  std::optional<bug::Bug> bug = read_bug(options.file);
  const std::optional<Wanted> wanted = bug ? choose(*bug, options) : std::nullopt;
  if (!wanted) return kCouldNotRun;
  Candidates candidates(options, *wanted);
  forget_results(*bug);
  if (!options.stage.empty()) return try_stage(*bug, options, candidates);
  if (options.output.empty()) {
    say("nothing to write: --output says what");
    return kCouldNotRun;
  }
  if (!candidates.still_found(*bug)) {
    say("'" + wanted->rule + "' is not found where the command is replayed with " + options.tools);
    return kFound;
  }
  const std::uint64_t before = shader_bytes(*bug);
  std::error_code error;
  reduce_all(*bug, options, candidates, wanted->rule);
  if (!write_with_results(*bug, options.output)) {
    say("the reduced command cannot be replayed");
    return kCouldNotRun;
  }
  say("'" + wanted->rule + "' stays, after " + std::to_string(candidates.runs()) +
      " runs: " + std::to_string(fs::file_size(options.file, error)) + " bytes became " +
      std::to_string(fs::file_size(options.output, error)) + ", shaders of " + std::to_string(before) + " bytes " +
      std::to_string(shader_bytes(*bug)));
  return 0;
}

}  // namespace vitrine::glass::cli
