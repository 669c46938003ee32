// Counters by number, from the tables of costs and fates.
#include "glass/profile.h"

#include "base/lasting.h"

namespace vitrine::glass {
namespace {

std::vector<ProfileCounter> make_counters() {
  std::vector<ProfileCounter> counters;
  for (const CostCounter& c : cost_counters()) counters.push_back({c.name, "shaders", c.description, c.is_bytes});
  for (const FateCounter& c : fate_counters()) {
    const std::string group = *c.group != 0 ? c.group : "vertices";
    counters.push_back(
        {*c.group != 0 ? group + " " + c.name : c.name, group, c.description, std::string_view(c.name) == "bytes"});
  }
  return counters;
}

}  // namespace

const std::vector<ProfileCounter>& profile_counters() {
  static const std::vector<ProfileCounter>& counters = base::lasting(make_counters);
  return counters;
}

Profile::Profile(raster::DrawObserver* others) {
  if (others) observers_.add(*others);
  observers_.add(draws_);
}

std::shared_ptr<ProgramTool> Profile::attach(const ShaderIdentity& shader, const spirv::Program& program) {
  auto made = std::make_shared<CountedProgram>(shader, program);
  const std::lock_guard lock(mutex_);
  programs_.push_back(made);
  return made;
}

std::vector<std::uint64_t> Profile::read() const {
  Costs costs;
  {
    const std::lock_guard lock(mutex_);
    for (const auto& program : programs_) costs.add(program->costs());
  }
  const Fates fates = draws_.total();
  std::vector<std::uint64_t> values;
  for (const CostCounter& counter : cost_counters()) values.push_back(counter.value(costs));
  for (const FateCounter& counter : fate_counters()) values.push_back(counter.value(fates));
  return values;
}

}  // namespace vitrine::glass
