// Result<T>: a value, or a message that says why there is none. For rooms below icd/; icd/ turns it into a VkResult.
#pragma once

#include <optional>
#include <string>
#include <utility>

namespace vitrine::base {

struct Error {
  std::string message;
};

template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : value_(std::move(value)) {}              // NOLINT: implicit by design
  Result(Error error) : error_(std::move(error.message)) {}  // NOLINT: implicit by design

  bool ok() const { return value_.has_value(); }
  explicit operator bool() const { return ok(); }
  T& value() { return *value_; }
  const T& value() const { return *value_; }
  T take() { return std::move(*value_); }
  /// Empty when ok().
  const std::string& message() const { return error_; }
  Error error() const { return Error{error_}; }

 private:
  std::optional<T> value_;
  std::string error_;
};

}  // namespace vitrine::base
