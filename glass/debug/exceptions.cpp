// See exceptions.h.
#include "glass/debug/exceptions.h"

#include <algorithm>
#include <cmath>

#include "glass/format.h"
#include "glass/sanitize/operands.h"
#include "spirv/exec/observe.h"

namespace vitrine::glass::debug {
namespace {

using sanitize::Number;
using spirv::Probe;
using spirv::ProbeOp;
using spirv::ProbeValue;

struct Row {
  const char* name;
  unsigned bit;
};
constexpr Row kRows[] = {{"printf", kCatchPrintf}, {"nan", kCatchNan}, {"finding", kCatchFinding}};

bool is_caught(const Probe& probe, unsigned catches) {
  if (probe.kind == Probe::Kind::kPrintf) return (catches & kCatchPrintf) != 0;
  return (catches & kCatchNan) != 0 && probe.kind == Probe::Kind::kOperation && probe.has_result &&
         probe.values.back().type == 'F';
}

bool is_nan(const spirv::Wave& wave, const ProbeOp& op, const ProbeValue& value, std::size_t lane) {
  for (std::uint32_t c = 0; value.type == 'F' && c < value.components; ++c)
    if (std::isnan(Number(wave, op, value, c).as_float(lane))) return true;
  return false;
}

/// Whether the result is a NaN and no operand is.
bool makes_nan(const Probe& probe, const spirv::Wave& wave, const ProbeOp& op, std::size_t lane) {
  if (!is_nan(wave, op, probe.values.back(), lane)) return false;
  return std::none_of(probe.values.begin(), probe.values.end() - 1,
                      [&](const ProbeValue& value) { return is_nan(wave, op, value, lane); });
}

std::string nan_text(const Probe& probe, const spirv::Wave& wave, const ProbeOp& op, std::size_t lane) {
  std::string text;
  for (auto value = probe.values.begin(); value + 1 != probe.values.end(); ++value)
    for (std::uint32_t c = 0; c < value->components; ++c)
      text.append(text.empty() ? "nan: NaN made of " : ", ").append(Number(wave, op, *value, c).text(lane));
  return text;
}

std::string printf_text(const Probe& probe, const spirv::Wave& wave, const ProbeOp& op, std::size_t lane) {
  std::vector<std::uint32_t> words;
  for (const spirv::OperandPlace place : op.operands) words.push_back(spirv::exec::word_of(wave, place, lane));
  std::string text = "printf: ";
  return text += format_text(probe.format, probe.values, words);
}

}  // namespace

unsigned catch_of(std::string_view name) {
  if (name == "findings") return kCatchFinding;
  for (const Row& row : kRows)
    if (name == row.name) return row.bit;
  return 0;
}

std::string catches_text(unsigned catches) {
  std::string text;
  for (const Row& row : kRows)
    if ((catches & row.bit) != 0) text.append(text.empty() ? "" : ", ").append(row.name);
  return text;
}

std::string finding_text(const Finding& finding) {
  std::string text = "finding: ";
  text.append(severity_name(finding.rule->severity)).append(": ").append(finding.message);
  text.append(" [vitrine/").append(finding.rule->id).append("]");
  for (const RelatedAccess& other : finding.related) {
    text.append("\n  ").append(other.message);
    if (!other.address.frames.empty()) text.append(" at ").append(to_text(other.address.frames[0]));
  }
  if (!finding.remedy.empty()) text.append("\n  missing: ").append(finding.remedy);
  return text;
}

bool may_raise(const Subject& subject, unsigned catches) {
  return catches != 0 &&
         std::ranges::any_of(subject.probes, [&](const Probe& probe) { return is_caught(probe, catches); });
}

std::optional<Raised> raised_at(const Probe& probe, const spirv::Wave& wave, const ProbeOp& op, base::LaneMask lanes,
                                std::size_t preferred, unsigned catches) {
  if (!is_caught(probe, catches)) return std::nullopt;
  const bool speaks = probe.kind == Probe::Kind::kPrintf;
  std::optional<std::size_t> found;
  base::for_each_lane(lanes, [&](std::size_t lane) {
    if ((found && lane != preferred) || !(speaks || makes_nan(probe, wave, op, lane))) return;
    found = lane;
  });
  if (!found) return std::nullopt;
  return Raised{*found, speaks ? printf_text(probe, wave, op, *found) : nan_text(probe, wave, op, *found)};
}

}  // namespace vitrine::glass::debug
