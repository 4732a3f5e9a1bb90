#include "server/net/http_session.hpp"

#include <atomic>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <chrono>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "core/barrier.hpp"
#include "server/net/admission.hpp"
#include "server/net/answer_sender.hpp"
#include "server/net/http/error_response.hpp"
#include "server/net/http_answers.hpp"
#include "server/net/upload_receiver.hpp"
#include "server/net/websocket_services.hpp"
#include "server/net/websocket_session.hpp"

namespace overfly::net {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using asio::ip::tcp;
using beast::error_code;

constexpr const char* kApiPrefix = "/api/";
/// Size of the buffer for pipelined requests.
constexpr std::size_t kReadBufferBytes = std::size_t{128} << 10U;
constexpr std::uint64_t kNoLimit = std::numeric_limits<std::uint64_t>::max();
/// A picture may wait for a world to open and for tiles to load, but not indefinitely.
constexpr std::chrono::seconds kAnswerLimit{120};
/// Limits for reading the rest of a request that was rejected by its header.
constexpr std::size_t kDrainBytes = std::size_t{2} << 20U;
constexpr std::size_t kDrainStepBytes = std::size_t{16} << 10U;
constexpr std::chrono::seconds kDrainLimit{2};

class HttpSession final : public std::enable_shared_from_this<HttpSession> {
 public:
  HttpSession(tcp::socket socket, std::shared_ptr<ServerContext> context)
      : context_(std::move(context)),
        stream_(std::move(socket)),
        answer_limit_(stream_.get_executor()),
        buffer_(kReadBufferBytes) {}

  void start();

 private:
  void read();
  void on_header(const error_code& error);
  void read_body();
  void receive_body();
  void on_body(const error_code& error);
  void refuse(const error_code& error);
  void dispatch();
  [[nodiscard]] HttpResponse stream_without_upgrade() const;
  void upgrade();
  void ask_router();
  void watch_client();
  void answer(std::uint64_t number, HttpResponse response);
  void write(HttpResponse response);
  void on_written(const error_code& error, bool keep_alive);
  void drain();
  void close();
  void end();
  template <typename Step>
  void attempt(const Step& step) noexcept {
    (void)contained(step, [this](const char* what) { fail(what); });
  }
  void fail(const char* what);

  std::shared_ptr<ServerContext> context_;
  std::unique_ptr<ConnectionTable::Place> place_;
  beast::tcp_stream stream_;
  /// Runs while an answer is awaited; keeps the session alive meanwhile.
  asio::steady_timer answer_limit_;
  beast::flat_buffer buffer_;
  std::optional<http::request_parser<http::string_body>> parser_;
  std::optional<http::response<http::string_body>> response_;
  HttpRequest request_;
  std::string request_line_;  ///< method and target of the admitted request, for the log
  std::vector<char> drained_;
  std::size_t drained_bytes_ = 0;
  std::uint64_t request_number_ = 0;  ///< an answer with another number comes too late
  /// Of the request that the router is answering: nobody waits any more.
  std::shared_ptr<std::atomic<bool>> abandoned_;
  bool body_complete_ = false;  ///< of a body that was not read by parser_
  bool admitted_ = false;       ///< a request of this connection had the token
  bool failed_ = false;
  bool head_ = false;
  bool keep_alive_ = false;
  unsigned version_ = 11;
};

void HttpSession::start() {
  place_ = context_->connections.add([weak = weak_from_this(), executor = stream_.get_executor()] {
    asio::post(executor, [weak] {
      if (const auto self = weak.lock()) self->end();
    });
  });
  read();
}

/// Reads only the header first: no body is accepted before the token was checked.
void HttpSession::read() {
  const ServerLimits& limits = context_->options.limits;
  if (admitted_ && !place_->enter(ConnectionPhase::kIdle)) {
    end();
    return;
  }
  parser_.emplace();
  parser_->body_limit(kNoLimit);
  parser_->header_limit(static_cast<std::uint32_t>(limits.max_header_bytes));
  stream_.expires_after(std::chrono::milliseconds(admitted_ ? limits.idle_ms : limits.header_ms));
  http::async_read_header(stream_,
                          buffer_,
                          *parser_,
                          [self = shared_from_this()](const error_code& error, std::size_t) {
                            self->attempt([&] { self->on_header(error); });
                          });
}

void HttpSession::on_header(const error_code& error) {
  if (error) {
    refuse(error);
    return;
  }
  const http::request<http::string_body>& message = parser_->get();
  head_ = message.method() == http::verb::head;
  keep_alive_ = message.keep_alive();
  version_ = message.version();
  ++request_number_;
  request_ = plain_request(message);
  error_code ignored;
  const auto local = stream_.socket().local_endpoint(ignored).address();
  if (auto response = not_admitted(*context_, local, &request_)) {
    const bool redirected = response->status == 303;
    keep_alive_ = keep_alive_ && redirected && parser_->is_done();
    admitted_ = admitted_ || redirected;
    write(std::move(*response));
    return;
  }
  if (beast::websocket::is_upgrade(message) && is_websocket_target(request_.target)) {
    upgrade();
    return;
  }
  if (!place_->enter(ConnectionPhase::kReceiving)) {
    keep_alive_ = false;
    write(error_response(503, "too_many_connections", "all connections are busy: try again soon"));
    return;
  }
  admitted_ = true;
  request_line_ = request_.method + " " + request_.target;
  if (context_->router.is_upload(request_)) {
    receive_body();
  } else {
    read_body();
  }
}

void HttpSession::receive_body() {
  UploadConnection connection{
      stream_,
      buffer_,
      *parser_,
      std::move(request_),
      [self = shared_from_this()](std::optional<HttpResponse> response, bool complete) {
        self->attempt([&] {
          self->body_complete_ = complete;
          self->keep_alive_ = self->keep_alive_ && complete;
          if (response) {
            self->write(std::move(*response));
          } else {
            self->close();
          }
        });
      }};
  receive_upload(context_, std::move(connection));
  parser_.reset();
}

void HttpSession::upgrade() {
  const http::request<http::string_body> message = parser_->get();
  const auto service = websocket_service(message, request_, context_);
  if (!service) {
    keep_alive_ = false;
    write(error_response(service.error()));
    return;
  }
  if (!place_->enter(web_socket_phase(request_))) {
    keep_alive_ = false;
    write(too_many_viewers(context_->options.limits.connections.max_viewers));
    return;
  }
  serve_websocket(stream_.release_socket(), message, context_, std::move(place_), *service);
}

void HttpSession::read_body() {
  const ServerLimits& limits = context_->options.limits;
  if (parser_->content_length().value_or(0) > limits.max_body_bytes) {
    refuse(http::error::body_limit);
    return;
  }
  parser_->body_limit(limits.max_body_bytes);
  invite_body(stream_,
              request_,
              std::chrono::milliseconds(limits.idle_ms),
              [self = shared_from_this()](const error_code& error) {
                if (error) return;
                const auto done = [self](const error_code& failure, std::size_t) {
                  self->attempt([&] { self->on_body(failure); });
                };
                self->attempt(
                    [&] { http::async_read(self->stream_, self->buffer_, *self->parser_, done); });
              });
}

void HttpSession::on_body(const error_code& error) {
  if (error) {
    refuse(error);
    return;
  }
  stream_.expires_never();
  request_.body = std::move(parser_->get().body());
  dispatch();
}

void HttpSession::refuse(const error_code& error) {
  keep_alive_ = false;
  auto response = answer_to_unreadable_request(error, context_->options.limits.max_body_bytes);
  if (response) {
    write(std::move(*response));
  } else {
    close();
  }
}

void HttpSession::dispatch() {
  if (is_websocket_target(request_.target)) {
    write(stream_without_upgrade());
  } else if (request_.target.starts_with(kApiPrefix)) {
    ask_router();
  } else {
    write(context_->files.serve(request_));
  }
}

/// The answer that the upgrade would have got, because a browser does not show that to its page.
HttpResponse HttpSession::stream_without_upgrade() const {
  if (!context_->connections.has_room_for(web_socket_phase(request_))) {
    return too_many_viewers(context_->options.limits.connections.max_viewers);
  }
  return error_response(426, "upgrade_required", "this is a WebSocket: request an upgrade");
}

void HttpSession::ask_router() {
  if (!place_->enter(ConnectionPhase::kAnswering)) {
    end();
    return;
  }
  const std::uint64_t number = request_number_;
  answer_limit_.expires_after(kAnswerLimit);
  answer_limit_.async_wait([self = shared_from_this(), number](const error_code& error) {
    if (error) return;
    self->attempt(
        [&] { self->answer(number, error_response(503, "timeout", "the answer took too long")); });
  });
  const Respond respond = [weak = weak_from_this(), context = context_, number](HttpResponse made) {
    std::shared_ptr<HttpResponse> response;
    context->deliver([&] {
      if (!response) response = std::make_shared<HttpResponse>(std::move(made));
      const auto self = weak.lock();
      if (!self) return;
      asio::post(self->stream_.get_executor(), [weak, number, response] {
        const auto session = weak.lock();
        if (session) session->attempt([&] { session->answer(number, std::move(*response)); });
      });
    });
  };
  if (context_->router.is_quick(request_)) {
    context_->router.handle(request_, respond);
    return;
  }
  abandoned_ = std::make_shared<std::atomic<bool>>(false);
  request_.abandoned = abandoned_;
  watch_client();
  context_->offload([context = context_, respond, asked = std::move(request_)] {
    context->router.handle(asked, respond);
  });
}

/// Notices that the client closes the connection while the router works on its answer.
void HttpSession::watch_client() {
  stream_.socket().async_wait(
      tcp::socket::wait_read,
      [weak = weak_from_this(), number = request_number_](const error_code&) {
        const auto self = weak.lock();
        if (!self || self->request_number_ != number) return;
        error_code error;
        char next = 0;
        self->stream_.socket().non_blocking(true, error);
        const std::size_t there = self->stream_.socket().receive(
            asio::buffer(&next, 1), tcp::socket::message_peek, error);
        // The next request may be there already: then nothing is noticed.
        const bool gone = there == 0 && error != asio::error::would_block;
        if (gone && self->abandoned_) *self->abandoned_ = true;
      });
}

void HttpSession::answer(std::uint64_t number, HttpResponse response) {
  if (number != request_number_) return;
  ++request_number_;
  if (abandoned_) *abandoned_ = true;
  answer_limit_.cancel();
  write(std::move(response));
}

void HttpSession::write(HttpResponse response) {
  if (!response.failure.empty()) {
    context_->log("error", request_line_ + " failed: " + response.failure);
  }
  if (admitted_ && place_) (void)place_->enter(ConnectionPhase::kSending);
  response_.emplace(http_answer(std::move(response), version_, keep_alive_, head_));
  send_answer(stream_,
              *response_,
              std::chrono::milliseconds(context_->options.limits.idle_ms),
              [self = shared_from_this()](const error_code& error) {
                self->attempt([&] { self->on_written(error, self->keep_alive_); });
              });
}

void HttpSession::on_written(const error_code& error, bool keep_alive) {
  response_.reset();
  if (error) return;
  if (keep_alive) {
    read();
    return;
  }
  close();
  if (parser_ ? parser_->is_done() : body_complete_) return;
  drained_.resize(kDrainStepBytes);
  stream_.expires_after(kDrainLimit);
  drain();
}

/// Reads the rest of a request that was answered early: closing a connection with unread bytes
/// resets it, and the client may lose the answer.
void HttpSession::drain() {
  stream_.async_read_some(asio::buffer(drained_),
                          [self = shared_from_this()](const error_code& error, std::size_t n) {
                            self->drained_bytes_ += n;
                            if (error || self->drained_bytes_ >= kDrainBytes) return;
                            self->attempt([&] { self->drain(); });
                          });
}

void HttpSession::close() {
  error_code ignored;
  stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
}

/// Answers an exception in a step of the connection with 500, or closes the connection if an answer
/// is being sent.
void HttpSession::fail(const char* what) {
  const bool again = std::exchange(failed_, true);
  keep_alive_ = false;
  ++request_number_;
  answer_limit_.cancel();
  context_->log("error", std::string("a connection failed: ") + what);
  if (again || response_) {
    end();
    return;
  }
  attempt([this] { write(internal_error_response()); });
}

/// Closes at once, in any phase.
void HttpSession::end() {
  ++request_number_;
  if (abandoned_) *abandoned_ = true;
  answer_limit_.cancel();
  stream_.close();
}

}  // namespace

void serve_http(tcp::socket socket, std::shared_ptr<ServerContext> context) {
  std::make_shared<HttpSession>(std::move(socket), std::move(context))->start();
}

}  // namespace overfly::net
