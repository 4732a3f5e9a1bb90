// Inside download only: one HTTP request, sent by GDAL's curl.
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace overfly::terrain::download {

struct HttpReply {
  /// Of the last answer after redirects; 0 = no complete answer. Each success is 200, or 204 if it
  /// has no body.
  int status = 0;
  std::string content_type;  ///< in lower case
  std::vector<std::uint8_t> body;
  std::optional<double> retry_after_s;  ///< wait requested by the service
  std::string error;                    ///< why there is no complete answer; empty if there is one
};

/// Follows redirects; never throws, never prints. Thread-safe.
/// @param stall_s  seconds without data before it fails
/// @param stop     becomes true: the request ends soon
[[nodiscard]] HttpReply http_get(const std::string& url,
                                 double stall_s,
                                 const std::atomic<bool>& stop);

/// Seconds to wait by a Retry-After header (RFC 9110, 10.2.3): a number, or a date after `now`.
[[nodiscard]] std::optional<double> retry_after_s(const std::string& value,
                                                  std::int64_t unix_now_s);

}  // namespace overfly::terrain::download
