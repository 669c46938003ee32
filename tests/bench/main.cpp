// The benchmark's driver: runs each workload in a child process on Vitrine, lavapipe and SwiftShader in turn, several
// rounds, and prints medians and ratios. Usage: vitrine_bench [--rounds=N] [--filter=TEXT] [--icd=NAME=MANIFEST]...
// [--tools=LIST]...: another column, Vitrine with these tools, instead of the peers; what they report is thrown away.
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <string>

#include "bench.h"
#include "corpus/corpus.h"
#include "harness/shader.h"
#include "threads.h"

namespace vitrine::bench {
namespace {

struct Driver {
  std::string name, manifest;
  std::string tools = {};  ///< as VITRINE_TOOLS has them
};

cts::Gpu open_gpu() {
  VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
  application.apiVersion = VK_API_VERSION_1_1;
  VkInstanceCreateInfo info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
  info.pApplicationInfo = &application;
  cts::Gpu gpu;
  CTS_VK(vkCreateInstance(&info, nullptr, &gpu.instance));
  std::uint32_t count = 1;
  CTS_VK(vkEnumeratePhysicalDevices(gpu.instance, &count, &gpu.physical));
  if (count == 0) throw std::runtime_error("no device");
  vkGetPhysicalDeviceProperties(gpu.physical, &gpu.properties);
  vkGetPhysicalDeviceFeatures(gpu.physical, &gpu.features);
  vkGetPhysicalDeviceMemoryProperties(gpu.physical, &gpu.memory);
  const float priority = 1;
  VkDeviceQueueCreateInfo queue{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
  queue.queueCount = 1;
  queue.pQueuePriorities = &priority;
  VkDeviceCreateInfo device{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO};
  device.queueCreateInfoCount = 1;
  device.pQueueCreateInfos = &queue;
  device.pEnabledFeatures = &gpu.features;
  CTS_VK(vkCreateDevice(gpu.physical, &device, nullptr, &gpu.device));
  vkGetDeviceQueue(gpu.device, 0, 0, &gpu.queue);
  return gpu;
}

constexpr char kFirstFragment[] =
    "layout(location=0) in vec2 uv; layout(location=0) out vec4 o; void main() { o = vec4(uv, 0.5, 1.0); }";

/// From the first Vulkan call to a pixel on the host: a triangle with everything it needs.
void first_pixel(cts::Gpu& gpu) {
  Run run(gpu, 1, 0);
  cts::TargetSpec target_spec;
  const cts::Target target = cts::make_target(run, target_spec);
  cts::GraphicsSpec spec;
  spec.vertex = cts::kFullScreenVertex;
  spec.fragment = kFirstFragment;
  const VkPipeline pipeline = cts::make_pipeline(run, spec, target);
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    cts::bind_pipeline(cmd, pipeline);
    vkCmdDraw(cmd, 3, 1, 0, 0);
    vkCmdEndRenderPass(cmd);
  });
  if (run.download(target.colors[0], 0).at(2) == 0) throw std::runtime_error("the first pixel is blank");
}

/// Start-up rows: time without GLSL compilation (a dry run fills the shader cache), memory growth.
void run_startup() {
  cts::compile_glsl(VK_SHADER_STAGE_VERTEX_BIT, cts::kFullScreenVertex);
  cts::compile_glsl(VK_SHADER_STAGE_FRAGMENT_BIT, kFirstFragment);
  const double memory = resident_megabytes(), start = now();
  cts::Gpu gpu = open_gpu();
  first_pixel(gpu);
  std::printf("start_to_pixel %.6g\nstart_rss %.6g\n", (now() - start) * 1e3, resident_megabytes() - memory);
}

int run_child(const std::string& name) {
  try {
    if (name == "startup") {
      run_startup();
      return 0;
    }
    cts::Gpu gpu = open_gpu();
    for (const Workload& workload : workloads()) {
      if (name != workload.name) continue;
      Run run(gpu, 1, 0);
      std::printf("%s %.6g\n", workload.name, workload.measure(run));
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", name.c_str(), error.what());
    return 1;
  }
  return 0;
}

/// Runs one child and adds what it printed to `samples` ("row value" lines).
void spawn(const Driver& driver, const std::string& workload, std::map<std::string, std::vector<double>>& samples) {
  int pipe_ends[2];
  if (pipe(pipe_ends) != 0) return;
  const pid_t child = fork();
  if (child == 0) {
    dup2(pipe_ends[1], STDOUT_FILENO);
    close(pipe_ends[0]);
    setenv("VK_DRIVER_FILES", driver.manifest.c_str(), 1);
    setenv("VK_ICD_FILENAMES", driver.manifest.c_str(), 1);
    setenv("LP_PERF", "no_rast_linear", 1);
    setenv("MESA_SHADER_CACHE_DISABLE", "true", 1);
    setenv("VK_LOADER_LAYERS_DISABLE", "~all~", 1);
    setenv("VITRINE_TOOLS", driver.tools.c_str(), 1);
    for (const char* output :
         {"VITRINE_REPORT", "VITRINE_COVERAGE", "VITRINE_COUNTS", "VITRINE_TIMELINE", "VITRINE_SOURCES"})
      setenv(output, "/dev/null", 1);
    const std::string argument = "--child=" + workload;
    execl("/proc/self/exe", "vitrine_bench", argument.c_str(), nullptr);
    _exit(127);
  }
  close(pipe_ends[1]);
  if (FILE* output = fdopen(pipe_ends[0], "r")) {
    char row[64];
    double value;
    while (std::fscanf(output, "%63s %lf", row, &value) == 2) samples[row].push_back(value);
    std::fclose(output);
  }
  waitpid(child, nullptr, 0);
}

double median(std::vector<double> values) {
  if (values.empty()) return NAN;
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

struct Row {
  std::string name, unit;
  bool lower_is_better, runs_shaders, fixed_function;
};

/// What a geometric mean is made of.
struct Ratios {
  double log_sum = 0;
  std::size_t rows = 0;
  void add(double ratio) {
    log_sum += std::log(ratio);
    ++rows;
  }
  void print(const std::string& against, const char* which) const {
    if (rows != 0)
      std::printf("geometric mean against %s over %zu rows%s: %.2f\n", against.c_str(), rows, which,
                  std::exp(log_sum / static_cast<double>(rows)));
  }
};
/// Of one column: of all rows that count, and of those of shaders.
struct Means {
  Ratios all, shaders;
};

/// One table row; the ratios say how many times better the first driver is than each other one. Those of rows without
/// shaders count only where no tools are on.
void print_row(const Row& row, const std::vector<Driver>& drivers,
               const std::map<std::string, std::vector<double>>* samples, std::vector<Means>& means) {
  std::printf("| %-16s | %-9s |", row.name.c_str(), row.unit.c_str());
  std::vector<double> values;
  for (std::size_t d = 0; d < drivers.size(); ++d) {
    const auto found = samples[d].find(row.name);
    values.push_back(found == samples[d].end() ? NAN : median(found->second));
    std::printf(" %11.4g |", values.back());
  }
  for (std::size_t d = 1; d < drivers.size(); ++d) {
    const double ratio = row.lower_is_better ? values[d] / values[0] : values[0] / values[d];
    std::printf(" %10.2f |", ratio);
    if (!std::isfinite(ratio) || (!row.runs_shaders && !drivers[d].tools.empty())) continue;
    means[d].all.add(ratio);
    if (!row.fixed_function) means[d].shaders.add(ratio);
  }
  std::printf("\n");
  std::fflush(stdout);
}

void add_peers(std::vector<Driver>& drivers) {
  drivers.push_back({"lavapipe", "/usr/share/vulkan/icd.d/lvp_icd.x86_64.json"});
  const char* swiftshader = "/usr/lib/chromium/vk_swiftshader_icd.json";
  if (access(swiftshader, R_OK) == 0) drivers.push_back({"swiftshader", swiftshader});
}

void print_head(const std::vector<Driver>& drivers) {
  std::printf("| %-16s | %-9s |", "workload", "unit");
  for (const Driver& driver : drivers) std::printf(" %11s |", driver.name.c_str());
  for (std::size_t d = 1; d < drivers.size(); ++d) std::printf(" x %-8.8s |", drivers[d].name.c_str());
  std::printf("\n|---|---|");
  for (std::size_t column = 0; column < drivers.size() * 2 - 1; ++column) std::printf("---:|");
  std::printf("\n");
}

int run_parent(const std::vector<Driver>& drivers, int rounds, const std::string& filter) {
  std::vector<std::vector<Row>> groups{
      {{"start_to_pixel", "ms", true, false, true}, {"start_rss", "MB", true, false, true}}};
  for (const Workload& workload : workloads())
    groups.push_back(
        {{workload.name, workload.unit, workload.lower_is_better, workload.runs_shaders, workload.fixed_function}});
  print_head(drivers);
  std::vector<Means> means(drivers.size());
  for (const std::vector<Row>& group : groups) {
    if (group[0].name.find(filter) == std::string::npos) continue;
    std::vector<std::map<std::string, std::vector<double>>> samples(drivers.size());
    const std::string child = group.size() > 1 ? "startup" : group[0].name;
    for (int round = 0; round < rounds; ++round) {
      for (std::size_t d = 0; d < drivers.size(); ++d) spawn(drivers[d], child, samples[d]);
    }
    for (const Row& row : group) print_row(row, drivers, samples.data(), means);
  }
  for (std::size_t d = 1; d < drivers.size(); ++d) {
    means[d].all.print(drivers[d].name, drivers[d].tools.empty() ? "" : " that run shaders");
    if (!drivers[d].tools.empty()) means[d].shaders.print(drivers[d].name, " whose work is mostly shaders");
  }
  return 0;
}

}  // namespace
}  // namespace vitrine::bench

int main(int argc, char** argv) {
  using namespace vitrine::bench;
  std::vector<Driver> drivers, with_tools;
  std::string filter, threads;
  CorpusOptions corpus;
  std::string module;
  int rounds = 3;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    const auto value = [&](const char* name) {
      const std::size_t length = std::strlen(name);
      return argument.compare(0, length, name) == 0 ? argument.c_str() + length : nullptr;
    };
    if (const char* child = value("--child=")) return run_child(child);
    if (const char* text = value("--rounds=")) {
      rounds = std::max(1, std::atoi(text));
    } else if (const char* counts = value("--threads=")) {
      threads = counts;
    } else if (const char* folder = value("--corpus=")) {
      corpus.folder = folder;
    } else if (const char* every = value("--every=")) {
      corpus.every = static_cast<unsigned>(std::max(1, std::atoi(every)));
    } else if (const char* path = value("--corpus-module=")) {
      module = path;
    } else if (const char* pattern = value("--filter=")) {
      filter = pattern;
    } else if (const char* icd = value("--icd=")) {
      const char* equals = std::strchr(icd, '=');
      if (equals) drivers.push_back({std::string(icd, equals), equals + 1});
    } else if (const char* tools = value("--tools=")) {
      with_tools.push_back({tools, {}, tools});
    } else {
      std::fprintf(stderr,
                   "usage: %s [--rounds=N] [--filter=TEXT] [--icd=NAME=MANIFEST]... [--tools=LIST]...\n"
                   "       %s --corpus=FOLDER [--every=N] [--rounds=N] [--icd=NAME=MANIFEST]\n"
                   "       %s --threads=COUNT,... [--filter=TEXT] [--icd=NAME=MANIFEST]\n",
                   argv[0], argv[0], argv[0]);
      return 2;
    }
  }
  corpus.manifest = drivers.empty() ? BENCH_DEFAULT_ICD : drivers[0].manifest;
  corpus.rounds = rounds;
  if (!module.empty()) return run_corpus_module(module, corpus.manifest, rounds);
  if (!corpus.folder.empty()) return run_corpus(corpus);
  if (!threads.empty()) return run_threads(corpus.manifest, threads, filter);
  if (drivers.empty()) {
    drivers.push_back({"vitrine", BENCH_DEFAULT_ICD});
    if (with_tools.empty()) add_peers(drivers);
  }
  // Tools are those of the first driver, against which everything is held.
  for (Driver& driver : with_tools) {
    driver.manifest = drivers[0].manifest;
    drivers.push_back(driver);
  }
  return run_parent(drivers, rounds, filter);
}
