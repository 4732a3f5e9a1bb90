// Accepts connections.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <memory>

#include "core/result.hpp"
#include "server/net/server_context.hpp"

namespace overfly::net {

/// Binds and accepts until the event loop ends.
/// @return the bound port
/// Errors: kIo with address, port and the system's reason; kInvalidArgument for an invalid address.
[[nodiscard]] Result<std::uint16_t> listen(boost::asio::io_context* loop,
                                           const std::shared_ptr<ServerContext>& context);

}  // namespace overfly::net
