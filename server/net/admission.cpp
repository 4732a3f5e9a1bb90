#include "server/net/admission.hpp"

#include <algorithm>
#include <string>

#include "server/net/http/error_response.hpp"
#include "server/net/websocket_services.hpp"

namespace overfly::net {
namespace {

namespace http = boost::beast::http;

/// @param any_origin  pages of other sites may send it
std::optional<HttpResponse> forbidden(const AllowedHosts& allowed,
                                      const std::string& local,
                                      bool any_origin,
                                      const HttpRequest& request) {
  const std::string host = request.header("host");
  const auto authority = parse_authority(host, 0);
  if (!authority) {
    return error_response(400, "invalid_argument", "Host: must be given once, as name:port");
  }
  if (!allowed.allows(authority->host, local)) {
    return error_response(
        403,
        "forbidden",
        "host " + authority->host +
            ": is not a name of this server (overfly serve --allow-host NAME adds one)");
  }
  const std::string origin = request.header("origin");
  if (!any_origin && !allowed.allows_origin(origin, host, local)) {
    return error_response(403, "forbidden", "origin " + origin + ": is a page of another site");
  }
  return std::nullopt;
}

}  // namespace

HttpRequest plain_request(const http::request<http::string_body>& message) {
  HttpRequest request;
  request.method = std::string(message.method_string());
  request.target = std::string(message.target());
  for (const auto& field : message) {
    std::string name(field.name_string());
    std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) {
      return static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
    });
    request.headers[name] = std::string(field.value());
  }
  // With two Host fields, readers could disagree on which one counts.
  if (message.count(http::field::host) != 1) request.headers.erase("host");
  return request;
}

std::optional<HttpResponse> not_admitted(const ServerContext& context,
                                         const boost::asio::ip::address& local,
                                         HttpRequest* request) {
  // Viewers that are pages of other sites connect with an address that their user gave them.
  const bool any_origin =
      is_foxglove_target(request->target) && context.token_gate.is_shown_in_query(*request);
  if (auto response = forbidden(context.allowed_hosts, local.to_string(), any_origin, *request)) {
    return response;
  }
  if (auto response = context.token_gate.check(request)) return response;
  if (request->access == Access::kViewer && context.router.changes(*request)) {
    return error_response(403,
                          "read_only",
                          "this token is for looking only: " + request->method +
                              " here needs the operator's (overfly serve --token-file)");
  }
  return std::nullopt;
}

}  // namespace overfly::net
