// Which parts of variables have been written where they are read. Every scalar of a variable, phi or result of a
// function is a cell. On the way through the structured control flow it is known of most reads that the cells have been
// written; only of the others observers are told at run time (Probe::Kind::kWrite, kRead, kUse). What a read gives that
// may be undefined is a slot for each scalar; copies, composites and arithmetic hand slots on; a branch, an address or
// a store that depends on one is a use. Internal to front/.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include "spirv/front/context.h"

namespace vitrine::spirv::front {

/// Cells that have certainly been written here.
struct Assigned {
  bool reachable = true;  ///< false: nothing comes here, so that everything has been written
  std::vector<bool> cells;

  bool has(std::uint32_t cell) const { return !reachable || (cell < cells.size() && cells[cell]); }
  void set(std::uint32_t cell, bool written);
};

/// What holds on both of two ways.
Assigned meet(const Assigned& a, const Assigned& b);

/// Slots that a scalar may be undefined because of, ascending; none: it is defined. Slot 0 is undefined always.
using Slots = std::vector<std::uint32_t>;
/// Of the scalars of a value in their order; empty: it is defined.
using SlotsOf = std::vector<Slots>;

/// State of one translation.
struct Initialization {
  static constexpr std::uint32_t kUntracked = ~0u;
  /// Variables with more scalars are not looked at.
  static constexpr std::uint32_t kMaxCells = 4096;

  Assigned here;
  std::unordered_map<std::uint32_t, std::uint32_t> first_cell;  ///< of locals
  std::uint32_t cells = 0, slots = 1;
  std::unordered_map<std::uint32_t, SlotsOf> values;                ///< by id; absent: defined
  std::vector<std::uint32_t> variable_of_slot{0};                   ///< OpVariable, 0: another thing
  std::unordered_map<std::uint32_t, std::uint32_t> source_of_cell;  ///< cell -> OpVariable that made it undefined
  std::vector<bool> read;                                ///< by local: something must know what has been written
  std::vector<std::uint32_t> local_of_probe;             ///< of kWrite probes
  std::unordered_map<std::uint32_t, std::string> names;  ///< OpName
};

/// State before a translation, with the names that a module gives its ids.
std::shared_ptr<Initialization> begin_initialization(const Module& module);

// ---- what the control flow tells; nothing happens where nobody wants to know
/// A copy of what holds here.
Assigned assigned_here(const Translator& t);
/// Goes on from another place; returns what held here.
Assigned go_on_from(Translator& t, const Assigned& place);
/// The flow jumps to `scope`'s end, or (null) somewhere else that needs not be known.
void jump_to_end(Translator& t, Scope* scope);
/// Here jumps to the end of a scope that is closed now come together with what runs to there.
void arrive(Translator& t, const Scope& scope);

// ---- what instructions tell
/// Before and after an instruction of a block is translated.
void before_instruction(Translator& t, const Inst& inst);
void after_instruction(Translator& t, const Inst& inst);
/// A terminator with an operand that decides, or a value that is returned.
void use_in_branch(Translator& t, std::uint32_t id);
/// `local` (a phi, the result of a function) gets the value of `id`; the value of `id` is that of `local`.
void copy_to_local(Translator& t, std::uint32_t local, std::uint32_t id);
void copy_from_local(Translator& t, std::uint32_t id, std::uint32_t local);
/// A parameter is its argument.
void copy_value(Translator& t, std::uint32_t to, std::uint32_t from);

/// Takes out what nobody needs to be told. The body is complete.
void drop_idle_writes(Translator& t);

}  // namespace vitrine::spirv::front
