// Runs a case on the device and on the reference, compares, and writes pictures when they differ.
#include "harness/execute.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <set>
#include <sstream>
#include <string_view>

#include "base/as_reference.h"
#include "harness/findings.h"
#include "harness/options.h"
#include "harness/random.h"
#include "harness/recorded.h"
#include "harness/reference.h"
#include "harness/report.h"
#include "harness/side.h"

namespace vitrine::cts {
namespace {

std::set<std::string> g_known;

/// How often a random case that draws nothing is run, each time with another seed: in sweeps; the default run stays
/// short.
uint32_t attempts() { return options().count ? 8 : 1; }

/// Only the names of generators' cases have a number behind a slash.
bool is_random(const Case& c) { return c.name.find('/') != std::string::npos; }

std::string write_pictures(const Case& c, const Output& device, const Output& reference) {
  const std::string path = result_path(c, reference.name);
  write_png(path + ".device.png", device);
  write_png(path + ".reference.png", reference);
  write_difference_png(path + ".difference.png", device, reference);
  return "  pictures: " + path + ".*.png\n";
}

/// Compares all outputs; fills the message with the first difference of each.
bool compare_all(const Case& c, const SideResult& device, const SideResult& reference, Judgement& judgement) {
  bool same = device.outputs.size() == reference.outputs.size();
  if (!same) judgement.message += "  different number of outputs\n";
  for (size_t i = 0; i < std::min(device.outputs.size(), reference.outputs.size()); ++i) {
    const Comparison found = compare(device.outputs[i], reference.outputs[i]);
    judgement.nan_bits |= found.nan_bits != 0;
    if (options().pictures) write_pictures(c, device.outputs[i], reference.outputs[i]);
    if (found.first.empty()) continue;
    if (const std::string& rows = reference.outputs[i].deviation; !rows.empty() && !is_asked(rows)) {
      judgement.verdict = Verdict::kDeviation;
      continue;
    }
    same = false;
    judgement.message += "  " + found.first + "\n" + write_pictures(c, device.outputs[i], reference.outputs[i]);
  }
  return same;
}

/// A reference that drew nothing proves nothing.
void check_blank(const std::vector<Output>& outputs, Judgement& judgement) {
  if (options().mutate) return;
  for (const Output& output : outputs) {
    if (output.may_be_blank || !is_blank(output)) continue;
    judgement.verdict = Verdict::kDiffering;
    judgement.message += "  " + output.name + ": the reference's output is blank, so the case tests nothing\n";
  }
  judgement.blank = all_blank(outputs);
  if (outputs.empty()) {
    judgement.verdict = Verdict::kDiffering;
    judgement.message += "  the case put nothing out\n";
  }
}

/// `again`: the case drew nothing and is to be run with another seed.
void judge_outputs(const Case& c, const SideResult& device, const SideResult& reference, bool again,
                   Judgement& judgement) {
  if (is_asked(c.deviation)) {
    if (!compare_all(c, device, reference, judgement)) judgement.verdict = Verdict::kDiffering;
    return;
  }
  if (c.deviation.empty()) {
    if (!compare_all(c, device, reference, judgement)) judgement.verdict = Verdict::kDiffering;
    if (!again) check_blank(reference.outputs, judgement);
    return;
  }
  const std::string wrong = c.check(device.outputs, reference.outputs);
  // With the reference on both sides its fault must show, and the "device" must be what is wrong.
  if (gpus().same_driver && wrong.starts_with("the device")) return;
  judgement.verdict = wrong.empty() ? Verdict::kDeviation : Verdict::kDiffering;
  if (!wrong.empty()) judgement.message += "  deviation " + c.deviation + " is not as listed: " + wrong + "\n";
}

Judgement judge(const Case& c, uint32_t attempt, bool& again) {
  Judgement judgement;
  if (attempt != 0) tell_parent("R");
  const SideResult reference = run_side(gpus().reference, c, attempt);
  tell_parent("D");
  const SideResult device = run_side(gpus().device, c, attempt);
  if (!options().record.empty()) record_case(c, device, reference);
  again = is_random(c) && attempt + 1 < attempts() && all_blank(reference.outputs);
  if (!reference.unsupported.empty() || !device.unsupported.empty()) {
    judgement.verdict = Verdict::kUnsupported;
    judgement.message = "  " + (device.unsupported.empty() ? reference.unsupported : device.unsupported) + "\n";
    return judgement;
  }
  if (device.lost && options().mutate) {
    judgement.verdict = Verdict::kUnsupported;
    judgement.message = "  a loop without an end\n";
    return judgement;
  }
  if (options().mutate && reference.error.empty() && device.error.empty() && reference.notes != device.notes) {
    judgement.verdict = Verdict::kUnsupported;
    judgement.message = "  the two devices are given different shaders, and so different mutants\n";
    return judgement;
  }
  if (reference.error.empty() && reference.validation.empty() && refused(device)) {
    judgement.verdict = Verdict::kUnsupported;
    judgement.message = "  " + device.validation.front() + "\n";
    return judgement;
  }
  for (const auto* side : {&device, &reference}) {
    const char* name = side == &device ? "device" : "reference";
    if (!side->error.empty()) judgement.message += std::string("  ") + name + ": " + side->error + "\n";
    for (const std::string& text : side->validation)
      judgement.message += std::string("  ") + name + ": validation: " + text + "\n";
  }
  if (judgement.message.empty())
    judge_outputs(c, device, reference, again, judgement);
  else
    judgement.verdict = Verdict::kDiffering;
  if (judgement.verdict == Verdict::kDiffering) write_notes(c, reference);
  return judgement;
}

/// Appends "name hash" of what the device puts out, every bit of it (those of NaNs too).
Judgement record_fingerprint(const Case& c) {
  uint64_t hash = 0;
  SideResult device;
  for (uint32_t attempt = 0; attempt < attempts(); ++attempt) {
    device = run_side(gpus().device, c, attempt);
    for (const Output& output : device.outputs) {
      const char* bytes = reinterpret_cast<const char*>(output.bytes.data());
      hash = hash_name(std::string_view(bytes, output.bytes.size()), hash);
    }
    if (!is_random(c) || !all_blank(device.outputs)) break;
  }
  char line[32];
  std::snprintf(line, sizeof(line), " %016llx\n", static_cast<unsigned long long>(hash));
  std::ofstream(options().fingerprints, std::ios::app) << full_name(c) + line << std::flush;
  Judgement judgement;
  if (!device.unsupported.empty()) judgement.verdict = Verdict::kUnsupported;
  return judgement;
}

Judgement judge_outputs_of(const Case& c) {
  if (!options().fingerprints.empty()) return record_fingerprint(c);
  Judgement judgement;
  if (recorded_reference()) judgement = judge_by_record(c);
  bool again = !recorded_reference();
  for (uint32_t attempt = 0; again && judgement.verdict == Verdict::kIdentical; ++attempt)
    judgement = judge(c, attempt, again);
  const bool known = g_known.contains(full_name(c));
  if (known && judgement.verdict == Verdict::kDiffering) judgement.verdict = Verdict::kKnown;
  return judgement;
}

}  // namespace

std::string full_name(const Case& c) { return c.group + "." + c.name; }

uint64_t case_seed(const Case& c) { return hash_name(full_name(c), options().seed); }

bool is_asked(const std::string& rows) {
  bool asked = !rows.empty();
  std::istringstream words(rows);
  for (std::string row; words >> row;) asked &= base::asked_rows().has(row);
  return asked;
}

void load_lists() {
  load_expected_findings();
  if (options().known.empty()) return;
  std::ifstream file(options().known);
  if (!file) throw std::runtime_error("cannot read " + options().known);
  for (std::string line; std::getline(file, line);)
    if (!line.empty() && line[0] != '#') g_known.insert(line.substr(0, line.find(' ')));
}

Judgement execute(const Case& c) {
  take_findings();
  Judgement judgement = judge_outputs_of(c);
  const std::string wrong = unexpected_findings(full_name(c), take_findings());
  if (wrong.empty()) return judgement;
  judgement.verdict = Verdict::kDiffering;
  judgement.message += wrong;
  return judgement;
}

}  // namespace vitrine::cts
