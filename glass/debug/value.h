// Values of a stopped shader: places of variables, numbers that expressions make of them, and both as text.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "glass/debug/run.h"
#include "glass/debug/texels.h"

namespace vitrine::glass::debug {

/// One number of one invocation. Bits in the low end; floats of 16 bits as such.
struct Scalar {
  char type = '?';  ///< B boolean, I, U integer, F float; '?': nobody has given it a value
  std::uint32_t width = 32;
  std::uint64_t bits = 0;
};

Scalar make_bool(bool value);
Scalar make_int(std::int64_t value);
Scalar make_uint(std::uint64_t value, std::uint32_t width = 32);
/// Rounded to `width` bits.
Scalar make_float(double value, std::uint32_t width = 32);
double to_double(const Scalar& scalar);
std::int64_t to_int(const Scalar& scalar);
bool to_bool(const Scalar& scalar);
std::string to_text(const Scalar& scalar);

/// Whose variables.
struct Viewer {
  const Run* run = nullptr;
  std::size_t lane = 0;
  bool memory = true;  ///< buffers and shared memory are there to be looked at
  const spirv::SourceVariables& tables() const { return *run->subject->variables; }
};

/// A variable, or a part of one; a texel of an image.
struct Place {
  const spirv::SourceVariable* variable = nullptr;
  std::uint32_t type = 0;
  std::uint32_t cell = 0;           ///< kCells
  std::uint64_t offset = 0;         ///< other memory: bytes
  std::uint32_t descriptor = 0;     ///< number in an array of them
  bool descriptors = false;         ///< the next index chooses one
  std::uint32_t matrix_stride = 0;  ///< of the member that it is in
  bool row_major = false;
  std::uint32_t component_stride = 0;           ///< bytes between components of a column of a row-major matrix
  std::uint32_t component = 0, components = 1;  ///< of the vector that it is in
  std::optional<TexelCoordinates> texel;
};

struct Value {
  std::optional<Place> place;  ///< nothing: `scalars` is a result
  std::vector<Scalar> scalars;
  /// Of {a, b}, {first = a, rest = b}: it has no scalars of its own. Names are empty, or those of members.
  std::vector<Value> list = {};
  std::vector<std::string> names = {};
};

Place place_of(const spirv::SourceVariable& variable);
/// The element, column or component of a number.
Place element_of(const spirv::SourceVariables& tables, const Place& place, std::uint32_t index);
Place member_of(const spirv::SourceVariables& tables, const Place& place, std::uint32_t member);
/// Elements that a place has: of an array without a length as many as its memory holds.
std::uint32_t count_of(const Viewer& viewer, const Place& place);
/// Numbers of a scalar or vector; empty: it is another thing.
std::vector<Scalar> numbers_of(const Viewer& viewer, const Place& place);

/// The texel that a place is; nothing: it is none that is there.
std::optional<StoredTexelAt> texel_at(const Viewer& viewer, const Place& place);

/// Memory that a place lies in, in pieces; nothing: it lies in cells, has none, or is too large (1 MiB).
std::vector<MemoryRange> memory_of_place(const Viewer& viewer, const Place& place);

/// Bytes of a number in memory: a word for booleans and where a word is a cell.
std::uint32_t stored_bytes(const Viewer& viewer, const Place& place);

/// "(1, 2)", "{first = 1, rest = ...}", "{0, 1, 2}". Long arrays are cut.
std::string to_text(const Viewer& viewer, const Value& value);
/// Name of a type.
std::string type_of(const Viewer& viewer, const Value& value);

/// As a tree, for those who unfold it.
struct Tree {
  std::string name, type, value;
  std::vector<Tree> children;
};
Tree tree_of(const Viewer& viewer, std::string name, const Value& value);

}  // namespace vitrine::glass::debug
