// Receives a request's body that is too large for memory.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "server/net/http/http_message.hpp"

namespace overfly::net {

/// Called on one thread at a time, which serves no connection. A sink that is destroyed before
/// finish() must leave nothing behind.
class BodySink {
 public:
  virtual ~BodySink() = default;

  /// The next piece. @return the answer with which the rest is refused; empty to go on
  [[nodiscard]] virtual std::optional<HttpResponse> write(std::span<const std::uint8_t> bytes) = 0;
  /// The body is complete. @return the answer
  [[nodiscard]] virtual HttpResponse finish() = 0;
};

}  // namespace overfly::net
