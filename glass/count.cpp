// What shaders and fixed function cost, in numbers that are the same in every run, on every CPU and with any number of
// threads: instructions of SPIR-V that invocations ran, by kind; primitives and fragments by what became of them.
// Written to VITRINE_COUNTS ("%p" is the process; default counts.json); VITRINE_COUNT_LINES: with instructions by line,
// and the sources; VITRINE_COUNT_DRAWS: with every draw.
#include <cstdlib>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>

#include "glass/costs.h"
#include "glass/fates.h"
#include "glass/output.h"
#include "glass/tools.h"

namespace vitrine::glass {
namespace {

using Json = nlohmann::ordered_json;
Json json_of(const Costs& costs) {
  Json json = Json::object();
  for (const CostCounter& counter : cost_counters())
    if (const std::uint64_t value = counter.value(costs); value != 0 || !counter.is_kind) json[counter.name] = value;
  return json;
}

/// Adds to "lines" and "sources".
void add_lines(Json& lines, Json& sources, const CountedProgram& program) {
  program.for_each_line([&](const spirv::SourceFile& file, std::uint32_t number, std::uint64_t instructions) {
    Json& line = lines[file.name][std::to_string(number)];
    line = (line.is_null() ? 0 : line.get<std::uint64_t>()) + instructions;
    if (!file.text.empty()) sources[file.name] = file.text;
  });
}

void put(Json& json, const Fates& fates) {
  for (const FateCounter& counter : fate_counters())
    if (const std::uint64_t value = counter.value(fates); value != 0)
      (*counter.group != 0 ? json[counter.group] : json)[counter.name] = value;
}

/// Adds what fixed function did: to "total", "pipelines" and "draws".
void add_draws(Json& json, const DrawCounts& draws) {
  put(json["total"], draws.total());
  if (const Overdraw overdraw = draws.overdraw(); overdraw.pixels != 0) {
    json["total"]["shading"]["pixels"] = overdraw.pixels;
    json["total"]["shading"]["mostOverdraw"] = overdraw.most;
  }
  for (const auto& [name, fates] : draws.of_pipelines()) put(json["pipelines"][name], fates);
  for (const DrawCounts::Draw& draw : draws.of_draws())
    put(json["draws"][std::to_string(draw.submission) + "." + std::to_string(draw.command) + " " + draw.name + ", " +
                      draw.pipeline],
        draw.fates);
}

class CountTool : public Tool {
 public:
  spirv::exec::Interest interest() const override { return {.blocks = true}; }

  std::shared_ptr<ProgramTool> attach(const ShaderIdentity& shader, const spirv::Program& program) override {
    auto made = std::make_shared<CountedProgram>(shader, program);
    const std::lock_guard lock(mutex_);
    programs_.push_back(made);
    return made;
  }

  raster::DrawObserver* draws() override { return &draws_; }

  void write() override;

 private:
  std::mutex mutex_;
  std::vector<std::shared_ptr<CountedProgram>> programs_;
  DrawCounts draws_{std::getenv("VITRINE_COUNT_DRAWS") != nullptr};
};

void CountTool::write() {
  const std::lock_guard lock(mutex_);
  Costs total;
  std::map<std::string, Costs> stages, shaders;
  for (const auto& program : programs_) {
    const Costs costs = program->costs();
    if (costs.invocations == 0) continue;
    total.add(costs);
    stages[program->stage].add(costs);
    shaders[program->name].add(costs);
  }
  Json json{{"format", "vitrine-counters"}, {"version", 1}, {"total", json_of(total)}};
  for (const auto& [name, costs] : stages) json["stages"][name] = json_of(costs);
  for (const auto& [name, costs] : shaders) json["shaders"][name] = json_of(costs);
  add_draws(json, draws_);
  if (std::getenv("VITRINE_COUNT_LINES") != nullptr) {
    Json lines = Json::object(), sources = Json::object();
    for (const auto& program : programs_) add_lines(lines, sources, *program);
    json["lines"] = std::move(lines);
    json["sources"] = std::move(sources);
  }
  write_output("VITRINE_COUNTS", "counts.json", json.dump(1, ' ', false, Json::error_handler_t::replace) + '\n');
}

}  // namespace

std::unique_ptr<Tool> make_count() { return std::make_unique<CountTool>(); }

}  // namespace vitrine::glass
