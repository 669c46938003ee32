// The counters of VK_KHR_performance_query: what shaders and fixed function cost while a query is active. A device that
// has a pool of such queries has one; its shaders and draws are counted in queries alone.
#pragma once

#include <mutex>
#include <vector>

#include "glass/costs.h"
#include "glass/draw_observers.h"
#include "glass/fates.h"
#include "glass/tool.h"

namespace vitrine::glass {

struct ProfileCounter {
  std::string name, category, description;
  bool is_bytes = false;
};
/// In a fixed order; the same in every process.
const std::vector<ProfileCounter>& profile_counters();

class Profile : public Tool {
 public:
  /// `others`: who else observes draws, or null.
  explicit Profile(raster::DrawObserver* others);

  spirv::exec::Interest interest() const override { return {.blocks = true}; }
  std::shared_ptr<ProgramTool> attach(const ShaderIdentity& shader, const spirv::Program& program) override;
  /// Of draws in a query.
  raster::DrawObserver* draws() override { return observers_.observer(); }

  /// All counters of everything that is done so far, as profile_counters() has them.
  std::vector<std::uint64_t> read() const;

 private:
  mutable std::mutex mutex_;
  std::vector<std::shared_ptr<CountedProgram>> programs_;
  DrawCounts draws_{false};
  DrawObservers observers_;
};

}  // namespace vitrine::glass
