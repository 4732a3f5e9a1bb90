// Errors and JSON values as HTTP answers: the one place where an Error becomes a status.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "core/result.hpp"
#include "server/net/http/http_message.hpp"

namespace overfly::net {

[[nodiscard]] HttpResponse json_response(int status, const nlohmann::json& body);
/// {"error": {"code", "message"}}; faults of fields ("field = value: must be limit", one a line)
/// are listed as {"field", "message"} under `faults` too.
[[nodiscard]] HttpResponse error_response(const Error& error);
/// The same for a status that no ErrorCode stands for: 403, 405, 413, 415, 422, 426, 429.
[[nodiscard]] HttpResponse error_response(int status,
                                          const std::string& code,
                                          const std::string& message);

/// Answers `result`'s value, or its error.
[[nodiscard]] HttpResponse json_or_error(const Result<nlohmann::json>& result);

}  // namespace overfly::net
