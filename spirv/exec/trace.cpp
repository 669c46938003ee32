// Writes what one invocation does as text.
#include "spirv/exec/trace.h"

#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "base/lasting.h"
#include "base/numeric.h"
#include "spirv/exec/invocation.h"
#include "spirv/exec/trace_line.h"

namespace vitrine::spirv::exec {
namespace {

std::string list_text(const std::uint32_t* numbers, std::size_t count) {
  std::string text;
  for (std::size_t i = 0; i < count; ++i) {
    if (i != 0) text += ',';
    text += std::to_string(numbers[i]);
  }
  return text;
}

constexpr std::pair<std::string_view, VkShaderStageFlagBits> kStages[] = {
    {"compute", VK_SHADER_STAGE_COMPUTE_BIT},
    {"vertex", VK_SHADER_STAGE_VERTEX_BIT},
    {"fragment", VK_SHADER_STAGE_FRAGMENT_BIT},
};

std::string head_text(const Wave& wave, const TraceTarget& target, std::size_t lane, bool resumed) {
  std::string text;
  for (const auto& [name, stage] : kStages)
    if (stage == target.stage) text += name;
  const bool compute = target.stage == VK_SHADER_STAGE_COMPUTE_BIT;
  const auto id = invocation_of(wave, lane);
  text += ' ' + list_text(id.data(), compute ? 3 : 2) + " (";
  if (compute) text += "workgroup " + list_text(wave.workgroup_id, 3) + ", ";
  text += "lane " + std::to_string(lane);
  if ((wave.live >> lane & 1) == 0) text += ", helper";
  if (resumed) text += ", behind a barrier";
  return text + ")\n";
}

std::string slot_text(const InterfaceSlot& slot) {
  const std::string part = slot.component < 4 ? std::string(1, "xyzw"[slot.component]) : std::to_string(slot.component);
  if (slot.built_in != BuiltIn::kNone)
    return "built-in " + std::to_string(static_cast<int>(slot.built_in)) + '.' + part;
  return "location " + std::to_string(slot.location) + '.' + part;
}

std::string outputs_text(const Wave& wave, std::size_t lane) {
  std::string text;
  for (const InterfaceSlot& slot : wave.program->observation->interface.outputs) {
    const OperandPlace place{'r', slot.reg * kRegisterStride};
    text += padded("       " + slot_text(slot), kTraceOperandColumn) + result_text(wave, place, lane) + '\n';
  }
  return text.empty() ? text : "outputs\n" + text;
}

/// What the preamble computed when the shader was bound, computed once more on a copy of the words. Buffers that it
/// reads may have changed since then by the shader's own stores through other descriptors.
std::string preamble_text(const Wave& wave) {
  const Program& program = *wave.program;
  std::vector<std::uint32_t> words(wave.uniforms, wave.uniforms + program.draw_words);
  Wave copy = wave;
  copy.uniforms = words.data();
  copy.active = copy.live = copy.launched = 1;
  std::string text;
  for (const Instruction* next = program.preamble.data(); next != nullptr;) {
    const auto index = static_cast<std::size_t>(next - program.preamble.data());
    TraceLine line(copy, *next, program.preamble_notes[index], index);
    line.read(copy, 0);
    const Instruction* const behind = next->handler(copy, next);
    if (behind != nullptr) text += line.text(copy, 0, {}) + '\n';
    next = behind;
  }
  return text.empty() ? text : "preamble\n" + text;
}

class LaneWatch : public Watch {
 public:
  LaneWatch(const TraceTarget& target, const TraceWriter& writer, const Wave& wave, const Instruction* start,
            base::LaneMask lanes)
      : wave_(wave), writer_(writer) {
    const bool resumed = start != wave.program->code.data();
    const std::string preamble = resumed ? std::string() : preamble_text(wave);
    base::for_each_lane(lanes, [&](std::size_t lane) {
      lanes_.push_back({lane, head_text(wave, target, lane, resumed) + preamble + "code\n", {}});
    });
  }

  ~LaneWatch() override {
    for (Lane& lane : lanes_) {
      if (wave_.status == Wave::Status::kDone) lane.text += outputs_text(wave_, lane.index);
      writer_(lane.text);
    }
  }

  void before(const Wave& wave, const Instruction* instruction) override {
    const std::size_t index = index_of(wave, instruction);
    for (Lane& lane : lanes_) {
      lane.was_active = (wave.active >> lane.index & 1) != 0;
      lane.line.emplace(wave, *instruction, wave.program->notes[index], index);
      lane.line->read(wave, lane.index);
    }
  }

  void after(const Wave& wave, const Instruction* instruction, const Instruction* next) override {
    std::optional<std::size_t> jump;
    if (next != nullptr && next != instruction + 1) jump = index_of(wave, next);
    for (Lane& lane : lanes_) {
      const bool active = (wave.active >> lane.index & 1) != 0;
      if (!active && !lane.was_active) continue;
      lane.text += lane.line->text(wave, lane.index, jump);
      if (active != lane.was_active) lane.text += active ? "  lane on" : "  lane off";
      lane.text += '\n';
    }
  }

 private:
  struct Lane {
    std::size_t index;
    std::string text;
    std::optional<TraceLine> line;
    bool was_active = false;
  };

  static std::size_t index_of(const Wave& wave, const Instruction* instruction) {
    return static_cast<std::size_t>(instruction - wave.program->code.data());
  }

  const Wave& wave_;
  const TraceWriter& writer_;
  std::vector<Lane> lanes_;
};

class Tracer : public Observer {
 public:
  Tracer(const TraceTarget& target, TraceWriter writer) : target_(target), writer_(std::move(writer)) {}

  std::unique_ptr<Watch> watch(const Wave& wave, const Instruction* start) const override {
    base::LaneMask lanes = 0;
    base::for_each_lane(wave.launched, [&](std::size_t lane) {
      const auto id = invocation_of(wave, lane);
      if (std::equal(id.begin(), id.begin() + static_cast<std::ptrdiff_t>(target_.count), target_.id.begin()))
        lanes |= base::LaneMask{1} << lane;
    });
    if (lanes == 0) return nullptr;
    return std::make_unique<LaneWatch>(target_, writer_, wave, start, lanes);
  }

 private:
  TraceTarget target_;
  TraceWriter writer_;
};

// ---- VITRINE_TRACE

struct Request {
  std::optional<TraceTarget> target;
  std::shared_ptr<const Observer> tracer;
};

void write_to(std::FILE* file, std::string_view text) {
  static std::mutex mutex;
  const std::lock_guard lock(mutex);
  std::fprintf(file, "vitrine: trace: %.*s", static_cast<int>(text.size()), text.data());
  std::fflush(file);
}

Request read_request() {
  const char* value = std::getenv("VITRINE_TRACE");
  if (value == nullptr) return {};
  const std::string_view text = value;
  const std::size_t at = text.find('@');
  Request request;
  request.target = parse_trace_target(text.substr(0, at));
  if (!request.target) return {};
  std::FILE* file = at == std::string_view::npos ? stderr : std::fopen(value + at + 1, "a");
  if (file == nullptr) return {};
  request.tracer = make_tracer(*request.target, [file](std::string_view run) { write_to(file, run); });
  return request;
}

}  // namespace

std::optional<TraceTarget> parse_trace_target(std::string_view text) {
  TraceTarget target;
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos) return {};
  bool known = false;
  for (const auto& [name, stage] : kStages) {
    if (name != text.substr(0, colon)) continue;
    target.stage = stage;
    known = true;
  }
  const char* at = text.data() + colon + 1;
  const char* const end = text.data() + text.size();
  for (; target.count < target.id.size() && at < end; at += at != end && *at == ',' ? 1 : 0) {
    const auto [next, error] = std::from_chars(at, end, target.id[target.count]);
    if (error != std::errc()) return {};
    ++target.count;
    if (next != end && *next != ',') return {};
    at = next;
  }
  const std::size_t most = target.stage == VK_SHADER_STAGE_COMPUTE_BIT ? 3 : 2;
  const std::size_t least = target.stage == VK_SHADER_STAGE_VERTEX_BIT ? 1 : most;
  if (!known || at != end || target.count < least || target.count > most) return {};
  return target;
}

std::shared_ptr<const Observer> make_tracer(const TraceTarget& target, TraceWriter writer) {
  return std::make_shared<Tracer>(target, std::move(writer));
}

std::shared_ptr<const Observer> requested_tracer(VkShaderStageFlagBits stage) {
  static const Request& request = base::lasting(read_request);
  return request.target && request.target->stage == stage ? request.tracer : nullptr;
}

}  // namespace vitrine::spirv::exec
