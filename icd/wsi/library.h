// A shared library of the window system, loaded at run time and kept for the life of the process.
#pragma once

#include <dlfcn.h>

namespace vitrine::icd::wsi {

class Library {
 public:
  explicit Library(const char* name) : handle_(dlopen(name, RTLD_NOW | RTLD_LOCAL)) {}
  bool loaded() const { return handle_ != nullptr; }

  /// Sets `symbol` to the function or object called `name`; false if there is none.
  template <class T>
  bool find(const char* name, T*& symbol) const {
    symbol = handle_ ? reinterpret_cast<T*>(dlsym(handle_, name)) : nullptr;
    return symbol != nullptr;
  }

 private:
  void* handle_;  // never closed: the application may hold objects made by it
};

}  // namespace vitrine::icd::wsi
