// Answers as they are sent, and what a request that cannot be read is answered.
#pragma once

#include <boost/beast/core/error.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "server/net/http/http_message.hpp"

namespace overfly::net {

using HttpAnswer = boost::beast::http::response<boost::beast::http::string_body>;

/// Adds the headers that every answer has.
/// @param version  of the request: 10 or 11
/// @param head  the request was HEAD: the length of the body is sent, not the body
[[nodiscard]] HttpAnswer http_answer(HttpResponse response,
                                     unsigned version,
                                     bool keep_alive,
                                     bool head);

/// @param most  viewers at once
[[nodiscard]] HttpResponse too_many_viewers(std::size_t most);

/// Empty if the connection is beyond an answer.
[[nodiscard]] std::optional<HttpResponse> answer_to_unreadable_request(
    const boost::beast::error_code& error, std::uint64_t max_body_bytes);

}  // namespace overfly::net
