// Where exceptions of libraries and of a lack of memory end.
#pragma once

#include <exception>
#include <utility>

#include "core/result.hpp"

namespace overfly {

/// Calls `action`, and `fail` with the text of what escapes it. What escapes `fail` is dropped.
/// @return true when nothing escaped
template <typename Action, typename Fail>
bool contained(Action&& action, Fail&& fail) noexcept {
  try {
    try {
      std::forward<Action>(action)();
      return true;
    } catch (const std::exception& error) {
      fail(error.what());
    } catch (...) {
      fail("an exception of an unknown kind");
    }
  } catch (...) {
    // There is no memory even to say so.
  }
  return false;
}

/// Calls what answers with a Status or Result; an exception becomes the error kInternal.
template <typename Call>
auto guarded(const Call& call) -> decltype(call()) {
  try {
    return call();
  } catch (const std::exception& error) {
    return Error{ErrorCode::kInternal, error.what()};
  } catch (...) {
    return Error{ErrorCode::kInternal, "an exception of an unknown kind"};
  }
}

}  // namespace overfly
