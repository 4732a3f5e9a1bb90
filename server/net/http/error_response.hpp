// Converts errors and JSON values to HTTP responses; the only place that maps an Error to a status.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "core/result.hpp"
#include "server/net/http/http_message.hpp"

namespace overfly::net {

[[nodiscard]] HttpResponse json_response(int status, const nlohmann::json& body);
/// {"error": {"code", "message"}}; invalid fields ("field = value: must be limit", one a line) are
/// also listed as {"field", "message"} under `faults`.
[[nodiscard]] HttpResponse error_response(const Error& error);
/// The answer to a request during which an exception was caught and logged.
[[nodiscard]] HttpResponse internal_error_response();
/// As above, for a status without an ErrorCode: 403, 405, 413, 415, 422, 426, 429.
[[nodiscard]] HttpResponse error_response(int status,
                                          const std::string& code,
                                          const std::string& message);

/// Every invalid field of a message as {"field", "message"}: lines "field = value: must be limit"
/// and "field: must be given".
[[nodiscard]] nlohmann::json field_errors_of(const std::string& message);
/// JSON that is text already.
[[nodiscard]] HttpResponse json_text_response(const std::string& text);

/// Responds with `result`'s value, or with its error.
[[nodiscard]] HttpResponse json_or_error(const Result<nlohmann::json>& result);

}  // namespace overfly::net
