// Whether a sanitizer watches: then processes hold and last what it needs itself, and limits on both mean nothing.
#pragma once

namespace vitrine::test {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

}  // namespace vitrine::test
