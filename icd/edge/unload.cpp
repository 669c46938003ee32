// What the C++ runtime inside of the driver leaves behind when the loader unloads it with its last instance: 71 KiB
// that it keeps for exceptions. Part of the library alone, and only where the runtime is.
namespace __gnu_cxx {
void __freeres() noexcept;  // libstdc++, for memory checkers; no header declares it
}

namespace vitrine::icd {
namespace {

[[gnu::destructor]] void free_exception_pool() { __gnu_cxx::__freeres(); }

}  // namespace
}  // namespace vitrine::icd
