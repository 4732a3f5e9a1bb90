// Whether a request is served at all: told by its header alone.
#pragma once

#include <boost/asio/ip/address.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>
#include <optional>

#include "server/net/http/http_message.hpp"
#include "server/net/server_context.hpp"

namespace overfly::net {

/// All of a request but its body, and but its Host where it has several.
[[nodiscard]] HttpRequest plain_request(
    const boost::beast::http::request<boost::beast::http::string_body>& message);

/// Checks the name that is asked for, the page that asks and the token.
/// @param local    the connection's end on this machine
/// @param request  its target loses the token
/// @return what is answered in place of the request; empty = serve it
[[nodiscard]] std::optional<HttpResponse> not_admitted(const ServerContext& context,
                                                       const boost::asio::ip::address& local,
                                                       HttpRequest* request);

}  // namespace overfly::net
