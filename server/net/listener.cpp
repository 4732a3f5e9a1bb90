#include "server/net/listener.hpp"

#include <boost/asio/ip/address.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/strand.hpp>
#include <chrono>
#include <utility>

#include "server/net/http_session.hpp"

namespace overfly::net {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

/// Wait after a failed accept (no file descriptors left), so that it does not spin.
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
  void accept();

 private:
  void on_accept(const error_code& error, tcp::socket socket);

  asio::io_context& loop_;
  tcp::acceptor acceptor_;
  asio::steady_timer pause_;
  std::shared_ptr<ServerContext> context_;
};

error_code Listener::open(const tcp::endpoint& endpoint) {
  error_code error;
  acceptor_.open(endpoint.protocol(), error);
  if (!error) acceptor_.set_option(asio::socket_base::reuse_address(true), error);
  if (!error) acceptor_.bind(endpoint, error);
  if (!error) acceptor_.listen(asio::socket_base::max_listen_connections, error);
  return error;
}

void Listener::accept() {
  acceptor_.async_accept(asio::make_strand(loop_),
                         [self = shared_from_this()](const error_code& error, tcp::socket socket) {
                           self->on_accept(error, std::move(socket));
                         });
}

void Listener::on_accept(const error_code& error, tcp::socket socket) {
  if (error) {
    pause_.expires_after(kAcceptPause);
    pause_.async_wait([self = shared_from_this()](const error_code& stopped) {
      if (!stopped) self->accept();
    });
    return;
  }
  const auto strand = socket.get_executor();
  asio::dispatch(strand, [moved = std::move(socket), context = context_]() mutable {
    serve_http(std::move(moved), context);
  });
  accept();
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
