// The picture streams of one viewer: which are subscribed, what each shows, and which is drawn
// next.
#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/result.hpp"
#include "server/net/stream/client_message.hpp"
#include "server/net/stream/picture_slot.hpp"
#include "server/net/stream/viewer_port.hpp"
#include "server/timeline/run_timeline.hpp"
#include "server/views/view_service.hpp"

namespace overfly::net {

class PictureStreams {
 public:
  /// The viewer's position.
  struct Instant {
    const server::RunTimeline& timeline;
    std::string run_id;
    std::int64_t frame = 0;
    std::int64_t t_ns = 0;
    bool live = false;
  };

  /// Replaces the set of streams. A stream that stays, or comes back later, keeps its number.
  void subscribe(const std::vector<StreamRequest>& requests);
  void set_view(const ViewCommand& command);
  /// The alignment of the estimates in the scene.
  void set_alignment(const std::string& mode);
  /// Discards the pictures in progress, because another run, or none, is watched now.
  void restart();
  /// The maximum rate of each stream; empty = none. @return true if it changed
  bool set_limit_hz(std::optional<double> limit_hz);
  /// Makes every stream send the picture of the present instant again.
  void show_again() { ++change_; }

  /// Requests every picture that is due.
  void pump(const Instant& instant, ViewerPort* port, std::int64_t now_ns);
  /// Sends a picture that was drawn, or reports to the client why it was not.
  void ready(const PictureTicket& ticket, const Result<server::Picture>& picture, ViewerPort* port);
  void sent(const PictureTicket& ticket);

  /// True if a picture waits only for its time.
  [[nodiscard]] bool waiting() const;
  /// The `streams` message.
  [[nodiscard]] nlohmann::json streams_json() const;

 private:
  struct Stream {
    StreamRequest request;
    std::uint32_t id = 0;
    PictureSlot slot{1.0};
    std::uint32_t sequence = 0;
    std::uint64_t ticket = 0;  ///< of the picture in progress; 0 = none
    bool live = false;         ///< it was requested as a live one
    std::uint64_t change = 0;  ///< the change count at its request
    std::optional<std::int64_t> sent_frame;
    std::uint64_t sent_change = 0;
    std::string error_sent;
  };
  Stream* find(const PictureTicket& ticket);
  std::optional<server::PictureRequest> request_of(const Stream& stream,
                                                   const Instant& instant) const;
  static void tell_error(Stream* stream, const Error& error, ViewerPort* port);

  std::vector<Stream> streams_;
  using StreamKey = std::pair<std::string, std::string>;  ///< name and camera
  std::map<StreamKey, std::uint32_t> ids_;                ///< of all streams ever subscribed
  std::map<StreamKey, std::uint32_t> sequences_;          ///< of streams not subscribed now
  server::SceneSettings scene_;
  std::optional<double> limit_hz_;
  std::uint64_t change_ = 0;
  std::uint64_t view_change_ = 0;
  std::uint64_t tickets_ = 0;
};

}  // namespace overfly::net
