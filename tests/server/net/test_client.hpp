// Clients of the server under test: one request at a time, and a WebSocket that reads in order.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "server/net/stream/pictures/picture_codec.hpp"

namespace overfly::testing {

struct Answer {
  int status = 0;
  std::map<std::string, std::string> headers;  ///< names in lower case
  std::string body;
  [[nodiscard]] nlohmann::json json() const { return nlohmann::json::parse(body, nullptr, false); }
};

using Headers = std::map<std::string, std::string>;

inline const Headers kJson = {{"Content-Type", "application/json"}};

/// One request on a new connection.
[[nodiscard]] Answer ask(std::uint16_t port,
                         const std::string& method,
                         const std::string& target,
                         const std::string& body = "",
                         const Headers& headers = {});

/// Sends bytes as they are and returns all that comes back until the server closes.
[[nodiscard]] std::string exchange_raw(std::uint16_t port, const std::string& bytes);

struct PictureMessage {
  net::PictureHeader header;
  std::vector<std::uint8_t> jpeg;
};

/// Throws std::runtime_error when nothing comes for 30 s.
class WebSocketClient {
 public:
  struct Options {
    Headers headers;
    int receive_buffer_bytes = 0;  ///< 0 = the system's own
    std::string target = "/api/v1/stream";
  };
  explicit WebSocketClient(std::uint16_t port);
  WebSocketClient(std::uint16_t port, const Options& options);
  ~WebSocketClient();

  /// Whether the server accepted the upgrade.
  [[nodiscard]] bool is_open() const;
  void send(const nlohmann::json& message);
  void send_text(const std::string& text);
  void send_binary(const std::string& bytes);

  /// The next text message with this type; those before it, and pictures, are kept aside.
  nlohmann::json wait_for(const std::string& type);
  /// The next text message for which the condition holds.
  nlohmann::json wait_until(const std::function<bool(const nlohmann::json&)>& condition);
  /// Likewise, from the message with index `first` of texts() on, which may have arrived already.
  nlohmann::json wait_since(std::size_t first,
                            const std::function<bool(const nlohmann::json&)>& condition);
  /// The answer (`ok` or `error`) to a message that is sent with a new `request` number.
  nlohmann::json command(nlohmann::json message);
  /// The next picture for which the condition holds.
  PictureMessage wait_for_picture(const std::function<bool(const PictureMessage&)>& condition);
  /// Reads on until the connection ends. @return the close code, 0 without a close frame
  int read_to_end();

  /// Every message read so far.
  [[nodiscard]] const std::vector<nlohmann::json>& texts() const;
  [[nodiscard]] const std::vector<PictureMessage>& pictures() const;
  /// Binary messages of other endpoints than the stream.
  [[nodiscard]] const std::vector<std::vector<std::uint8_t>>& binaries() const;
  /// The subprotocol that the server chose; may be empty.
  [[nodiscard]] const std::string& protocol() const;

 private:
  bool read_one();
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The run in a message `playback` of a client that watches one run.
[[nodiscard]] inline nlohmann::json run_in(const nlohmann::json& playback) {
  return playback.at("runs").begin().value();
}

}  // namespace overfly::testing
