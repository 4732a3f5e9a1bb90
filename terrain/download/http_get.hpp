// Inside download only: one HTTP request, by the curl inside GDAL.
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace overfly::terrain::download {

struct HttpReply {
  int status = 0;            ///< of the last answer after redirects; 0 = none came whole
  std::string content_type;  ///< in lower case
  std::vector<std::uint8_t> body;
  std::optional<double> retry_after_s;  ///< what the service asked for
  std::string error;                    ///< why there is no whole answer; empty when there is one
  bool cancelled = false;
};

/// Follows redirects; never throws, never prints. Thread-safe.
/// @param stall_s  seconds without data before it fails
/// @param stop     becomes true: the request ends soon
[[nodiscard]] HttpReply http_get(const std::string& url,
                                 double stall_s,
                                 const std::atomic<bool>& stop);

/// Seconds that a Retry-After header asks for (RFC 9110, 10.2.3): a number, or a date after `now`.
[[nodiscard]] std::optional<double> retry_after_s(const std::string& value,
                                                  std::int64_t unix_now_s);

}  // namespace overfly::terrain::download
