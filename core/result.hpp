// Errors as values: returned by library code when something outside the program (a file, a peer, a
// GPU, a user's scenario) is invalid or fails. A bug in Overfly itself is an assert, not a Result.
#pragma once

#include <cassert>
#include <optional>
#include <string>
#include <utility>
#include <variant>

namespace overfly {

enum class ErrorCode {
  kInvalidArgument,  ///< a value outside its limits; the message names field, value and limit
  kNotFound,         ///< a file, run, frame or name does not exist
  kUnreadable,       ///< a file exists but cannot be parsed
  kIo,               ///< reading or writing failed
  kUnsupported,      ///< not supported by this build or machine
  kCancelled,        ///< cancelled by the user
  kConflict,         ///< already exists, or is in another state
  kTimeout,          ///< a peer did not answer in time
  kForbidden,        ///< only the owner of the machine may do or name this
  kInternal,         ///< a library failed; not the user's fault
};

/// The stable lower-case name of a code ("invalid_argument"), used by the REST interface.
[[nodiscard]] const char* to_string(ErrorCode code);

/// One failure. `message` says what failed and names the file or field, the value and the limit.
struct Error {
  ErrorCode code = ErrorCode::kInternal;
  std::string message;

  /// The same error with "context: " before its message.
  [[nodiscard]] Error in(const std::string& context) const {
    return {code, context + ": " + message};
  }
};

/// A T, or the Error that prevented it.
template <typename T>
class [[nodiscard]] Result {
 public:
  Result(T value) : state_(std::move(value)) {}
  Result(Error error) : state_(std::move(error)) {}

  [[nodiscard]] bool ok() const { return state_.index() == 0; }
  explicit operator bool() const { return ok(); }

  /// @pre ok()
  [[nodiscard]] T& value() & {
    assert(ok());
    return std::get<0>(state_);
  }
  [[nodiscard]] const T& value() const& {
    assert(ok());
    return std::get<0>(state_);
  }
  [[nodiscard]] T&& value() && {
    assert(ok());
    return std::get<0>(std::move(state_));
  }
  T& operator*() & { return value(); }
  const T& operator*() const& { return value(); }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }

  /// @pre !ok()
  [[nodiscard]] const Error& error() const {
    assert(!ok());
    return std::get<1>(state_);
  }

 private:
  std::variant<T, Error> state_;
};

/// Success, or an Error.
template <>
class [[nodiscard]] Result<void> {
 public:
  Result() = default;
  Result(Error error) : error_(std::move(error)) {}

  [[nodiscard]] bool ok() const { return !error_.has_value(); }
  explicit operator bool() const { return ok(); }
  [[nodiscard]] const Error& error() const {
    assert(!ok());
    return *error_;
  }

 private:
  std::optional<Error> error_;
};

using Status = Result<void>;

}  // namespace overfly
