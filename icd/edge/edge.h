// The API edge: the one wrapper through which applications reach every command. No exception passes it.
#pragma once

#include <cstddef>
#include <new>
#include <type_traits>

#include "base/check.h"
#include "icd/edge/vulkan_api.h"

namespace vitrine::icd {

/// Makes the first error of a recording stick (design.md section 6); vkEndCommandBuffer returns it. Defined with the
/// command buffer.
__attribute__((weak)) void stick_record_error(VkCommandBuffer command_buffer, VkResult error);

/// Records that the application called a command, for observers (icd/replay/observed_replay.h).
void mark_command(VkCommandBuffer command_buffer, const char* name);

namespace detail {

template <class First, class... Rest>
void report_void_failure(VkResult error, First first, Rest...) {
  if constexpr (std::is_same_v<First, VkCommandBuffer>) {
    if (stick_record_error) stick_record_error(first, error);
  } else {
    VITRINE_UNREACHABLE("exception in a command that returns nothing");
  }
}

}  // namespace detail

template <auto Function>
struct Edge;

template <class R, class... Args, R(VKAPI_PTR* Function)(Args...)>
struct Edge<Function> {
  static VKAPI_ATTR R VKAPI_CALL call(Args... args) noexcept {
    try {
      return Function(args...);
    } catch (const std::bad_alloc&) {
      return failure(VK_ERROR_OUT_OF_HOST_MEMORY, args...);
    } catch (...) {
      return failure(VK_ERROR_UNKNOWN, args...);
    }
  }

 private:
  static R failure(VkResult error, Args... args) {
    if constexpr (std::is_same_v<R, VkResult>) {
      return error;
    } else {
      detail::report_void_failure(error, args...);
      if constexpr (!std::is_void_v<R>) return R{};
    }
  }
};

/// The name of a command as a template argument.
template <std::size_t N>
struct CommandName {
  char text[N];
  consteval CommandName(const char (&name)[N]) {  // NOLINT: implicit, a literal is the argument
    for (std::size_t i = 0; i < N; ++i) text[i] = name[i];
  }
};

/// A command of command buffers where tools are on: its name is recorded before it.
template <auto Function, CommandName Name>
struct Marked;

template <class R, class... Args, R(VKAPI_PTR* Function)(VkCommandBuffer, Args...), CommandName Name>
struct Marked<Function, Name> {
  static VKAPI_ATTR R VKAPI_CALL call(VkCommandBuffer command_buffer, Args... args) {
    mark_command(command_buffer, Name.text);
    return Function(command_buffer, args...);
  }
};

}  // namespace vitrine::icd
