// What a SPIR-V module asks of its surroundings: stage, descriptors, inputs and outputs. The first entry point alone.
#pragma once

#define SPV_ENABLE_UTILITY_CODE
#include <spirv/unified1/spirv.hpp11>

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "harness/random.h"

namespace vitrine::cts {

struct Reflection {
  struct Type {
    spv::Op op = spv::Op::OpTypeVoid;
    std::vector<uint32_t> operands;  ///< behind the result id
  };
  struct Variable {
    uint32_t id = 0, pointee = 0;
    spv::StorageClass storage = spv::StorageClass::Private;
  };

  spv::ExecutionModel model = spv::ExecutionModel::Max;
  uint32_t entry = 0;
  std::string entry_name;
  std::set<uint32_t> interface;
  uint32_t local_size[3] = {1, 1, 1};
  std::map<spv::ExecutionMode, uint32_t> modes;  ///< with their first operand
  std::set<spv::Capability> capabilities;
  bool compares_depth = false;
  std::map<uint32_t, Type> types;
  std::map<uint32_t, uint32_t> constants;                                               ///< default values
  std::map<std::pair<uint32_t, int>, std::map<spv::Decoration, uint32_t>> decorations;  ///< member, -1: the id itself
  std::vector<Variable> variables;
  std::set<uint32_t> used;  ///< ids that some instruction of a function names

  explicit Reflection(std::span<const uint32_t> words);

  const Type& type(uint32_t id) const { return types.at(id); }
  std::optional<uint32_t> decoration(uint32_t id, spv::Decoration kind, int member = -1) const;
  /// Elements of an array; of a runtime array `runtime`.
  uint32_t length(const Type& array, uint32_t runtime) const;
  /// Bytes that a value with explicit layout takes, a runtime array with `runtime` elements.
  uint32_t size(uint32_t type, uint32_t runtime, uint32_t matrix_stride = 0) const;
  /// Random numbers: floats of ordinary magnitude, integers that suit as counts and indices.
  void fill(Random& random, uint32_t type, std::span<unsigned char> bytes, uint32_t runtime,
            uint32_t matrix_stride = 0) const;
};

/// The module with its vertex outputs captured: buffer 0, one float or word after the other. Bytes per vertex in
/// `stride`; 0 where nothing can be captured.
std::vector<uint32_t> with_feedback(const Reflection& reflection, std::span<const uint32_t> words, uint32_t& stride);

}  // namespace vitrine::cts
