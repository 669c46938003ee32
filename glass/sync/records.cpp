// See records.h.
#include "glass/sync/records.h"

#include <algorithm>

namespace vitrine::glass::sync {

std::shared_ptr<Who> host(bool writes, const char* command, std::string resource) {
  auto who = std::make_shared<Who>();
  who->what = writes ? "write by the host" : "read by the host";
  who->address.command_name = command;
  who->resource = std::move(resource);
  who->place = who->address.command_name + who->what + who->resource;
  return who;
}

void Records::split(std::uintptr_t at) {
  auto piece = pieces_.lower_bound(at);
  if (piece == pieces_.begin()) return;
  --piece;
  if (piece->second.end <= at) return;
  pieces_.emplace_hint(std::next(piece), at, Piece{piece->second.end, piece->second.state});
  piece->second.end = at;
}

Records::Pieces::iterator Records::settle(Pieces::iterator at) {
  if (at->second.state.empty()) return pieces_.erase(at);
  if (at == pieces_.begin()) return std::next(at);
  const auto before = std::prev(at);
  if (before->second.end != at->first || before->second.state != at->second.state) return std::next(at);
  before->second.end = at->second.end;
  return pieces_.erase(at);
}

void Records::join_at(std::uintptr_t at) {
  if (const auto piece = pieces_.find(at); piece != pieces_.end()) settle(piece);
}

void Records::forget(const Range& range) {
  if (range.first >= range.end) return;
  split(range.first);
  split(range.end);
  pieces_.erase(pieces_.lower_bound(range.first), pieces_.lower_bound(range.end));
}

void Records::forget_until(Tag tag) {
  for (auto at = pieces_.begin(); at != pieces_.end();) {
    State& state = at->second.state;
    if (state.write.tag <= tag) state.write = {}, state.passages.clear();
    std::erase_if(state.reads, [&](const Past& read) { return read.tag <= tag; });
    at = settle(at);
  }
}

}  // namespace vitrine::glass::sync
