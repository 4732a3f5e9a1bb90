#include "server/net/foxglove/flight_feed.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "server/net/foxglove/server_message.hpp"
#include "server/net/stream/run_instant.hpp"
#include "server/timeline/recorded_points.hpp"

namespace overfly::net::foxglove {
namespace {

/// Of tracks, which are sent as a whole.
constexpr std::int64_t kSlowPeriodNs = 1'000'000'000;
constexpr std::int64_t kPointsPeriodNs = 500'000'000;

}  // namespace

FlightFeed::FlightFeed(std::shared_ptr<const server::RunTimeline> timeline,
                       ViewerPort& port,
                       Subscriptions& subscriptions,
                       FolderOf folder_of)
    : timeline_(std::move(timeline)),
      port_(port),
      subscriptions_(subscriptions),
      folder_of_(std::move(folder_of)),
      seat_(timeline_->audience()),
      messages_(timeline_, port, subscriptions),
      rows_(timeline_) {
  take_in();
  clock_ = PlaybackClock(clock_.extent());
  rows_until_ns_ = clock_.t_ns();
  rows_.jump_to(rows_until_ns_);
}

void FlightFeed::take_in() {
  const server::RunStatus status = timeline_->info().status;
  PlaybackClock::Extent extent;
  extent.end_ns = end_of(*timeline_);
  extent.newest_ns = extent.end_ns;
  extent.flying = status == server::RunStatus::kRunning || status == server::RunStatus::kQueued;
  clock_.set_extent(extent);
}

bool FlightFeed::advance(std::int64_t now_ns) {
  bool renamed = false;
  if (const std::uint64_t revision = timeline_->revision(); revision_ != revision) {
    revision_ = revision;
    take_in();
    renamed = messages_.refresh();
    if (renamed) {
      rows_ = DueRows(timeline_);
      rows_.jump_to(rows_until_ns_);
      pictures_.restart();
    }
  }
  const std::int64_t elapsed_ns = now_ns_ ? std::max<std::int64_t>(now_ns - *now_ns_, 0) : 0;
  now_ns_ = now_ns;
  if (!behind_) played_ns_ += elapsed_ns;
  clock_.advance(played_ns_);
  if (clock_.t_ns() < rows_until_ns_) jump();  // it repeats the flight
  return renamed;
}

void FlightFeed::seek(std::int64_t t_ns) {
  clock_.seek(t_ns);
  jump();
}

bool FlightFeed::go_live() {
  if (clock_.live()) return true;
  if (!clock_.go_live()) return false;
  jump();
  return true;
}

Status FlightFeed::align(const std::string& mode) {
  if (Status status = server::check_alignment(*timeline_, mode); !status) return status;
  messages_.set_places(EstimatePlaces::of(*timeline_, mode));
  show_points_again();
  present_due_ = true;
  return {};
}

void FlightFeed::jump() {
  rows_until_ns_ = clock_.t_ns();
  rows_.jump_to(rows_until_ns_);
  time_sent_ns_.reset();
  show_points_again();
  pictures_.show_again();
  jumped_ = true;
  present_due_ = true;
}

void FlightFeed::show_points_again() {
  ++jumps_;
  points_at_ns_.reset();
  for (auto& [estimator, points] : points_) {
    points.frame = -1;
    points.sent.clear();
  }
}

bool FlightFeed::take_jumped() { return std::exchange(jumped_, false); }

void FlightFeed::send_present(const std::vector<Channel>& channels) {
  if (!ready() || timeline_->frame_count() == 0) return;
  send_time(rows_until_ns_);
  for (const Channel& channel : channels) messages_.send_present(channel, rows_until_ns_);
  const bool points = std::any_of(channels.begin(), channels.end(), [](const Channel& channel) {
    return channel.kind == ChannelKind::kPoints;
  });
  if (points) show_points_again();
}

void FlightFeed::send_due(std::int64_t now_ns) {
  if (!ready()) return;
  if (std::exchange(present_due_, false)) send_present(subscriptions_.channels());
  send_rows();
  if (behind_) return;
  send_slow(now_ns);
  send_points(now_ns);
  const FlightPictures::Instant instant{clock_.t_ns(), clock_.live()};
  pictures_.pump(*timeline_, instant, subscriptions_, &port_, now_ns);
}

void FlightFeed::send_rows() {
  const std::int64_t t_ns = clock_.t_ns();
  // The log goes on after the last frame.
  const bool all = !clock_.extent().flying && t_ns >= clock_.extent().end_ns;
  const std::int64_t until_ns = all ? std::numeric_limits<std::int64_t>::max() : t_ns;
  rows_until_ns_ = t_ns;
  behind_ = true;
  while (port_.unsent_bytes() < kHighWaterBytes) {
    const auto row = rows_.next(until_ns);
    if (!row) {
      behind_ = false;
      send_time(t_ns);
      return;
    }
    send_time(std::min(row->t_ns, t_ns));
    messages_.send_row(*row);
  }
}

void FlightFeed::send_time(std::int64_t t_ns) {
  // An answer that comes late does not turn back the time.
  if (time_sent_ns_ && t_ns <= *time_sent_ns_) return;
  time_sent_ns_ = t_ns;
  port_.send_binary(time_message(messages_.utc_ns(t_ns)));
}

void FlightFeed::send_slow(std::int64_t now_ns) {
  const std::int64_t t_ns = clock_.t_ns();
  if (slow_t_ns_ == t_ns || timeline_->frame_count() == 0) return;
  if (slow_at_ns_ && now_ns - *slow_at_ns_ < kSlowPeriodNs) return;
  slow_at_ns_ = now_ns;
  slow_t_ns_ = t_ns;
  messages_.send_paths(t_ns);
}

void FlightFeed::send_points(std::int64_t now_ns) {
  if (points_at_ns_ && now_ns - *points_at_ns_ < kPointsPeriodNs) return;
  points_at_ns_ = now_ns;
  const auto row = timeline_->frame_at(clock_.t_ns());
  if (!row) return;
  for (const Channel& channel : subscriptions_.channels(ChannelKind::kPoints)) {
    if (!subscriptions_.of(channel.kind, channel.index)) continue;
    if (clock_.live()) {
      put_points(channel.index, row->t_ns, timeline_->live_points(channel.index));
    } else {
      read_points(channel.index, *row);
    }
  }
}

void FlightFeed::read_points(std::size_t estimator, const server::FrameRow& row) {
  Points& points = points_[estimator];
  const auto& place = messages_.places().of_estimator.at(estimator);
  if (points.reading || points.frame == row.frame || !place) return;
  points.frame = row.frame;
  points.reading = true;
  port_.work([this,
              timeline = timeline_,
              folder_of = folder_of_,
              numbers = points.numbers,
              estimator,
              row,
              place = *place,
              jumps = jumps_]() -> std::function<void()> {
    std::vector<Eigen::Vector3f> read;
    if (const auto folder = folder_of(timeline->info().id)) {
      read = server::recorded_points(*folder, *numbers, *timeline, estimator, place, row);
    }
    return [this, estimator, jumps, t_ns = row.t_ns, read = std::move(read)] {
      points_[estimator].reading = false;
      if (jumps == jumps_) put_points(estimator, t_ns, read);
    };
  });
}

void FlightFeed::put_points(std::size_t estimator,
                            std::int64_t t_ns,
                            std::vector<Eigen::Vector3f> points) {
  std::vector<Eigen::Vector3f>& sent = points_[estimator].sent;
  if (sent == points) return;
  sent = std::move(points);
  messages_.send_points(estimator, t_ns, sent);
}

}  // namespace overfly::net::foxglove
