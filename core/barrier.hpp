// Exception barriers: exceptions from libraries and failed allocations stop here.
#pragma once

#include <exception>
#include <utility>

#include "core/result.hpp"

namespace overfly {

/// Calls `action`. If it throws, calls `fail` with the exception's text; an exception from `fail`
/// is dropped.
/// @return true if `action` did not throw
template <typename Action, typename Fail>
bool contained(Action&& action, Fail&& fail) noexcept {
  try {
    try {
      std::forward<Action>(action)();
      return true;
    } catch (const std::exception& error) {
      fail(error.what());
    } catch (...) {
      fail("unknown exception");
    }
  } catch (...) {
    // Out of memory: not even the report can be built.
  }
  return false;
}

/// Calls a function that returns a Status or a Result and converts an exception into the error
/// kInternal.
template <typename Call>
auto guarded(const Call& call) -> decltype(call()) {
  try {
    return call();
  } catch (const std::exception& error) {
    return Error{ErrorCode::kInternal, error.what()};
  } catch (...) {
    return Error{ErrorCode::kInternal, "unknown exception"};
  }
}

}  // namespace overfly
