// Formats a scenario's errors: field, value, limit.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "core/result.hpp"

namespace overfly::server {

/// "faults.0.every = 0: must be at least 1"
[[nodiscard]] inline Error bad_field(const std::string& path,
                                     const nlohmann::json& value,
                                     const std::string& must) {
  return {ErrorCode::kInvalidArgument, path + " = " + value.dump() + ": must " + must};
}

}  // namespace overfly::server
