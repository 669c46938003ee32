// VkQueryPool: counters that replay fills and the host reads.
#pragma once

#include <atomic>

#include "icd/object/device.h"
#include "raster/draw.h"

namespace vitrine::icd {

/// One counter per raster::Statistic.
inline constexpr std::uint32_t kStatisticsCounters =
    static_cast<std::uint32_t>(raster::Statistic::kComputeInvocations) + 1;

struct QueryPool : Object<VkQueryPool, VK_OBJECT_TYPE_QUERY_POOL> {
  QueryPool(const HostMemory& m, Device& owner, const VkQueryPoolCreateInfo& info);
  ~QueryPool();

  VkQueryType type;
  VkQueryPipelineStatisticFlags statistics;  ///< enabled ones: the values a result consists of
  Vector<std::uint32_t> selected;            ///< of performance queries: the counters that a result consists of
  bool wraps;                                ///< results of 32 bits are the low ones of 64; else they saturate
  std::shared_ptr<glass::Profile> profile;   ///< of performance queries: what they read
  std::uint32_t count;
  std::uint32_t stride;  ///< counters per query: all statistics in bit order; written and needed primitives;
                         ///< all of glass::profile_counters(); or one
  std::atomic<std::uint64_t>* counters;
  std::atomic<std::uint8_t>* available;

  std::atomic<std::uint64_t>* counters_of(std::uint32_t query) const { return counters + std::size_t{query} * stride; }
};

/// What timestamps are: CLOCK_MONOTONIC.
std::uint64_t monotonic_nanoseconds();

/// Sets the counters of a range to zero and the queries unavailable.
void reset_queries(QueryPool& pool, std::uint32_t first, std::uint32_t count);

/// Writes the results of a range as VkQueryResultFlags say (without waiting), `stride` bytes apart, no byte beyond
/// `size`. VK_NOT_READY if a query was not available.
VkResult write_query_results(const QueryPool& pool, std::uint32_t first, std::uint32_t count, std::byte* out,
                             std::size_t size, VkDeviceSize stride, VkQueryResultFlags flags);

}  // namespace vitrine::icd
