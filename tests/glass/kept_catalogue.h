// The catalogues of planted faults and races for other programs: where VITRINE_TEST_CATALOGUE names a folder, every
// module in which something was found goes there, with what was found. tests/glass/catalogue_bugs_test.py runs them
// through Vulkan.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include <vulkan/vulkan_core.h>

namespace vitrine::glass::test {

/// The folder; null: nobody asked.
inline const char* catalogue_folder() { return std::getenv("VITRINE_TEST_CATALOGUE"); }

inline void keep_module(const std::string& name, const std::vector<std::uint32_t>& module) {
  std::ofstream file(std::string(catalogue_folder()) + "/" + name + ".spv", std::ios::binary);
  file.write(reinterpret_cast<const char*>(module.data()), static_cast<std::streamsize>(module.size() * 4));
}

/// What stands in the stages that are not the fault's.
inline void keep_plain(VkShaderStageFlagBits stage, const std::vector<std::uint32_t>& module) {
  if (catalogue_folder()) keep_module("plain" + std::to_string(stage), module);
}

/// NAME.spv and NAME.case: stage, workgroups and tool in one line, then a finding a line.
inline void keep_case(const std::string& tool, VkShaderStageFlagBits stage, std::uint32_t groups,
                      const std::vector<std::uint32_t>& module, const std::vector<std::string>& found) {
  if (!catalogue_folder() || found.empty()) return;
  static int number = 0;
  const testing::TestInfo& test = *testing::UnitTest::GetInstance()->current_test_info();
  std::string name = std::string(test.test_suite_name()) + "." + test.name() + "." + std::to_string(number++);
  for (char& c : name)
    if (c == '/') c = '-';
  keep_module(name, module);
  std::ofstream file(std::string(catalogue_folder()) + "/" + name + ".case");
  file << stage << " " << groups << " " << tool << "\n";
  for (const std::string& text : found) file << text << "\n";
}

}  // namespace vitrine::glass::test
