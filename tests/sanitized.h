// Whether a sanitizer watches: then processes hold and last what it needs itself, and limits on both mean nothing.
#pragma once

namespace vitrine::test {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

/// Whether races are looked for: then nothing can lie where the program chooses, children of a process with threads
/// start none, and what shaders are told to do on purpose is found.
#if defined(__SANITIZE_THREAD__)
inline constexpr bool kRacesAreFound = true;
#else
inline constexpr bool kRacesAreFound = false;
#endif

}  // namespace vitrine::test
