// Messages of shaders (NonSemantic.DebugPrintf), in an order that does not depend on threads: by submission, command,
// stage, invocation, and for one invocation as it said them.
#include <algorithm>
#include <bit>
#include <cstdlib>
#include <mutex>
#include <tuple>

#include "glass/format.h"
#include "glass/place.h"
#include "glass/printf_output.h"
#include "glass/tools.h"
#include "spirv/exec/invocation.h"

namespace vitrine::glass {
namespace {

using Id = std::array<std::uint32_t, 3>;

struct Message {
  Finding finding;
  std::uint64_t sequence = 0;  ///< of all messages as they came
};

/// Invocations in the order of rows.
auto key(const Message& message) {
  const Address& address = message.finding.address;
  const Id& id = address.invocation.id;
  return std::tuple(address.submission, address.command, address.stage, id[2], id[1], id[0], message.sequence);
}

std::string_view setting(const char* variable) {
  const char* value = std::getenv(variable);
  return value != nullptr ? value : "";
}

/// An assertion in a shader is a message that says so: there is no instruction for it.
constexpr std::string_view kAssertion = "assertion failed";

/// What all programs say.
class Collector {
 public:
  const PrintfFilter filter{setting("VITRINE_PRINTF_FILTER")};

  void add(Finding finding) {
    const std::lock_guard lock(mutex_);
    messages_.push_back({std::move(finding), messages_.size()});
  }

  std::vector<Finding> take() {
    std::vector<Message> messages;
    {
      const std::lock_guard lock(mutex_);
      messages.swap(messages_);
    }
    std::sort(messages.begin(), messages.end(), [](const Message& a, const Message& b) { return key(a) < key(b); });
    std::vector<Finding> findings;
    for (Message& message : messages) findings.push_back(std::move(message.finding));
    return findings;
  }

 private:
  std::mutex mutex_;
  std::vector<Message> messages_;
};

/// What all messages of a program have.
struct Speaker {
  ShaderContext context;
  std::shared_ptr<Collector> collector;
  std::vector<spirv::Probe> probes;
};

class PrintfWatch : public spirv::exec::Watch {
 public:
  PrintfWatch(const Speaker& speaker, const spirv::Wave& wave) : speaker_(speaker), invocations_(wave) {}

  void probe(const spirv::Wave& wave, const spirv::ProbeOp& op) override {
    const spirv::Probe& probe = speaker_.probes[op.probe];
    if (probe.kind != spirv::Probe::Kind::kPrintf) return;
    std::vector<std::uint32_t> words(op.operands.size());
    base::for_each_lane(spirv::exec::lanes_at(wave, op) & wave.live, [&](std::size_t lane) {
      const Id id = invocations_(wave, lane);
      if (!speaker_.collector->filter.wants(speaker_.context.stage, id)) return;
      for (std::size_t i = 0; i < words.size(); ++i) words[i] = spirv::exec::word_of(wave, op.operands[i], lane);
      say(wave, probe, id, format_text(probe.format, probe.values, words));
    });
  }

 private:
  void say(const spirv::Wave& wave, const spirv::Probe& probe, const Id& id, std::string text) {
    Finding finding;
    finding.rule = &rule(text.starts_with(kAssertion) ? "assertion" : "printf");
    finding.message = std::move(text);
    finding.address = speaker_.context.address(wave, id, probe.id, probe.place);
    speaker_.collector->add(std::move(finding));
  }

  const Speaker& speaker_;
  const spirv::exec::Invocations invocations_;
};

class PrintfProgram : public ProgramTool {
 public:
  explicit PrintfProgram(Speaker speaker) : speaker_(std::move(speaker)) {}
  std::unique_ptr<spirv::exec::Watch> watch(const spirv::Wave& wave, const spirv::Instruction*) override {
    return std::make_unique<PrintfWatch>(speaker_, wave);
  }

 private:
  Speaker speaker_;
};

class Printf : public Tool {
 public:
  spirv::exec::Interest interest() const override { return {.printf = true}; }

  std::shared_ptr<ProgramTool> attach(const ShaderIdentity& shader, const spirv::Program& program) override {
    const auto speaks = [](const spirv::Probe& probe) { return probe.kind == spirv::Probe::Kind::kPrintf; };
    if (std::none_of(program.probes.begin(), program.probes.end(), speaks)) return nullptr;
    return std::make_shared<PrintfProgram>(Speaker{{shader, program}, collector_, program.probes});
  }

  std::vector<Finding> take_findings() override {
    std::vector<Finding> messages = collector_->take();
    output_.write(messages);
    return messages;
  }

 private:
  PrintfOutput output_{setting("VITRINE_PRINTF")};
  std::shared_ptr<Collector> collector_ = std::make_shared<Collector>();
};

}  // namespace

std::unique_ptr<Tool> make_printf() { return std::make_unique<Printf>(); }

}  // namespace vitrine::glass
