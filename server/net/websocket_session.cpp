#include "server/net/websocket_session.hpp"

#include <array>
#include <boost/asio/dispatch.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <deque>
#include <optional>
#include <utility>

#include "core/barrier.hpp"
#include "server/net/http/json_text.hpp"
#include "server/net/stream/viewer.hpp"
#include "server/timeline/run_timeline.hpp"
#include "server/views/picture_request.hpp"

namespace overfly::net {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using beast::error_code;

constexpr std::uint16_t kTooSlow = 4000;
/// Time for a slow client to receive the message in progress before the close frame.
constexpr std::chrono::seconds kCloseGrace{5};
constexpr std::chrono::seconds kFarewellGrace{1};

std::int64_t monotonic_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

/// One message in the send queue.
struct Outgoing {
  std::string text;  ///< a text message, unless there is a picture
  std::array<std::uint8_t, kPictureHeaderBytes> header{};
  std::shared_ptr<const std::vector<std::uint8_t>> payload;
  PictureTicket ticket;

  [[nodiscard]] std::size_t bytes() const {
    return payload ? header.size() + payload->size() : text.size();
  }
};

using Timeline = Result<std::shared_ptr<server::RunTimeline>>;

class WebSocketSession final : public ViewerPort,
                               public std::enable_shared_from_this<WebSocketSession> {
 public:
  WebSocketSession(tcp::socket socket,
                   std::shared_ptr<ServerContext> context,
                   std::unique_ptr<ConnectionTable::Place> place)
      : context_(std::move(context)),
        place_(std::move(place)),
        ws_(std::move(socket)),
        timer_(ws_.get_executor()),
        viewer_(*this),
        client_(context_->next_client++) {}
  ~WebSocketSession() override {
    (void)contained(
        [this] {
          if (registered_) context_->sessions.remove(*registered_);
          context_->views.forget(client_);
        },
        [this](const char* what) { report(what); });
  }

  void run(const http::request<http::string_body>& upgrade);

  void send_text(std::string text) override;
  void send_picture(const PictureTicket& ticket,
                    const PictureHeader& header,
                    std::shared_ptr<const std::vector<std::uint8_t>> payload) override;
  void draw(const PictureTicket& ticket, const server::PictureRequest& request) override;
  void open_run(const std::string& run_id) override;
  [[nodiscard]] std::optional<double> picture_limit_hz() const override {
    return context_->runs.picture_rate().limit_hz();
  }
  [[nodiscard]] std::size_t unsent_bytes() const override { return unsent_bytes_; }

 private:
  void greet();
  void read();
  void on_read(const error_code& error);
  void run_opened(Timeline timeline);
  void picture_ready(const PictureTicket& ticket, const Result<server::Picture>& picture);
  void enqueue(Outgoing message);
  void write();
  void on_written(const error_code& error);
  void schedule();
  void on_timer(const error_code& error);
  void check_pace();
  void close_too_slow();
  void go_away();
  void close_with(const websocket::close_reason& reason, std::chrono::seconds grace);
  void send_close_frame();
  void end();
  void report(const char* what) const {
    context_->log("error", std::string("a viewer's connection failed: ") + what);
  }
  /// Runs a step of the session; an exception ends the session.
  template <typename Step>
  void attempt(const Step& step) noexcept {
    const auto fail = [this](const char* what) {
      report(what);
      end();
    };
    if (!contained(step, fail)) (void)contained([this] { end(); }, [](const char*) {});
  }

  std::shared_ptr<ServerContext> context_;
  std::unique_ptr<ConnectionTable::Place> place_;
  websocket::stream<beast::tcp_stream> ws_;
  beast::flat_buffer read_buffer_;
  std::deque<Outgoing> queue_;  ///< the front one is being sent while writing_
  std::size_t unsent_bytes_ = 0;
  std::int64_t write_began_ns_ = 0;
  bool writing_ = false;
  bool closing_ = false;
  bool ended_ = false;
  websocket::close_reason reason_;  ///< valid once closing_
  std::optional<std::uint64_t> registered_;
  std::shared_ptr<WebSocketSession>
      unread_;  ///< keeps the session alive while it does not read because the viewer is full
  asio::steady_timer timer_;
  Viewer viewer_;
  std::uint64_t client_;
};

void WebSocketSession::run(const http::request<http::string_body>& upgrade) {
  const ServerLimits& limits = context_->options.limits;
  error_code ignored;
  auto& socket = beast::get_lowest_layer(ws_).socket();
  socket.set_option(tcp::no_delay(true), ignored);
  socket.set_option(asio::socket_base::send_buffer_size(limits.send_buffer_bytes), ignored);
  beast::get_lowest_layer(ws_).expires_never();
  websocket::stream_base::timeout timeout{};
  timeout.handshake_timeout = std::chrono::milliseconds(limits.idle_ms);
  timeout.idle_timeout = std::chrono::milliseconds(limits.idle_ms);
  timeout.keep_alive_pings = true;
  ws_.set_option(timeout);
  ws_.read_message_max(limits.max_message_bytes);
  ws_.auto_fragment(false);
  ws_.async_accept(upgrade, [self = shared_from_this()](const error_code& error) {
    if (!error) self->attempt([&] { self->greet(); });
  });
}

void WebSocketSession::greet() {
  registered_ = context_->sessions.add([weak = weak_from_this(), executor = ws_.get_executor()] {
    asio::post(executor, [weak] {
      if (const auto session = weak.lock()) session->attempt([&] { session->go_away(); });
    });
  });
  viewer_.greet("c" + std::to_string(client_));
  read();
}

void WebSocketSession::read() {
  ws_.async_read(read_buffer_, [self = shared_from_this()](const error_code& error, std::size_t) {
    self->attempt([&] { self->on_read(error); });
  });
}

void WebSocketSession::on_read(const error_code& error) {
  if (error) {
    end();
    return;
  }
  if (!closing_) {
    // A binary message is not JSON: it is answered as one that could not be parsed.
    viewer_.handle(ws_.got_text() ? beast::buffers_to_string(read_buffer_.data()) : std::string(),
                   monotonic_ns());
    schedule();
  }
  read_buffer_.consume(read_buffer_.size());
  if (viewer_.full()) {
    unread_ = shared_from_this();
  } else {
    read();
  }
}

void WebSocketSession::open_run(const std::string& run_id) {
  context_->offload([weak = weak_from_this(), context = context_, run_id] {
    Timeline timeline = Error{ErrorCode::kInternal, {}};
    (void)contained([&] { timeline = context->runs.timeline(run_id); },
                    [&](const char* what) {
                      timeline = Error{ErrorCode::kInternal, "run " + run_id + ": " + what};
                      context->log("error", timeline.error().message);
                    });
    context->deliver([&] {
      const auto self = weak.lock();
      if (!self) return;
      asio::post(self->ws_.get_executor(), [weak, opened = timeline]() mutable {
        const auto session = weak.lock();
        if (session) session->attempt([&] { session->run_opened(std::move(opened)); });
      });
    });
  });
}

void WebSocketSession::run_opened(Timeline timeline) {
  if (closing_ || ended_) return;
  viewer_.run_opened(std::move(timeline), monotonic_ns());
  schedule();
  if (unread_ && !viewer_.full()) {
    unread_.reset();
    read();
  }
}

void WebSocketSession::send_text(std::string text) {
  Outgoing message;
  message.text = std::move(text);
  enqueue(std::move(message));
}

void WebSocketSession::send_picture(const PictureTicket& ticket,
                                    const PictureHeader& header,
                                    std::shared_ptr<const std::vector<std::uint8_t>> payload) {
  Outgoing message;
  message.header = encode_picture_header(header);
  message.payload = std::move(payload);
  message.ticket = ticket;
  enqueue(std::move(message));
}

void WebSocketSession::draw(const PictureTicket& ticket, const server::PictureRequest& request) {
  const auto done = [weak = weak_from_this(), context = context_, ticket](
                        const Result<server::Picture>& picture) {
    context->deliver([&] {
      const auto self = weak.lock();
      if (!self) return;
      asio::post(self->ws_.get_executor(), [weak, ticket, picture] {
        const auto session = weak.lock();
        if (session) session->attempt([&] { session->picture_ready(ticket, picture); });
      });
    });
  };
  context_->views.request(client_, static_cast<int>(ticket.stream_id), request, done);
}

void WebSocketSession::picture_ready(const PictureTicket& ticket,
                                     const Result<server::Picture>& picture) {
  if (closing_) return;
  viewer_.picture_ready(ticket, picture, monotonic_ns());
  schedule();
}

void WebSocketSession::enqueue(Outgoing message) {
  if (closing_ || ended_) return;
  unsent_bytes_ += message.bytes();
  queue_.push_back(std::move(message));
  check_pace();
  if (!writing_ && !closing_) write();
}

void WebSocketSession::write() {
  writing_ = true;
  write_began_ns_ = monotonic_ns();
  const Outgoing& message = queue_.front();
  const auto written = [self = shared_from_this()](const error_code& error, std::size_t) {
    self->attempt([&] { self->on_written(error); });
  };
  if (message.payload) {
    ws_.binary(true);
    const std::array<asio::const_buffer, 2> parts = {asio::buffer(message.header),
                                                     asio::buffer(*message.payload)};
    ws_.async_write(parts, written);
  } else {
    ws_.text(true);
    ws_.async_write(asio::buffer(message.text), written);
  }
}

void WebSocketSession::on_written(const error_code& error) {
  writing_ = false;
  if (error) {
    end();
    return;
  }
  const Outgoing message = std::move(queue_.front());
  queue_.pop_front();
  unsent_bytes_ -= message.bytes();
  if (closing_) {
    send_close_frame();
    return;
  }
  if (!queue_.empty()) write();
  if (message.payload) {
    viewer_.picture_sent(message.ticket, monotonic_ns());
    schedule();
  }
}

void WebSocketSession::schedule() {
  const auto after_ns = viewer_.tick_after_ns();
  if (!after_ns || closing_ || ended_) return;
  timer_.expires_after(std::chrono::nanoseconds(*after_ns));
  timer_.async_wait([weak = weak_from_this()](const error_code& error) {
    if (const auto self = weak.lock()) self->attempt([&] { self->on_timer(error); });
  });
}

void WebSocketSession::on_timer(const error_code& error) {
  if (error || closing_ || ended_) return;
  viewer_.tick(monotonic_ns());
  check_pace();
  schedule();
}

void WebSocketSession::check_pace() {
  const ServerLimits& limits = context_->options.limits;
  const std::int64_t stalled_ms = writing_ ? (monotonic_ns() - write_began_ns_) / 1'000'000 : 0;
  if (unsent_bytes_ > limits.max_unsent_bytes || stalled_ms > limits.max_stall_ms) {
    close_too_slow();
  }
}

void WebSocketSession::close_too_slow() {
  if (closing_) return;
  context_->log("warning", "a slow client was disconnected (it may reconnect and resume)");
  close_with({static_cast<websocket::close_code>(kTooSlow), "too slow"}, kCloseGrace);
}

void WebSocketSession::go_away() {
  close_with({websocket::close_code::going_away, "the server is shutting down"}, kFarewellGrace);
}

/// The message in progress cannot be withdrawn: the close frame follows it. If the client receives
/// nothing at all, the connection ends without a close frame.
void WebSocketSession::close_with(const websocket::close_reason& reason,
                                  std::chrono::seconds grace) {
  if (closing_ || ended_) return;
  closing_ = true;
  reason_ = reason;
  if (queue_.size() > 1) queue_.erase(queue_.begin() + 1, queue_.end());
  context_->views.forget(client_);
  timer_.expires_after(grace);
  timer_.async_wait([weak = weak_from_this()](const error_code& error) {
    const auto self = weak.lock();
    if (self && !error) self->attempt([&] { self->end(); });
  });
  if (!writing_) send_close_frame();
}

void WebSocketSession::send_close_frame() {
  ws_.async_close(reason_, [self = shared_from_this()](const error_code&) {
    self->attempt([&] { self->end(); });
  });
}

void WebSocketSession::end() {
  if (ended_) return;
  ended_ = true;
  unread_.reset();
  timer_.cancel();
  context_->views.forget(client_);
  beast::get_lowest_layer(ws_).close();
}

}  // namespace

void serve_websocket(tcp::socket socket,
                     const http::request<http::string_body>& upgrade,
                     std::shared_ptr<ServerContext> context,
                     std::unique_ptr<ConnectionTable::Place> place) {
  std::make_shared<WebSocketSession>(std::move(socket), std::move(context), std::move(place))
      ->run(upgrade);
}

}  // namespace overfly::net
