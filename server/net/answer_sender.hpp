// Sends HTTP answers to clients of any speed.
#pragma once

#include <boost/beast/core/error.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <chrono>
#include <functional>

#include "server/net/http_answers.hpp"

namespace overfly::net {

/// Sends an answer. Every piece that leaves begins a new deadline, because a slow client is not a
/// dead one; but a client that takes less than 1 kB/s on average, counted from the first minute on,
/// holds the answer no longer.
/// @param answer  must live, like the stream, until `done` is called
/// @param idle  time for one piece
/// @param done  on the stream's executor
void send_answer(boost::beast::tcp_stream& stream,
                 const HttpAnswer& answer,
                 std::chrono::milliseconds idle,
                 std::function<void(const boost::beast::error_code&)> done);

/// Sends "100 Continue" to a client that waits for it before it sends the body (RFC 9110, section
/// 10.1.1).
/// @param idle  time for the message and, if the body is read at once, for the body
/// @param done  called at once if the client does not wait, else on the stream's executor
void invite_body(boost::beast::tcp_stream& stream,
                 const HttpRequest& request,
                 std::chrono::milliseconds idle,
                 std::function<void(const boost::beast::error_code&)> done);

}  // namespace overfly::net
