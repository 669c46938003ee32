// The tool `sync`: two accesses to the same bytes by different commands, one of them a write, without the dependency
// that they need (Vulkan 1.3.239, Synchronization and Cache Control).
#include "glass/sync/sync.h"

#include <algorithm>
#include <atomic>
#include <iterator>

#include "glass/sync/shader_accesses.h"
#include "glass/tools.h"

namespace vitrine::glass {
namespace {

using sync::Hazards;
using sync::ShaderAccesses;
using sync::Sites;
using sync::Touches;

class SyncWatch : public spirv::exec::Watch {
 public:
  SyncWatch(Touches& touches, const Sites& program) : touches_(touches), program_(program) {}
  void access(const spirv::Wave& wave, const spirv::Instruction* i, const spirv::InstructionNote& note) override {
    sync::record_access(touches_, program_, wave, i, note);
  }

 private:
  Touches& touches_;
  const Sites& program_;
};

class SyncTool;
std::atomic<SyncTool*> current = nullptr;

class SyncTool : public Tool {
 public:
  SyncTool() { current = this; }
  ~SyncTool() override {
    SyncTool* self = this;
    current.compare_exchange_strong(self, nullptr);
  }

  spirv::exec::Interest interest() const override { return {.accesses = true}; }
  std::shared_ptr<ProgramTool> attach(const ShaderIdentity& shader, const spirv::Program& program) override;
  void commands_done(const void* owner) override {
    Hazards& hazards = hazards_of(owner);
    accesses_.tell(owner, hazards);
    hazards.settle();
  }
  std::vector<Finding> take_findings() override {
    const std::lock_guard lock(mutex_);
    std::vector<Finding> findings;
    for (const auto& [owner, hazards] : hazards_) std::ranges::move(hazards->take(), std::back_inserter(findings));
    return findings;
  }

  Hazards& hazards_of(const void* owner) {
    const std::lock_guard lock(mutex_);
    std::unique_ptr<Hazards>& hazards = hazards_[owner];
    if (!hazards) hazards = std::make_unique<Hazards>();
    return *hazards;
  }
  void forget(const void* owner) {
    const std::lock_guard lock(mutex_);
    hazards_.erase(owner);
  }
  void forget(const sync::Range& range) {
    const std::lock_guard lock(mutex_);
    for (const auto& [owner, hazards] : hazards_) hazards->forget(range);
  }
  ShaderAccesses& accesses() { return accesses_; }

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<Sites>> programs_;
  std::map<const void*, std::unique_ptr<Hazards>> hazards_;
  ShaderAccesses accesses_;
};

class SyncProgram : public ProgramTool {
 public:
  SyncProgram(SyncTool& tool, const Sites& sites) : tool_(tool), sites_(sites) {}
  std::unique_ptr<spirv::exec::Watch> watch(const spirv::Wave& wave, const spirv::Instruction*) override {
    Touches* const touches = tool_.accesses().here(sites_, wave.resources->command);
    return touches != nullptr ? std::make_unique<SyncWatch>(*touches, sites_) : nullptr;
  }
  void draw(const raster::DrawCall& call) override {
    if (call.vertex_resources.command != nullptr)
      sync::touch_vertices(tool_.hazards_of(call.vertex_resources.command->owner), call);
  }

 private:
  SyncTool& tool_;
  const Sites& sites_;
};

std::shared_ptr<ProgramTool> SyncTool::attach(const ShaderIdentity& shader, const spirv::Program& program) {
  auto sites = std::make_unique<Sites>(shader, program);
  const std::lock_guard lock(mutex_);
  programs_.push_back(std::move(sites));
  return std::make_shared<SyncProgram>(*this, *programs_.back());
}

}  // namespace

namespace sync {

bool is_on() { return current.load(std::memory_order_relaxed) != nullptr; }

Hazards* hazards_of(const void* owner) {
  SyncTool* const tool = current;
  return tool != nullptr ? &tool->hazards_of(owner) : nullptr;
}

void forget_owner(const void* owner) {
  if (SyncTool* const tool = current) tool->forget(owner);
}

void share_image(const void* owner, const void* image) {
  if (Hazards* const hazards = hazards_of(owner)) hazards->layouts().share(image);
}

void forget_image(const void* owner, const void* image) {
  if (Hazards* const hazards = hazards_of(owner)) hazards->layouts().forget(image);
}

void forget_memory(const std::byte* data, std::uint64_t size) {
  const auto first = reinterpret_cast<std::uintptr_t>(data);
  if (SyncTool* const tool = current) tool->forget(Range{first, first + size});
}

}  // namespace sync

std::unique_ptr<Tool> make_sync() { return std::make_unique<SyncTool>(); }

}  // namespace vitrine::glass
