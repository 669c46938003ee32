// The places of a program that access device memory.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "glass/place.h"
#include "glass/sync/stages.h"

namespace vitrine::glass::sync {

/// One instruction.
struct Site {
  std::optional<Access> read, write;
  bool atomic = false;  ///< Use::atomic
  std::string what;     ///< "store of 4 bytes"
  std::string place;    ///< Who::place
  spirv::ir::Origin origin;
  std::uint32_t set = 0, slot = 0;
};

/// The sites of a program; it keeps nothing of the program itself, which may be gone before its accesses are told of.
struct Sites {
  Sites(const ShaderIdentity& shader, const spirv::Program& program);
  ShaderContext context;
  std::vector<Site> all;
  std::vector<std::uint32_t> by_instruction;  ///< in `all`; kNone: it is none
  static constexpr std::uint32_t kNone = ~0u;
};

}  // namespace vitrine::glass::sync
