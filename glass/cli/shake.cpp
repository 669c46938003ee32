// vitrine shake: runs an application with choices of the device that are legal but unkind. One run with a given seed;
// or several, until one leaves other bytes in memory than the usual order does: then says which command it was.
#include <cstdio>

#include "base/shake.h"
#include "glass/cli/application.h"
#include "glass/cli/commands.h"
#include "glass/cli/digests.h"
#include "glass/cli/files.h"
#include "glass/cli/findings.h"
#include "glass/cli/say.h"
#include "glass/report/report.h"

namespace vitrine::glass::cli {
namespace {

/// How the choices of a run are asked for; seed 0: the usual ones.
std::string list_of(const ShakeOptions& options, std::uint64_t seed) {
  std::string list = std::to_string(seed);
  if (!options.kinds.empty()) list += "," + options.kinds;
  return list;
}

bool demand_kinds(const std::string& kinds) {
  const base::ShakeSettings settings = base::parse_shake("1," + kinds);
  for (const std::string& word : settings.unknown)
    say("nothing to be shaken is called '" + word + "'; there are: " + base::names_of_shakes());
  return settings.unknown.empty();
}

/// A run with digests, those of each process in the folder. `more`: variables besides.
Ending run_digested(const ShakeOptions& options, std::uint64_t seed, const std::filesystem::path& folder,
                    Environment more = {}) {
  more.try_emplace("VITRINE_TOOLS", "digest");
  more["VITRINE_DIGEST"] = folder / "%p.jsonl";
  if (seed != 0) more["VITRINE_SHAKE"] = list_of(options, seed);
  return run_application(options.application, more);
}

/// The digests of the process that wrote most: applications have one that draws.
std::optional<Digests> digests_in(const TemporaryFolder& folder) {
  std::optional<Digests> longest;
  for (const std::filesystem::path& path : folder.files(".jsonl")) {
    const std::optional<std::string> text = read_file(path);
    std::optional<Digests> digests = text ? read_digests(*text) : std::nullopt;
    if (digests && (!longest || digests->size() > longest->size())) longest = std::move(digests);
  }
  return longest;
}

std::vector<Finding> findings_in(const TemporaryFolder& folder) {
  std::vector<Finding> findings;
  for (const std::filesystem::path& path : folder.files(".json")) {
    std::string error;
    if (const std::optional<std::string> text = read_file(path)) read_findings(*text, findings, error);
  }
  return findings;
}

/// One more run: which invocation writes that word last. Nothing: none that is seen does.
std::optional<Finding> last_writer(const ShakeOptions& options, std::uint64_t seed, const std::string& word) {
  const TemporaryFolder folder;
  run_digested(options, seed, folder.path(),
               {{"VITRINE_TOOLS", "digest,writers"},
                {"VITRINE_THREADS", "1"},
                {"VITRINE_DIGEST_AT", word},
                {"VITRINE_REPORT", folder.path() / "%p.json"}});
  std::vector<Finding> findings = findings_in(folder);
  if (findings.empty()) return std::nullopt;
  return std::move(findings.front());
}

/// Who wrote the word in either run; the finding's place becomes that of the shaken one.
void add_writers(const ShakeOptions& options, std::uint64_t seed, const std::string& word, Finding& finding) {
  const std::optional<Finding> here = last_writer(options, seed, word), there = last_writer(options, 0, word);
  if (!here || !there) return;
  const Address &a = here->address, &b = there->address;
  finding.message += "; written last by " + to_text(a.invocation) + " here, by " + to_text(b.invocation) + " there";
  if (!a.frames.empty() && !b.frames.empty() && to_text(a.frames.front()) != to_text(b.frames.front()))
    finding.message += ", at " + to_text(b.frames.front());
  if (a.invocation == b.invocation) finding.message += ": it has read other values";
  finding.address = a;
}

/// Two more runs up to where memory parts: the second one says what the first byte is that differs.
std::vector<Finding> find_byte(const ShakeOptions& options, std::uint64_t seed, const Parting& parting) {
  const TemporaryFolder usual, shaken;
  const std::string at = std::to_string(parting.point.submission) + ":" + std::to_string(parting.point.command) + ":" +
                         std::to_string(parting.allocation);
  const std::string saved = usual.path() / "memory";
  run_digested(options, 0, usual.path(), {{"VITRINE_DIGEST_AT", at}, {"VITRINE_DIGEST_SAVE", saved}});
  run_digested(
      options, seed, shaken.path(),
      {{"VITRINE_DIGEST_AT", at}, {"VITRINE_DIGEST_COMPARE", saved}, {"VITRINE_REPORT", shaken.path() / "%p.json"}});
  std::vector<Finding> findings = findings_in(shaken);
  const std::optional<Digests> digests = digests_in(shaken);
  if (findings.size() != 1 || !digests) return findings;
  for (const DigestLine& line : *digests)
    if (line.differs) add_writers(options, seed, at + ":" + std::to_string(*line.differs), findings.front());
  return findings;
}

/// What is said of two runs that part.
std::vector<Finding> explain(const ShakeOptions& options, std::uint64_t seed, const Parting& parting) {
  if (parting.point.command == 0) {
    say("what the application itself wrote differs before submission " + std::to_string(parting.point.submission) +
        ": it is not the same from run to run, or reads memory before the device is done with it");
    return {};
  }
  std::vector<Finding> findings = find_byte(options, seed, parting);
  if (!findings.empty()) return findings;
  Finding finding;
  finding.rule = &rule("order-dependent");
  finding.message = "another order of invocations leaves other bytes in allocation " +
                    std::to_string(parting.allocation) + " of device memory";
  finding.address.submission = parting.point.submission;
  finding.address.command = parting.point.command;
  finding.address.command_name = parting.point.name;
  finding.address.labels = parting.point.labels;
  finding.address.pipeline = parting.point.pipeline;
  return {finding};
}

int run_one(const ShakeOptions& options) {
  say("seed " + std::to_string(*options.seed));
  const Ending ending = run_application(options.application, {{"VITRINE_SHAKE", list_of(options, *options.seed)}});
  return ending.error.empty() ? ending.code : kCouldNotRun;
}

int compare_runs(const ShakeOptions& options) {
  const TemporaryFolder usual;
  if (usual.path().empty()) return kCouldNotRun;
  Ending ending = run_digested(options, 0, usual.path());
  if (!ending.error.empty()) return kCouldNotRun;
  const std::optional<Digests> before = digests_in(usual);
  if (!before) {
    say("nothing was compared: no process of the application used this driver");
    return kCouldNotRun;
  }
  if (ending.code != 0) return ending.code;
  for (std::uint64_t seed = 1; seed <= options.runs; ++seed) {
    const TemporaryFolder shaken;
    ending = run_digested(options, seed, shaken.path());
    if (!ending.error.empty()) return kCouldNotRun;
    const std::optional<Digests> after = digests_in(shaken);
    const std::optional<Parting> parting = after ? first_parting(*before, *after) : std::nullopt;
    if (!parting && ending.code == 0) continue;
    say("seed " + std::to_string(seed) + ": " +
        (parting ? "memory differs from the run in the usual order" : "the application failed"));
    if (!parting) return ending.code;
    const std::vector<Finding> findings = explain(options, seed, *parting);
    std::fputs(to_report(ReportFormat::kText, findings).c_str(), stderr);
    return write_reports({options.sarif, options.json, {}}, findings) ? kFound : kCouldNotRun;
  }
  say("the same bytes after each of " + std::to_string(before->size()) + " commands, with " +
      std::to_string(options.runs) + " seeds");
  return write_reports({options.sarif, options.json, {}}, {}) ? 0 : kCouldNotRun;
}

}  // namespace

int shake(const ShakeOptions& options) {
  if (!demand_kinds(options.kinds)) return kCouldNotRun;
  if (options.seed) return run_one(options);
  if (base::parse_shake("1," + options.kinds).has(base::ShakeKind::kPoison) && !options.kinds.empty()) {
    say("memory that holds noise is never the same: poison goes with --seed alone");
    return kCouldNotRun;
  }
  ShakeOptions compared = options;
  if (compared.kinds.empty()) compared.kinds = "order";
  return compare_runs(compared);
}

}  // namespace vitrine::glass::cli
