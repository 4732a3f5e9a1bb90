// Decides from a request's header whether it is served.
#pragma once

#include <boost/asio/ip/address.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>
#include <optional>

#include "server/net/http/http_message.hpp"
#include "server/net/server_context.hpp"

namespace overfly::net {

/// The request without its body; without its Host if there are several.
[[nodiscard]] HttpRequest plain_request(
    const boost::beast::http::request<boost::beast::http::string_body>& message);

/// Checks the requested host, the requesting page, the token and what it allows.
/// @param local  the connection's local address
/// @param request  the token is removed from its target
/// @return the response to send instead of serving the request; empty = serve it
[[nodiscard]] std::optional<HttpResponse> not_admitted(const ServerContext& context,
                                                       const boost::asio::ip::address& local,
                                                       HttpRequest* request);

}  // namespace overfly::net
