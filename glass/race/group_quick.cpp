// What instructions do to memory, whole waves at a time: the common cases, in which nobody can race with anybody, are
// recorded quickly; the others go word by word through Group::touch(). See group.h.
#include <algorithm>
#include <bit>
#include <utility>

#include "glass/race/group.h"

namespace vitrine::glass::race {
namespace {

/// Whether another invocation has done something to the word since `from`.
bool other(const Slots& slots, std::uint32_t k, std::uint32_t who, std::uint32_t from) {
  return slots.time[k] >= from && slots.who[k] != who;
}

void put(Slots& slots, std::uint32_t k, const Record& record) {
  slots.who[k] = record.who;
  slots.time[k] = record.time;
  slots.site[k] = record.site;
  slots.used |= std::uint64_t{1} << k;
}

bool load_quickly(Page& page, std::uint32_t k, const Record& record, std::uint32_t from, std::uint32_t writes_from) {
  if (other(page.write, k, record.who, writes_from) || other(page.atomic, k, record.who, writes_from)) return false;
  if (!other(page.read, k, record.who, from)) {
    put(page.read, k, record);
  } else if (page.other.time[k] < from || page.other.who[k] == page.read.who[k]) {
    put(page.other, k, record);
  }
  return true;
}

bool operate_quickly(Page& page, std::uint32_t k, const Record& record, std::uint32_t from) {
  for (const Slots* slots : {&page.write, &page.read, &page.other})
    if (other(*slots, k, record.who, from)) return false;
  put(page.atomic, k, record);
  return true;
}

bool store_quickly(Page& page, std::uint32_t k, const Record& record, std::uint32_t value, std::uint32_t from) {
  for (const Slots* slots : {&page.write, &page.atomic, &page.read, &page.other})
    if (other(*slots, k, record.who, from)) return false;
  put(page.write, k, record);
  page.value[k] = value;
  return true;
}

/// Bit n goes to bit n << shift; bits that would go further than 63 are not set.
std::uint64_t spaced(std::uint64_t bits, std::uint32_t shift) {
  constexpr std::uint64_t kHalves[] = {0x00000000ffffffff, 0x0000ffff0000ffff, 0x00ff00ff00ff00ff,
                                       0x0f0f0f0f0f0f0f0f, 0x3333333333333333, 0x5555555555555555};
  for (; shift != 0; --shift)
    for (std::uint32_t i = 1; i < 6; ++i) bits = (bits | bits << (32u >> i)) & kHalves[i];
  return bits;
}

SharedLog::Kind kind_of(const Site& site) {
  if (site.is_atomic()) return SharedLog::Kind::kAtomic;
  return site.loads() ? SharedLog::Kind::kLoad : SharedLog::Kind::kStore;
}

}  // namespace

bool Group::fast(const Site& site) const {
  // What earlier workgroups did to shared memory is forgotten; to other memory, in a whole dispatch, it is not.
  const bool whole = whole_ && site.memory != Memory::kShared;
  if (whole || order_.hides(site.memory) || interlocked_ || !program_->compute()) return false;
  if (!site.is_atomic()) return true;
  return !program_->sites.has_narrow_scope && !site.order.releases() && !site.order.acquires() && order_.is_plain();
}

std::uint32_t Group::writes_from(const Site& site) const {
  return site.memory != Memory::kShared && program_->sites.has_private ? 1 : order_.from(site.memory);
}

bool Group::touch_quickly(const Site& site, const Record& record, std::uint64_t word, std::uint32_t value) {
  Page& page = page_of(site, word);
  const auto k = static_cast<std::uint32_t>(word % kPageWords);
  const std::uint32_t from = order_.from(site.memory);
  if (site.is_atomic()) return operate_quickly(page, k, record, from);
  return site.writes() ? store_quickly(page, k, record, value, from)
                       : load_quickly(page, k, record, from, writes_from(site));
}

void Group::touch_page(const Doing& by, Page& page, std::uint64_t word, const Row& row, const std::uint32_t* values) {
  const Site& now = program_->sites.all[by.site];
  const std::uint32_t from = order_.from(now.memory), written = now.loads() ? writes_from(now) : from;
  std::uint64_t slow = row.words;
  const bool quick = fast(now);
  if (quick) {
    slow = others(page.write, row, written) | others(page.read, row, from);
    if (!now.is_atomic()) slow |= others(page.atomic, row, written);
    if (!now.loads()) slow |= others(page.other, row, from);
  }
  Row rest = row;
  rest.words &= ~slow;
  put(now.is_atomic() ? page.atomic : now.loads() ? page.read : page.write, rest);
  const std::uint32_t lane_0 = row.who - by.wave.first;  // of the page's word 0; it may lie in front of the wave
  if (values != nullptr) put_words(page.value, rest.words, values, lane_0, row.shift);
  base::for_each_lane(slow, [&](std::size_t at) {
    const auto k = static_cast<std::uint32_t>(at), lane = lane_0 + (k >> row.shift);
    const std::uint32_t value = values != nullptr ? values[lane] : 0;
    const Record record{by.wave.first + lane, row.time, row.site};
    if (!quick || !touch_quickly(now, record, word + k, value)) touch(by, record.who, {word + k, 15, value});
  });
}

bool Group::touch_rows(const Span& span, const Spread& spread) {
  const Site& now = program_->sites.all[span.by.site];
  if (by_word_ || spread.step == 0 || now.element_bytes != 4 || span.by.wave.names != nullptr) return false;
  if (((span.base + spread.least + now.first) & 3) != 0 || std::uint64_t{spread.most} + now.end > span.size)
    return false;
  for (std::uint32_t part = 0; part < now.touched.count; ++part)
    if (now.action == spirv::Access::kStore && span.values[now.component[part]] == nullptr) return false;
  for (std::uint32_t part = 0; part < now.touched.count; ++part)
    touch_row(span, now.touched.at[part] + spread.least, spread.step, span.values[now.component[part]]);
  return true;
}

void Group::touch_row(const Span& span, std::uint32_t offset, std::uint32_t step, const std::uint32_t* values) {
  const Site& now = program_->sites.all[span.by.site];
  const auto shift = static_cast<std::uint32_t>(std::countr_zero(step / 4));
  auto lane = static_cast<std::uint32_t>(std::countr_zero(span.lanes));
  std::uint64_t word = (span.base + offset) / 4;
  while (lane < base::kWaveWidth) {
    const auto k = static_cast<std::uint32_t>(word % kPageWords);
    const std::uint32_t count = std::min<std::uint32_t>(((kPageWords - 1 - k) >> shift) + 1, base::kWaveWidth - lane);
    const Row row{spaced(span.lanes >> lane & base::first_lanes(count), shift) << k,
                  span.by.wave.first + lane - (k >> shift), shift, span.by.time, span.by.site << 4 | 15};
    if (row.words != 0) touch_page(span.by, page_of(now, word), word - k, row, values);
    word += std::uint64_t{count} << shift;
    lane += count;
  }
}

void Group::touch_part(const Span& span, std::uint32_t part) {
  const Site& now = program_->sites.all[span.by.site];
  const std::uint32_t bytes = now.element_bytes;
  const std::uint32_t* const values = now.writes() ? span.values[now.component[part]] : nullptr;
  std::uint64_t words[base::kWaveWidth];
  base::LaneMask whole = 0;
  base::for_each_lane(span.lanes, [&](std::size_t lane) {
    const std::uint32_t at = span.offsets[lane] + now.touched.at[part];
    if (std::uint64_t{at} + bytes > span.size) return;
    words[lane] = (span.base + at) / 4;
    if (bytes == 4 && ((span.base + at) & 3) == 0)
      whole |= base::LaneMask{1} << lane;
    else
      touch_bytes(span.by, span.by.wave[lane], span.base + at, bytes, values != nullptr ? values[lane] : 0);
  });
  touch_words(span.by, whole, words, values);
}

void Group::touch_words(const Doing& by, base::LaneMask lanes, const std::uint64_t* words,
                        const std::uint32_t* values) {
  const Site& now = program_->sites.all[by.site];
  const bool quick = fast(now);
  std::uint64_t last = ~std::uint64_t{0}, before = last;
  base::for_each_lane(lanes, [&](std::size_t lane) {
    // Two readers of a word are kept: the others of a row add nothing.
    if (quick && now.loads() && words[lane] == last && last == before) return;
    before = std::exchange(last, words[lane]);
    const Record record{by.wave[lane], by.time, by.site << 4 | 15};
    const std::uint32_t value = values != nullptr ? values[lane] : 0;
    if (!quick || !touch_quickly(now, record, words[lane], value)) touch(by, record.who, {words[lane], 15, value});
  });
}

void Group::touch_span(const Span& span) {
  if (span.lanes != 0) touch_spread(span, spread_of(span.offsets, span.lanes));
}

void Group::touch_spread(const Span& span, const Spread& spread) {
  if (touch_rows(span, spread)) return;
  for (std::uint32_t part = 0; part < program_->sites.all[span.by.site].touched.count; ++part) touch_part(span, part);
}

bool Group::log_shared(const Doing& by, base::LaneMask lanes, const Offsets& offsets) {
  const Site& now = program_->sites.all[by.site];
  if (by_word_ || (now.is_atomic() ? !fast(now) : !logs_loads_)) return false;
  if (log_.is_full()) settle_shared();
  return log_.add(kind_of(now), by, lanes, offsets, now.first, now.end);
}

void Group::touch_shared(const Span& span) {
  const Site& now = program_->sites.all[span.by.site];
  const Spread spread = spread_of(span.offsets, span.lanes);
  const bool met =
      log_.meets(kind_of(now), std::uint64_t{spread.least} + now.first, std::uint64_t{spread.most} + now.end);
  if ((met && log_.meets_written(kind_of(now), span.by, span.lanes, spread, now.first, now.end)) || !fast(now))
    settle_shared();
  touch_spread(span, spread);
}

void Group::stop_following() {
  if (follower_.is_on() && follower_.give_up()) record_followed();
}

void Group::record_followed() {
  follower_.for_each_since_barrier([&](std::uint32_t site, std::uint32_t first, base::LaneMask lanes,
                                       const Offsets& offsets, const Follower::Values& values) {
    Span span{{site, {first}, order_.time()}, lanes, offsets, 0, shared_bytes_};
    std::copy_n(values, 4, span.values);
    if (!program_->sites.all[site].is_logged() || !log_shared(span.by, lanes, offsets)) touch_shared(span);
  });
}

void Group::settle_shared() {
  if (log_.empty()) return;
  log_.for_each(shared_bytes_, [&](const Span& span, const Spread& spread) { touch_spread(span, spread); });
  log_.forget();
}

}  // namespace vitrine::glass::race
