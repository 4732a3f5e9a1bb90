#include "server/net/http/error_response.hpp"

#include <sstream>

#include "server/net/http/json_text.hpp"

namespace overfly::net {
namespace {

using nlohmann::json;

int status_of(ErrorCode code) {
  switch (code) {
    case ErrorCode::kInvalidArgument:
      return 400;
    case ErrorCode::kNotFound:
      return 404;
    case ErrorCode::kConflict:
      return 409;
    case ErrorCode::kCancelled:
      return 503;
    case ErrorCode::kUnreadable:
    case ErrorCode::kIo:
    case ErrorCode::kUnsupported:
    case ErrorCode::kInternal:
      return 500;
  }
  return 500;
}

/// Every line "field = value: must be ..." of a message.
json field_errors_of(const std::string& message) {
  json field_errors = json::array();
  std::istringstream lines(message);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t equals = line.find(" = ");
    if (equals == std::string::npos || equals == 0) continue;
    const std::size_t begin = line.find_last_of(' ', equals - 1);
    const std::size_t from = begin == std::string::npos ? 0 : begin + 1;
    field_errors.push_back(
        {{"field", line.substr(from, equals - from)}, {"message", line.substr(from)}});
  }
  return field_errors;
}

}  // namespace

HttpResponse json_response(int status, const json& body) {
  HttpResponse response;
  response.status = status;
  response.content_type = "application/json";
  response.headers.emplace_back("Cache-Control", "no-store");
  response.body = to_text(body);
  return response;
}

HttpResponse error_response(const Error& error) {
  json body = {{"code", to_string(error.code)}, {"message", error.message}};
  if (error.code == ErrorCode::kInvalidArgument) {
    json field_errors = field_errors_of(error.message);
    if (!field_errors.empty()) body["faults"] = std::move(field_errors);
  }
  return json_response(status_of(error.code), {{"error", std::move(body)}});
}

HttpResponse error_response(int status, const std::string& code, const std::string& message) {
  return json_response(status, {{"error", {{"code", code}, {"message", message}}}});
}

HttpResponse json_or_error(const Result<json>& result) {
  return result ? json_response(200, *result) : error_response(result.error());
}

}  // namespace overfly::net
