// Judges cases by the record of the reference, and collects such records.
#include "harness/recorded.h"
#include "harness/reference.h"

#include <glslang/Public/ShaderLang.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <set>
#include <stdexcept>

#include "cts-subset/revision.h"
#include "harness/claims.h"
#include "harness/options.h"
#include "harness/report.h"

namespace vitrine::cts {
namespace {

std::vector<std::string> g_kept;

std::string compiler() {
  const glslang::Version version = glslang::GetVersion();
  return "glslang " + std::to_string(version.major) + "." + std::to_string(version.minor) + "." +
         std::to_string(version.patch);
}

uint32_t source_hash(const std::string& file) {
  for (const SourceFile& source : kSourceFiles)
    if (file == source.path) return source.hash;
  return 0;
}

std::string how_to_record(const Case& c) {
  return "  to record it, with " + recorded_reference()->driver + " installed: cts_subset --record --gtest_filter='" +
         full_name(c) + "'\n";
}

/// Why a result that is not the recorded one may be right, and what to do without the reference's picture.
std::string what_to_do(const Case& c, const SideResult& device, const RecordedCase& recorded) {
  std::string text;
  const auto source = recorded_reference()->sources.find(c.file);
  if (source == recorded_reference()->sources.end() || source->second != source_hash(c.file))
    text += "  " + c.file + " has changed since it was recorded: the case may have become another\n" + how_to_record(c);
  if (device.modules != recorded.modules)
    text += "  " + compiler() + " makes other modules of its shaders than " + recorded_reference()->compiler +
            " did when it was recorded\n";
  return text + "  the reference's own result is not in the record; to see it, install " +
         recorded_reference()->driver + " and run the case with --reference=MANIFEST\n";
}

/// Whether the recorded compiler itself makes another module of the same text: it computes what has no result (an
/// integer of NaN) as the CPU does that it runs on.
bool folds_otherwise(const SideResult& device, const RecordedCase& recorded) {
  return device.modules != recorded.modules && compiler() == recorded_reference()->compiler;
}

/// The outputs of a deviation's case: the device's own in all but their bytes.
std::vector<Output> recorded_outputs(const SideResult& device, const RecordedCase& recorded) {
  std::vector<Output> outputs = device.outputs;
  for (size_t i = 0; i < outputs.size(); ++i) outputs[i].bytes = recorded.outputs[i].bytes;
  return outputs;
}

void compare_output(const Case& c, const Output& output, const RecordedOutput& recorded, Judgement& judgement) {
  const RecordedOutput found = record_output(output, false);
  if (found.hash == recorded.hash) {
    judgement.nan_bits |= found.raw != recorded.raw;
    if (options().pictures) write_png(result_path(c, output.name) + ".device.png", output);
    if (output.may_be_blank || recorded.has_deviation || !is_blank(output)) return;
    judgement.message += "  " + output.name + ": the reference's output is blank, so the case tests nothing\n";
  } else if (recorded.has_deviation && !is_asked(output.deviation)) {
    judgement.verdict = Verdict::kDeviation;
    return;
  } else {
    const std::string picture = result_path(c, output.name) + ".device.png";
    write_png(picture, output);
    judgement.message += "  " + output.name + " (" + output.format.name + " " + std::to_string(output.width) + "x" +
                         std::to_string(output.height) + ") is not as recorded; the device's picture: " + picture +
                         "\n";
  }
}

void compare_outputs(const Case& c, const SideResult& device, const RecordedCase& recorded, Judgement& judgement) {
  if (device.outputs.size() != recorded.outputs.size()) {
    judgement.message = "  " + std::to_string(device.outputs.size()) + " outputs, recorded are " +
                        std::to_string(recorded.outputs.size()) + "\n";
  } else if (is_asked(c.deviation)) {
    const std::vector<Output> wanted = recorded_outputs(device, recorded);
    for (size_t i = 0; i < wanted.size(); ++i)
      if (const Comparison found = compare(device.outputs[i], wanted[i]); !found.first.empty())
        judgement.message += "  " + found.first + "\n";
  } else if (!c.deviation.empty()) {
    const std::string wrong = c.check(device.outputs, recorded_outputs(device, recorded));
    judgement.verdict = Verdict::kDeviation;
    if (!wrong.empty()) judgement.message = "  deviation " + c.deviation + " is not as listed: " + wrong + "\n";
  } else {
    judgement.blank = recorded.blank;
    for (size_t i = 0; i < device.outputs.size(); ++i)
      compare_output(c, device.outputs[i], recorded.outputs[i], judgement);
    if (device.outputs.empty()) judgement.message = "  the case put nothing out\n";
  }
  if (judgement.message.empty()) return;
  judgement.verdict = Verdict::kDiffering;
  judgement.message += what_to_do(c, device, recorded);
  write_notes(c, device);
}

Judgement verdict_of(Verdict verdict, const std::string& message) {
  Judgement judgement;
  judgement.verdict = verdict;
  judgement.message = message;
  return judgement;
}

/// `recorded`: null for a case without a record.
Judgement judge(const Case& c, const SideResult& device, const RecordedCase* recorded) {
  if (!device.unsupported.empty()) return verdict_of(Verdict::kUnsupported, "  " + device.unsupported + "\n");
  if (recorded && recorded->unsupported)
    return verdict_of(Verdict::kUnsupported, "  " + recorded_reference()->driver + " lacks what it needs\n");
  if (refused(device)) return verdict_of(Verdict::kUnsupported, "  " + device.validation.front() + "\n");
  std::string errors = device.error.empty() ? "" : "  device: " + device.error + "\n";
  for (const std::string& text : device.validation) errors += "  device: validation: " + text + "\n";
  if (!errors.empty()) return verdict_of(Verdict::kDiffering, errors);
  if (!recorded)
    return verdict_of(Verdict::kUnrecorded,
                      "  " + options().recorded + " has no result of the case\n" + how_to_record(c));
  if (device.inputs != recorded->inputs)
    return verdict_of(
        Verdict::kChanged,
        "  it gives the device something else than when it was recorded: it is another case now\n" + how_to_record(c));
  Judgement judgement;
  compare_outputs(c, device, *recorded, judgement);
  if (judgement.verdict == Verdict::kDiffering && folds_otherwise(device, *recorded))
    return verdict_of(Verdict::kUnsupported,
                      "  " + compiler() + " folds constants of its shaders otherwise on this CPU than where it " +
                          "was recorded: nothing is known of the modules that it makes here\n");
  return judgement;
}

/// What a record says of itself. Of a part of the cases: the rest stays as the file has it.
Record new_record(bool part) {
  Record record;
  record.driver = driver_info(gpus().reference);
  record.device = gpus().reference.name;
  record.compiler = compiler();
  record.seed = options().seed;
  record.revision = kRevision;
  record.float_to_uint = reference_cpu().float_to_uint;
  record.srgb_hash = reference_cpu().srgb_hash;
  record.rsqrt_hash = rsqrt_hash();
  record.claims = claims_of(gpus().reference);
  if (!part) return record;
  Record old = read_record(options().record);
  if (old.driver != record.driver || old.seed != record.seed || old.float_to_uint != record.float_to_uint ||
      old.srgb_hash != record.srgb_hash || old.compiler != record.compiler || old.claims != record.claims)
    throw std::runtime_error(options().record + " was recorded with " + old.driver + ", " + old.compiler + ", seed " +
                             std::to_string(old.seed) + " or on another kind of CPU: record all cases anew");
  return old;
}

}  // namespace

Judgement judge_by_record(const Case& c) {
  tell_parent("D");
  const SideResult device = run_side(gpus().device, c, 0);
  const auto line = recorded_reference()->cases.find(full_name(c));
  if (line == recorded_reference()->cases.end()) return judge(c, device, nullptr);
  const RecordedCase recorded = parse_case_line(line->second);
  return judge(c, device, &recorded);
}

void record_case(const Case& c, const SideResult& device, const SideResult& reference) {
  if (!reference.error.empty() || !reference.validation.empty()) return;
  RecordedCase recorded;
  recorded.unsupported = !reference.unsupported.empty();
  recorded.blank = all_blank(reference.outputs);
  recorded.inputs = device.inputs;
  recorded.modules = device.modules;
  if (!recorded.unsupported)
    for (const Output& output : reference.outputs)
      recorded.outputs.push_back(record_output(output, !c.deviation.empty()));
  const std::string line = c.file + " " + full_name(c) + " " + case_line(recorded);
  if (has_parent())
    tell_parent("L " + line);
  else
    keep_recorded_line(line);
}

void keep_recorded_line(const std::string& line) { g_kept.push_back(line); }

void write_recorded_reference() {
  if (options().record.empty()) return;
  const bool part = GTEST_FLAG_GET(filter) != "*" && std::filesystem::exists(options().record);
  Record record = new_record(part);
  for (const std::string& line : g_kept) {
    const size_t file_end = line.find(' '), name_end = line.find(' ', file_end + 1);
    const std::string file = line.substr(0, file_end);
    record.sources[file] = source_hash(file);
    record.cases[line.substr(file_end + 1, name_end - file_end - 1)] = line.substr(name_end + 1);
  }
  write_record(options().record, record);
  std::printf("recorded: %zu of %zu cases in %s, by %s\n", g_kept.size(), record.cases.size(), options().record.c_str(),
              record.driver.c_str());
}

}  // namespace vitrine::cts
