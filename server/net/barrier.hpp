// Where exceptions of libraries and of the memory end.
#pragma once

#include <exception>
#include <utility>

namespace overfly::net {

/// Calls `action`. What escapes it is told to `fail` as text; what escapes that is dropped.
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

}  // namespace overfly::net
