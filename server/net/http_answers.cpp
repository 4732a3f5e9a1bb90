#include "server/net/http_answers.hpp"

#include <boost/beast/http/error.hpp>
#include <string>
#include <utility>

#include "server/net/http/error_response.hpp"

namespace overfly::net {

namespace http = boost::beast::http;

HttpAnswer http_answer(HttpResponse response, unsigned version, bool keep_alive, bool head) {
  HttpAnswer answer(static_cast<http::status>(response.status), version);
  answer.set(http::field::server, "overfly");
  answer.set("X-Content-Type-Options", "nosniff");
  // Keeps the address, which contains the token, from other sites.
  answer.set("Referrer-Policy", "no-referrer");
  answer.set("Content-Security-Policy",
             "default-src 'self'; img-src 'self' blob: data:; style-src 'self' "
             "'unsafe-inline'; connect-src 'self' ws: wss:; frame-ancestors 'self'; "
             "form-action 'self'; base-uri 'none'");
  if (!response.content_type.empty()) {
    answer.set(http::field::content_type, response.content_type);
  }
  for (const auto& [name, value] : response.headers) answer.set(name, value);
  answer.keep_alive(keep_alive);
  const std::size_t body_bytes = response.body.size();
  if (!head) answer.body() = std::move(response.body);
  answer.prepare_payload();
  // RFC 9110, 8.6: no length for 204, and for 304 only that of the whole answer.
  if (response.status == 204 || response.status == 304) {
    answer.erase(http::field::content_length);
  } else if (head) {
    answer.content_length(body_bytes);
  }
  return answer;
}

HttpResponse too_many_viewers(std::size_t most) {
  return error_response(
      503,
      "too_many_viewers",
      std::to_string(most) + " viewers are connected, which is this server's limit");
}

std::optional<HttpResponse> answer_to_unreadable_request(const boost::beast::error_code& error,
                                                         std::uint64_t max_body_bytes) {
  if (error == http::error::body_limit) {
    return error_response(413,
                          "payload_too_large",
                          "the body is larger than " + std::to_string(max_body_bytes) + " bytes");
  }
  if (error == http::error::header_limit || error == http::error::buffer_overflow) {
    return error_response(431, "headers_too_large", "the request's headers are too large");
  }
  if (error.category() == make_error_code(http::error::bad_method).category() &&
      error != http::error::end_of_stream && error != http::error::partial_message) {
    return error_response(400, "invalid_argument", "the request is malformed: " + error.message());
  }
  return std::nullopt;
}

}  // namespace overfly::net
