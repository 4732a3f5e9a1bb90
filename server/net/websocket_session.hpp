// One WebSocket connection: a StreamClient on a socket.
#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>
#include <functional>
#include <memory>
#include <string>

#include "server/net/server_context.hpp"
#include "server/net/stream/viewer_port.hpp"

namespace overfly::net {

/// What a connection speaks.
struct WebSocketService {
  std::string protocol;  ///< the subprotocol to accept; may be empty
  /// The port outlives what this makes.
  std::function<std::unique_ptr<StreamClient>(ViewerPort&)> make_client;
};

/// Accepts the upgrade and serves the connection until it ends. @pre one thread runs the socket's
/// event loop
/// @param place  must be in the phase of a viewer
void serve_websocket(boost::asio::ip::tcp::socket socket,
                     const boost::beast::http::request<boost::beast::http::string_body>& upgrade,
                     std::shared_ptr<ServerContext> context,
                     std::unique_ptr<ConnectionTable::Place> place,
                     const WebSocketService& service);

}  // namespace overfly::net
