#include "tests/terrain/local_http_server.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <stdexcept>

namespace overfly::testing {
namespace {

void send_all(int socket, const std::string& text) {
  std::size_t sent = 0;
  while (sent < text.size()) {
    const ssize_t n = ::send(socket, text.data() + sent, text.size() - sent, MSG_NOSIGNAL);
    if (n <= 0) return;
    sent += static_cast<std::size_t>(n);
  }
}

HttpRequest parse(const std::string& head) {
  HttpRequest request;
  const std::size_t begin = head.find(' ') + 1;
  const std::string target = head.substr(begin, head.find(' ', begin) - begin);
  const std::size_t question = target.find('?');
  request.path = target.substr(0, question);
  std::string query = question == std::string::npos ? "" : target.substr(question + 1) + "&";
  for (std::size_t end = query.find('&'); end != std::string::npos; end = query.find('&')) {
    const std::string pair = query.substr(0, end);
    const std::size_t equals = pair.find('=');
    if (equals != std::string::npos)
      request.query[pair.substr(0, equals)] = pair.substr(equals + 1);
    query.erase(0, end + 1);
  }
  const std::size_t agent = head.find("User-Agent: ");
  if (agent != std::string::npos) {
    request.user_agent = head.substr(agent + 12, head.find('\r', agent) - agent - 12);
  }
  return request;
}

}  // namespace

LocalHttpServer::LocalHttpServer(Handler handler) : handler_(std::move(handler)) {
  listener_ = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in place{};
  place.sin_family = AF_INET;
  place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof(place);
  if (listener_ < 0 || ::bind(listener_, reinterpret_cast<sockaddr*>(&place), size) != 0 ||
      ::listen(listener_, 16) != 0 ||
      ::getsockname(listener_, reinterpret_cast<sockaddr*>(&place), &size) != 0) {
    throw std::runtime_error("no loopback socket for a test server");
  }
  port_ = ntohs(place.sin_port);
  acceptor_ = std::thread([this] { accept_all(); });
}

LocalHttpServer::~LocalHttpServer() {
  stop_.store(true);
  acceptor_.join();
  for (std::thread& connection : connections_) connection.join();
  ::close(listener_);
}

std::string LocalHttpServer::address() const { return "http://127.0.0.1:" + std::to_string(port_); }

void LocalHttpServer::accept_all() {
  while (!stop_.load()) {
    pollfd wait{listener_, POLLIN, 0};
    constexpr int kLookMs = 20;
    if (::poll(&wait, 1, kLookMs) <= 0) continue;
    const int socket = ::accept(listener_, nullptr, nullptr);
    if (socket < 0) continue;
    connections_.emplace_back([this, socket] {
      serve(socket);
      ::close(socket);
    });
  }
}

void LocalHttpServer::serve(int socket) {
  std::string head;
  char buffer[4096];
  while (head.find("\r\n\r\n") == std::string::npos) {
    const ssize_t n = ::recv(socket, buffer, sizeof(buffer), 0);
    if (n <= 0) return;
    head.append(buffer, static_cast<std::size_t>(n));
  }
  ++requests_;
  const int now = ++running_;
  int most = most_at_a_time_.load();
  while (now > most && !most_at_a_time_.compare_exchange_weak(most, now)) {
  }
  const HttpAnswer answer = handler_(parse(head));
  --running_;  // before the client can know that it may ask again
  std::string text = "HTTP/1.1 " + std::to_string(answer.status) +
                     " Test\r\nContent-Type: " + answer.content_type +
                     "\r\nContent-Length: " + std::to_string(answer.body.size()) +
                     "\r\nConnection: close\r\n";
  for (const std::string& header : answer.headers) text += header + "\r\n";
  send_all(socket,
           text + "\r\n" + answer.body.substr(0, answer.cut_after.value_or(answer.body.size())));
  ::shutdown(socket, SHUT_WR);
}

}  // namespace overfly::testing
