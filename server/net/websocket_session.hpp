// One WebSocket connection: a Viewer on a socket.
#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>
#include <memory>

#include "server/net/server_context.hpp"

namespace overfly::net {

/// Accepts the upgrade and serves the connection until it ends. The socket's event loop has one
/// thread.
/// @param place  of a viewer
void serve_websocket(boost::asio::ip::tcp::socket socket,
                     const boost::beast::http::request<boost::beast::http::string_body>& upgrade,
                     std::shared_ptr<ServerContext> context,
                     std::unique_ptr<ConnectionTable::Place> place);

}  // namespace overfly::net
