// The fuzzers' target, also libFuzzer's entry point (tests/fuzz/CMakeLists.txt).
#include "tests/fuzz/module_fuzz.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iterator>

#include "spirv/front/translate.h"
#include "spirv/ir_passes.h"
#include "spirv/program.h"
#include "spirv/shader.h"
#include "tests/fuzz/target.h"

namespace vitrine::fuzz {
namespace {

constexpr std::uint32_t kBindings = 8, kElements = 4, kBufferWords = 256;
constexpr std::size_t kStageWords = std::size_t{1} << 20;

// Loops that never end are what mutation makes most.
const int budget_is_set = setenv("VITRINE_SHADER_BUDGET", "100000", 1);
// Mutants race: one thread, so that two runs of one are equal.
const int threads_are_set = setenv("VITRINE_THREADS", "1", 1);

spirv::CompileOptions options_of(VkShaderStageFlagBits stage) {
  spirv::CompileOptions options;
  options.stage = stage;
  for (std::uint32_t set = 0; set < 2; set++) {
    spirv::SetLayoutInfo layout;
    for (std::uint32_t binding = 0; binding < kBindings; binding++)
      layout.bindings.push_back(
          {binding, VK_DESCRIPTOR_TYPE_MUTABLE_EXT, set, kElements * binding, kElements, nullptr});
    options.sets.push_back(layout);
  }
  return options;
}

std::vector<std::uint32_t> run_once(const spirv::Shader& shader) {
  std::vector<std::uint32_t> buffers(2 * kBindings * kElements * kBufferWords);
  for (std::size_t i = 0; i < buffers.size(); i++) buffers[i] = static_cast<std::uint32_t>(i * 2654435761u) >> (i % 31);
  std::vector<spirv::Descriptor> descriptors(2 * kBindings * kElements);
  for (std::size_t i = 0; i < descriptors.size(); i++) {
    descriptors[i].data = reinterpret_cast<std::byte*>(buffers.data() + i * kBufferWords);
    descriptors[i].size = kBufferWords * 4;
  }
  spirv::ResourceTable table;
  std::vector<std::byte> push(spirv::kMaxPushConstantBytes, std::byte{3});
  table.push_constants = push.data();
  for (std::uint32_t set = 0; set < 2; set++) {
    table.set[set] = descriptors.data() + set * kBindings * kElements;
    table.set_size[set] = kBindings * kElements;
  }
  spirv::Fault fault;
  const spirv::BoundShader bound(shader, table, fault);
  if (shader.interface().stage == VK_SHADER_STAGE_COMPUTE_BIT) {
    const std::uint32_t base[3] = {0, 0, 0}, groups[3] = {3, 1, 1};
    spirv::dispatch(bound, base, groups);
    return buffers;
  }
  std::vector<std::uint32_t> stage(kStageWords);
  spirv::WaveRunner runner;
  runner.bind(bound);
  runner.set_stage_memory(stage.data(), stage.size());
  for (const spirv::InterfaceSlot& slot : shader.interface().inputs)
    for (std::uint32_t lane = 0; lane < base::kWaveWidth; lane++)
      runner.input(slot.reg).lane[lane] = slot.location + slot.component + (lane << (lane % 24));
  runner.run(base::kAllLanes, 0xff00);
  for (const spirv::InterfaceSlot& slot : shader.interface().outputs)
    buffers.insert(buffers.end(), runner.output(slot.reg).lane, runner.output(slot.reg).lane + base::kWaveWidth);
  return buffers;
}

/// Ends the process where the front end has made what nothing behind it may rely on.
void expect_none(const std::string& complaint) {
  if (complaint.empty()) return;
  std::fprintf(stderr, "the front end makes what is malformed: %s\n", complaint.c_str());
  std::abort();
}

bool has_clock(const spirv::Shader& shader) {
  const auto& notes = shader.program().notes;
  return std::any_of(notes.begin(), notes.end(), [](const auto& note) { return !std::strcmp(note.name, "ReadClock"); });
}

}  // namespace

Outcome run_module(VkShaderStageFlagBits stage, std::span<const std::uint32_t> words) {
  static_cast<void>(budget_is_set + threads_are_set);
  const spirv::CompileOptions options = options_of(stage);
  if (spirv::check_module(words).empty()) {
    constexpr spirv::exec::Interest kAll{true, true, true, true, true, true, true, true, true, true, true, true};
    for (const spirv::exec::Interest& interest : {spirv::exec::Interest{}, kAll}) {
      const base::Result<spirv::ir::Function> function = spirv::translate(words, options, interest);
      if (function) expect_none(spirv::ir::verify(function.value()));
    }
  }
  const auto shader = spirv::compile(words, options);
  if (!shader) return Outcome::kRefused;
  if (has_clock(*shader.value())) return Outcome::kCompiled;
  const std::vector<std::uint32_t> first = run_once(*shader.value());
  const std::vector<std::uint32_t> second = run_once(*shader.value());
  if (first != second) {
    const auto at = std::mismatch(first.begin(), first.end(), second.begin());
    std::fprintf(stderr, "two runs differ in word %td: %08x, %08x\n", at.first - first.begin(), *at.first, *at.second);
    std::abort();
  }
  return Outcome::kRan;
}

std::uint8_t number_of(VkShaderStageFlagBits stage) {
  return static_cast<std::uint8_t>(std::find(std::begin(kStages), std::end(kStages), stage) - std::begin(kStages));
}

std::vector<std::uint32_t> words_of(std::span<const std::uint8_t> bytes) {
  std::vector<std::uint32_t> words((bytes.size() - 1) / 4);
  if (!words.empty()) std::memcpy(words.data(), bytes.data() + 1, words.size() * 4);
  return words;
}

Outcome run_bytes(std::span<const std::uint8_t> bytes) {
  if (bytes.empty()) return Outcome::kRefused;
  return run_module(kStages[bytes[0] % std::size(kStages)], words_of(bytes));
}

}  // namespace vitrine::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  vitrine::fuzz::run_bytes({data, size});
  return 0;
}
