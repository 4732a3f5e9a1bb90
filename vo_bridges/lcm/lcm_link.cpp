#include "vo_bridges/lcm/lcm_link.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "middleware/lcm/sensor_messages.hpp"
#include "vo_bridges/estimator_text.hpp"

namespace overfly {
namespace {

/// Maximum number of names of counters, and of timings, in a session: each becomes a recorded
/// column.
constexpr std::size_t kMostNames = 256;

/// A session number that differs from all previous ones, here and on other machines: the time in
/// microseconds since 1970, increased by one if it was used within this process.
std::int64_t new_session() {
  static std::atomic<std::int64_t> last = 0;
  const std::int64_t now = std::chrono::duration_cast<std::chrono::microseconds>(
                               std::chrono::system_clock::now().time_since_epoch())
                               .count();
  std::int64_t before = last.load();
  while (!last.compare_exchange_weak(before, std::max(before + 1, now))) {
  }
  return std::max(before + 1, now);
}

}  // namespace

Result<std::unique_ptr<LcmLink>> LcmLink::open(std::shared_ptr<lcm::Node> node,
                                               const std::string& prefix,
                                               bool hears) {
  std::unique_ptr<LcmLink> link(new LcmLink(std::move(node), prefix));
  if (!hears) return link;
  if (Status status = link->subscribe(); !status) return status.error();
  link->node_->start();
  return link;
}

LcmLink::~LcmLink() {
  if (session() != 0) {
    time_.ended = 1;
    // A failure cannot be reported any more.
    static_cast<void>(lcm::publish_message(*node_, prefix_ + "TIME", time_));
  }
  node_->stop();
}

Status LcmLink::subscribe() {
  using Method = void (LcmLink::*)(std::span<const std::uint8_t>);
  const auto hear = [this](const std::string& name, Method method) {
    return node_->subscribe(prefix_ + name, [this, method](std::span<const std::uint8_t> bytes) {
      (this->*method)(bytes);
    });
  };
  if (Status status = hear("POSE", &LcmLink::hear_pose); !status) return status;
  if (Status status = hear("STATUS", &LcmLink::hear_status); !status) return status;
  return hear("DEBUG", &LcmLink::hear_debug);
}

void LcmLink::begin(overfly_lcm::calibration_t calibration) {
  calibration_ = std::move(calibration);
  calibration_.session = new_session();
  time_.utime = calibration_.utime;
  time_.session = calibration_.session;
  width_px_ = calibration_.width;
  height_px_ = calibration_.height;
  session_ = calibration_.session;
}

Status LcmLink::announce() {
  return lcm::publish_message(*node_, prefix_ + "CALIBRATION", calibration_);
}

Status LcmLink::send(const SensorSamples& samples) {
  return lcm::with_each_message(samples,
                                [&](const char* name, std::int64_t /*available*/, auto message) {
                                  const std::string channel = prefix_ + name;
                                  message.session = session();
                                  message.sequence = ++sample_counts_[channel];
                                  return lcm::publish_message(*node_, channel, message);
                                });
}

Status LcmLink::send(const VoFrame& frame) {
  overfly_lcm::image_t message = lcm::image_message(
      *frame.image, frame.index, frame.t_ns, frame.exposure_ns, frame.image_crc32);
  message.session = session();
  message.sequence = ++sequence_;
  message.debug_wanted = debug_wanted_ ? 1 : 0;
  answers_.expect(frame.t_ns);
  time_.utime = message.utime;
  time_.t_ns = frame.t_ns;
  time_.frame = frame.index;
  time_.sequence = message.sequence;
  time_.attempt = 0;
  if (Status status = lcm::publish_message(*node_, prefix_ + "IMAGE", message); !status)
    return status;
  return ask_again();
}

Status LcmLink::ask_again() {
  ++time_.attempt;
  return lcm::publish_message(*node_, prefix_ + "TIME", time_);
}

void LcmLink::hear_pose(std::span<const std::uint8_t> bytes) {
  const auto message = lcm::decode_message<overfly_lcm::pose_t>(bytes);
  if (!message) return far_end_.refuse(prefix_ + "POSE", "not an overfly_lcm.pose_t");
  // Before the session begins, its number is 0.
  if (message->session == 0 || message->session != session()) {
    ++outdated_;
    return;
  }
  // A second answer to the same image was requested and is not an error.
  if (message->attempt > 1 && message->t_ns == answered_t_ns_) return;
  VoEstimate estimate;
  if (message->image_received == 0) {
    // Ignore a report about an image that was sent again in the meantime.
    if (message->sequence != sequence_) return;
    estimate.counters[kImageLost] = 1.0;
  } else if (Result<VoEstimate> understood = estimate_from(*message); understood) {
    estimate = std::move(*understood);
    limit_names(counters_, estimate.counters);
    limit_names(timings_, estimate.timing_ms);
    if (message->debug_sent != 0) attach_debug(estimate);
  } else {
    far_end_.refuse(prefix_ + "POSE", understood.error().message);
    estimate.sample.state = TrackingState::kLost;
    estimate.pose_fault = understood.error().message;
  }
  if (message->image_received != 0) answered_t_ns_ = message->t_ns;
  answers_.deliver(message->t_ns, std::move(estimate));
}

void LcmLink::limit_names(Names& names, std::map<std::string, double>& figures) {
  std::erase_if(figures, [&](const auto& figure) {
    const std::string& name = figure.first;
    if (names.known.contains(name)) return false;
    const bool sound = is_figure_name(name);
    if (sound && names.known.size() < kMostNames) {
      names.known.insert(name);
      return false;
    }
    if (!std::exchange(sound ? names.limit_told : names.bad_told, true)) {
      far_end_.say(names.what + (" \"" + printable(name, 80)) +
                   "\" ignored, as will be others like it: " +
                   (sound ? "a session has at most " + std::to_string(kMostNames) + " names"
                          : "names must be 1 to 128 printable ASCII characters without spaces"));
    }
    return true;
  });
}

void LcmLink::attach_debug(VoEstimate& estimate) {
  if (!debug_wanted_) return;
  if (debug_t_ns_ != estimate.sample.t_ns) {
    // It is published before its pose, so it was lost.
    estimate.counters["debug_lost"] = 1.0;
    return;
  }
  estimate.debug_image = std::move(debug_.image);
  estimate.map_points_vo = std::move(debug_.map_points_vo);
  debug_t_ns_ = -1;
}

void LcmLink::hear_debug(std::span<const std::uint8_t> bytes) {
  const auto message = lcm::decode_message<overfly_lcm::debug_t>(bytes);
  if (!message) return far_end_.refuse(prefix_ + "DEBUG", "not an overfly_lcm.debug_t");
  if (message->session != session()) return;
  Result<DebugView> view = debug_view_from(*message, width_px_, height_px_);
  if (!view) return far_end_.refuse(prefix_ + "DEBUG", view.error().message);
  debug_t_ns_ = message->t_ns;
  debug_ = std::move(*view);
}

void LcmLink::hear_status(std::span<const std::uint8_t> bytes) {
  const auto message = lcm::decode_message<overfly_lcm::status_t>(bytes);
  if (!message) return far_end_.refuse(prefix_ + "STATUS", "not an overfly_lcm.status_t");
  far_end_.hear(*message);
}

}  // namespace overfly
