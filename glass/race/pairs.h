// Pairs of places that race, one finding each, with how often and who was first.
#pragma once

#include <map>
#include <mutex>
#include <string>
#include <tuple>
#include <vector>

#include "glass/race/conflict.h"

namespace vitrine::glass::race {

class Pairs {
 public:
  void add(const Conflict& conflict, const spirv::ObservedCommand* command);
  /// In an order that does not depend on threads; each pair once.
  std::vector<Finding> take();
  bool empty();

 private:
  using Key = std::tuple<int, const Told*, std::uint64_t, const Told*, std::uint64_t>;
  using First = std::tuple<std::uint64_t, std::uint32_t, Who, Who, std::uint64_t>;
  struct Entry {
    std::uint64_t count = 0;
    First first;
    Finding finding;
    bool all_equal = true, delivered = false;
  };
  std::mutex mutex_;
  std::map<Key, Entry> entries_;
};

}  // namespace vitrine::glass::race
