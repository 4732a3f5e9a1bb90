#include "server/net/upload_receiver.hpp"

#include <boost/asio/post.hpp>
#include <boost/beast/http/buffer_body.hpp>
#include <boost/beast/http/error.hpp>
#include <boost/beast/http/read.hpp>
#include <chrono>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "server/net/answer_sender.hpp"
#include "server/net/http/error_response.hpp"

namespace overfly::net {
namespace {

namespace asio = boost::asio;
namespace http = boost::beast::http;
using boost::beast::error_code;

constexpr std::size_t kPieceBytes = std::size_t{256} << 10U;

class UploadReceiver final : public std::enable_shared_from_this<UploadReceiver> {
 public:
  UploadReceiver(std::shared_ptr<ServerContext> context, UploadConnection connection)
      : context_(std::move(context)),
        stream_(connection.stream),
        buffer_(connection.buffer),
        parser_(std::move(connection.parser)),
        request_(std::move(connection.request)),
        done_(std::move(connection.done)) {}

  void start() {
    std::optional<std::uint64_t> size;
    if (const auto length = parser_.content_length()) size = *length;
    parser_.eager(true);
    parser_.body_limit(std::numeric_limits<std::uint64_t>::max());
    on_worker([self = shared_from_this(), size] {
      self->context_->router.receive(self->request_, size, &self->sink_, &self->answer_);
      self->on_stream([self] {
        if (self->sink_) {
          self->piece_.resize(kPieceBytes);
          self->invite();
        } else {
          self->done_(std::move(self->answer_), self->parser_.is_done());
        }
      });
    });
  }

 private:
  using Clock = std::chrono::steady_clock;

  void on_worker(std::function<void()> work) {
    stream_.expires_never();
    context_->offload(std::move(work));
  }
  void on_stream(std::function<void()> action) {
    context_->deliver([&] { asio::post(stream_.get_executor(), action); });
  }
  void invite() {
    invite_body(stream_,
                request_,
                std::chrono::milliseconds(context_->options.limits.idle_ms),
                [self = shared_from_this()](const error_code& error) {
                  if (error) {
                    self->done_(std::nullopt, false);
                  } else {
                    self->read();
                  }
                });
  }
  /// Receives the next piece.
  void read() {
    parser_.get().body().data = piece_.data();
    parser_.get().body().size = piece_.size();
    parser_.get().body().more = true;
    if (parser_.is_done()) {
      on_piece();
    } else {
      receive();
    }
  }
  /// Every arrival of bytes begins a new deadline: a slow client is no dead one.
  void receive() {
    stream_.expires_after(std::chrono::milliseconds(context_->options.limits.idle_ms));
    waiting_since_ = Clock::now();
    http::async_read_some(stream_,
                          buffer_,
                          parser_,
                          [self = shared_from_this()](const error_code& error, std::size_t bytes) {
                            self->on_some(error, bytes);
                          });
  }
  void on_some(const error_code& error, std::size_t bytes) {
    if (error && error != http::error::need_buffer) {
      done_(std::nullopt, false);
      return;
    }
    waited_ += Clock::now() - waiting_since_;
    received_bytes_ += bytes;
    const bool piece_complete = error || parser_.is_done() || parser_.get().body().size == 0;
    if (piece_complete) {
      on_piece();
    } else if (too_slow()) {
      give_up();
    } else {
      receive();
    }
  }
  /// Clients that send a byte now and then must not keep the places of others.
  [[nodiscard]] bool too_slow() const {
    const ServerLimits& limits = context_->options.limits;
    if (waited_ <= std::chrono::milliseconds(limits.upload_grace_ms)) return false;
    const double waited_s = std::chrono::duration<double>(waited_).count();
    return static_cast<double>(received_bytes_) <
           waited_s * static_cast<double>(limits.min_upload_bytes_per_s);
  }
  void give_up() {
    on_worker([self = shared_from_this()] {
      self->sink_.reset();
      self->on_stream([self] {
        const ServerLimits& limits = self->context_->options.limits;
        self->done_(error_response(408,
                                   "too_slow",
                                   "the upload is slower than " +
                                       std::to_string(limits.min_upload_bytes_per_s) +
                                       " bytes/s on average"),
                    false);
      });
    });
  }
  void on_piece() {
    const std::size_t bytes = piece_.size() - parser_.get().body().size;
    on_worker([self = shared_from_this(), bytes] {
      self->answer_ = self->sink_->write({self->piece_.data(), bytes});
      const bool complete = self->parser_.is_done();
      if (!self->answer_ && complete) self->answer_ = self->sink_->finish();
      // What was refused is removed before the client knows.
      if (self->answer_) self->sink_.reset();
      self->on_stream([self, complete] {
        if (self->answer_) {
          self->done_(std::move(self->answer_), complete);
        } else {
          self->read();
        }
      });
    });
  }

  std::shared_ptr<ServerContext> context_;
  boost::beast::tcp_stream& stream_;
  boost::beast::flat_buffer& buffer_;
  http::request_parser<http::buffer_body> parser_;
  HttpRequest request_;
  std::function<void(std::optional<HttpResponse>, bool)> done_;
  std::unique_ptr<BodySink> sink_;
  std::optional<HttpResponse> answer_;
  std::vector<std::uint8_t> piece_;
  Clock::time_point waiting_since_;
  Clock::duration waited_{};  ///< for the client's bytes, in all
  std::uint64_t received_bytes_ = 0;
};

}  // namespace

void receive_upload(std::shared_ptr<ServerContext> context, UploadConnection connection) {
  std::make_shared<UploadReceiver>(std::move(context), std::move(connection))->start();
}

}  // namespace overfly::net
