// Values that last until the library is unloaded. A static local is destroyed among the exit handlers, and so before
// the handlers that the application registered earlier, which may still draw (piglit closes its windows there); the
// main thread's thread_local values go earlier yet.
#pragma once

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

/// What is destroyed with its thread, or when the thread that it belongs to unloads the library. Not a thread_local
/// with a destructor: that keeps the library loaded, with its threads, for as long as the thread lives.
struct ThreadNode {
  virtual ~ThreadNode() = default;
  ThreadNode* next = nullptr;
};

/// Takes the node for the calling thread.
void keep_with_thread(ThreadNode* node) noexcept;

/// This thread's T, made at its first use and destroyed with the thread. A use after that makes another one.
template <class T>
T& per_thread() {
  thread_local T* value = nullptr;
  struct Node : ThreadNode {
    explicit Node(T** place) : slot(place) { *slot = &kept; }
    ~Node() override { *slot = nullptr; }
    Node(const Node&) = delete;
    Node& operator=(const Node&) = delete;
    T** slot;
    T kept{};
  };
  if (!value) keep_with_thread(new Node(&value));
  return *value;
}

}  // namespace vitrine::base
