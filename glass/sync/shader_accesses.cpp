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

/// What threads have gathered of a site.
struct Gathered {
  ByteSet bytes;
  std::vector<ByteSet> levels;
};

/// What a stage of a command did.
bool same_run(const Told& a, const Told& b) {
  return a.command == b.command && a.program->context.stage == b.program->context.stage;
}

class Run {
 public:
  Run(const Told& first, Hazards& hazards)
      : hazards_(hazards),
        tag_(make_tag(first.command->submission, first.command->command, Part::kWork)),
        stage_(shader_stage(first.program->context.stage)) {}

  void add(const Told& told, const Gathered& gathered) {
    const Site& site = told.program->all[told.site];
    const std::shared_ptr<const Who> who = who_of(told);
    for (const auto& access : {site.read, site.write})
      if (access && !gathered.bytes.empty()) add({*access, site.atomic}, gathered.bytes, who);
    std::vector<std::vector<Range>> levels;
    for (const ByteSet& level : gathered.levels)
      if (!level.empty()) levels.push_back(level.ranges());
    if (site.read && !levels.empty()) hazards_.touch(tag_, {{stage_, *site.read}, 0, {}, who, std::move(levels)});
  }

  /// Sites that use memory in one way together.
  void tell() {
    for (auto& [way, uses] : uses_) {
      const std::shared_ptr<const Who> who = uses.several->parts[0].second;
      const bool alone = uses.several->parts.size() == 1;
      Touch touch{{stage_, way.first, way.second}, 0, uses.bytes.ranges(), who, {}};
      if (!alone) touch.several = std::move(uses.several);
      hazards_.touch(tag_, std::move(touch));
    }
  }

 private:
  struct Uses {
    ByteSet bytes;
    std::shared_ptr<Several> several = std::make_shared<Several>();
  };
  using Way = std::pair<Access, bool>;  ///< and whether by atomic operations
  void add(Way way, const ByteSet& bytes, const std::shared_ptr<const Who>& who) {
    Uses& uses = uses_[way];
    uses.bytes.add(bytes);
    uses.several->parts.emplace_back().first.add(bytes);
    uses.several->parts.back().second = who;
  }

  Hazards& hazards_;
  const Tag tag_;
  const Stage stage_;
  std::map<Way, Uses> uses_;
};

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
  for (auto at = all.begin(); at != all.end();) {
    const auto end = std::find_if(at, all.end(), [&](const auto& one) { return !same_run(one.first, at->first); });
    Run run(at->first, hazards);
    for (; at != end; ++at) run.add(at->first, at->second);
    run.tell();
  }
}

}  // namespace vitrine::glass::sync
