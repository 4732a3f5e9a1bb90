// The pictures of a flight for one client of the Foxglove protocol: of each channel only the newest
// one, and one at a time.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "server/net/foxglove/flight_messages.hpp"
#include "server/net/foxglove/subscriptions.hpp"
#include "server/net/stream/pictures/picture_slot.hpp"
#include "server/net/stream/viewer_port.hpp"

namespace overfly::net::foxglove {

class FlightPictures {
 public:
  /// What to show.
  struct Instant {
    std::int64_t t_ns = 0;
    bool live = false;
  };

  /// The channels are others now.
  void restart() { slots_.clear(); }
  /// Pictures are sent again even if their frame was sent before.
  void show_again() { ++change_; }
  /// Asks the connection to draw what is due.
  void pump(const server::RunTimeline& timeline,
            const Instant& instant,
            const Subscriptions& subscriptions,
            ViewerPort* port,
            std::int64_t now_ns);
  /// Sends a picture that was drawn, after the calibration of its camera.
  void ready(const PictureTicket& ticket,
             const Result<server::Picture>& picture,
             FlightMessages* messages,
             ViewerPort* port);
  void sent(const PictureTicket& ticket);
  /// True if a picture waits only for its time.
  [[nodiscard]] bool waiting() const;

 private:
  struct Slot {
    Channel channel;
    PictureSlot slot;
    std::uint64_t ticket = 0;  ///< of the picture in flight
    PictureKey drawn;          ///< the key of its request
    std::optional<PictureKey> sent;
    std::string error_sent;
  };
  Slot* find(const PictureTicket& ticket);
  void match(const Subscriptions& subscriptions);
  static void tell_error(Slot* slot, const Error& error, ViewerPort* port);

  std::map<std::uint32_t, Slot> slots_;  ///< by channel
  std::uint64_t change_ = 0;
  std::uint64_t tickets_ = 0;
};

}  // namespace overfly::net::foxglove
