// A flight as one client of the Foxglove protocol gets it: the clock, the rows that it passes, and
// what is shown at its time.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "server/net/foxglove/due_rows.hpp"
#include "server/net/foxglove/flight_messages.hpp"
#include "server/net/foxglove/flight_pictures.hpp"
#include "server/net/foxglove/subscriptions.hpp"
#include "server/net/stream/playback_clock.hpp"
#include "server/net/stream/viewer_port.hpp"
#include "server/record/recorded_numbers.hpp"

namespace overfly::net::foxglove {

/// Rows are never left out: while the client takes them slower than they come, a replay's clock
/// waits, and a live flight's rows stay with the run.
class FlightFeed {
 public:
  using FolderOf = std::function<Result<std::filesystem::path>(const std::string&)>;

  /// Follows a run that flies live; a run that has flown waits at its beginning.
  /// @param port, subscriptions  must outlive the object
  /// @param folder_of  of a run, by its id; called on other threads
  FlightFeed(std::shared_ptr<const server::RunTimeline> timeline,
             ViewerPort& port,
             Subscriptions& subscriptions,
             FolderOf folder_of);

  [[nodiscard]] PlaybackClock& clock() { return clock_; }
  [[nodiscard]] const PlaybackClock& clock() const { return clock_; }
  [[nodiscard]] const FlightMessages& messages() const { return messages_; }
  [[nodiscard]] const server::RunTimeline& timeline() const { return *timeline_; }

  /// Takes in what was recorded since, and lets the clock go on.
  /// @return true if the channels are others now
  bool advance(std::int64_t now_ns);
  /// Sends what is due.
  void send_due(std::int64_t now_ns);
  /// Sends what new subscriptions show now.
  void send_present(const std::vector<Channel>& channels);

  /// Goes to another time: rows in between are left out, and everything is sent again.
  void seek(std::int64_t t_ns);
  bool go_live();
  /// Errors: as server::check_alignment.
  Status align(const std::string& mode);
  /// True once after the clock went to another time.
  [[nodiscard]] bool take_jumped();

  void picture_ready(const PictureTicket& ticket, const Result<server::Picture>& picture) {
    pictures_.ready(ticket, picture, &messages_, &port_);
  }
  void picture_sent(const PictureTicket& ticket) { pictures_.sent(ticket); }
  /// True while something becomes due soon.
  [[nodiscard]] bool busy() const {
    return clock_.playing() || behind_ || pictures_.waiting() || present_due_;
  }

 private:
  /// Map points of an estimator.
  struct Points {
    std::int64_t frame = -1;  ///< sent last, or being read
    bool reading = false;
    /// Used by one thread at a time, because only one reads.
    std::shared_ptr<server::RecordedNumbers> numbers = std::make_shared<server::RecordedNumbers>();
    std::vector<Eigen::Vector3f> sent;
  };
  [[nodiscard]] bool ready() const { return messages_.has_epoch() && messages_.check_epoch(); }
  void take_in();
  void jump();
  void send_rows();
  void send_time(std::int64_t t_ns);
  void send_slow(std::int64_t now_ns);
  void show_points_again();
  void send_points(std::int64_t now_ns);
  void read_points(std::size_t estimator, const server::FrameRow& row);
  void put_points(std::size_t estimator, std::int64_t t_ns, std::vector<Eigen::Vector3f> points);

  std::shared_ptr<const server::RunTimeline> timeline_;
  ViewerPort& port_;
  Subscriptions& subscriptions_;
  FolderOf folder_of_;
  server::Audience::Seat seat_;
  FlightMessages messages_;
  DueRows rows_;
  FlightPictures pictures_;
  PlaybackClock clock_;
  std::optional<std::uint64_t> revision_;  ///< taken in last
  std::optional<std::int64_t> now_ns_;     ///< of the last advance
  std::int64_t played_ns_ = 0;      ///< wall time without that in which the client was behind
  std::int64_t rows_until_ns_ = 0;  ///< time of the clock when rows were sent last
  std::optional<std::int64_t> time_sent_ns_;
  std::optional<std::int64_t> slow_at_ns_;
  std::optional<std::int64_t> points_at_ns_;
  std::int64_t slow_t_ns_ = -1;  ///< time of the clock then
  std::map<std::size_t, Points> points_;
  std::uint64_t jumps_ = 0;  ///< points that were read before the last one are not sent
  bool jumped_ = false;
  bool present_due_ = false;
  bool behind_ = false;
};

}  // namespace overfly::net::foxglove
