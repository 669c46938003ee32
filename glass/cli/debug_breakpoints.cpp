// See debug_breakpoints.h.
#include "glass/cli/debug_breakpoints.h"

#include <algorithm>
#include <utility>

#include "glass/json_members.h"

namespace vitrine::glass::cli {

void Breakpoints::replace(const std::string& owner, json request) {
  std::vector<Row>& rows = rows_[owner];
  rows.clear();
  for (const json& row : list_of(request, "list")) rows.push_back({++last_id_, 0, number_of(row, "line"), false});
  requests_[owner] = std::move(request);
}

void Breakpoints::learn(const std::string& owner, const json& answer) {
  const json list = list_of(answer, "list");
  std::vector<Row>& rows = rows_[owner];
  for (std::size_t i = 0; i < std::min(list.size(), rows.size()); ++i) {
    rows[i].number = number_of(list[i], "number");
    rows[i].verified = list[i].value("verified", json(false)) == json(true);
    rows[i].line = number_of(list[i], "line", rows[i].line);
  }
}

Breakpoints::Row* Breakpoints::find(std::size_t number) {
  if (number == 0) return nullptr;
  for (auto& [owner, rows] : rows_) {
    const auto row = std::ranges::find(rows, number, &Row::number);
    if (row != rows.end()) return &*row;
  }
  return nullptr;
}

std::vector<Breakpoints::json> Breakpoints::learn_placed(const json& answer) {
  std::vector<json> news;
  for (const json& placed : list_of(answer, "list")) {
    Row* const row = find(number_of(placed, "number"));
    if (row == nullptr || row->verified) continue;
    row->verified = true;
    row->line = number_of(placed, "line", row->line);
    news.push_back({{"reason", "changed"}, {"breakpoint", describe(*row)}});
  }
  return news;
}

Breakpoints::json Breakpoints::describe(const Row& row) {
  json described = {{"id", row.id}, {"verified", row.verified}, {"line", row.line}};
  if (!row.verified) described["message"] = "no shader that has been made so far is there";
  return described;
}

Breakpoints::json Breakpoints::answer(const std::string& owner) const {
  json list = json::array();
  if (const auto rows = rows_.find(owner); rows != rows_.end())
    for (const Row& row : rows->second) list.push_back(describe(row));
  return {{"breakpoints", std::move(list)}};
}

Breakpoints::json Breakpoints::id_of(std::size_t number) {
  const Row* const row = find(number);
  return row != nullptr ? json(row->id) : json();
}

bool Breakpoints::are_all_verified() const {
  return std::ranges::all_of(rows_, [](const auto& set) { return std::ranges::all_of(set.second, &Row::verified); });
}

}  // namespace vitrine::glass::cli
