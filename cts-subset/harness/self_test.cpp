// Cases that must fail, registered with --self-test only: they show that the suite can see each kind of failure.
#include "harness/self_test.h"

#include <csignal>

#include "harness/case.h"
#include "harness/run.h"

namespace vitrine::cts {
namespace {

bool on_device_under_test(const Run& run) { return &run.gpu == &gpus().device; }

int g_ordinary_runs = 0;

void ordinary(Run& run) {
  ++g_ordinary_runs;
  run.out("ramp", run.buffer_of<uint32_t>({1, 2, 3, 4}));
}

void one_bit(Run& run) { run.out("ramp", run.buffer_of<uint32_t>({1, 2, on_device_under_test(run) ? 7u : 3u, 4})); }

void blank(Run& run) { run.out("zeros", run.buffer(64)); }

void invalid_usage(Run& run) {
  VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
  info.size = 16;  // and no usage at all
  VkBuffer buffer;
  CTS_VK(vkCreateBuffer(run.device, &info, nullptr, &buffer));
  run.own(buffer, vkDestroyBuffer);
  ordinary(run);
}

void crash(Run& run) {
  if (on_device_under_test(run)) std::raise(SIGSEGV);
  ordinary(run);
}

/// The reference crashes unless this is the first case of its process.
void crash_of_reference(Run& run) {
  if (!on_device_under_test(run) && g_ordinary_runs > 0) std::raise(SIGSEGV);
  ordinary(run);
}

}  // namespace

void register_self_test() {
  cases().clear();
  generators().clear();
  AddCase("self", "identical", ordinary);
  AddCase("self", "one_bit", one_bit);
  AddCase("self", "crash", crash);
  AddCase("self", "identical_again", ordinary);
  AddCase("self", "crash_of_reference", crash_of_reference);
  AddCase("self", "blank", blank);
  AddCase("self", "invalid_usage", invalid_usage);
  AddGenerator("self", "identical_random", 3, [](Run& run) {
    run.out("random", run.buffer_of<uint32_t>({run.random.bits(), 1}));
  });
}

}  // namespace vitrine::cts
