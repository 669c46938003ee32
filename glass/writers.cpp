// Which invocation was the last to write a word of device memory in one command: what vitrine shake asks of both runs,
// once it knows the word. VITRINE_DIGEST_AT names command and word (glass/digest.h); the run has one thread, so that
// "last" means something.
#include <mutex>
#include <optional>

#include "glass/digest.h"
#include "glass/place.h"
#include "glass/sanitize/accesses.h"
#include "glass/tools.h"
#include "spirv/exec/buffers.h"
#include "spirv/exec/invocation.h"

namespace vitrine::glass {
namespace {

using spirv::InstructionNote;
using spirv::MemorySpace;
using spirv::Wave;

std::mutex mutex;
std::optional<Finding> last;  ///< of the command so far

/// The watch of one run of a wave.
class WriterWatch : public spirv::exec::Watch {
 public:
  WriterWatch(const ShaderContext& context, const Wave& wave, const DigestWord& word)
      : context_(context), invocations_(wave), word_(word) {}

  void access(const Wave& wave, const spirv::Instruction* i, const InstructionNote& note) override {
    if (note.extra != InstructionNote::Extra::kMemory || note.access == spirv::Access::kLoad) return;
    const spirv::MemoryOp& row = wave.program->memory_ops[i->extra[0]];
    if (!sanitize::writes(row, note.access)) return;
    const sanitize::Touched touched = sanitize::touched_by(row, note.access);
    const base::LaneMask lanes = wave.active & wave.live;
    Wave& plain = const_cast<Wave&>(wave);
    if (note.space == MemorySpace::kStorageBuffer) {
      spirv::exec::for_each_buffer(plain, row, lanes, [&](const spirv::exec::Bytes& bytes, base::LaneMask same) {
        look(wave, note, row, touched, bytes, same, [&](std::size_t lane) {
          return spirv::exec::word_of(wave, {note.files[1], i->src[0]}, lane);
        });
      });
    } else if (note.space == MemorySpace::kGlobal) {
      spirv::exec::for_each_stretch(
          plain, i, row, lanes, [&](const spirv::exec::Bytes& bytes, base::LaneMask same, const auto& offsets) {
            look(wave, note, row, touched, bytes, same, [&](std::size_t lane) { return offsets.lane[lane]; });
          });
    }
  }

 private:
  template <class OffsetOf>
  void look(const Wave& wave, const InstructionNote& note, const spirv::MemoryOp& row, const sanitize::Touched& touched,
            const spirv::exec::Bytes& bytes, base::LaneMask lanes, OffsetOf offset_of) {
    if (bytes.data == nullptr || word_.at + 4 <= bytes.data || word_.at >= bytes.data + bytes.size) return;
    base::for_each_lane(lanes, [&](std::size_t lane) {
      for (std::uint32_t c = 0; c < touched.count; ++c) {
        const std::byte* const first = bytes.data + offset_of(lane) + touched.at[c];
        if (first < word_.at + 4 && word_.at < first + row.element_bytes) note_writer(wave, note, lane);
      }
    });
  }

  void note_writer(const Wave& wave, const InstructionNote& note, std::size_t lane) {
    const std::lock_guard lock(mutex);
    last.emplace();
    last->rule = &rule("last-writer");
    last->message = "wrote the word last";
    last->address = context_.address(wave, invocations_(wave, lane), note.origin.spirv_id, note.origin.place);
  }

  const ShaderContext& context_;
  const spirv::exec::Invocations invocations_;
  const DigestWord word_;
};

class WriterProgram : public ProgramTool {
 public:
  WriterProgram(const ShaderIdentity& shader, const spirv::Program& program) : context_(shader, program) {}
  std::unique_ptr<spirv::exec::Watch> watch(const Wave& wave, const spirv::Instruction*) override {
    const spirv::ObservedCommand* command = wave.resources->command;
    if (command == nullptr) return nullptr;
    const std::optional<DigestWord> word = watched_word(command->submission, command->command);
    return word ? std::make_unique<WriterWatch>(context_, wave, *word) : nullptr;
  }

 private:
  const ShaderContext context_;
};

class WritersTool : public Tool {
 public:
  spirv::exec::Interest interest() const override { return {.accesses = true}; }
  std::shared_ptr<ProgramTool> attach(const ShaderIdentity& shader, const spirv::Program& program) override {
    return std::make_shared<WriterProgram>(shader, program);
  }
  std::vector<Finding> take_findings() override {
    const std::lock_guard lock(mutex);
    std::vector<Finding> findings;
    if (last) findings.push_back(std::move(*std::exchange(last, std::nullopt)));
    return findings;
  }
};

}  // namespace

std::unique_ptr<Tool> make_writers() { return std::make_unique<WritersTool>(); }

}  // namespace vitrine::glass
