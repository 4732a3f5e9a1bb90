#include "server/net/http/token_gate.hpp"

#include <algorithm>
#include <string_view>

#include "server/net/http/access_token.hpp"
#include "server/net/http/error_response.hpp"
#include "server/net/http/locked_page.hpp"
#include "server/net/http/url.hpp"

namespace overfly::net {
namespace {

constexpr const char* kParameter = "token";
constexpr std::string_view kBearer = "bearer ";

bool is_api(const HttpRequest& request) { return request.target.starts_with("/api/"); }

bool starts_with_any_case(std::string_view text, std::string_view lower_case_start) {
  if (text.size() < lower_case_start.size()) return false;
  return std::equal(
      lower_case_start.begin(), lower_case_start.end(), text.begin(), [](char wanted, char c) {
        return (c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c) == wanted;
      });
}

/// Calls `each` with every value of a cookie.
template <typename Each>
void for_each_cookie(std::string_view header, std::string_view name, Each each) {
  while (!header.empty()) {
    const std::size_t end = std::min(header.find(';'), header.size());
    std::string_view pair = header.substr(0, end);
    header.remove_prefix(std::min(end + 1, header.size()));
    pair.remove_prefix(std::min(pair.find_first_not_of(' '), pair.size()));
    const std::size_t equals = pair.find('=');
    if (equals != std::string_view::npos && pair.substr(0, equals) == name) {
      each(pair.substr(equals + 1));
    }
  }
}

/// Accepts the whole printed address as well, because users may paste it.
std::string_view token_in(std::string_view text) {
  const std::size_t at = text.rfind("token=");
  return at == std::string_view::npos ? text : text.substr(at + 6);
}

HttpResponse token_refusal(const HttpRequest& request, bool wrong) {
  HttpResponse response;
  if (is_api(request)) {
    response = error_response(401,
                              "unauthorized",
                              wrong ? "the token is wrong"
                                    : "a token is required, which the server printed when it "
                                      "started: Authorization: Bearer TOKEN, or ?token=TOKEN");
  } else {
    response.status = 401;
    response.content_type = "text/html; charset=utf-8";
    response.headers.emplace_back("Cache-Control", "no-store");
    response.body = locked_page(wrong);
  }
  response.headers.emplace_back("WWW-Authenticate", "Bearer realm=\"Overfly\"");
  return response;
}

/// Redirects to the same page, relative to it: the path in the browser's address may begin with a
/// prefix that a proxy has removed. Never leads to another host: "./" comes first, and a browser
/// reads "\" as "/".
std::string location_of(const std::string& target) {
  const std::size_t query = std::min(target.find('?'), target.size());
  const std::size_t slash = target.find_last_of("/\\", query == 0 ? 0 : query - 1);
  return "./" + target.substr(slash == std::string::npos ? query : slash + 1);
}

}  // namespace

std::string token_cookie_name(const std::string& host_header) {
  const std::size_t colon = host_header.rfind(':');
  const std::string port = colon == std::string::npos ? "" : host_header.substr(colon + 1);
  const bool is_port = !port.empty() && port.find_first_not_of("0123456789") == std::string::npos;
  return "overfly_" + (is_port ? port : "80");
}

std::optional<Access> TokenGate::access_by(std::string_view shown) const {
  const bool is_operator = same_token(shown, operator_token_);
  const bool is_viewer = !viewer_token_.empty() && same_token(shown, viewer_token_);
  if (is_operator) return Access::kOperator;
  return is_viewer ? std::optional(Access::kViewer) : std::nullopt;
}

std::optional<Access> TokenGate::access_by_headers(const HttpRequest& request) const {
  std::optional<Access> most;
  const auto take = [&](std::string_view shown) {
    const std::optional<Access> access = access_by(shown);
    if (access && most != Access::kOperator) most = access;
  };
  const std::string authorization = request.header("authorization");
  if (starts_with_any_case(authorization, kBearer)) {
    take(std::string_view(authorization).substr(kBearer.size()));
  }
  for_each_cookie(request.header("cookie"), token_cookie_name(request.header("host")), take);
  return most;
}

bool TokenGate::is_shown_in_query(const HttpRequest& request) const {
  if (operator_token_.empty()) return false;
  std::string target = request.target;
  const auto shown = take_query_parameter(&target, kParameter);
  return shown && access_by(token_in(*shown));
}

std::optional<HttpResponse> TokenGate::check(HttpRequest* request) const {
  const auto shown = take_query_parameter(&request->target, kParameter);
  if (operator_token_.empty()) return std::nullopt;
  const auto by_query = shown ? access_by(token_in(*shown)) : std::nullopt;
  const auto access = by_query ? by_query : access_by_headers(*request);
  if (!access) return token_refusal(*request, shown.has_value());
  request->access = *access;
  const bool reads = request->method == "GET" || request->method == "HEAD";
  if (!shown || !reads || is_api(*request)) return std::nullopt;
  HttpResponse response;
  response.status = 303;
  response.headers.emplace_back("Location", location_of(request->target));
  response.headers.emplace_back("Cache-Control", "no-store");
  if (by_query) {
    // Without a path the cookie is for the folder of the address in the browser, with its prefix.
    response.headers.emplace_back(
        "Set-Cookie",
        token_cookie_name(request->header("host")) + "=" +
            (*by_query == Access::kOperator ? operator_token_ : viewer_token_) +
            "; HttpOnly; SameSite=Strict");
  }
  return response;
}

}  // namespace overfly::net
