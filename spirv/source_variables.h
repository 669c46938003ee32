// The variables of a shader as the person who wrote it knows them: names, types, where they lie. Made by the front end
// for who asks for them (Interest::debug), names of inputs for whoever observes. Variables of functions, inputs,
// outputs and private ones consist of numbered cells, a 32-bit word each (64-bit numbers: two, the low one first),
// which get values by probes (Probe::Kind::kAssign).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "spirv/shader.h"

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

/// A scalar or vector of an input of a fragment shader, as the module names it: its words lie one behind the other from
/// a component of a location, or of a built-in, on.
struct SourceInput {
  std::string name;  ///< "light.colors[1]"; empty: the module has no name for it
  BuiltIn built_in = BuiltIn::kNone;
  std::uint16_t location = 0;
  std::uint8_t component = 0;
  InputPart part = InputPart::kValue;  ///< or of which vertex
  std::uint8_t words = 1;
  SourceType::Kind kind = SourceType::Kind::kFloat;  ///< of its numbers
  bool wide = false;                                 ///< they are of 64 bits: two words each, the low one first
};

struct SourceVariables {
  std::vector<SourceType> types{1};
  std::vector<SourceVariable> variables;
  std::uint32_t cells = 0;          ///< of all variables
  std::vector<SourceInput> inputs;  ///< of observed fragment shaders
  bool inputs_alone = false;        ///< nobody has asked for anything else
};

}  // namespace vitrine::spirv
