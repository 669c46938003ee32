// What observers are told of the commands that replay runs: numbers, names, debug labels, what is bound; and how what
// they find reaches the application. A device has it only where tools are on (glass/session.h).
#pragma once

#include <array>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "glass/finding.h"
#include "glass/pixel/pass.h"
#include "glass/pixel/primitives.h"
#include "glass/sync/sync.h"
#include "icd/edge/diagnostics.h"
#include "icd/object/labels.h"
#include "icd/replay/replay.h"
#include "spirv/observed_command.h"

namespace vitrine::glass::debug {
class CommandWatch;  // glass/debug/command_watch.h
}

namespace vitrine::icd {

/// A draw or dispatch as it is replayed: valid until its pass is flushed.
class ReplayedCommand final : public spirv::ObservedCommand {
 public:
  ReplayedCommand(const Device& device, const Pipeline& bound, const spirv::ResourceTable& resources);
  std::string resource(std::uint32_t set, std::uint32_t slot) const override;
  std::string bytes(const std::byte* first, std::uint64_t size) const override;
  std::uint64_t push_range(VkShaderStageFlagBits stage) const override;
  std::string departed(std::uint32_t set, std::uint32_t slot) const override;
  std::string departed(std::uint64_t address) const override;
  spirv::AddressRange buffers_at(std::uint64_t address) const override;

 private:
  const spirv::Descriptor* find(std::uint32_t set, std::uint32_t slot) const;

  const Device& device_;
  std::shared_ptr<const PipelineLayoutShape> layout_;
  spirv::ResourceTable resources_;
  mutable std::once_flag looked_up_;
  mutable std::vector<spirv::AddressRange> buffers_;  ///< those of the book, once somebody has asked
};

/// The attachments of the pass that is being replayed, and what draws have counted as writing of each (colours, depth,
/// stencil): kept where tools shadow memory.
struct ObservedPass {
  raster::PassDesc desc;
  std::array<VkRect2D, raster::kMaxColorAttachments + 2> drawn{};
};

/// A watched texel of an attachment, and what a load op does to it.
struct LoadedTexel {
  glass::pixel::Texel* texel = nullptr;
  glass::pixel::EventKind kind{};
  const char* text = "";
};

/// What the tool sync remembers of a render pass instance.
struct SyncedPass {
  std::uint64_t number = 0;                                        ///< of the subpass, among all
  glass::sync::Tag begin = 0;                                      ///< of the instance
  std::map<const std::byte*, std::uint64_t> drawn;                 ///< planes that were written: in which subpass last
  std::array<VkRect2D, raster::kMaxColorAttachments + 3> areas{};  ///< of them, as ObservedPass::drawn; of rates
};

struct ObservedReplay {
  /// The objects of a draw or dispatch of the submission.
  struct Objects {
    std::uint32_t command;
    ObjectRef command_buffer;
    std::array<ObjectRef, kGraphicsStages> shaders;  ///< the pipeline, or shader objects; null behind the last
  };

  bool shadows_memory = false;             ///< icd/replay/written.h is told
  glass::pixel::Pixels* pixels = nullptr;  ///< likewise, and icd/replay/texel_events.h; null: no texel is watched
  std::shared_ptr<glass::pixel::PassPixels> pixel_pass;         ///< null: the pass has none of them
  std::unique_ptr<glass::pixel::PrimitiveObserver> primitives;  ///< null: no primitive is asked for
  glass::sync::Hazards* hazards = nullptr;                      ///< null: sync is off
  SyncedPass synced;
  glass::debug::CommandWatch* debugger = nullptr;  ///< null: nobody debugs
  bool every_fragment = true;                      ///< some tool must see each
  std::vector<LoadedTexel> loaded;                 ///< by the scope that begins
  std::uint64_t submission = 0;                    ///< counted from 1
  std::uint32_t command = 0;                       ///< of the submission, counted from 1; 0: none yet
  const char* name = "";                           ///< of the command
  std::uint64_t pass_number = 0;                   ///< of the draws at hand: spirv::ObservedCommand::pass
  ObjectRef command_buffer;                        ///< primary
  LabelStack labels;                               ///< of command buffers; they go on from one submission to the next
  std::vector<std::string> queue_labels;
  /// What descriptors that were hidden named, by their nulls; and the sets without such ones, as of how many
  /// departures.
  std::map<const spirv::Descriptor*, std::string> departed;
  std::map<const DescriptorSet*, std::uint64_t> alive;
  std::vector<std::unique_ptr<const ReplayedCommand>> commands;  ///< that observers may still ask
  std::vector<Objects> objects;                                  ///< ascending commands
  ObservedPass pass;
  const CmdBeginRendering* rendering = nullptr;  ///< dynamic rendering that has begun
  // Where commands are captured (icd/replay/captured_replay.h)
  const CmdBeginRendering* captured_rendering = nullptr;  ///< the last that has begun
  /// Of the submission: by where they were taken (Snapshots of icd/replay/captured_objects.h).
  std::map<const std::byte*, std::shared_ptr<const std::vector<std::byte>>> snapshots;
  /// By word of the push constants: ranges of the layout that it was set with, in the command buffer; none: it was not.
  std::array<std::span<const VkPushConstantRange>, spirv::kMaxPushConstantBytes / 4> pushed{};
};

/// Labels of the queue and of the command buffers that are open, outermost first.
std::vector<std::string> open_labels(const ObservedReplay& observed);
/// The command that is being replayed, by its numbers, name and labels.
glass::Address address_of(const ObservedReplay& observed);

/// What observers are told of the draw or dispatch that is being replayed.
const spirv::ObservedCommand* observe_command(ReplayState& state, const Pipeline& pipeline,
                                              const spirv::ResourceTable& resources);

/// Descriptors whose resources are gone: gives the table copies of their sets in which they are null, before anything
/// reads what they point to.
void hide_departed(ReplayState& state, const BindPoint& bind_point, spirv::ResourceTable& table);

/// The arguments of an indirect draw or dispatch lie outside of their buffer: `what` names them.
void report_arguments(ReplayState& state, const BindPoint& bind_point, const Buffer& buffer, std::uint64_t offset,
                      std::uint64_t size, const char* what);
/// Words of the push constants have been set.
void note_push_constants(ReplayState& state, const CmdPushConstants& command);
/// None have been in what is replayed next. Nothing if nobody observes.
void forget_push_constants(ReplayState& state);
/// A pass begins.
void begin_observed_pass(ReplayState& state);

/// A submission begins, on a queue with these labels; `host`: what the host knew to be done when it made it
/// (glass/sync/hazards.h). Nothing if nobody observes.
void begin_observed_submission(Device& device, std::vector<std::string> queue_labels, std::uint64_t host);
/// It is done, or lost: what has been found goes to the application's messengers. No lock is held.
void end_observed_submission(Device& device) noexcept;

/// Sends a finding to the messengers of the device's instance.
void send_finding(Device& device, const ObservedReplay& observed, const glass::Finding& finding);

/// Bytes of a buffer: "'mesh' (96 bytes at offset 32)".
std::string describe_bytes(const Device& device, const std::byte* first, std::uint64_t size);
/// What a descriptor of this binding is or, if it is `departed`, was, in words: "storage buffer 'particles' (set 0,
/// binding 1, 4096 bytes)".
std::string describe_descriptor(const Device& device, std::uint32_t set, const SetBinding& binding,
                                std::uint32_t element, const spirv::Descriptor* descriptor,
                                const std::string& departed);

}  // namespace vitrine::icd
