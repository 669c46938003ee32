// See run.h. Words of an entry: of a step, the probe by lane; of an assignment, by lane the first cell if its indices
// are not constant, then by cell the mask of lanes that have a value, and the values by lane; of stores, the place and
// the number of parts, then by part the address (low, high), the number of bytes, the lane and above it the bytes of
// each lane, and the bytes; of a change, the number of cells, then by cell its number, 1 if it has a value, and the
// value.
#include "glass/debug/run.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "spirv/exec/invocation.h"
#include "spirv/exec/observe.h"
#include "spirv/homes.h"

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

std::optional<std::uint32_t> Subject::home_of(std::uint32_t cell) const {
  for (const spirv::Probe& probe : probes) {
    if (!spirv::is_home(probe) || cell < probe.first_cell || cell >= probe.first_cell + probe.cells) continue;
    return probe.number - 1 + (cell - probe.first_cell) * static_cast<std::uint32_t>(sizeof(base::WaveRegister));
  }
  return std::nullopt;
}

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
    words_.append(count_of(lanes), op.probe);
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
  words_.append({place, 0});
}

void Run::add_store(const Written& written) { add_store(written, written.at); }

void Run::add_store(const Written& written, const std::byte* before) {
  const auto address = reinterpret_cast<std::uintptr_t>(written.at);
  ++words_[entries_.back().first + 1];
  words_.append({static_cast<std::uint32_t>(address), static_cast<std::uint32_t>(address >> 32), written.bytes,
                 written.lane | written.lane_bytes << 8});
  const std::size_t first = words_.size();
  words_.append((written.bytes + 3) / 4, 0);
  std::memcpy(&words_[first], before, written.bytes);
}

void Run::change(std::size_t lane, const std::vector<Change>& changes) {
  const Entry entry{kChange, base::LaneMask{1} << lane, words_.size()};
  words_.push_back(static_cast<std::uint32_t>(changes.size()));
  for (const Change& change : changes) words_.append({change.cell, 1, change.word});
  entries_.push_back(entry);
  exchange_change(entry);
}

void Run::exchange_change(const Entry& entry) {
  std::size_t word = entry.first;
  const std::size_t lane = static_cast<std::size_t>(__builtin_ctzll(entry.lanes));
  for (std::uint32_t left = words_[word++]; left != 0; --left) {
    const std::uint32_t cell = words_[word++];
    const bool before = (known_[cell] & entry.lanes) != 0;
    known_[cell] = words_[word] != 0 ? known_[cell] | entry.lanes : known_[cell] & ~entry.lanes;
    words_[word++] = before ? 1 : 0;
    std::swap(cells_[cell].lane[lane], words_[word++]);
  }
}

namespace {

/// One part of a store.
struct Part {
  std::byte* at;
  std::uint32_t bytes, lane, lane_bytes;
  std::size_t kept;  ///< word
};

/// Takes the part at `word`, which goes on to the next.
Part take_part(const WordLog& words, std::size_t& word) {
  Part part{
      reinterpret_cast<std::byte*>(static_cast<std::uintptr_t>(std::uint64_t{words[word + 1]} << 32 | words[word])),
      words[word + 2], words[word + 3] & 0xff, words[word + 3] >> 8, word + 4};
  word += 4 + (part.bytes + 3) / 4;
  return part;
}

}  // namespace

/// What has been freed is not written: while a submission runs, all that it uses is there (Vulkan 1.3.239, Object
/// Lifetime); memory of workgroups is that of the one that runs.
bool Run::has_memory(const std::byte* at, const Run& live) const {
  if (submission != live.submission || (submission == 0 && serial != live.serial)) return false;
  if (shared == nullptr || at < shared || at >= shared + shared_size) return true;
  if (live.shared_gone) return false;
  return serial == live.serial && shared == live.shared;
}

/// Parts may overlap: what was written last is taken back first.
void Run::exchange_stores(const Entry& entry, bool back, const Run& live) {
  std::size_t word = entry.first + 2;
  std::vector<Part> parts;
  for (std::uint32_t part = 0; part < words_[entry.first + 1]; ++part) parts.push_back(take_part(words_, word));
  if (back) std::ranges::reverse(parts);
  for (const Part& part : parts) {
    auto* const kept = reinterpret_cast<std::byte*>(&words_[part.kept]);
    if (has_memory(part.at, live)) std::swap_ranges(kept, kept + part.bytes, part.at);
  }
}

std::optional<Run::Store> Run::store_to(const Entry& entry, std::span<const MemoryRange> memory,
                                        const Run& live) const {
  std::optional<Store> found;
  if (entry.probe != kStores) return found;
  std::size_t word = entry.first + 2;
  for (std::uint32_t number = 0; number < words_[entry.first + 1]; ++number) {
    const Part part = take_part(words_, word);
    const auto* const kept = reinterpret_cast<const std::byte*>(&words_[part.kept]);
    for (const MemoryRange& range : memory) {
      std::byte *const begin = std::max(part.at, range.at), *const end =
                                                                std::min(part.at + part.bytes, range.at + range.bytes);
      if (begin >= end) continue;
      const auto from = static_cast<std::size_t>(begin - part.at), count = static_cast<std::size_t>(end - begin);
      std::size_t at = from;
      if (has_memory(begin, live)) {
        const std::size_t same = static_cast<std::size_t>(std::mismatch(begin, end, kept + from).first - begin);
        if (same != count) at = from + same;
        found = Store{kNoLane, (found && found->changed) || same != count};
      } else {
        found = Store{kNoLane, found && found->changed};
      }
      if (part.lane != kNoLane)
        found->lane = part.lane + static_cast<std::uint32_t>(at / std::max(part.lane_bytes, 1u));
    }
  }
  return found;
}

void Run::exchange(const Entry& entry, bool back, const Run& live) {
  if (entry.probe == kStores) return exchange_stores(entry, back, live);
  entry.probe == kChange ? exchange_change(entry) : exchange_values(entry);
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
  if (entry.probe == kChange) return changes(entry, lane, cell, count);
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

bool Run::changes(const Entry& entry, std::size_t lane, std::uint32_t cell, std::uint32_t count) const {
  if ((entry.lanes >> lane & 1) == 0) return false;
  for (std::uint32_t i = 0; i < words_[entry.first]; ++i) {
    const std::uint32_t changed = words_[entry.first + 1 + 3 * i];
    if (changed >= cell && changed < cell + count) return true;
  }
  return false;
}

std::size_t Run::bytes() const {
  return sizeof(*this) + cells_.size() * (sizeof(base::WaveRegister) + sizeof(base::LaneMask)) +
         entries_.capacity() * sizeof(Entry) + words_.bytes();
}

void Run::forget() {
  entries_.clear();
  words_.clear();
}

void Run::pack() {
  entries_.shrink_to_fit();
  words_.pack();
}

}  // namespace vitrine::glass::debug
