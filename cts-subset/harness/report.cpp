// Per-group totals, and the lines for the parent.
#include "harness/report.h"

#include <unistd.h>

#include <cstdio>
#include <cstdlib>

#include "harness/options.h"

namespace vitrine::cts {
namespace {

int g_parent = -1;

void print_row(const char* name, const GroupCounts& c) {
  std::printf("%-16s %6u cases  %6u identical  %4u listed deviation  %4u unsupported  %4u differing  %4u crashed", name,
              c.cases, c.identical, c.deviation, c.unsupported, c.differing, c.crashed);
  if (c.known) std::printf("  (%u known differences)", c.known);
  if (c.unrecorded) std::printf("  (%u without a record)", c.unrecorded);
  if (c.changed) std::printf("  (%u changed since they were recorded)", c.changed);
  if (c.nan_bits) std::printf("  (%u with other NaN bits)", c.nan_bits);
  if (c.blank) std::printf("  (%u blank)", c.blank);
  std::printf("\n");
}

}  // namespace

std::string command_of(const std::string& name) {
  std::string command = "cts_subset --seed=" + std::to_string(options().seed);
  if (options().count != 0) command += " --count=" + std::to_string(options().count);
  if (options().mutate) command += " --mutate";
  return command + " --gtest_filter='" + name + "'";
}

void set_parent(int pipe) { g_parent = pipe; }
bool has_parent() { return g_parent >= 0; }

void tell_parent(std::string line) {
  if (g_parent < 0) return;
  for (char& c : line)
    if (c == '\n') c = '\x1f';
  line += '\n';
  for (size_t sent = 0; sent < line.size();) {
    const ssize_t count = write(g_parent, line.data() + sent, line.size() - sent);
    if (count < 0) std::_Exit(3);
    sent += static_cast<size_t>(count);
  }
}

void count(Counts& counts, const std::string& group, const Judgement& judgement) {
  GroupCounts& row = counts[group];
  ++row.cases;
  row.identical += judgement.verdict == Verdict::kIdentical;
  row.deviation += judgement.verdict == Verdict::kDeviation;
  row.unsupported += judgement.verdict == Verdict::kUnsupported;
  row.known += judgement.verdict == Verdict::kKnown;
  row.differing += judgement.verdict == Verdict::kDiffering;
  row.crashed += judgement.verdict == Verdict::kCrashed;
  row.unrecorded += judgement.verdict == Verdict::kUnrecorded;
  row.changed += judgement.verdict == Verdict::kChanged;
  row.nan_bits += judgement.nan_bits;
  row.blank += judgement.blank;
}

bool print_counts(const Counts& counts) {
  GroupCounts total;
  for (const auto& [name, row] : counts) {
    print_row(name.c_str(), row);
    total.cases += row.cases;
    total.identical += row.identical;
    total.deviation += row.deviation;
    total.unsupported += row.unsupported;
    total.known += row.known;
    total.differing += row.differing;
    total.crashed += row.crashed;
    total.unrecorded += row.unrecorded;
    total.changed += row.changed;
    total.nan_bits += row.nan_bits;
    total.blank += row.blank;
  }
  print_row("total", total);
  std::fflush(stdout);
  return total.differing == 0 && total.crashed == 0 && total.unrecorded == 0 && total.changed == 0;
}

}  // namespace vitrine::cts
