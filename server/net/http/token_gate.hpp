// Checks every request for the server's token.
#pragma once

#include <optional>
#include <string>
#include <utility>

#include "server/net/http/http_message.hpp"

namespace overfly::net {

class TokenGate {
 public:
  /// @param token  empty = no token is required
  explicit TokenGate(std::string token) : token_(std::move(token)) {}

  /// Looks for the token in the query parameter `token`, in `Authorization: Bearer` and in the
  /// cookie. Removes the parameter from the request's target, so that later code neither sees nor
  /// repeats the token.
  /// @return the response to send instead of serving the request: 401, or for a page requested with
  /// the parameter a redirection to the same page without it, which sets the cookie. Empty = serve
  /// it
  [[nodiscard]] std::optional<HttpResponse> check(HttpRequest* request) const;

  /// True if a token is required and the request shows it in the query parameter, as one does who
  /// was given the address, and not a page that only knows where the server is.
  [[nodiscard]] bool is_shown_in_query(const HttpRequest& request) const;

 private:
  [[nodiscard]] bool has_token(const HttpRequest& request) const;
  std::string token_;
};

/// Name of the cookie that holds the token. Cookies are not separated by port, so the name contains
/// the requested port ("overfly_8480"). Several servers on one host thus have separate cookies.
[[nodiscard]] std::string token_cookie_name(const std::string& host_header);

}  // namespace overfly::net
