// The variables of a shader as the person who wrote it knows them: names, types, where they lie. Made by the front end
// for who asks for them (Interest::debug). Variables of functions, inputs, outputs and private ones consist of numbered
// cells, a 32-bit word each (64-bit numbers: two, the low one first), which get values by probes
// (Probe::Kind::kAssign).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace vitrine::spirv {

/// A type; `element` and those of members are numbers of SourceVariables::types.
struct SourceType {
  enum class Kind : std::uint8_t { kOther, kBool, kInt, kUint, kFloat, kVector, kMatrix, kArray, kStruct };
  struct Member {
    std::string name;
    std::uint32_t type = 0;
    std::uint32_t offset = 0;         ///< bytes in memory
    std::uint32_t matrix_stride = 0;  ///< bytes
    bool row_major = false;
  };
  Kind kind = Kind::kOther;
  std::uint32_t width = 32;   ///< bits of a number
  std::uint32_t element = 0;  ///< component, column or element
  std::uint32_t count = 0;    ///< of those; an array: 0 if only its memory tells
  std::uint32_t array_stride = 0;
  std::uint32_t cells = 0;  ///< words of a value; 0: it is none that can be shown
  std::string name;         ///< as GLSL says it
  std::vector<Member> members;
};

struct SourceVariable {
  enum class Memory : std::uint8_t {
    kCells,
    kBuffer,  ///< descriptor `set`, `slot`
    kPush,
    kShared,
    kOpaque,  ///< images, samplers
  };
  std::string name;
  std::uint32_t type = 0;  ///< SourceVariables::types; of an array of descriptors: of one
  Memory memory = Memory::kCells;
  std::uint32_t scope = 0;          ///< SourceInfo::scopes: the function instance; 0: visible everywhere
  std::uint32_t line = 0;           ///< where it is declared; 0: unknown
  std::uint32_t first_cell = 0;     ///< kCells
  std::uint32_t set = 0, slot = 0;  ///< kBuffer: as ResourceTable has them
  std::uint32_t descriptors = 0;    ///< of an array of them; 0: it is none
  std::uint32_t offset = 0;         ///< kShared: bytes
  bool word_layout = false;         ///< kShared: a word per cell, without gaps
};

struct SourceVariables {
  std::vector<SourceType> types{1};
  std::vector<SourceVariable> variables;
  std::uint32_t cells = 0;  ///< of all variables
};

}  // namespace vitrine::spirv
