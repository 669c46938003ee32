// Files of counters: added up over processes, compared.
#include "glass/cli/counters.h"

#include <fnmatch.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "glass/report/json.h"

namespace vitrine::glass::cli {
namespace {

using Json = nlohmann::ordered_json;

bool is_header(std::string_view name) { return name == "version" || name == "format"; }

/// Whole where both are and their sum fits.
Json sum_of(const Json& a, const Json& b) {
  std::int64_t sum = 0;
  const bool whole = a.is_number_integer() && b.is_number_integer();
  if (whole && !__builtin_add_overflow(a.get<std::int64_t>(), b.get<std::int64_t>(), &sum)) return sum;
  return a.get<double>() + b.get<double>();
}

void add(Json& sum, const Json& part) {
  for (const auto& [name, value] : part.items()) {
    Json* const there = sum.contains(name) ? &sum[name] : nullptr;
    if (!there)
      sum[name] = value;
    else if (there->is_object() && value.is_object())
      add(*there, value);
    else if (is_header(name))
      continue;
    else if (name.starts_with("most") && there->is_number() && value.is_number())
      *there = std::max(*there, value);
    else if (there->is_number() && value.is_number())
      *there = sum_of(*there, value);
  }
}

void collect(const Json& group, const std::string& path, Counters& counters) {
  for (const auto& [name, value] : group.items()) {
    if (value.is_object())
      collect(value, path + name + "/", counters);
    else if (value.is_number() && !is_header(name))
      counters[path + name] = value.get<double>();
  }
}

double value_of(const Counters& counters, const std::string& name) {
  const auto entry = counters.find(name);
  return entry == counters.end() ? 0 : entry->second;
}

}  // namespace

std::optional<std::string> sum_of_counters(std::string_view a, std::string_view b) {
  Json sum = Json::parse(a, nullptr, false);
  const Json part = Json::parse(b, nullptr, false);
  if (!sum.is_object() || !part.is_object()) return std::nullopt;
  add(sum, part);
  return sum.dump(1, ' ', false, Json::error_handler_t::replace) + '\n';
}

std::optional<Counters> read_counters(std::string_view text) {
  const Json json = Json::parse(text, nullptr, false);
  if (!json.is_object()) return std::nullopt;
  Counters counters;
  collect(json, "", counters);
  return counters;
}

std::vector<std::pair<std::string, double>> dearest_shaders(const Counters& counters) {
  constexpr std::string_view kGroup = "shaders/", kCounter = "/instructions";
  std::vector<std::pair<std::string, double>> shaders;
  for (const auto& [name, value] : counters)
    if (name.starts_with(kGroup) && name.ends_with(kCounter) && name.size() > kGroup.size() + kCounter.size())
      shaders.emplace_back(name.substr(kGroup.size(), name.size() - kGroup.size() - kCounter.size()), value);
  std::stable_sort(shaders.begin(), shaders.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
  return shaders;
}

std::vector<std::string> names_in_group(const Counters& counters, const std::string& group) {
  std::vector<std::string> names;
  for (const auto& [name, value] : counters) {
    if (!name.starts_with(group + "/")) continue;
    const std::string rest = name.substr(group.size() + 1);
    const std::string first = rest.substr(0, rest.find('/'));
    if (names.empty() || names.back() != first) names.push_back(first);
  }
  return names;
}

std::string annotated_sources(std::string_view text) {
  const Json json = Json::parse(text, nullptr, false);
  const Json none = Json::object();
  const auto group = [&](const Json& of, const std::string& name) -> const Json& {
    return of.is_object() && of.contains(name) && of[name].is_object() ? of[name] : none;
  };
  std::string result;
  for (const auto& [file, source] : group(json, "sources").items()) {
    if (!source.is_string()) continue;
    const Json& costs = group(group(json, "lines"), file);
    result += "\n" + file + "\n";
    std::istringstream lines(source.get<std::string>());
    std::size_t number = 1;
    for (std::string line; std::getline(lines, line); ++number) {
      const std::string key = std::to_string(number);
      const bool known = costs.contains(key) && costs[key].is_number_unsigned();
      std::string cost = known ? std::to_string(costs[key].get<std::uint64_t>()) : "";
      cost.insert(0, std::size_t{14} - std::min<std::size_t>(cost.size(), 14), ' ');
      result += cost + " | " + line + "\n";
    }
  }
  return result;
}

double CounterChange::growth() const {
  if (before == 0) return after == 0 ? 0 : std::numeric_limits<double>::infinity();
  return (after - before) / before * 100;
}

std::vector<CounterChange> changes(const Counters& before, const Counters& after, const std::string& pattern) {
  std::set<std::string> names;
  for (const auto& [name, value] : before) names.insert(name);
  for (const auto& [name, value] : after) names.insert(name);
  std::vector<CounterChange> result;
  for (const std::string& name : names) {
    if (pattern == "*" && name.starts_with("lines/")) continue;
    const CounterChange change{name, value_of(before, name), value_of(after, name)};
    if (change.before != change.after && ::fnmatch(pattern.c_str(), name.c_str(), 0) == 0) result.push_back(change);
  }
  return result;
}

}  // namespace vitrine::glass::cli
