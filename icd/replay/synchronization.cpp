// Replay of queries, events and barriers.
#include <bit>

#include "glass/profile.h"
#include "icd/object/memory.h"
#include "icd/object/sync.h"
#include "icd/replay/replay.h"

namespace vitrine::icd {
namespace {

/// "If a query is used in a subpass with N views, N consecutive query indices are used": the first counts everything,
/// the others stay 0.
std::uint32_t query_indices(const ReplayState& state) {
  if (!state.pass) return 1;
  const std::uint32_t views = state.scope.view_mask;
  return views ? static_cast<std::uint32_t>(std::popcount(views)) : 1;
}

/// Queries become readable when their counters are final: now outside a pass, else when it is flushed.
void end_queries(ReplayState& state, QueryPool& pool, std::uint32_t query, bool timestamp = false) {
  const std::uint32_t end = std::min(query + query_indices(state), pool.count);
  for (std::uint32_t q = query; q < end; ++q) state.pending_queries.push_back({&pool, q, timestamp && q == query});
  if (!state.pass) publish_queries(state);
}

/// What an active query counts into; null ends it.
void set_counters(raster::QueryCounters& active, VkQueryType type, std::uint32_t index,
                  std::atomic<std::uint64_t>* counters) {
  if (type == VK_QUERY_TYPE_OCCLUSION) active.occlusion = counters;
  if (type == VK_QUERY_TYPE_PIPELINE_STATISTICS) active.statistics = counters;
  if (index >= raster::kMaxStreams) return;
  if (type == VK_QUERY_TYPE_TRANSFORM_FEEDBACK_STREAM_EXT) active.feedback[index] = counters;
  if (type == VK_QUERY_TYPE_PRIMITIVES_GENERATED_EXT) active.generated[index] = counters;
}

/// What was recorded before is done, and what comes is counted: by other shaders, in observed draws.
void begin_profile(ReplayState& state, const QueryPool& pool) {
  flush_pass(state);
  state.profiled = &pool;
  state.profile_started = pool.profile->read();
}

void end_profile(ReplayState& state, const QueryPool& pool, std::uint32_t query) {
  if (state.profiled != &pool) return;
  flush_pass(state);
  state.profiled = nullptr;
  const std::vector<std::uint64_t> now = pool.profile->read();
  for (std::size_t i = 0; i < now.size(); ++i)
    pool.counters_of(query)[i].store(now[i] - state.profile_started[i], std::memory_order_relaxed);
}

}  // namespace

void publish_queries(ReplayState& state) {
  if (state.pending_queries.empty()) return;
  const std::uint64_t now = monotonic_nanoseconds();
  {
    const std::lock_guard lock(state.device.sync_mutex);
    for (const PendingQuery& q : state.pending_queries) {
      if (q.timestamp) q.pool->counters_of(q.query)->store(now);
      q.pool->available[q.query].store(1, std::memory_order_release);
    }
  }
  state.pending_queries.clear();
  state.device.sync_changed.notify_all();
}

void execute(ReplayState& state, const CmdBeginQuery& command) {
  if (command.query >= command.pool->count) return;
  if (command.pool->profile) return begin_profile(state, *command.pool);
  set_counters(state.counters, command.pool->type, command.index, command.pool->counters_of(command.query));
}

void execute(ReplayState& state, const CmdEndQuery& command) {
  if (command.query >= command.pool->count) return;
  if (command.pool->profile) end_profile(state, *command.pool, command.query);
  set_counters(state.counters, command.pool->type, command.index, nullptr);
  end_queries(state, *command.pool, command.query);
}

void execute(ReplayState&, const CmdResetQueryPool& command) {
  reset_queries(*command.pool, command.first, command.count);
}

void execute(ReplayState& state, const CmdWriteTimestamp& command) {
  if (command.query >= command.pool->count) return;
  const bool later = command.after_work && state.pass;
  if (!later) command.pool->counters_of(command.query)->store(monotonic_nanoseconds());
  end_queries(state, *command.pool, command.query, later);
}

void execute(ReplayState&, const CmdCopyQueryPoolResults& command) {
  const Buffer& target = *command.target;
  if (!target.data || command.offset >= target.size) return;
  // Nothing to wait for: earlier commands are done.
  write_query_results(*command.pool, command.first, command.count, target.data + command.offset,
                      target.size - command.offset, command.stride, command.flags);
}

void execute(ReplayState& state, const CmdPipelineBarrier&) {
  if (state.pass) flush_pass(state);
}

void execute(ReplayState& state, const CmdSetEvent& command) {
  if (state.pass) flush_pass(state);
  set_event(state.device, *command.event, command.set);
}

void execute(ReplayState& state, const CmdWaitEvents& command) {
  if (state.pass) flush_pass(state);
  wait_events(state.device, command.events.data(), static_cast<std::uint32_t>(command.events.size()));
}

}  // namespace vitrine::icd
