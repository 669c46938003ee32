// See shader_accesses.h.
#include "glass/sync/shader_accesses.h"

#include <algorithm>
#include <tuple>

#include "glass/sanitize/descriptors.h"

namespace vitrine::glass::sync {
namespace {

/// Whose touches are told together, in an order that every run has.
struct Told {
  const spirv::ObservedCommand* command = nullptr;
  const Sites* program = nullptr;
  std::size_t site = 0;

  auto key() const {
    const Site& s = program->all[site];
    return std::tuple(command->submission, command->command, program->context.stage, std::cref(s.place).get(), site);
  }
};
struct Less {
  bool operator()(const Told& a, const Told& b) const { return a.key() < b.key(); }
};

std::shared_ptr<const Who> who_of(const Told& told) {
  const Site& site = told.program->all[told.site];
  auto who = std::make_shared<Who>();
  who->what = site.what;
  who->place = site.place;
  who->address = told.program->context.address(told.command, {}, site.origin.spirv_id, site.origin.place);
  who->address.invocation = {};
  if (site.set != spirv::ir::kAnySet) who->resource = sanitize::resource_text(told.command, site.set, site.slot, {});
  return who;
}

}  // namespace

ShaderAccesses::Thread& ShaderAccesses::thread() {
  const std::lock_guard lock(mutex_);
  std::unique_ptr<Thread>& thread = threads_[std::this_thread::get_id()];
  if (!thread) thread = std::make_unique<Thread>();
  return *thread;
}

Touches* ShaderAccesses::here(const Sites& program, const spirv::ObservedCommand* command) {
  if (command == nullptr || program.all.empty()) return nullptr;
  Thread& mine = thread();
  const std::lock_guard lock(mine.mutex);
  const Key key{command, &program};
  if (mine.recent == key) return mine.found;
  const auto [at, added] = mine.touches.try_emplace(key, program.all.size());
  mine.recent = key;
  return mine.found = &at->second;
}

void ShaderAccesses::tell(const void* owner, Hazards& hazards) {
  struct Gathered {
    ByteSet bytes;
    std::vector<ByteSet> levels;
  };
  std::map<Told, Gathered, Less> all;
  {
    const std::lock_guard lock(mutex_);
    for (const auto& [id, thread] : threads_) {
      const std::lock_guard own(thread->mutex);
      for (auto at = thread->touches.begin(); at != thread->touches.end();) {
        const auto& [command, program] = at->first;
        if (command->owner != owner) {
          ++at;
          continue;
        }
        for (std::size_t site = 0; site < at->second.bytes.size(); ++site)
          if (!at->second.bytes[site].empty()) all[{command, program, site}].bytes.add(at->second.bytes[site]);
        for (const auto& [site, levels] : at->second.levels) {
          std::vector<ByteSet>& sum = all[{command, program, site}].levels;
          if (sum.empty()) sum = std::vector<ByteSet>(levels.size());
          for (std::size_t level = 0; level < levels.size(); ++level) sum[level].add(levels[level]);
        }
        at = thread->touches.erase(at);
        thread->recent = {};
      }
    }
  }
  for (const auto& [told, gathered] : all) {
    const Site& site = told.program->all[told.site];
    const Tag tag = make_tag(told.command->submission, told.command->command, Part::kWork);
    const Stage stage = shader_stage(told.program->context.stage);
    const std::shared_ptr<const Who> who = who_of(told);
    const std::vector<Range> ranges = gathered.bytes.ranges();
    std::vector<std::vector<Range>> levels;
    for (const ByteSet& level : gathered.levels)
      if (!level.empty()) levels.push_back(level.ranges());
    if (site.read) hazards.touch(tag, {{stage, *site.read}, 0, ranges, who, std::move(levels)});
    if (site.write) hazards.touch(tag, {{stage, *site.write}, 0, ranges, who, {}});
  }
}

}  // namespace vitrine::glass::sync
