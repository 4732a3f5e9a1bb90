// Asks every request for the server's token.
#pragma once

#include <optional>
#include <string>
#include <utility>

#include "server/net/http/http_message.hpp"

namespace overfly::net {

class TokenGate {
 public:
  /// @param token  empty = nothing is asked for
  explicit TokenGate(std::string token) : token_(std::move(token)) {}

  /// Looks for the token in the query parameter `token`, in `Authorization: Bearer` and in the
  /// cookie. Takes the parameter out of the request's target: what comes behind the gate neither
  /// sees the token nor repeats it.
  /// @return what is answered instead of the request: 401, or for a page asked for with the
  ///   parameter a redirection to the same page without it, which sets the cookie. Empty = serve it
  [[nodiscard]] std::optional<HttpResponse> check(HttpRequest* request) const;

 private:
  [[nodiscard]] bool has_token(const HttpRequest& request) const;
  std::string token_;
};

/// Name of the cookie that holds the token. Cookies do not know ports, so the name has the one that
/// the client asks for ("overfly_8480"): several servers on one host keep apart.
[[nodiscard]] std::string token_cookie_name(const std::string& host_header);

}  // namespace overfly::net
