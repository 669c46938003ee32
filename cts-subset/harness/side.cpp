// Runs a case on one device.
#include "harness/side.h"

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "harness/execute.h"
#include "harness/options.h"
#include "harness/run.h"

namespace vitrine::cts {
namespace {

uint64_t attempt_seed(const Case& c, uint32_t attempt) { return case_seed(c) + attempt * 0x9e3779b97f4a7c15u; }

}  // namespace

SideResult run_side(Gpu& gpu, const Case& c, uint32_t attempt) {
  SideResult result;
  take_validation_errors();
  try {
    Run run(gpu, attempt_seed(c, attempt), c.index);
    const auto collect = [&] {
      result.outputs = std::move(run.outputs);
      result.notes = std::move(run.notes);
      run.inputs.given().numbers(run.random.state());
      result.inputs = run.inputs.of_case();
      result.modules = run.inputs.of_modules();
    };
    try {
      c.body(run);
    } catch (...) {
      collect();
      throw;
    }
    collect();
  } catch (const Unsupported& missing) {
    result.unsupported = missing.what();
  } catch (const VulkanError& error) {
    result.error = error.what();
    result.lost = error.code == VK_ERROR_DEVICE_LOST;
  } catch (const std::exception& error) {
    result.error = error.what();
  }
  result.validation = take_validation_errors();
  if (result.lost) recreate(gpu);
  return result;
}

bool all_blank(const std::vector<Output>& outputs) {
  return !outputs.empty() && std::all_of(outputs.begin(), outputs.end(), is_blank);
}

bool refused(const SideResult& device) {
  if (device.error.find("Pipelines") == std::string::npos) return false;
  for (const std::string& text : device.validation)
    if (text.ends_with("is not supported")) return true;
  return false;
}

std::string result_path(const Case& c, const std::string& part) {
  std::string stem = full_name(c) + "." + part;
  std::replace(stem.begin(), stem.end(), '/', '_');
  std::error_code ignored;
  std::filesystem::create_directories(options().results, ignored);
  return options().results + "/" + stem;
}

void write_notes(const Case& c, const SideResult& side) {
  for (const auto& [name, text] : side.notes) std::ofstream(result_path(c, name) + ".txt") << text;
}

}  // namespace vitrine::cts
