// A whole small program (compute, a render pass, a submission) in which every host allocation fails in turn: each time
// an error code, never a crash, and nothing leaks.
#include <atomic>
#include <cstddef>
#include <limits>
#include <new>

#include "tests/icd/small_program.h"

namespace vitrine::icd::test {
namespace {

constexpr long kUnlimited = std::numeric_limits<long>::max();
std::atomic<long> allocations_left = kUnlimited;

void* allocate_or_throw(std::size_t size, std::size_t alignment) {
  if (allocations_left.load(std::memory_order_relaxed) != kUnlimited &&
      allocations_left.fetch_sub(1, std::memory_order_relaxed) <= 0) {
    throw std::bad_alloc();
  }
  void* memory = std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
  if (!memory) throw std::bad_alloc();
  return memory;
}

/// Not inlined: the compiler would see new-expressions end in free() and warn.
[[gnu::noinline]] void give_back(void* memory) { std::free(memory); }

TEST(Exhaustion, TheProgramRuns) {
  CountingAllocator allocator;
  Program p;
  p.allocator = allocator.callbacks();
  ASSERT_EQ(run(p), VK_SUCCESS);
  check_results(p);
  destroy(p);
  EXPECT_EQ(allocator.live(), 0u);
}

TEST(Exhaustion, EveryFailingAllocationIsAnErrorAndLeaksNothing) {
  CountingAllocator allocator;
  std::size_t n = 0;
  for (; n < 2000; ++n) {
    allocator.fail_after(n);
    Program p;
    p.allocator = allocator.callbacks();
    const VkResult result = run(p);
    destroy(p);
    ASSERT_EQ(allocator.live(), 0u) << "after failing allocation " << n;
    if (result == VK_SUCCESS) break;
    // Memory that runs out while a submitted batch is replayed loses the device: the submission cannot be undone.
    const bool submitted = p.fence != VK_NULL_HANDLE;
    ASSERT_TRUE(result == VK_ERROR_OUT_OF_HOST_MEMORY || (submitted && result == VK_ERROR_DEVICE_LOST))
        << "allocation " << n << " gave " << result;
  }
  EXPECT_GE(n, 20u) << "fewer allocations than objects";
  EXPECT_LT(n, 2000u);
}

TEST(Exhaustion, LaterSubmissionsTakeTheMemoryOfEarlierOnes) {
  CountingAllocator allocator;
  Program p;
  p.allocator = allocator.callbacks();
  ASSERT_EQ(run(p), VK_SUCCESS);
  VkQueue queue;
  VK_GET(p.instance, GetDeviceQueue)(p.device, 0, 0, &queue);
  ASSERT_EQ(VK_GET(p.instance, QueueWaitIdle)(queue), VK_SUCCESS);
  auto info = make_struct<VkSubmitInfo>();
  info.commandBufferCount = 1;
  info.pCommandBuffers = &p.commands;
  for (int i = 0; i < 3; ++i) {
    allocator.fail_after(1);  // that of the call; the batch and its lists are there
    EXPECT_EQ(VK_GET(p.instance, QueueSubmit)(queue, 1, &info, VK_NULL_HANDLE), VK_SUCCESS);
    EXPECT_EQ(VK_GET(p.instance, QueueWaitIdle)(queue), VK_SUCCESS);
  }
  EXPECT_FALSE(allocator.failed());
  allocator.fail_after(~std::size_t{0});
  destroy(p);
  EXPECT_EQ(allocator.live(), 0u);
}

/// Runs the steps that compile shaders and draw while every allocation from the n-th on, on any thread, throws.
VkResult run_starved(Program& p, long n) {
  VkResult result = VK_SUCCESS;
  for (const auto step : {make_device, make_resources, make_descriptors, make_render_pass}) {
    result = step(p);
    if (result != VK_SUCCESS) return result;
  }
  allocations_left = n;
  for (const auto step : {make_pipelines, record, submit}) {
    result = step(p);
    if (result != VK_SUCCESS) break;
  }
  allocations_left = kUnlimited;
  return result;
}

TEST(Exhaustion, MemoryThatEndsInsideTheDriverIsAnErrorToo) {
  std::size_t failures = 0;
  // Every allocation up to the 200th, then ever fewer: a shader's compilation makes tens of thousands.
  for (long n = 0; n < 2'000'000; n += 1 + n / 200) {
    Program p;
    const VkResult result = run_starved(p, n);
    if (result == VK_SUCCESS) {
      check_results(p);
      destroy(p);
      break;
    }
    ++failures;
    const bool submitted = p.fence != VK_NULL_HANDLE;
    EXPECT_TRUE(result == VK_ERROR_OUT_OF_HOST_MEMORY || (submitted && result == VK_ERROR_DEVICE_LOST))
        << "allocation " << n << " gave " << result;
    destroy(p);
  }
  EXPECT_GE(failures, 200u);
}

}  // namespace
}  // namespace vitrine::icd::test

// The test program's own operator new, so that allocations inside the driver and its libraries can fail.
void* operator new(std::size_t size) { return vitrine::icd::test::allocate_or_throw(size, alignof(std::max_align_t)); }
void* operator new(std::size_t size, std::align_val_t alignment) {
  return vitrine::icd::test::allocate_or_throw(size, static_cast<std::size_t>(alignment));
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  try {
    return operator new(size);
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}
void operator delete(void* memory) noexcept { vitrine::icd::test::give_back(memory); }
void operator delete(void* memory, std::size_t) noexcept { vitrine::icd::test::give_back(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { vitrine::icd::test::give_back(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { vitrine::icd::test::give_back(memory); }
