// Errors as values: what library code returns when the outside world (a file, a peer, a GPU,
// a user's scenario) is bad. A bug in our own code is an assert, not a Result.
#pragma once

#include <cassert>
#include <optional>
#include <string>
#include <utility>
#include <variant>

namespace overfly {

enum class ErrorCode {
  kInvalidArgument,  ///< a value outside its limits; the message names field, value and limit
  kNotFound,         ///< a file, run, frame or name that is not there
  kUnreadable,       ///< a file that is there and cannot be understood
  kIo,               ///< reading or writing failed
  kUnsupported,      ///< this build or machine lacks what is asked
  kCancelled,        ///< the user stopped it
  kConflict,         ///< the thing exists already or is in another state
  kInternal,         ///< a library failed in a way that is not the user's doing
};

/// The stable lower-case name of a code ("invalid_argument"), as the REST interface prints it.
[[nodiscard]] const char* to_string(ErrorCode code);

/// One failure: what failed, which value, which limit, which file or field, in `message`.
struct Error {
  ErrorCode code = ErrorCode::kInternal;
  std::string message;

  /// The same error with "context: " before its message.
  [[nodiscard]] Error in(const std::string& context) const {
    return {code, context + ": " + message};
  }
};

/// A T, or the Error that kept us from it.
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

/// The outcome of an action without a value.
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
