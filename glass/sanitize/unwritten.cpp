// Keeping and sorting out reads of what nothing has written.
#include "glass/sanitize/unwritten.h"

#include <algorithm>

namespace vitrine::glass::sanitize {
namespace {

/// Reads that are kept of one place and one owner.
constexpr std::size_t kMostReads = 1024;

const void* owner_of(const spirv::ObservedCommand* command) { return command ? command->owner : nullptr; }

}  // namespace

bool UnwrittenRead::holds() const {
  const auto written = [](const Piece& piece) { return piece.written(); };
  return needs_all ? std::none_of(pieces.begin(), pieces.end(), written)
                   : !std::all_of(pieces.begin(), pieces.end(), written);
}

void UnwrittenReads::add(const ReadPlace& place, const spirv::ObservedCommand* command, const Id& id,
                         const Order& order, UnwrittenRead read) {
  const std::lock_guard lock(mutex_);
  any_.store(true, std::memory_order_relaxed);
  Reads& reads = reads_[{owner_of(command), place.program, place.number, place.rule}];
  reads.origin = place.origin;
  std::vector<Read>& kept = reads.kept;
  if (kept.size() == kMostReads) {
    // What has been written since will not become a finding.
    std::erase_if(kept, [](const Read& r) { return !r.read.holds(); });
    std::make_heap(kept.begin(), kept.end());
  }
  if (kept.size() == kMostReads) {
    ++reads.others;
    if (kept.front().order < order) return;
    std::pop_heap(kept.begin(), kept.end());
    kept.pop_back();
  }
  kept.push_back({order, id, command, std::move(read)});
  std::push_heap(kept.begin(), kept.end());
}

void UnwrittenReads::tell(const Key& key, const Reads& reads) {
  if (reads.kept.empty()) return;
  const Read& first = *std::min_element(reads.kept.begin(), reads.kept.end());
  key.program->places.add({key.number, key.rule}, reads.kept.size() + reads.others, first.order, [&] {
    Finding finding;
    finding.rule = &rule(key.rule);
    finding.message = first.read.message();
    finding.address = key.program->context.address(first.command, first.id, reads.origin.spirv_id, reads.origin.place);
    return finding;
  });
}

void UnwrittenReads::settle(const void* owner) {
  if (!any_.load(std::memory_order_relaxed)) return;
  const std::lock_guard lock(mutex_);
  const auto begin = reads_.lower_bound({owner, nullptr, 0, {}});
  auto end = begin;
  for (; end != reads_.end() && end->first.owner == owner; ++end) {
    std::erase_if(end->second.kept, [](const Read& r) { return !r.read.holds(); });
    tell(end->first, end->second);
  }
  for (auto at = begin; at != end; ++at)
    for (const Read& r : at->second.kept)
      for (const Piece& piece : r.read.pieces) piece.region->fill(piece.address, piece.bytes, ByteState::kWritten);
  reads_.erase(begin, end);
  any_.store(!reads_.empty(), std::memory_order_relaxed);
}

}  // namespace vitrine::glass::sanitize
