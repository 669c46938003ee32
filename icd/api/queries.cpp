// Query pools, their results and the recording of queries (Vulkan 1.3.239, Queries).
#include <time.h>

#include <algorithm>
#include <cstring>
#include <memory>

#include "glass/profile.h"
#include "glass/session.h"
#include "icd/edge/util.h"
#include "icd/entry_points.h"
#include "icd/object/memory.h"
#include "icd/object/query_pool.h"
#include "icd/object/sync.h"
#include "icd/record/command_buffer.h"

namespace vitrine::icd {
namespace {

/// Writes one value of a result in 32 or 64 bits; values that do not fit in 32 saturate, or lose their high bits.
class ResultWriter {
 public:
  ResultWriter(std::byte* out, std::size_t size, bool wide, bool wraps)
      : out_(out), size_(size), wide_(wide), wraps_(wraps) {}

  void put(std::uint64_t value) {
    const std::size_t bytes = wide_ ? 8 : 4;
    if (size_ >= bytes) {
      const std::uint64_t stored = wide_ || wraps_ ? value : std::min<std::uint64_t>(value, UINT32_MAX);
      std::memcpy(out_, &stored, bytes);  // little endian: the low word comes first
      out_ += bytes;
      size_ -= bytes;
    }
  }
  void skip() {
    const std::size_t bytes = std::min<std::size_t>(size_, wide_ ? 8 : 4);
    out_ += bytes;
    size_ -= bytes;
  }

 private:
  std::byte* out_;
  std::size_t size_;
  bool wide_, wraps_;
};

void write_values(const QueryPool& pool, std::uint32_t query, bool write, ResultWriter& writer) {
  const std::atomic<std::uint64_t>* counters = pool.counters_of(query);
  if (pool.type == VK_QUERY_TYPE_PERFORMANCE_QUERY_KHR) {
    for (const std::uint32_t index : pool.selected) writer.put(counters[index].load(std::memory_order_relaxed));
    return;
  }
  const bool statistics = pool.type == VK_QUERY_TYPE_PIPELINE_STATISTICS;
  for (std::uint32_t bit = 0; bit < pool.stride; ++bit) {
    if (statistics && !(pool.statistics & (1u << bit))) continue;
    if (write) {
      writer.put(counters[bit].load(std::memory_order_relaxed));
    } else {
      writer.skip();
    }
  }
}

std::uint32_t counters_per_query(VkQueryType type) {
  if (type == VK_QUERY_TYPE_PIPELINE_STATISTICS) return kStatisticsCounters;
  if (type == VK_QUERY_TYPE_PERFORMANCE_QUERY_KHR) return static_cast<std::uint32_t>(glass::profile_counters().size());
  return type == VK_QUERY_TYPE_TRANSFORM_FEEDBACK_STREAM_EXT ? 2 : 1;  // written, needed
}

std::shared_ptr<glass::Profile> profile_of(Device& device) {
  const std::lock_guard lock(device.sync_mutex);
  if (!device.profile) device.profile = std::make_shared<glass::Profile>(glass::session().draws());
  return device.profile;
}

/// "for an unsigned integer query, the 32-bit result value must be equal to the 32 least significant bits of the
/// equivalent 64-bit result value" (Vulkan 1.4.309, VK_KHR_maintenance7); the reference saturates.
bool wraps_results([[maybe_unused]] const Device& device) {
#ifdef VK_KHR_maintenance7
  return device.features.test(Feature::maintenance7);
#else
  return false;
#endif
}

}  // namespace

QueryPool::QueryPool(const HostMemory& m, Device& owner, const VkQueryPoolCreateInfo& info)
    : Object(m),
      type(info.queryType),
      statistics(info.pipelineStatistics),
      selected(m),
      wraps(wraps_results(owner)),
      count(info.queryCount),
      stride(counters_per_query(info.queryType)) {
  const std::size_t counter_bytes = sizeof(*counters) * count * stride;
  if (const auto* wanted = find_in_chain<VkQueryPoolPerformanceCreateInfoKHR>(info.pNext);
      wanted && type == VK_QUERY_TYPE_PERFORMANCE_QUERY_KHR) {
    profile = profile_of(owner);
    selected.assign(wanted->pCounterIndices, wanted->pCounterIndices + wanted->counterIndexCount);
    std::erase_if(selected, [&](std::uint32_t index) { return index >= stride; });
  }
  // Atomics of zero. Not written here: of the billions that may be asked for, few are used.
  auto* storage = static_cast<std::byte*>(
      m.allocate_zeros(counter_bytes + sizeof(*available) * count, VK_SYSTEM_ALLOCATION_SCOPE_OBJECT));
  counters = reinterpret_cast<std::atomic<std::uint64_t>*>(storage);
  available = reinterpret_cast<std::atomic<std::uint8_t>*>(storage + counter_bytes);
}

QueryPool::~QueryPool() { memory.free(counters); }

void reset_queries(QueryPool& pool, std::uint32_t first, std::uint32_t count) {
  for (std::uint32_t q = first; q < first + count && q < pool.count; ++q) {
    for (std::uint32_t i = 0; i < pool.stride; ++i) pool.counters_of(q)[i].store(0, std::memory_order_relaxed);
    pool.available[q].store(0, std::memory_order_release);
  }
}

VkResult write_query_results(const QueryPool& pool, std::uint32_t first, std::uint32_t count, std::byte* out,
                             std::size_t size, VkDeviceSize stride, VkQueryResultFlags flags) {
  VkResult result = VK_SUCCESS;
  for (std::uint32_t i = 0; i < count && first + i < pool.count; ++i) {
    const std::uint64_t offset = i * stride;
    if (offset >= size) break;
    const bool available = pool.available[first + i].load(std::memory_order_acquire);
    if (!available) result = VK_NOT_READY;
    const bool performance = pool.type == VK_QUERY_TYPE_PERFORMANCE_QUERY_KHR;  // VkPerformanceCounterResultKHR
    ResultWriter writer(out + offset, size - offset, performance || (flags & VK_QUERY_RESULT_64_BIT), pool.wraps);
    write_values(pool, first + i, available || (flags & VK_QUERY_RESULT_PARTIAL_BIT), writer);
    if (flags & VK_QUERY_RESULT_WITH_AVAILABILITY_BIT) writer.put(available);
  }
  return result;
}

std::uint64_t monotonic_nanoseconds() {
  // POSIX: the clock behind steady_clock too, and what the time domain names.
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<std::uint64_t>(now.tv_sec) * 1'000'000'000 + static_cast<std::uint64_t>(now.tv_nsec);
}

namespace entry {

VKAPI_ATTR VkResult VKAPI_CALL CreateQueryPool(VkDevice device, const VkQueryPoolCreateInfo* info,
                                               const VkAllocationCallbacks* allocator, VkQueryPool* pool) {
  Device& d = from_handle<Device>(device);
  *pool = to_handle(create_object<QueryPool>(d.memory, allocator, d, *info));
  return VK_SUCCESS;
}

VKAPI_ATTR void VKAPI_CALL DestroyQueryPool(VkDevice, VkQueryPool pool, const VkAllocationCallbacks*) {
  destroy_handle<QueryPool>(pool);
}

VKAPI_ATTR VkResult VKAPI_CALL GetQueryPoolResults(VkDevice device, VkQueryPool pool, std::uint32_t first,
                                                   std::uint32_t count, std::size_t size, void* data,
                                                   VkDeviceSize stride, VkQueryResultFlags flags) {
  Device& d = from_handle<Device>(device);
  const QueryPool& p = from_handle<QueryPool>(pool);
  if (flags & VK_QUERY_RESULT_WAIT_BIT) {
    const auto available = [&] {
      for (std::uint32_t q = first; q < first + count && q < p.count; ++q) {
        if (!p.available[q].load(std::memory_order_acquire)) return false;
      }
      return true;
    };
    std::unique_lock lock(d.sync_mutex);
    d.sync_changed.wait(lock, [&] { return d.lost || available(); });
  }
  if (is_lost(d)) return VK_ERROR_DEVICE_LOST;
  return write_query_results(p, first, count, static_cast<std::byte*>(data), size, stride, flags);
}

VKAPI_ATTR void VKAPI_CALL ResetQueryPool(VkDevice, VkQueryPool pool, std::uint32_t first, std::uint32_t count) {
  reset_queries(from_handle<QueryPool>(pool), first, count);
}

VKAPI_ATTR VkResult VKAPI_CALL GetPhysicalDeviceCalibrateableTimeDomainsEXT(VkPhysicalDevice, std::uint32_t* count,
                                                                            VkTimeDomainEXT* domains) {
  OutArray<VkTimeDomainEXT> array(count, domains);
  for (const VkTimeDomainEXT domain : {VK_TIME_DOMAIN_DEVICE_EXT, VK_TIME_DOMAIN_CLOCK_MONOTONIC_EXT})
    array.push(domain);
  return array.result();
}

/// The device's clock is the monotonic one: they are never apart.
VKAPI_ATTR VkResult VKAPI_CALL GetCalibratedTimestampsEXT(VkDevice, std::uint32_t count,
                                                          const VkCalibratedTimestampInfoEXT*,
                                                          std::uint64_t* timestamps, std::uint64_t* deviation) {
  std::fill_n(timestamps, count, monotonic_nanoseconds());
  *deviation = 0;
  return VK_SUCCESS;
}

VKAPI_ATTR void VKAPI_CALL CmdBeginQuery(VkCommandBuffer buffer, VkQueryPool pool, std::uint32_t query,
                                         VkQueryControlFlags flags) {
  record(buffer, icd::CmdBeginQuery{&from_handle<QueryPool>(pool), query, flags});
}

VKAPI_ATTR void VKAPI_CALL CmdEndQuery(VkCommandBuffer buffer, VkQueryPool pool, std::uint32_t query) {
  record(buffer, icd::CmdEndQuery{&from_handle<QueryPool>(pool), query});
}

VKAPI_ATTR void VKAPI_CALL CmdResetQueryPool(VkCommandBuffer buffer, VkQueryPool pool, std::uint32_t first,
                                             std::uint32_t count) {
  record(buffer, icd::CmdResetQueryPool{&from_handle<QueryPool>(pool), first, count});
}

VKAPI_ATTR void VKAPI_CALL CmdWriteTimestamp(VkCommandBuffer buffer, VkPipelineStageFlagBits stage, VkQueryPool pool,
                                             std::uint32_t query) {
  const bool after_work = stage != VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT;
  record(buffer, icd::CmdWriteTimestamp{&from_handle<QueryPool>(pool), query, after_work});
}

VKAPI_ATTR void VKAPI_CALL CmdWriteTimestamp2(VkCommandBuffer buffer, VkPipelineStageFlags2 stage, VkQueryPool pool,
                                              std::uint32_t query) {
  const bool after_work = stage != VK_PIPELINE_STAGE_2_TOP_OF_PIPE_BIT && stage != VK_PIPELINE_STAGE_2_NONE;
  record(buffer, icd::CmdWriteTimestamp{&from_handle<QueryPool>(pool), query, after_work});
}

VKAPI_ATTR void VKAPI_CALL CmdCopyQueryPoolResults(VkCommandBuffer buffer, VkQueryPool pool, std::uint32_t first,
                                                   std::uint32_t count, VkBuffer target, VkDeviceSize offset,
                                                   VkDeviceSize stride, VkQueryResultFlags flags) {
  record(buffer, icd::CmdCopyQueryPoolResults{&from_handle<QueryPool>(pool), first, count, &from_handle<Buffer>(target),
                                              offset, stride, flags});
}

}  // namespace entry
}  // namespace vitrine::icd
