// A camera that speaks RTSP (RFC 2326) and sends uncompressed video (RFC 4175) interleaved in the
// same connection. Written for tests: one client, one image over and over.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "core/camera/image.hpp"

namespace overfly::testing {

class RawRtspServer {
 public:
  /// @param image   8-bit grey; its values become the luma
  /// @param silent  never answers
  explicit RawRtspServer(Image image, bool silent = false);
  ~RawRtspServer();
  RawRtspServer(const RawRtspServer&) = delete;
  RawRtspServer& operator=(const RawRtspServer&) = delete;

  /// "rtsp://127.0.0.1:PORT/live"
  [[nodiscard]] std::string address() const;
  /// Everything that the client has sent.
  [[nodiscard]] std::string requests();
  void wait_for_client();

 private:
  void serve();
  void answer(int socket, const std::string& request);
  /// One RTP packet for each row. @return false if the client has gone
  bool send_image(int socket, std::uint32_t timestamp);

  const Image image_;
  const bool silent_;
  int listener_ = -1;
  int port_ = 0;
  std::atomic<bool> stop_{false};
  bool playing_ = false;
  std::uint16_t sequence_ = 0;
  std::mutex mutex_;
  std::condition_variable arrived_;
  bool connected_ = false;
  std::string requests_;
  std::thread thread_;
};

}  // namespace overfly::testing
