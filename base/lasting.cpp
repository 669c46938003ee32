// The list of values that last until the library is unloaded.
#include "base/lasting.h"

#include <mutex>

namespace vitrine::base {
namespace {

std::mutex mutex;
LastingNode* newest = nullptr;

/// A destructor of the shared object, not of a C++ static: those of a process run after all of its exit handlers.
[[gnu::destructor]] void destroy_all() {
  while (newest) {
    LastingNode* node = newest;
    newest = node->next;
    delete node;
  }
}

}  // namespace

void keep_until_unload(LastingNode* node) noexcept {
  const std::lock_guard lock(mutex);
  node->next = newest;
  newest = node;
}

}  // namespace vitrine::base
