// Who touched which bytes last: the last write of each byte, and the reads since.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "glass/finding.h"
#include "glass/sync/byte_set.h"
#include "glass/sync/order.h"

namespace vitrine::glass::sync {

/// One access of one command as findings tell of it.
struct Who {
  std::string what;      ///< "store of 4 bytes", "read by a copy"
  std::string resource;  ///< "buffer 'mesh' (96 bytes)"; empty: unknown
  std::string place;     ///< tells it apart from other accesses of the program: findings are told once for two places
  Address address;
  std::uintptr_t base = 0;  ///< of the buffer; 0: it is none, offsets say nothing
};

/// The host, which calls that command.
std::shared_ptr<Who> host(bool writes, const char* command, std::string resource);

/// Accesses of one command that use memory in one way, told apart only where somebody asks: so that what several lines
/// of a shader touch in turns is not as many pieces.
struct Several {
  std::vector<std::pair<ByteSet, std::shared_ptr<const Who>>> parts;
};

/// An access that has happened.
struct Past {
  Use use;
  Tag tag = 0;
  std::uint64_t pass = 0;                    ///< of accesses to attachments: the subpass; else 0
  std::shared_ptr<const Who> who;            ///< null: none has; of several, the first
  std::shared_ptr<const Several> several{};  ///< null: `who` alone
  bool operator==(const Past&) const = default;
  /// Who touched a byte.
  const Who& who_at(std::uintptr_t address) const {
    for (std::size_t i = 0; several && i < several->parts.size(); ++i)
      if (several->parts[i].first.contains(address)) return *several->parts[i].second;
    return *who;
  }
};

/// What is known of some bytes.
struct State {
  Past write;  ///< `who` null: none is known
  std::vector<Passage> passages;
  std::vector<Past> reads;  ///< the last one of each use
  bool empty() const { return !write.who && reads.empty(); }
  bool operator==(const State&) const = default;
};

class Records {
 public:
  /// Calls f(range, state) for all bytes of a range, piece by piece; f may change the state.
  template <class F>
  void update(const Range& range, F&& f) {
    if (range.first >= range.end) return;
    split(range.first);
    split(range.end);
    auto at = pieces_.lower_bound(range.first);
    for (std::uintptr_t here = range.first; here < range.end;) {
      if (at == pieces_.end() || at->first > here) {
        const std::uintptr_t next = at == pieces_.end() ? range.end : std::min(at->first, range.end);
        at = pieces_.emplace_hint(at, here, Piece{next, {}});
      }
      f(Range{here, at->second.end}, at->second.state);
      here = at->second.end;
      at = settle(at);
    }
    join_at(range.end);
  }
  /// The same of bytes of which something is known; f may not change it.
  template <class F>
  void look(const Range& range, F&& f) const {
    auto at = pieces_.upper_bound(range.first);
    if (at != pieces_.begin() && std::prev(at)->second.end > range.first) --at;
    for (; at != pieces_.end() && at->first < range.end; ++at)
      f(Range{std::max(at->first, range.first), std::min(at->second.end, range.end)}, at->second.state);
  }
  /// The memory is gone.
  void forget(const Range& range);
  /// What happened up to `tag` happens before all that comes.
  void forget_until(Tag tag);
  std::size_t size() const { return pieces_.size(); }

 private:
  struct Piece {
    std::uintptr_t end = 0;
    State state;
  };
  using Pieces = std::map<std::uintptr_t, Piece>;

  void split(std::uintptr_t at);
  /// Joins a piece with the one before it if they are equal, or drops it if it is empty; the next one.
  Pieces::iterator settle(Pieces::iterator at);
  void join_at(std::uintptr_t at);

  Pieces pieces_;  ///< by their first byte
};

}  // namespace vitrine::glass::sync
