#include "tests/server/net/test_client.hpp"

#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <stdexcept>

namespace overfly::testing {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using beast::error_code;

constexpr std::chrono::seconds kPatience{30};

tcp::endpoint loopback(std::uint16_t port) { return {asio::ip::make_address("127.0.0.1"), port}; }

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
  return text;
}

}  // namespace

Answer ask(std::uint16_t port,
           const std::string& method,
           const std::string& target,
           const std::string& body,
           const Headers& headers) {
  asio::io_context loop;
  beast::tcp_stream stream(loop);
  stream.connect(loopback(port));
  http::request<http::string_body> request;
  request.method_string(method);
  request.target(target);
  request.version(11);
  request.set(http::field::host, "127.0.0.1:" + std::to_string(port));
  for (const auto& [name, value] : headers) request.set(name, value);
  request.body() = body;
  request.prepare_payload();
  request.keep_alive(false);
  error_code error;
  http::write(stream, request, error);
  http::response_parser<http::string_body> parser;
  parser.body_limit(std::uint64_t{1} << 30U);
  parser.skip(method == "HEAD");
  beast::flat_buffer buffer;
  http::read(stream, buffer, parser, error);
  Answer answer;
  answer.status = static_cast<int>(parser.get().result_int());
  for (const auto& field : parser.get()) {
    answer.headers[lower(std::string(field.name_string()))] = std::string(field.value());
  }
  answer.body = parser.get().body();
  return answer;
}

std::string exchange_raw(std::uint16_t port, const std::string& bytes) {
  asio::io_context loop;
  tcp::socket socket(loop);
  socket.connect(loopback(port));
  error_code error;
  asio::write(socket, asio::buffer(bytes), error);
  socket.shutdown(tcp::socket::shutdown_send, error);
  std::string answer;
  asio::read(socket, asio::dynamic_buffer(answer), error);
  return answer;
}

struct WebSocketClient::Impl {
  asio::io_context loop;
  websocket::stream<tcp::socket> ws{loop};
  http::response<http::string_body> response;
  bool open = false;
  int next_request = 1000;
  std::vector<nlohmann::json> texts;
  std::vector<PictureMessage> pictures;
  bool is_stream = true;
  std::vector<std::vector<std::uint8_t>> binaries;
  std::string protocol;
};

WebSocketClient::WebSocketClient(std::uint16_t port) : WebSocketClient(port, Options{}) {}

WebSocketClient::WebSocketClient(std::uint16_t port, const Options& options)
    : impl_(std::make_unique<Impl>()) {
  tcp::socket& socket = impl_->ws.next_layer();
  socket.open(tcp::v4());
  if (options.receive_buffer_bytes > 0) {
    socket.set_option(asio::socket_base::receive_buffer_size(options.receive_buffer_bytes));
  }
  socket.connect(loopback(port));
  impl_->ws.read_message_max(std::size_t{64} << 20U);
  impl_->ws.set_option(websocket::stream_base::decorator([&](websocket::request_type& request) {
    for (const auto& [name, value] : options.headers) request.set(name, value);
  }));
  websocket::response_type response;
  error_code error;
  impl_->ws.handshake(response, "127.0.0.1:" + std::to_string(port), options.target, error);
  impl_->open = !error;
  impl_->is_stream = options.target.starts_with("/api/v1/stream");
  impl_->protocol = std::string(response[http::field::sec_websocket_protocol]);
}

WebSocketClient::~WebSocketClient() = default;

bool WebSocketClient::is_open() const { return impl_->open; }
const std::vector<nlohmann::json>& WebSocketClient::texts() const { return impl_->texts; }
const std::vector<PictureMessage>& WebSocketClient::pictures() const { return impl_->pictures; }
const std::vector<std::vector<std::uint8_t>>& WebSocketClient::binaries() const {
  return impl_->binaries;
}
const std::string& WebSocketClient::protocol() const { return impl_->protocol; }

void WebSocketClient::send(const nlohmann::json& message) { send_text(message.dump()); }

void WebSocketClient::send_text(const std::string& text) {
  impl_->ws.text(true);
  error_code error;
  impl_->ws.write(asio::buffer(text), error);
}

void WebSocketClient::send_binary(const std::string& bytes) {
  impl_->ws.binary(true);
  error_code error;
  impl_->ws.write(asio::buffer(bytes), error);
}

bool WebSocketClient::read_one() {
  beast::flat_buffer buffer;
  bool done = false;
  error_code failure;
  impl_->ws.async_read(buffer, [&](const error_code& error, std::size_t) {
    done = true;
    failure = error;
  });
  impl_->loop.restart();
  impl_->loop.run_for(kPatience);
  if (!done) {
    impl_->ws.next_layer().close();
    impl_->loop.restart();
    impl_->loop.run();
    throw std::runtime_error("the server said nothing for 30 s");
  }
  if (failure) return false;
  if (impl_->ws.got_text()) {
    impl_->texts.push_back(nlohmann::json::parse(beast::buffers_to_string(buffer.data())));
    return true;
  }
  const auto* bytes = static_cast<const std::uint8_t*>(buffer.data().data());
  if (!impl_->is_stream) {
    impl_->binaries.emplace_back(bytes, bytes + buffer.size());
    return true;
  }
  const auto header = net::decode_picture_header({bytes, buffer.size()});
  if (!header) throw std::runtime_error("a binary message is no picture");
  impl_->pictures.push_back({*header, {bytes + net::kPictureHeaderBytes, bytes + buffer.size()}});
  return true;
}

nlohmann::json WebSocketClient::wait_until(
    const std::function<bool(const nlohmann::json&)>& condition) {
  return wait_since(impl_->texts.size(), condition);
}

nlohmann::json WebSocketClient::wait_since(
    std::size_t first, const std::function<bool(const nlohmann::json&)>& condition) {
  for (std::size_t next = first;;) {
    for (; next < impl_->texts.size(); ++next) {
      if (condition(impl_->texts[next])) return impl_->texts[next];
    }
    if (!read_one()) throw std::runtime_error("the connection ended");
  }
}

nlohmann::json WebSocketClient::wait_for(const std::string& type) {
  return wait_until([&](const nlohmann::json& message) { return message.at("type") == type; });
}

nlohmann::json WebSocketClient::command(nlohmann::json message) {
  const int request = impl_->next_request++;
  message["request"] = request;
  send(message);
  return wait_until([&](const nlohmann::json& answer) {
    return answer.contains("request") && answer.at("request") == request;
  });
}

PictureMessage WebSocketClient::wait_for_picture(
    const std::function<bool(const PictureMessage&)>& condition) {
  for (;;) {
    const std::size_t before = impl_->pictures.size();
    if (!read_one()) throw std::runtime_error("the connection ended");
    if (impl_->pictures.size() > before && condition(impl_->pictures.back())) {
      return impl_->pictures.back();
    }
  }
}

int WebSocketClient::read_to_end() {
  while (read_one()) {
  }
  return impl_->ws.reason().code;
}

}  // namespace overfly::testing
