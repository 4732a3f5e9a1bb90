// Passes the body of a request to a sink piece by piece, in bounded memory.
#pragma once

#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/string_body.hpp>
#include <functional>
#include <memory>
#include <optional>

#include "server/net/http/http_message.hpp"
#include "server/net/server_context.hpp"

namespace overfly::net {

struct UploadConnection {
  boost::beast::tcp_stream& stream;
  boost::beast::flat_buffer& buffer;
  boost::beast::http::request_parser<boost::beast::http::string_body>& parser;  ///< header is read
  HttpRequest request;
  /// Called on the stream's executor with the answer, and whether the whole body was read; without
  /// an answer if the connection has failed. Must keep stream and buffer alive.
  std::function<void(std::optional<HttpResponse>, bool complete)> done;
};

/// The disk is written on the context's worker threads; the next piece is received after that.
void receive_upload(std::shared_ptr<ServerContext> context, UploadConnection connection);

}  // namespace overfly::net
