// Operands with their values, what stands behind them and where the instruction comes from.
#include "spirv/exec/trace_line.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "base/numeric.h"
#include "spirv/exec/observe.h"

namespace vitrine::spirv::exec {
namespace {

std::string name_of(OperandPlace place) {
  const std::uint32_t size = place.file == 'r' ? kRegisterStride : place.file == 'm' ? sizeof(base::LaneMask) : 4;
  return place.file + std::to_string(place.offset / size);
}

/// What is no likely float is a small integer.
std::string bits_text(std::uint32_t bits) {
  const float number = base::float_of(bits);
  const auto integer = static_cast<std::int32_t>(bits);
  char text[48];
  if (integer > -65536 && integer < 65536) {
    std::snprintf(text, sizeof text, "%08x %d", bits, integer);
  } else if (std::isnan(number)) {  // the C library prints their signs as it likes
    std::snprintf(text, sizeof text, "%08x nan", bits);
  } else {
    std::snprintf(text, sizeof text, "%08x %.9g", bits, static_cast<double>(number));
  }
  return text;
}

std::string value_text(const Wave& wave, OperandPlace place, std::size_t lane) {
  const std::uint32_t value = word_of(wave, place, lane);
  return name_of(place) + (place.file == 'm' ? ' ' + std::to_string(value) : ' ' + bits_text(value));
}

std::string place_text(const MemoryOp& row) {
  std::string text = "  set " + std::to_string(row.set) + " slot " + std::to_string(row.slot);
  if (row.added != 0) text += " +" + std::to_string(static_cast<std::int32_t>(row.added));
  return text;
}

std::string extra_text(const Program& program, const Instruction& instruction, const InstructionNote& note) {
  switch (note.extra) {
    case InstructionNote::Extra::kMemory:
      return place_text(program.memory_ops[instruction.extra[0]]);
    case InstructionNote::Extra::kImage: {
      const ir::ImageInfo& info = program.image_ops[instruction.extra[0]].info;
      return "  set " + std::to_string(info.set) + " slot " + std::to_string(info.slot);
    }
    default:
      return {};
  }
}

std::string origin_text(const Program& program, const ir::Origin& origin) {
  std::string text;
  if (origin.spirv_id != 0) text += " %" + std::to_string(origin.spirv_id);
  if (origin.place != 0 && program.sources) text += ' ' + program.sources->text(origin.place);
  return text.empty() ? text : "  ;" + text;
}

}  // namespace

std::string padded(std::string text, std::size_t column) {
  text.resize(std::max(text.size() + 1, column), ' ');
  return text;
}

std::string result_text(const Wave& wave, OperandPlace place, std::size_t lane) {
  const std::uint32_t value = word_of(wave, place, lane);
  return name_of(place) + " = " + (place.file == 'm' ? std::to_string(value) : bits_text(value));
}

TraceLine::TraceLine(const Wave& wave, const Instruction& instruction, const InstructionNote& note, std::size_t index)
    : instruction_(instruction), note_(note), operands_(operands_of(*wave.program, instruction, note)) {
  constexpr std::size_t kNumber = kTraceNameColumn - 2;
  std::string number = std::to_string(index);
  number.insert(0, number.size() < kNumber ? kNumber - number.size() : 0, ' ');
  head_ = padded(padded(number, kTraceNameColumn) + note.name, kTraceOperandColumn);
}

void TraceLine::read(const Wave& wave, std::size_t lane) {
  for (const OperandPlace place : operands_.sources)
    sources_ += (sources_.empty() ? " <- " : ", ") + value_text(wave, place, lane);
}

std::string TraceLine::text(const Wave& wave, std::size_t lane, std::optional<std::size_t> jump) const {
  std::string text = head_;
  const char* separator = "";
  for (const OperandPlace place : operands_.results)
    text += std::exchange(separator, ", ") + result_text(wave, place, lane);
  text += sources_.substr(operands_.results.empty() && !sources_.empty() ? 1 : 0);
  text += extra_text(*wave.program, instruction_, note_);
  if (jump) text += "  -> " + std::to_string(*jump);
  text += origin_text(*wave.program, note_.origin);
  return text.erase(text.find_last_not_of(' ') + 1);
}

}  // namespace vitrine::spirv::exec
