// One HTTP connection: requests one after the other, kept alive between them.
#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <memory>

#include "server/net/server_context.hpp"

namespace overfly::net {

/// Serves a connection until it ends or becomes a WebSocket. The socket's event loop has one
/// thread.
void serve_http(boost::asio::ip::tcp::socket socket, std::shared_ptr<ServerContext> context);

}  // namespace overfly::net
