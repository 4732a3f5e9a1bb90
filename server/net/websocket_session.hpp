// One WebSocket connection: a Viewer on a socket.
#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>
#include <memory>

#include "server/net/server_context.hpp"

namespace overfly::net {

/// Accepts the upgrade and serves the connection until it ends. @pre one thread runs the socket's
/// event loop
/// @param place  must be in the phase of a viewer
void serve_websocket(boost::asio::ip::tcp::socket socket,
                     const boost::beast::http::request<boost::beast::http::string_body>& upgrade,
                     std::shared_ptr<ServerContext> context,
                     std::unique_ptr<ConnectionTable::Place> place);

}  // namespace overfly::net
