// Debug labels (VK_EXT_debug_utils) that are open: of a queue, or of the command buffers that it runs one after the
// other. Kept only where tools are on.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace vitrine::icd {

class LabelStack {
 public:
  void begin(std::string_view name) {
    drop_inserted();
    open_.emplace_back(name);
  }
  /// One more than were begun does nothing.
  void end() {
    drop_inserted();
    if (!open_.empty()) open_.pop_back();
  }
  /// A label of one point: stands until the next label of any kind.
  void insert(std::string_view name) {
    begin(name);
    inserted_ = true;
  }
  /// Outermost first.
  const std::vector<std::string>& open() const { return open_; }

 private:
  void drop_inserted() {
    if (inserted_) open_.pop_back();
    inserted_ = false;
  }

  std::vector<std::string> open_;
  bool inserted_ = false;
};

}  // namespace vitrine::icd
