// Breakpoints as the editor knows them: by numbers of their own, since it sets them before there is a process, and
// unverified until a shader has their line (Debug Adapter Protocol, Breakpoint).
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace vitrine::glass::cli {

class Breakpoints {
 public:
  using json = nlohmann::json;

  /// All of an owner: the name of a file, or empty: of functions. `request`: what the process is asked for, with a
  /// "list" of rows.
  void replace(const std::string& owner, json request);
  /// What the process says of an owner's: a "list" of {number, verified, line}, one for each row.
  void learn(const std::string& owner, const json& answer);
  /// What the process says of all: a "list" of {number, line}, of those that a shader has. The editor's view of those
  /// that it did not know to be there: the bodies of events.
  std::vector<json> learn_placed(const json& answer);
  /// The body of the editor's answer.
  json answer(const std::string& owner) const;
  /// Null: none.
  json id_of(std::size_t number);
  /// By owner.
  const std::map<std::string, json>& requests() const { return requests_; }
  bool are_all_verified() const;

 private:
  struct Row {
    std::size_t id = 0;      ///< the editor's
    std::size_t number = 0;  ///< the process's; 0: it has not been told yet
    std::size_t line = 0;
    bool verified = false;
  };
  /// By the process's number; null: none.
  Row* find(std::size_t number);
  static json describe(const Row& row);

  std::map<std::string, json> requests_;
  std::map<std::string, std::vector<Row>> rows_;  ///< of each request
  std::size_t last_id_ = 0;
};

}  // namespace vitrine::glass::cli
