// Checks every request for one of the server's tokens.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "server/net/http/http_message.hpp"

namespace overfly::net {

class TokenGate {
 public:
  /// @param operator_token  empty = no token is required
  /// @param viewer_token  of those who may only look; empty = there is none
  explicit TokenGate(std::string operator_token, std::string viewer_token = "")
      : operator_token_(std::move(operator_token)), viewer_token_(std::move(viewer_token)) {}

  /// Looks for a token in the query parameter `token`, in `Authorization: Bearer` and in the
  /// cookie, and sets the request's access: that of the query parameter, otherwise the most that a
  /// token of the others gives. Removes the parameter from the request's target, so that later code
  /// neither sees nor repeats the token.
  /// @return the response to send instead of serving the request: 401, or for a page requested with
  /// the parameter a redirection to the same page without it, which sets the cookie. Empty = serve
  /// it
  [[nodiscard]] std::optional<HttpResponse> check(HttpRequest* request) const;

  /// True if a token is required and the request shows it in the query parameter, as one does who
  /// was given the address, and not a page that only knows where the server is.
  [[nodiscard]] bool is_shown_in_query(const HttpRequest& request) const;

 private:
  /// Empty if this is no token of the server.
  [[nodiscard]] std::optional<Access> access_by(std::string_view shown) const;
  [[nodiscard]] std::optional<Access> access_by_headers(const HttpRequest& request) const;
  std::string operator_token_;
  std::string viewer_token_;
};

/// Name of the cookie that holds the token. Cookies are not separated by port, so the name contains
/// the requested port ("overfly_8480"). Several servers on one host thus have separate cookies.
[[nodiscard]] std::string token_cookie_name(const std::string& host_header);

}  // namespace overfly::net
