// What the server speaks on WebSockets: the dashboard's stream, and the Foxglove protocol.
#pragma once

#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>
#include <memory>
#include <string>

#include "core/result.hpp"
#include "server/net/server_context.hpp"
#include "server/net/websocket_session.hpp"

namespace overfly::net {

/// True if the target's path is one of a WebSocket.
[[nodiscard]] bool is_websocket_target(const std::string& target);
/// True if it is that of the Foxglove protocol.
[[nodiscard]] bool is_foxglove_target(const std::string& target);

/// The kind of connection that a client with this token opens.
[[nodiscard]] ConnectionPhase web_socket_phase(const HttpRequest& request);

/// The service that an upgrade asks for.
/// @param request  its header, without the token. @pre is_websocket_target(request.target)
/// Errors: kInvalidArgument if the client offers no subprotocol that the endpoint speaks, or for an
/// invalid query.
[[nodiscard]] Result<WebSocketService> websocket_service(
    const boost::beast::http::request<boost::beast::http::string_body>& upgrade,
    const HttpRequest& request,
    const std::shared_ptr<ServerContext>& context);

}  // namespace overfly::net
