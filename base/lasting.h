// Values that last until the library is unloaded. A static local is destroyed among the exit handlers, and so before
// the handlers that the application registered earlier, which may still draw (piglit closes its windows there); the
// main thread's thread_local values go earlier yet.
#pragma once

#include <utility>

namespace vitrine::base {

/// What is destroyed when the library is unloaded or the process has run its exit handlers.
struct LastingNode {
  virtual ~LastingNode() = default;
  LastingNode* next = nullptr;
};

/// Takes the node. Nodes are destroyed in the reverse order of these calls.
void keep_until_unload(LastingNode* node) noexcept;

/// Makes a value that lasts: static Pool& pool = lasting([] { return Pool(threads); });
template <class F>
auto& lasting(F&& make) {
  struct Node : LastingNode {
    explicit Node(F& f) : value(f()) {}
    decltype(make()) value;
  };
  Node* node = new Node(make);
  keep_until_unload(node);
  return node->value;
}

/// This thread's T, made at its first use and destroyed with the thread. A use after that, in an exit handler, makes
/// another one.
template <class T>
T& per_thread() {
  struct Owner {
    T** slot;
    ~Owner() { delete std::exchange(*slot, nullptr); }
  };
  thread_local T* value = nullptr;
  if (!value) {
    thread_local const Owner owner{&value};
    static_cast<void>(owner);
    value = new T;
  }
  return *value;
}

}  // namespace vitrine::base
