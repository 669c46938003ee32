// See run.h. Words of an entry: of a step, the probe by lane; of an assignment, by lane the first cell if its indices
// are not constant, then by cell the mask of lanes that have a value, and the values by lane; of stores, the place and
// the number of parts, then by part the address (low, high), the number of bytes and the bytes.
#include "glass/debug/run.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "spirv/exec/invocation.h"
#include "spirv/exec/observe.h"

namespace vitrine::glass::debug {
namespace {

std::size_t count_of(base::LaneMask lanes) { return static_cast<std::size_t>(__builtin_popcountll(lanes)); }

/// Whether two places are on one line of one function instance.
bool same_line(const spirv::SourcePlace& a, const spirv::SourcePlace& b) {
  return a.file == b.file && a.line == b.line && a.scope == b.scope;
}

std::string describe(const spirv::ObservedCommand* command) {
  if (command == nullptr || command->submission == 0) return {};
  std::string text = "submission " + std::to_string(command->submission) + ", command " +
                     std::to_string(command->command) + " (" + command->name + ")";
  for (const std::string& label : command->labels) text.append(" in '").append(label).append("'");
  return text;
}

}  // namespace

std::uint32_t Subject::depth(std::uint32_t probe) const {
  const spirv::SourceInfo& sources = *context.sources;
  std::uint32_t depth = 0;
  for (std::uint32_t at = probes[probe].place; at != 0 && depth < 1000; ++depth)
    at = sources.scopes[sources.place(at).scope].call;
  return depth;
}

Run::Run(std::shared_ptr<const Subject> of, const spirv::Wave& wave)
    : subject(std::move(of)),
      launched(wave.launched),
      helpers(wave.launched & ~wave.live),
      local_size{wave.program->local_size[0], wave.program->local_size[1], wave.program->local_size[2]},
      serial(wave.resources->serial),
      where(describe(wave.resources->command)),
      resources(wave.resources),
      shared(wave.shared),
      shared_size(wave.shared_size),
      cells_(subject->variables->cells),
      known_(subject->variables->cells, 0) {
  at_.fill(kNoProbe);
  const spirv::exec::Invocations invocations(wave);
  base::for_each_lane(launched, [&](std::size_t lane) { id[lane] = invocations(wave, lane); });
  if (wave.resources->command == nullptr) return;
  submission = wave.resources->command->submission;
  command = wave.resources->command->command;
}

std::uint32_t Run::cell_of(const spirv::Wave& wave, const spirv::ProbeOp& op, std::size_t lane) const {
  const spirv::Probe& probe = subject->probes[op.probe];
  std::uint32_t cell = probe.first_cell;
  for (std::size_t i = 0; i < probe.steps.size(); ++i) {
    // lavapipe-shader-math.md 10: clamped to the last element.
    const std::uint32_t index = spirv::exec::word_of(wave, op.operands[i], lane);
    cell += probe.steps[i][0] * std::min(index, std::max(probe.steps[i][1], 1u) - 1);
  }
  return cell;
}

void Run::record(const spirv::Wave& wave, const spirv::ProbeOp& op, base::LaneMask lanes) {
  const spirv::Probe& probe = subject->probes[op.probe];
  const Entry entry{op.probe, lanes, words_.size()};
  if (probe.kind == spirv::Probe::Kind::kStep) {
    words_.insert(words_.end(), count_of(lanes), op.probe);
  } else {
    const bool indexed = !probe.steps.empty();
    if (indexed) base::for_each_lane(lanes, [&](std::size_t lane) { words_.push_back(cell_of(wave, op, lane)); });
    for (std::uint32_t i = 0; i < probe.cells; ++i) {
      if (!indexed) {
        const base::LaneMask known = known_[probe.first_cell + i] | lanes;
        words_.push_back(static_cast<std::uint32_t>(known));
        words_.push_back(static_cast<std::uint32_t>(known >> 32));
      }
      base::for_each_lane(lanes, [&](std::size_t lane) {
        if (indexed) words_.push_back(1);
        words_.push_back(spirv::exec::word_of(wave, op.operands[probe.steps.size() + i], lane));
      });
    }
  }
  entries_.push_back(entry);
  exchange_values(entry);
}

void Run::begin_stores(std::uint32_t place) {
  entries_.push_back({kStores, 0, words_.size()});
  words_.insert(words_.end(), {place, 0});
}

void Run::add_store(std::byte* at, std::uint32_t bytes) { add_store(at, bytes, at); }

void Run::add_store(std::byte* at, std::uint32_t bytes, const std::byte* before) {
  const auto address = reinterpret_cast<std::uintptr_t>(at);
  ++words_[entries_.back().first + 1];
  words_.insert(words_.end(), {static_cast<std::uint32_t>(address), static_cast<std::uint32_t>(address >> 32), bytes});
  const std::size_t first = words_.size();
  words_.resize(first + (bytes + 3) / 4);
  std::memcpy(&words_[first], before, bytes);
}

/// What has been freed is not written: while a submission runs, all that it uses is there (Vulkan 1.3.239, Object
/// Lifetime); memory of workgroups is that of the one that runs.
bool Run::has_memory(const std::byte* at, const Run& live) const {
  if (submission != live.submission || (submission == 0 && serial != live.serial)) return false;
  if (shared == nullptr || at < shared || at >= shared + shared_size) return true;
  return serial == live.serial && shared == live.shared;
}

/// Parts may overlap: what was written last is taken back first.
void Run::exchange_stores(const Entry& entry, bool back, const Run& live) {
  std::size_t word = entry.first + 2;
  std::vector<std::size_t> parts;
  for (std::uint32_t part = 0; part < words_[entry.first + 1]; ++part) {
    parts.push_back(word);
    word += 3 + (words_[word + 2] + 3) / 4;
  }
  if (back) std::ranges::reverse(parts);
  for (const std::size_t at : parts) {
    auto* const data =
        reinterpret_cast<std::byte*>(static_cast<std::uintptr_t>(std::uint64_t{words_[at + 1]} << 32 | words_[at]));
    auto* const kept = reinterpret_cast<std::byte*>(&words_[at + 3]);
    if (has_memory(data, live)) std::swap_ranges(kept, kept + words_[at + 2], data);
  }
}

void Run::exchange(const Entry& entry, bool back, const Run& live) {
  entry.probe == kStores ? exchange_stores(entry, back, live) : exchange_values(entry);
}

void Run::exchange_cell(std::uint32_t cell, base::LaneMask lanes, std::size_t& word) {
  const base::LaneMask known = words_[word] | base::LaneMask{words_[word + 1]} << 32;
  const base::LaneMask before = std::exchange(known_[cell], known);
  words_[word++] = static_cast<std::uint32_t>(before);
  words_[word++] = static_cast<std::uint32_t>(before >> 32);
  base::for_each_lane(lanes, [&](std::size_t lane) { std::swap(cells_[cell].lane[lane], words_[word++]); });
}

void Run::exchange_values(const Entry& entry) {
  const spirv::Probe& probe = subject->probes[entry.probe];
  std::size_t word = entry.first;
  if (probe.kind == spirv::Probe::Kind::kStep)
    return base::for_each_lane(entry.lanes, [&](std::size_t lane) { std::swap(at_[lane], words_[word++]); });
  if (probe.steps.empty()) {
    for (std::uint32_t i = 0; i < probe.cells; ++i) exchange_cell(probe.first_cell + i, entry.lanes, word);
    return;
  }
  const std::size_t cells = word;
  word += count_of(entry.lanes);
  for (std::uint32_t i = 0; i < probe.cells; ++i) {
    std::size_t n = 0;
    base::for_each_lane(entry.lanes, [&](std::size_t lane) {
      const std::uint32_t cell = words_[cells + n++] + i;
      const base::LaneMask bit = base::LaneMask{1} << lane;
      const bool before = (known_[cell] & bit) != 0;
      known_[cell] = words_[word] != 0 ? known_[cell] | bit : known_[cell] & ~bit;
      words_[word++] = before ? 1 : 0;
      std::swap(cells_[cell].lane[lane], words_[word++]);
    });
  }
}

base::LaneMask Run::fresh_lanes(const Entry& entry) const {
  const spirv::SourcePlace& place = subject->place(entry.probe);
  base::LaneMask fresh = 0;
  std::size_t word = entry.first;
  base::for_each_lane(entry.lanes, [&](std::size_t lane) {
    const std::uint32_t before = words_[word++];
    if (before == kNoProbe || !same_line(subject->place(before), place)) fresh |= base::LaneMask{1} << lane;
  });
  return fresh;
}

bool Run::is_first(const Entry& entry, std::size_t lane) const {
  return words_[entry.first + count_of(entry.lanes & ((base::LaneMask{1} << lane) - 1))] == kNoProbe;
}

bool Run::assigns(const Entry& entry, std::size_t lane, std::uint32_t cell, std::uint32_t count, bool any) const {
  if (entry.probe == kStores) return false;
  const spirv::Probe& probe = subject->probes[entry.probe];
  if (probe.kind != spirv::Probe::Kind::kAssign || (entry.lanes >> lane & 1) == 0) return false;
  const std::size_t lanes = count_of(entry.lanes), n = count_of(entry.lanes & ((base::LaneMask{1} << lane) - 1));
  const bool indexed = !probe.steps.empty();
  const std::uint32_t first = indexed ? words_[entry.first + n] : probe.first_cell;
  for (std::uint32_t i = 0; i < probe.cells; ++i) {
    if (first + i < cell || first + i >= cell + count) continue;
    if (any) return true;
    std::size_t before = 0;
    bool was_known = false;
    if (indexed) {
      before = entry.first + lanes + (i * lanes + n) * 2 + 1;
      was_known = words_[before - 1] != 0;
    } else {
      const std::size_t mask = entry.first + i * (lanes + 2);
      before = mask + 2 + n;
      was_known = ((words_[mask] | base::LaneMask{words_[mask + 1]} << 32) >> lane & 1) != 0;
    }
    if (!was_known || words_[before] != word(first + i, lane)) return true;
  }
  return false;
}

std::size_t Run::bytes() const {
  return sizeof(*this) + cells_.size() * (sizeof(base::WaveRegister) + sizeof(base::LaneMask)) +
         entries_.capacity() * sizeof(Entry) + words_.capacity() * sizeof(std::uint32_t);
}

void Run::forget() {
  entries_.clear();
  words_.clear();
}

}  // namespace vitrine::glass::debug
