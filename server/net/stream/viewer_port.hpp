// Interface of the connection that a viewer uses.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "server/net/stream/picture_codec.hpp"
#include "server/views/view_service.hpp"

namespace overfly::net {

/// Identifies a picture in progress; later calls refer to it by stream and ticket.
struct PictureTicket {
  std::uint32_t stream_id = 0;
  std::uint64_t number = 0;
};

/// While more than this is unsent, no further rows are encoded, and positions of the clock are
/// skipped.
inline constexpr std::size_t kHighWaterBytes = std::size_t{1} << 20U;

class ViewerPort {
 public:
  virtual ~ViewerPort() = default;

  virtual void send_text(std::string text) = 0;
  /// When it has been sent, the connection calls Viewer::picture_sent.
  virtual void send_picture(const PictureTicket& ticket,
                            const PictureHeader& header,
                            std::shared_ptr<const std::vector<std::uint8_t>> payload) = 0;
  /// Requests a picture; when it is ready, the connection calls Viewer::picture_ready.
  virtual void draw(const PictureTicket& ticket, const server::PictureRequest& request) = 0;
  /// Opens a run, which may require reading it from disk. The connection calls Viewer::run_opened
  /// when that is done, never before this returns.
  virtual void open_run(const std::string& run_id) = 0;
  /// Maximum rate of each picture stream during real-time flights [Hz]; empty = none.
  [[nodiscard]] virtual std::optional<double> picture_limit_hz() const = 0;
  /// Bytes accepted by send_* that have not been sent yet.
  [[nodiscard]] virtual std::size_t unsent_bytes() const = 0;
};

}  // namespace overfly::net
