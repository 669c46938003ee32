// Chooses the reference.
#include "harness/reference.h"

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <utility>

#include "harness/gpu.h"
#include "harness/options.h"
#include "harness/record.h"

namespace vitrine::cts {
namespace {

std::optional<Record> g_record;

/// What the driver of a manifest says of its version: it is loaded for that, and unloaded. Empty if it is not there.
std::string installed_driver(const std::string& manifest) {
  if (!std::filesystem::exists(manifest)) return {};
  setenv("VK_DRIVER_FILES", manifest.c_str(), 1);
  VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
  application.apiVersion = VK_API_VERSION_1_1;
  VkInstanceCreateInfo info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
  info.pApplicationInfo = &application;
  Gpu gpu;
  if (vkCreateInstance(&info, nullptr, &gpu.instance) != VK_SUCCESS) return {};
  uint32_t count = 1;
  vkEnumeratePhysicalDevices(gpu.instance, &count, &gpu.physical);
  const std::string driver = count ? driver_info(gpu) : "";
  vkDestroyInstance(gpu.instance, nullptr);
  return driver;
}

std::string recorded_as(const Record& record) {
  return "recorded of " + record.driver + ", seed " + std::to_string(record.seed);
}

}  // namespace

const Record* recorded_reference() { return g_record ? &*g_record : nullptr; }

void load_recorded_reference() {
  if (options().recorded.empty()) return;
  Record record = read_record(options().recorded);
  const std::string instead = "; for that, name the reference itself: --reference=MANIFEST";
  if (options().mutate) throw std::runtime_error("mutants have no recorded results" + instead);
  if (options().seed != record.seed)
    throw std::runtime_error(options().recorded + " has results of seed " + std::to_string(record.seed) + ", not of " +
                             std::to_string(options().seed) + instead);
  g_record = std::move(record);
}

std::string choose_reference(Options& options) {
  prepare_reference();
  if (!options.recorded.empty()) return recorded_as(read_record(options.recorded)) + " (" + options.recorded + ")";
  const std::string installed = installed_driver(options.reference_icd);
  const std::string live = (installed.empty() ? "no driver" : installed) + " (" + options.reference_icd + ")";
  const bool must_be_live =
      options.reference_is_given || !options.record.empty() || options.mutate || options.self_test;
  if (must_be_live || !std::filesystem::exists(default_record())) return live;
  const Record record = read_record(default_record());
  if (installed == record.driver) return live + ", the recorded version";
  options.recorded = default_record();
  return recorded_as(record) + ", because " +
         (installed.empty() ? "lavapipe is not installed" : installed + " is installed");
}

}  // namespace vitrine::cts
