// What has happened in one wave, and what its variables hold: a log of the lines that its lanes came to and of the
// values that variables got, and of what it has written to memory. Every entry holds what it replaced: it can be taken
// back, and done again.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "glass/debug/stores.h"
#include "glass/debug/word_log.h"
#include "glass/place.h"
#include "spirv/program.h"
#include "spirv/source_variables.h"

namespace vitrine::glass::debug {

inline constexpr std::uint32_t kNoProbe = ~std::uint32_t{0};
/// Instead of a probe, in entries: memory is written.
inline constexpr std::uint32_t kStores = kNoProbe - 1;
/// The same: somebody gives variables of one invocation values from outside.
inline constexpr std::uint32_t kChange = kNoProbe - 2;
/// Of a store: nobody's.
inline constexpr std::uint32_t kNoLane = 0xff;

/// A shader that may be stopped in.
struct Subject {
  Subject(const ShaderIdentity& shader, const spirv::Program& program)
      : context(shader, program),
        probes(program.probes),
        variables(program.sources->variables),
        program(spirv::disassemble(program)) {}

  const spirv::SourcePlace& place(std::uint32_t probe) const { return context.sources->place(probes[probe].place); }
  /// Calls that lead to a place.
  std::uint32_t depth(std::uint32_t probe) const;

  ShaderContext context;
  std::vector<spirv::Probe> probes;
  std::shared_ptr<const spirv::SourceVariables> variables;
  /// Where a cell of a rehearsed program lies, from Wave::arrays (spirv/homes.h), if it can be changed. Cells as their
  /// homes have them: of a vector of 64-bit numbers the low words come first.
  std::optional<std::uint32_t> home_of(std::uint32_t cell) const;
  std::string program;  ///< disassembled
};

/// Bytes of memory.
struct MemoryRange {
  std::byte* at = nullptr;
  std::uint64_t bytes = 0;
  bool operator==(const MemoryRange&) const = default;
};

class Run {
 public:
  struct Entry {
    std::uint32_t probe = 0;
    base::LaneMask lanes = 0;
    std::size_t first = 0;  ///< of its words
  };

  Run(std::shared_ptr<const Subject> of, const spirv::Wave& wave);

  /// The wave comes by a probe of Kind::kStep or kAssign.
  void record(const spirv::Wave& wave, const spirv::ProbeOp& op, base::LaneMask lanes);
  /// Memory is about to be written, at a place (SourceInfo::places; 0: outside of the shader): the entry begins, and
  /// gets its parts.
  void begin_stores(std::uint32_t place);
  void add_store(const Written& written);
  /// The same of memory that has been written, with what it held before.
  void add_store(const Written& written, const std::byte* before);
  /// Cells of a lane get values from outside.
  struct Change {
    std::uint32_t cell = 0, word = 0;
  };
  void change(std::size_t lane, const std::vector<Change>& changes);
  /// Takes an entry back, or does it again; memory, where it is that of `live`, which runs.
  void exchange(const Entry& entry, bool back, const Run& live);

  std::size_t size() const { return entries_.size(); }
  const Entry& entry(std::size_t i) const { return entries_[i]; }
  bool steps(const Entry& entry) const {
    return entry.probe < kChange && subject->probes[entry.probe].kind == spirv::Probe::Kind::kStep;
  }
  /// Of a step that has been done: the lanes that were on another line before.
  base::LaneMask fresh_lanes(const Entry& entry) const;
  /// Of an assignment that has been done: whether it changed one of these cells of a lane; `any`: or gave it the value
  /// that it had.
  bool assigns(const Entry& entry, std::size_t lane, std::uint32_t cell, std::uint32_t count, bool any) const;
  /// Of stores that have been done, `live` as above: the lane (kNoLane: nobody) that has written some of this memory
  /// last, and whether that, and what comes to the same place with it, has changed it. Nothing: they have not written
  /// it.
  struct Store {
    std::uint32_t lane = kNoLane;
    bool changed = false;
  };
  std::optional<Store> store_to(const Entry& entry, std::span<const MemoryRange> memory, const Run& live) const;
  /// SourceInfo::places of stores.
  std::uint32_t place_of_stores(const Entry& entry) const { return words_[entry.first]; }
  /// Of a compute shader.
  std::array<std::uint32_t, 3> workgroup_of(std::size_t lane) const {
    return {id[lane][0] / local_size[0], id[lane][1] / local_size[1], id[lane][2] / local_size[2]};
  }
  /// Whether a step that has been done is the first of a lane.
  bool is_first(const Entry& entry, std::size_t lane) const;
  /// Bytes that it takes.
  std::size_t bytes() const;
  /// Forgets the log, not the values.
  void forget();
  /// Nothing happens to it for a while: its log takes less room until it is asked for again.
  void pack();

  /// Step that a lane came to last; kNoProbe: none.
  std::uint32_t at(std::size_t lane) const { return at_[lane]; }
  bool known(std::uint32_t cell, std::size_t lane) const { return (known_[cell] >> lane & 1) != 0; }
  std::uint32_t word(std::uint32_t cell, std::size_t lane) const { return cells_[cell].lane[lane]; }

  const std::shared_ptr<const Subject> subject;
  base::LaneMask launched = 0, helpers = 0;
  std::array<std::array<std::uint32_t, 3>, base::kWaveWidth> id{};  ///< of invocations
  std::array<std::uint32_t, 3> local_size{1, 1, 1};
  std::uint64_t submission = 0, serial = 0;  ///< of what the command has bound
  std::uint32_t command = 0;
  std::string where;                                ///< the command, for people
  const spirv::ResourceTable* resources = nullptr;  ///< while its command runs
  std::byte* shared = nullptr;                      ///< while its workgroup runs
  std::uint32_t shared_size = 0;
  bool shared_gone = false;  ///< its workgroup has ended, and so has its command
  bool changed = false;      ///< somebody has changed what it computes

 private:
  std::uint32_t cell_of(const spirv::Wave& wave, const spirv::ProbeOp& op, std::size_t lane) const;
  bool has_memory(const std::byte* at, const Run& live) const;
  void exchange_values(const Entry& entry);
  void exchange_stores(const Entry& entry, bool back, const Run& live);
  void exchange_change(const Entry& entry);
  bool changes(const Entry& entry, std::size_t lane, std::uint32_t cell, std::uint32_t count) const;
  void exchange_cell(std::uint32_t cell, base::LaneMask lanes, std::size_t& word);

  std::vector<base::WaveRegister> cells_;
  std::vector<base::LaneMask> known_;
  std::array<std::uint32_t, base::kWaveWidth> at_;
  std::vector<Entry> entries_;
  WordLog words_;
};

}  // namespace vitrine::glass::debug
