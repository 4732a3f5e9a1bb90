#include "server/net/listener.hpp"

#include <boost/asio/ip/address.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <string>
#include <thread>
#include <utility>

#include "core/barrier.hpp"
#include "server/net/http_session.hpp"

namespace overfly::net {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

/// Pause after a failed accept (no file descriptors left), to avoid a busy loop.
constexpr std::chrono::milliseconds kAcceptPause{100};

class Listener final : public std::enable_shared_from_this<Listener> {
 public:
  Listener(asio::io_context* loop, std::shared_ptr<ServerContext> context)
      : loop_(*loop), acceptor_(*loop), pause_(*loop), context_(std::move(context)) {}

  error_code open(const tcp::endpoint& endpoint);
  [[nodiscard]] std::uint16_t port() const {
    error_code ignored;
    return acceptor_.local_endpoint(ignored).port();
  }
  void accept() noexcept;

 private:
  class OnAccept;
  void on_accept(const error_code& error, tcp::socket socket);
  void report(const char* what) const;

  asio::io_context& loop_;
  tcp::acceptor acceptor_;
  asio::steady_timer pause_;
  std::shared_ptr<ServerContext> context_;
  bool starting_ = false;  ///< accept() is running: a handler that it drops need not call it again
};

error_code Listener::open(const tcp::endpoint& endpoint) {
  error_code error;
  acceptor_.open(endpoint.protocol(), error);
  if (!error) acceptor_.set_option(asio::socket_base::reuse_address(true), error);
  // Connections inherit it.
  const int send_buffer_bytes = context_->options.limits.send_buffer_bytes;
  if (!error) acceptor_.set_option(asio::socket_base::send_buffer_size(send_buffer_bytes), error);
  if (!error) acceptor_.bind(endpoint, error);
  if (!error) acceptor_.listen(asio::socket_base::max_listen_connections, error);
  return error;
}

/// Accepts the connection. If the handler is destroyed without a call, for example by an exception
/// in Asio, it starts the next accept, since the server could not accept connections any more.
class Listener::OnAccept {
 public:
  explicit OnAccept(std::shared_ptr<Listener> listener) : listener_(std::move(listener)) {}
  OnAccept(OnAccept&&) = default;
  OnAccept(const OnAccept&) = delete;
  OnAccept& operator=(const OnAccept&) = delete;
  OnAccept& operator=(OnAccept&&) = delete;
  ~OnAccept() {
    if (listener_) listener_->accept();
  }
  void operator()(const error_code& error, tcp::socket socket) {
    std::exchange(listener_, nullptr)->on_accept(error, std::move(socket));
  }

 private:
  std::shared_ptr<Listener> listener_;
};

void Listener::accept() noexcept {
  if (starting_) return;
  starting_ = true;
  const auto begin = [this] { acceptor_.async_accept(OnAccept(shared_from_this())); };
  const auto log = [this](const char* what) { report(what); };
  while (!loop_.stopped() && !contained(begin, log)) std::this_thread::sleep_for(kAcceptPause);
  starting_ = false;
}

void Listener::on_accept(const error_code& error, tcp::socket socket) {
  const auto wait = [this] {
    pause_.expires_after(kAcceptPause);
    pause_.async_wait([self = shared_from_this()](const error_code& stopped) {
      if (!stopped) self->accept();
    });
  };
  const auto serve = [&] { serve_http(std::move(socket), context_); };
  const auto log = [this](const char* what) { report(what); };
  if (error && contained(wait, log)) return;
  if (!error) (void)contained(serve, log);
  accept();
}

void Listener::report(const char* what) const {
  context_->log("error", std::string("a connection could not be accepted: ") + what);
}

}  // namespace

Result<std::uint16_t> listen(asio::io_context* loop,
                             const std::shared_ptr<ServerContext>& context) {
  const ServerOptions& options = context->options;
  error_code error;
  const std::string name = options.address == "localhost" ? "127.0.0.1" : options.address;
  const auto address = asio::ip::make_address(name, error);
  if (error) {
    return Error{ErrorCode::kInvalidArgument,
                 "address = " + options.address + ": must be an IPv4 or IPv6 address"};
  }
  const auto listener = std::make_shared<Listener>(loop, context);
  if (const error_code failed = listener->open({address, options.port})) {
    return Error{ErrorCode::kIo,
                 "cannot listen on " + options.address + " port " + std::to_string(options.port) +
                     ": " + failed.message()};
  }
  listener->accept();
  return listener->port();
}

}  // namespace overfly::net
