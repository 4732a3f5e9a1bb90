// What a viewer needs of the connection it speaks over.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "server/net/stream/picture_codec.hpp"
#include "server/views/view_service.hpp"

namespace overfly::net {

/// A picture on its way: the viewer hears of it again by its stream and ticket.
struct PictureTicket {
  std::uint32_t stream_id = 0;
  std::uint64_t number = 0;
};

class ViewerPort {
 public:
  virtual ~ViewerPort() = default;

  virtual void send_text(std::string text) = 0;
  /// Once it is on the wire the connection calls Viewer::picture_sent.
  virtual void send_picture(const PictureTicket& ticket,
                            const PictureHeader& header,
                            std::shared_ptr<const std::vector<std::uint8_t>> jpeg) = 0;
  /// Has it drawn; once it is there the connection calls Viewer::picture_ready.
  virtual void draw(const PictureTicket& ticket, const engine::PictureRequest& request) = 0;
  /// Opens a run, which may mean to read it from disk; once that is done, not before it returns,
  /// the connection calls Viewer::run_opened.
  virtual void open_run(const std::string& run_id) = 0;
  /// Of each stream, beside flights in real time [Hz]; empty = none.
  [[nodiscard]] virtual std::optional<double> picture_limit_hz() const = 0;
  /// Bytes accepted by send_* that are not on the wire yet.
  [[nodiscard]] virtual std::size_t unsent_bytes() const = 0;
};

}  // namespace overfly::net
