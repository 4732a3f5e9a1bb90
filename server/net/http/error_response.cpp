#include "server/net/http/error_response.hpp"

#include <algorithm>
#include <cctype>
#include <sstream>

#include "server/net/http/json_text.hpp"

namespace overfly::net {
namespace {

using nlohmann::json;

int status_of(ErrorCode code) {
  switch (code) {
    case ErrorCode::kInvalidArgument:
      return 400;
    case ErrorCode::kForbidden:
      return 403;
    case ErrorCode::kNotFound:
      return 404;
    case ErrorCode::kConflict:
      return 409;
    case ErrorCode::kUnreadable:
    case ErrorCode::kUnsupported:
      return 422;
    case ErrorCode::kCancelled:
      return 503;
    case ErrorCode::kIo:
    case ErrorCode::kTimeout:
    case ErrorCode::kInternal:
      return 500;
  }
  return 500;
}

/// A dotted path of names and numbers.
bool is_path(const std::string& text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '.' || c == '$';
  });
}

/// The field that a line of a message begins with; empty if there is none.
std::string field_of(const std::string& line, std::size_t* from) {
  const std::size_t equals = line.find(" = ");
  if (equals != std::string::npos && equals > 0) {
    const std::size_t begin = line.find_last_of(' ', equals - 1);
    *from = begin == std::string::npos ? 0 : begin + 1;
    return line.substr(*from, equals - *from);
  }
  const std::size_t must = line.find(": must ");
  *from = 0;
  const std::string field = line.substr(0, must);
  return must != std::string::npos && is_path(field) ? field : std::string();
}

}  // namespace

json field_errors_of(const std::string& message) {
  json field_errors = json::array();
  std::istringstream lines(message);
  for (std::string line; std::getline(lines, line);) {
    std::size_t from = 0;
    const std::string field = field_of(line, &from);
    if (field.empty()) continue;
    field_errors.push_back({{"field", field}, {"message", line.substr(from)}});
  }
  return field_errors;
}

HttpResponse json_text_response(const std::string& text) {
  HttpResponse response;
  response.content_type = "application/json";
  response.headers.emplace_back("Cache-Control", "no-cache");
  response.body = text;
  return response;
}

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
  HttpResponse response = json_response(status_of(error.code), {{"error", std::move(body)}});
  if (response.status == 500) response.failure = error.message;
  return response;
}

HttpResponse internal_error_response() {
  return error_response(500, "internal", "internal error: the server's log has the reason");
}

HttpResponse error_response(int status, const std::string& code, const std::string& message) {
  return json_response(status, {{"error", {{"code", code}, {"message", message}}}});
}

HttpResponse json_or_error(const Result<json>& result) {
  return result ? json_response(200, *result) : error_response(result.error());
}

}  // namespace overfly::net
