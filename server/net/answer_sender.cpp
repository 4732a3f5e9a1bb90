#include "server/net/answer_sender.hpp"

#include <boost/asio/write.hpp>
#include <boost/beast/http/serializer.hpp>
#include <boost/beast/http/write.hpp>
#include <cstddef>
#include <memory>
#include <string_view>
#include <utility>

#include "core/text/lower_case.hpp"

namespace overfly::net {
namespace {

namespace beast = boost::beast;
namespace http = boost::beast::http;
using beast::error_code;
using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds kGrace{60};
constexpr double kLeastBytesPerS = 1024.0;

class AnswerSender final : public std::enable_shared_from_this<AnswerSender> {
 public:
  AnswerSender(beast::tcp_stream& stream,
               const HttpAnswer& answer,
               std::chrono::milliseconds idle,
               std::function<void(const error_code&)> done)
      : stream_(stream), serializer_(answer), idle_(idle), done_(std::move(done)) {}

  void send() {
    stream_.expires_after(idle_);
    http::async_write_some(stream_,
                           serializer_,
                           [self = shared_from_this()](const error_code& error, std::size_t bytes) {
                             self->on_piece(error, bytes);
                           });
  }

 private:
  void on_piece(const error_code& error, std::size_t bytes) {
    sent_bytes_ += bytes;
    if (error || serializer_.is_done()) {
      done_(error);
    } else if (too_slow()) {
      done_(beast::error::timeout);
    } else {
      send();
    }
  }
  [[nodiscard]] bool too_slow() const {
    const Clock::duration taken = Clock::now() - begun_;
    return taken > kGrace && static_cast<double>(sent_bytes_) <
                                 kLeastBytesPerS * std::chrono::duration<double>(taken).count();
  }

  beast::tcp_stream& stream_;
  http::response_serializer<http::string_body> serializer_;
  const std::chrono::milliseconds idle_;
  const std::function<void(const error_code&)> done_;
  const Clock::time_point begun_ = Clock::now();
  std::size_t sent_bytes_ = 0;
};

}  // namespace

void send_answer(beast::tcp_stream& stream,
                 const HttpAnswer& answer,
                 std::chrono::milliseconds idle,
                 std::function<void(const error_code&)> done) {
  std::make_shared<AnswerSender>(stream, answer, idle, std::move(done))->send();
}

void invite_body(beast::tcp_stream& stream,
                 const HttpRequest& request,
                 std::chrono::milliseconds idle,
                 std::function<void(const error_code&)> done) {
  stream.expires_after(idle);
  if (lower_case(request.header("expect")) != "100-continue") {
    done({});
    return;
  }
  static constexpr std::string_view kContinue = "HTTP/1.1 100 Continue\r\n\r\n";
  boost::asio::async_write(
      stream,
      boost::asio::buffer(kContinue),
      [done = std::move(done)](const error_code& error, std::size_t) { done(error); });
}

}  // namespace overfly::net
