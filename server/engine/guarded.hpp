// Calls into estimators.
#pragma once

#include <exception>

#include "core/result.hpp"

namespace overfly::engine {

/// Calls an estimator; whatever a library throws through it is its end, not ours: kInternal.
template <typename Call>
auto guarded(const Call& call) -> decltype(call()) {
  try {
    return call();
  } catch (const std::exception& error) {
    return Error{ErrorCode::kInternal, error.what()};
  }
}

}  // namespace overfly::engine
