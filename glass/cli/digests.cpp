// See digests.h.
#include "glass/cli/digests.h"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace vitrine::glass::cli {
namespace {

DigestLine read_line(const nlohmann::json& json) {
  DigestLine line{
      json.at("submission"), json.at("command"), json.at("name"), json.at("labels"), json.at("pipeline"), {}, {}};
  if (json.contains("differs")) line.differs = json.at("differs").get<std::uint64_t>();
  for (const auto& [number, digest] : json.at("memory").items()) line.memory[std::stoull(number)] = digest;
  return line;
}

}  // namespace

std::optional<Digests> read_digests(std::string_view text) {
  Digests digests;
  try {
    while (!text.empty()) {
      const std::size_t end = std::min(text.find('\n'), text.size());
      digests.push_back(read_line(nlohmann::json::parse(text.substr(0, end))));
      text.remove_prefix(std::min(end + 1, text.size()));
    }
  } catch (const std::exception&) {
    return std::nullopt;
  }
  return digests;
}

std::optional<Parting> first_parting(const Digests& before, const Digests& after) {
  std::map<std::uint64_t, std::string> here, there;
  for (std::size_t i = 0; i < std::min(before.size(), after.size()); ++i) {
    for (const auto& [number, digest] : before[i].memory) here[number] = digest;
    for (const auto& [number, digest] : after[i].memory) there[number] = digest;
    for (const auto& [number, digest] : here)
      if (const auto other = there.find(number); other != there.end() && other->second != digest)
        return Parting{before[i], number};
  }
  return std::nullopt;
}

}  // namespace vitrine::glass::cli
