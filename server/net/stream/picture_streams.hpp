// The picture streams of one viewer: which are subscribed of each run, what each shows, and which
// is drawn next.
#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "core/result.hpp"
#include "server/net/stream/client_message.hpp"
#include "server/net/stream/pictures/link_meter.hpp"
#include "server/net/stream/pictures/picture_slot.hpp"
#include "server/net/stream/pictures/send_window.hpp"
#include "server/net/stream/viewer_port.hpp"
#include "server/timeline/row_alignment.hpp"
#include "server/timeline/run_timeline.hpp"
#include "server/views/view_service.hpp"

namespace overfly::net {

class PictureStreams {
 public:
  static constexpr std::size_t kMaxViews = 16;

  /// The viewer's position in a run.
  struct Instant {
    const server::RunTimeline* timeline;
    std::string run_id;
    std::int64_t frame = 0;
    std::int64_t t_ns = 0;   ///< of the frame
    std::int64_t at_ns = 0;  ///< of the run, by the clock
    bool at_end = false;     ///< there is no later frame
    bool live = false;
    std::string alignment = server::kRecordedAlignment;  ///< of the estimates in scenes
  };

  /// Pictures of a stream that a client who acknowledges may have got and not shown. Several, so
  /// that a long round trip does not limit the rate; SendWindow limits their bytes.
  static constexpr int kWindow = 8;

  /// Replaces the set of streams. A stream that stays, or comes back later, keeps its number; one
  /// that stays unchanged is not sent again.
  void subscribe(const SubscribeCommand& command);
  /// Errors: kInvalidArgument beyond kMaxViews views.
  Status set_view(const ViewCommand& command, std::int64_t now_ns);
  void shown(const ShownCommand& command);
  /// Errors: kNotFound if there is no such stream.
  Status restart_video(const KeyCommand& command);
  /// Discards a run's pictures in progress, because it is not watched any more, or again.
  void restart(const std::string& run_id);
  /// The maximum rate of each stream; empty = none. @return true if it changed
  bool set_limit_hz(std::optional<double> limit_hz);
  /// Makes every stream send the picture of the present instant again.
  void show_again();
  /// As show_again(), after a jump in time: a scene that takes long to draw is sent in half the
  /// size first, and then completely.
  void show_after_jump();

  /// Requests every picture that is due.
  /// @param instants  of the watched runs that have frames
  /// @param playing  the clock moves
  void pump(const std::vector<Instant>& instants,
            bool playing,
            ViewerPort* port,
            std::int64_t now_ns);
  /// Sends a picture that was drawn, or reports to the client why it was not.
  void ready(const PictureTicket& ticket,
             const Result<server::Picture>& picture,
             ViewerPort* port,
             std::int64_t now_ns);
  void sent(const PictureTicket& ticket);

  /// True if a picture waits only for its time, or a view has just been moved or previewed.
  [[nodiscard]] bool waiting() const;
  /// By how much moving pictures are reduced for the client (LinkMeter). @return true if it changed
  /// since the last call
  bool reduction_changed();
  /// The `pictures` message.
  [[nodiscard]] nlohmann::json pictures_json() const;

 private:
  struct Stream {
    StreamRequest request;
    std::uint32_t id = 0;
    PictureSlot slot{1.0};
    std::uint32_t sequence = 0;
    std::uint64_t change = 0;  ///< increases with each change of the request
    std::uint64_t ticket = 0;  ///< of the picture in progress; 0 = none
    bool live = false;         ///< it was requested as a live one
    bool moving = false;       ///< more are to follow
    bool reduced = false;      ///< the one requested last: in detail, or by a video's coding
    PictureKey drawn;          ///< the key of its request
    std::optional<PictureKey> sent;
    std::optional<std::uint32_t> shown;  ///< sequence number of the newest that the client shows
    std::int64_t requested_ns = 0;       ///< when the newest was requested
    bool still = true;                   ///< the one requested last was to rest
    bool jumped = false;                 ///< the next one is the first after a jump
    bool preview = false;                ///< the one requested last is in half the size
    std::int64_t drawing_ns = 0;         ///< of one that rests, in full detail
    std::size_t still_bytes = SendWindow::kLeastBytes;  ///< size of the last one that rests
    std::size_t moving_bytes = 0;  ///< size of the last one that moves; 0 = none yet
    std::uint64_t video_sent = 0;  ///< video pictures
    bool key_wanted = false;       ///< the client lost one
    std::string error_sent;
  };
  Stream* find(const PictureTicket& ticket);
  std::optional<server::PictureRequest> request_of(const Stream& stream,
                                                   const Instant& instant) const;
  /// The size of its next picture, by the last one.
  static std::size_t expected_bytes(const Stream& stream);
  /// @return true if its picture is due, but waits for room on the way to the client
  bool request_one(Stream* stream,
                   const std::vector<Instant>& instants,
                   bool playing,
                   bool room,
                   ViewerPort* port,
                   std::int64_t now_ns);
  /// Previews of scenes first, then the frames of a jump, then those that were not requested for
  /// the longest time.
  std::vector<Stream*> in_turn();
  /// Reduces a moving picture, and chooses its coding.
  void fit_to_link(Stream* stream, server::PictureRequest* request) const;
  /// Whether its next picture is to be drawn in half the size, to be there sooner.
  static bool wants_preview(const Stream& stream);
  /// Whether its preview is new, so that the whole picture is to wait.
  static bool preview_stands(const Stream& stream, std::int64_t now_ns);
  [[nodiscard]] bool view_moves(const Stream& stream, std::int64_t now_ns) const;
  static void count_unshown(Stream* stream);
  /// Adds the other runs that a scene shows, at the time of the main run's frame.
  /// @return the sum of their times
  static std::int64_t add_others(const Stream& stream,
                                 const Instant& main,
                                 const std::vector<Instant>& instants,
                                 server::PictureRequest* request);
  static const Instant* find_instant(const std::vector<Instant>& instants,
                                     const std::string& run_id);
  static void tell_error(Stream* stream, const Error& error, ViewerPort* port);

  /// Settings of the scene view of a stream.
  struct View {
    server::SceneSettings settings;
    std::uint64_t change = 0;
    std::int64_t changed_ns = 0;
  };
  std::uint64_t change_of(const Stream& stream) const;
  void forget_old_streams();

  std::vector<Stream> streams_;
  /// Run, name, camera and view.
  using StreamKey = std::tuple<std::string, std::string, std::string, std::string>;
  static StreamKey key_of(const StreamRequest& request);
  std::map<StreamKey, std::uint32_t> ids_;  ///< of the streams subscribed so far
  std::uint32_t next_id_ = 1;
  std::map<StreamKey, std::uint32_t> sequences_;  ///< of streams not subscribed now
  std::map<std::string, View> views_;             ///< by name
  std::optional<double> limit_hz_;
  bool acknowledges_ = false;
  LinkMeter link_;
  SendWindow window_;
  int reduction_told_ = 0;
  bool changes_soon_ = false;  ///< a view was moving, or a preview stood, in the last pump
  std::uint64_t change_ = 0;
  std::uint64_t tickets_ = 0;
};

}  // namespace overfly::net
