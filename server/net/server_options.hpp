#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "server/imagery/live/live_address.hpp"
#include "server/logs/log_uploads.hpp"
#include "server/net/connection_table.hpp"

namespace overfly::net {

/// Limits for one client.
struct ServerLimits {
  std::size_t max_body_bytes = std::size_t{1} << 20U;      ///< of a request; beyond: 413
  std::size_t max_header_bytes = std::size_t{16} << 10U;   ///< of a request; beyond: 431
  std::size_t max_message_bytes = std::size_t{64} << 10U;  ///< WebSocket; beyond: close code 1009
  std::size_t max_unsent_bytes = std::size_t{16} << 20U;   ///< WebSocket; beyond: close code 4000
  std::int64_t max_stall_ms = 15'000;  ///< WebSocket: time to send one message; beyond: 4000
  std::int64_t header_ms = 10'000;     ///< time for a new connection's first request header
  std::int64_t idle_ms = 30'000;       ///< connections without traffic (WebSockets are pinged)
  /// Uploads that are slower on average, counted from when they have been waited for so long: 408.
  std::uint64_t min_upload_bytes_per_s = 1024;
  std::int64_t upload_grace_ms = 60'000;
  ConnectionLimits connections;
  server::UploadLimits uploads;  ///< of flight logs
  /// Kernel send buffer of a connection. Small: pictures for a viewer that wait in it become
  /// outdated, and with a large one a slow client seems to take nothing of an answer for a long
  /// time.
  int send_buffer_bytes = 256 << 10;
};

struct ServerOptions {
  std::string address = "127.0.0.1";  ///< loopback by default
  std::uint16_t port = 8480;          ///< 0 = any free port
  /// Every request must carry it (access_token.hpp); empty = no token, only on a loopback address.
  std::string token;
  /// Of those who may look at everything and change nothing; empty = there is none.
  std::string viewer_token;
  /// Host names and addresses that clients may use, in addition to those of AllowedHosts.
  std::vector<std::string> allowed_hosts;
  std::filesystem::path web_folder;  ///< built dashboard; empty = REST and WebSocket only
  /// Where uploaded flight logs are kept; empty = no uploads. Scenarios may name its files only if
  /// it is one of the run manager's data folders.
  std::filesystem::path uploads_folder;
  /// This program, which flies the single scenarios of sweeps and makes studies.
  std::filesystem::path program = "/proc/self/exe";
  /// Size of the frame cache that the sweeps share; 0 = none.
  double frame_cache_gib = 0.0;
  /// Live cameras that calibrations may open.
  std::vector<server::LiveAddress> cameras;
  ServerLimits limits;
  /// Called with each log line: (level, text).
  std::function<void(const std::string&, const std::string&)> log;
};

}  // namespace overfly::net
