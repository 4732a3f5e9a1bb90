// One HTTP connection: sequential requests with keep-alive.
#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <memory>

#include "server/net/server_context.hpp"

namespace overfly::net {

/// Serves a connection until it ends or becomes a WebSocket. @pre one thread runs the socket's
/// event loop
void serve_http(boost::asio::ip::tcp::socket socket, std::shared_ptr<ServerContext> context);

}  // namespace overfly::net
