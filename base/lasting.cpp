// The list of values that last until the library is unloaded.
#include "base/lasting.h"

#include <pthread.h>

#include <mutex>

namespace vitrine::base {
namespace {

std::mutex mutex;
LastingNode* newest = nullptr;

void destroy_list(void* first) {
  for (ThreadNode* node = static_cast<ThreadNode*>(first); node;) {
    ThreadNode* const next = node->next;
    delete node;
    node = next;
  }
}

/// Its values: the first node of each thread, which destroys its list when it ends.
pthread_key_t key;
bool has_key = false;
pthread_once_t key_made = PTHREAD_ONCE_INIT;
void make_key() { has_key = pthread_key_create(&key, &destroy_list) == 0; }

/// A destructor of the shared object, not of a C++ static: those of a process run after all of its exit handlers. What
/// other threads have, which may be at work in a process that ends, stays.
[[gnu::destructor]] void destroy_all() {
  while (newest) {
    LastingNode* node = newest;
    newest = node->next;
    delete node;
  }
  if (!has_key) return;
  destroy_list(pthread_getspecific(key));
  pthread_key_delete(key);
}

}  // namespace

void keep_until_unload(LastingNode* node) noexcept {
  const std::lock_guard lock(mutex);
  node->next = newest;
  newest = node;
}

void keep_with_thread(ThreadNode* node) noexcept {
  pthread_once(&key_made, &make_key);
  if (!has_key) return;  // the process has no more keys: the value lasts
  node->next = static_cast<ThreadNode*>(pthread_getspecific(key));
  pthread_setspecific(key, node);
}

}  // namespace vitrine::base
