// See debug_breakpoints.h.
#include "glass/cli/debug_breakpoints.h"

#include <algorithm>
#include <utility>

#include "glass/cli/debug_json.h"

namespace vitrine::glass::cli {

void Breakpoints::replace(const std::string& owner, json request) {
  Set& set = sets_[owner];
  set.rows.clear();
  for (const json& row : list_of(request, "list")) set.rows.push_back({++last_id_, 0, number_of(row, "line"), false});
  set.request = std::move(request);
}

void Breakpoints::learn(const std::string& owner, const json& answer) {
  const json list = list_of(answer, "list");
  std::vector<Row>& rows = sets_[owner].rows;
  for (std::size_t i = 0; i < std::min(list.size(), rows.size()); ++i) {
    rows[i].number = number_of(list[i], "number");
    rows[i].verified = list[i].value("verified", json(false)) == json(true);
    rows[i].line = number_of(list[i], "line", rows[i].line);
  }
}

std::vector<Breakpoints::json> Breakpoints::learn_placed(const json& answer) {
  std::vector<json> news;
  for (const json& placed : list_of(answer, "list")) {
    for (auto& [owner, set] : sets_) {
      for (Row& row : set.rows) {
        if (row.verified || row.number == 0 || row.number != number_of(placed, "number")) continue;
        row.verified = true;
        row.line = number_of(placed, "line", row.line);
        news.push_back({{"reason", "changed"}, {"breakpoint", describe(row)}});
      }
    }
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
  if (const auto set = sets_.find(owner); set != sets_.end())
    for (const Row& row : set->second.rows) list.push_back(describe(row));
  return {{"breakpoints", std::move(list)}};
}

Breakpoints::json Breakpoints::id_of(std::size_t number) const {
  for (const auto& [owner, set] : sets_)
    for (const Row& row : set.rows)
      if (row.number == number && number != 0) return row.id;
  return {};
}

std::map<std::string, Breakpoints::json> Breakpoints::requests() const {
  std::map<std::string, json> requests;
  for (const auto& [owner, set] : sets_) requests.emplace(owner, set.request);
  return requests;
}

bool Breakpoints::are_all_verified() const {
  return std::ranges::all_of(sets_,
                             [](const auto& set) { return std::ranges::all_of(set.second.rows, &Row::verified); });
}

}  // namespace vitrine::glass::cli
