#include "server/net/websocket_session.hpp"

#include <algorithm>
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

/// The newest run that flies, or else the newest one. @param runs  newest first
std::optional<std::string> newest_run(const server::RunList& runs) {
  const auto flies = std::find_if(runs.begin(), runs.end(), [](const auto& run) {
    return run->status == server::RunStatus::kRunning;
  });
  if (flies != runs.end()) return (*flies)->id;
  const auto flown =
      std::find_if(runs.begin(), runs.end(), [](const auto& run) { return run->frames > 0; });
  return flown == runs.end() ? std::nullopt : std::optional((*flown)->id);
}

std::int64_t monotonic_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

/// One message in the send queue.
struct Outgoing {
  std::string text;                ///< a text message, unless there are bytes
  std::vector<std::uint8_t> head;  ///< of a binary message
  std::shared_ptr<const std::vector<std::uint8_t>> payload;  ///< follows the head; may be null
  std::optional<PictureTicket> ticket;                       ///< of a picture

  [[nodiscard]] std::size_t bytes() const {
    return text.size() + head.size() + (payload ? payload->size() : 0);
  }
};

using Timeline = Result<std::shared_ptr<server::RunTimeline>>;

class WebSocketSession final : public ViewerPort,
                               public std::enable_shared_from_this<WebSocketSession> {
 public:
  WebSocketSession(tcp::socket socket,
                   std::shared_ptr<ServerContext> context,
                   std::unique_ptr<ConnectionTable::Place> place,
                   const WebSocketService& service)
      : context_(std::move(context)),
        place_(std::move(place)),
        ws_(std::move(socket)),
        timer_(ws_.get_executor()),
        protocol_(service.protocol),
        client_(service.make_client(*this)),
        number_(context_->next_client++) {}
  ~WebSocketSession() override {
    (void)contained(
        [this] {
          if (registered_) context_->sessions.remove(*registered_);
          context_->views.forget(number_);
        },
        [this](const char* what) { report(what); });
  }

  void run(const http::request<http::string_body>& upgrade);

  void send_text(std::string text) override;
  void send_binary(std::vector<std::uint8_t> message) override;
  void send_picture(const PictureTicket& ticket,
                    std::vector<std::uint8_t> head,
                    std::shared_ptr<const std::vector<std::uint8_t>> payload) override;
  void draw(const PictureTicket& ticket, const server::PictureRequest& request) override;
  void open_run(const std::string& run_id) override;
  void open_newest_run() override;
  void work(std::function<std::function<void()>()> slow) override;
  [[nodiscard]] std::optional<double> picture_limit_hz() const override {
    return context_->runs.picture_rate().limit_hz();
  }
  [[nodiscard]] std::size_t unsent_bytes() const override { return unsent_bytes_; }

 private:
  void greet();
  void read();
  void on_read(const error_code& error);
  void take(std::int64_t now_ns);
  void open(std::function<Timeline(server::RunManager&)> opened);
  void run_opened(Timeline timeline);
  void finish_work(const std::function<void()>& then);
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

  /// Lets a session that is still there take a step on its own thread. Callable on any thread.
  template <typename Step>
  static void post_step(const std::weak_ptr<WebSocketSession>& weak,
                        ServerContext& context,
                        const Step& step) {
    context.deliver([&] {
      const auto self = weak.lock();
      if (!self) return;
      // A copy: without memory for the post, the step is needed for the next try.
      asio::post(self->ws_.get_executor(), [weak, step] {
        const auto session = weak.lock();
        if (session) session->attempt([&] { step(*session); });
      });
    });
  }

  std::shared_ptr<ServerContext> context_;
  std::unique_ptr<ConnectionTable::Place> place_;
  websocket::stream<beast::tcp_stream, false> ws_;  ///< pictures are compressed already
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
  std::string protocol_;
  std::unique_ptr<StreamClient> client_;
  std::uint64_t number_;  ///< for the view service
};

void WebSocketSession::run(const http::request<http::string_body>& upgrade) {
  const ServerLimits& limits = context_->options.limits;
  error_code ignored;
  auto& socket = beast::get_lowest_layer(ws_).socket();
  socket.set_option(tcp::no_delay(true), ignored);
  beast::get_lowest_layer(ws_).expires_never();
  websocket::stream_base::timeout timeout{};
  timeout.handshake_timeout = std::chrono::milliseconds(limits.idle_ms);
  timeout.idle_timeout = std::chrono::milliseconds(limits.idle_ms);
  timeout.keep_alive_pings = true;
  ws_.set_option(timeout);
  ws_.read_message_max(limits.max_message_bytes);
  ws_.auto_fragment(false);
  if (!protocol_.empty()) {
    ws_.set_option(websocket::stream_base::decorator([this](websocket::response_type& response) {
      response.set(http::field::sec_websocket_protocol, protocol_);
    }));
  }
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
  client_->greet("c" + std::to_string(number_));
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
  if (!closing_) take(monotonic_ns());
  read_buffer_.consume(read_buffer_.size());
  if (client_->full()) {
    unread_ = shared_from_this();
  } else {
    read();
  }
}

void WebSocketSession::take(std::int64_t now_ns) {
  const asio::const_buffer bytes = read_buffer_.data();
  if (ws_.got_text()) {
    client_->take_text(std::string(static_cast<const char*>(bytes.data()), bytes.size()), now_ns);
  } else {
    client_->take_binary({static_cast<const std::uint8_t*>(bytes.data()), bytes.size()}, now_ns);
  }
  schedule();
}

void WebSocketSession::open_run(const std::string& run_id) {
  open([run_id](server::RunManager& runs) { return runs.timeline(run_id); });
}

void WebSocketSession::open_newest_run() {
  open([](server::RunManager& runs) -> Timeline {
    const auto run_id = newest_run(runs.runs());
    if (!run_id)
      return Error{ErrorCode::kNotFound, "no run was flown yet: start one, connect again"};
    return runs.timeline(*run_id);
  });
}

void WebSocketSession::open(std::function<Timeline(server::RunManager&)> opened) {
  context_->offload([weak = weak_from_this(), context = context_, opened = std::move(opened)] {
    Timeline timeline = Error{ErrorCode::kInternal, {}};
    (void)contained(
        [&] { timeline = opened(context->runs); },
        [&](const char* what) {
          timeline = Error{ErrorCode::kInternal, std::string("a run cannot be opened: ") + what};
          context->log("error", timeline.error().message);
        });
    post_step(
        weak, *context, [timeline](WebSocketSession& session) { session.run_opened(timeline); });
  });
}

void WebSocketSession::run_opened(Timeline timeline) {
  if (closing_ || ended_) return;
  client_->run_opened(std::move(timeline), monotonic_ns());
  schedule();
  if (unread_ && !client_->full()) {
    unread_.reset();
    read();
  }
}

void WebSocketSession::work(std::function<std::function<void()>()> slow) {
  context_->offload([weak = weak_from_this(), context = context_, asked = std::move(slow)] {
    std::function<void()> then;
    (void)contained([&] { then = asked(); },
                    [&](const char* what) {
                      context->log("error", std::string("work for a viewer failed: ") + what);
                    });
    if (!then) return;
    post_step(weak, *context, [then](WebSocketSession& session) { session.finish_work(then); });
  });
}

void WebSocketSession::finish_work(const std::function<void()>& then) {
  if (closing_ || ended_) return;
  then();
  schedule();
}

void WebSocketSession::send_text(std::string text) {
  Outgoing message;
  message.text = std::move(text);
  enqueue(std::move(message));
}

void WebSocketSession::send_binary(std::vector<std::uint8_t> message) {
  Outgoing outgoing;
  outgoing.head = std::move(message);
  enqueue(std::move(outgoing));
}

void WebSocketSession::send_picture(const PictureTicket& ticket,
                                    std::vector<std::uint8_t> head,
                                    std::shared_ptr<const std::vector<std::uint8_t>> payload) {
  Outgoing message;
  message.head = std::move(head);
  message.payload = std::move(payload);
  message.ticket = ticket;
  enqueue(std::move(message));
}

void WebSocketSession::draw(const PictureTicket& ticket, const server::PictureRequest& request) {
  const auto done = [weak = weak_from_this(), context = context_, ticket](
                        const Result<server::Picture>& picture) {
    post_step(weak, *context, [ticket, picture](WebSocketSession& session) {
      session.picture_ready(ticket, picture);
    });
  };
  server::PictureRequest drawn = request;
  if (drawn.video) drawn.video->viewer = number_;
  context_->views.request(number_, static_cast<int>(ticket.stream_id), drawn, done);
}

void WebSocketSession::picture_ready(const PictureTicket& ticket,
                                     const Result<server::Picture>& picture) {
  if (closing_) return;
  client_->picture_ready(ticket, picture, monotonic_ns());
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
  if (!message.head.empty()) {
    ws_.binary(true);
    const std::array<asio::const_buffer, 2> parts = {
        asio::buffer(message.head),
        message.payload ? asio::buffer(*message.payload) : asio::const_buffer()};
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
  if (message.ticket) {
    client_->picture_sent(*message.ticket, monotonic_ns());
    schedule();
  }
}

void WebSocketSession::schedule() {
  const auto after_ns = client_->tick_after_ns();
  if (!after_ns || closing_ || ended_) return;
  timer_.expires_after(std::chrono::nanoseconds(*after_ns));
  timer_.async_wait([weak = weak_from_this()](const error_code& error) {
    if (const auto self = weak.lock()) self->attempt([&] { self->on_timer(error); });
  });
}

void WebSocketSession::on_timer(const error_code& error) {
  if (error || closing_ || ended_) return;
  client_->tick(monotonic_ns());
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
  context_->views.forget(number_);
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
  context_->views.forget(number_);
  beast::get_lowest_layer(ws_).close();
}

}  // namespace

void serve_websocket(tcp::socket socket,
                     const http::request<http::string_body>& upgrade,
                     std::shared_ptr<ServerContext> context,
                     std::unique_ptr<ConnectionTable::Place> place,
                     const WebSocketService& service) {
  std::make_shared<WebSocketSession>(
      std::move(socket), std::move(context), std::move(place), service)
      ->run(upgrade);
}

}  // namespace overfly::net
