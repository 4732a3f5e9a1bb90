#include "tests/vo_bridges/lcm/lcm_test_estimator.hpp"

#include <unistd.h>

#include <cmath>
#include <overfly_lcm/debug_t.hpp>
#include <overfly_lcm/status_t.hpp>
#include <stdexcept>
#include <utility>

#include "core/measure/crc32.hpp"
#include "core/time.hpp"
#include "middleware/lcm/messages.hpp"
#include "vo_bridges/lcm/lcm_estimator.hpp"

namespace overfly::testing {

std::vector<VoFrame> varied_frames(int count, int width_px, int height_px) {
  const auto intrinsics =
      PinholeCamera::from_fov(width_px, height_px, 1.48, FovAxis::kHorizontal).value();
  std::vector<VoFrame> frames;
  for (int i = 0; i < count; ++i) {
    Image image(width_px, height_px, 1);
    for (std::size_t at = 0; at < image.data.size(); ++at) {
      image.data[at] = static_cast<std::uint8_t>(at * 31 + at / 977 + 5 * static_cast<unsigned>(i));
    }
    VoFrame& frame = frames.emplace_back();
    frame.index = i;
    frame.t_ns = frame_time_ns(i, FrameRate{});
    frame.image = std::make_shared<const Image>(std::move(image));
    frame.intrinsics = intrinsics;
  }
  return frames;
}

LcmTestEstimator::LcmTestEstimator(std::shared_ptr<lcm::Node> node,
                                   std::string prefix,
                                   LcmBehaviour behaviour)
    : node_(std::move(node)), prefix_(std::move(prefix)), behaviour_(std::move(behaviour)) {
  using Bytes = std::span<const std::uint8_t>;
  const auto subscribe = [&](const std::string& name, auto method) {
    return node_->subscribe(prefix_ + name, [this, method](Bytes bytes) {
      const std::lock_guard lock(mutex_);
      (this->*method)(bytes);
    });
  };
  static_cast<void>(subscribe("CALIBRATION", &LcmTestEstimator::hear_calibration));
  static_cast<void>(subscribe("IMAGE", &LcmTestEstimator::hear_image));
  static_cast<void>(subscribe("TIME", &LcmTestEstimator::hear_time));
  static_cast<void>(subscribe("IMU", &LcmTestEstimator::hear_imu));
  static_cast<void>(subscribe("GPS", &LcmTestEstimator::hear_gps));
}

LcmTestEstimator::~LcmTestEstimator() { node_->stop(); }

std::vector<overfly_lcm::imu_t> LcmTestEstimator::imu() const {
  const std::lock_guard lock(mutex_);
  return imu_;
}

std::vector<overfly_lcm::gps_t> LcmTestEstimator::gps() const {
  const std::lock_guard lock(mutex_);
  return gps_;
}

void LcmTestEstimator::hear_imu(std::span<const std::uint8_t> bytes) {
  imu_.push_back(lcm::decode_message<overfly_lcm::imu_t>(bytes).value());
}

void LcmTestEstimator::hear_gps(std::span<const std::uint8_t> bytes) {
  gps_.push_back(lcm::decode_message<overfly_lcm::gps_t>(bytes).value());
}

std::vector<overfly_lcm::image_t> LcmTestEstimator::images() const {
  const std::lock_guard lock(mutex_);
  return images_;
}

std::optional<overfly_lcm::calibration_t> LcmTestEstimator::calibration() const {
  const std::lock_guard lock(mutex_);
  return calibration_;
}

int LcmTestEstimator::sessions() const {
  const std::lock_guard lock(mutex_);
  return sessions_;
}

bool LcmTestEstimator::ended() const {
  const std::lock_guard lock(mutex_);
  return ended_;
}

void LcmTestEstimator::publish_raw(const std::string& channel,
                                   const std::vector<std::uint8_t>& bytes) {
  static_cast<void>(node_->publish(prefix_ + channel, bytes));
}

void LcmTestEstimator::hear_calibration(std::span<const std::uint8_t> bytes) {
  const auto message = lcm::decode_message<overfly_lcm::calibration_t>(bytes);
  if (!message || calibrations_++ < behaviour_.calibrations_missed) return;
  if (!calibration_ || calibration_->session != message->session) {
    calibration_ = message;
    last_pose_.reset();
    tracked_ = 0;
    ++sessions_;
  }
  publish_status(message->session);
}

void LcmTestEstimator::hear_image(std::span<const std::uint8_t> bytes) {
  const auto message = lcm::decode_message<overfly_lcm::image_t>(bytes);
  if (!message || !calibration_ || message->session != calibration_->session) return;
  if (behaviour_.loses_image && behaviour_.loses_image(*message)) return;
  images_.push_back(*message);
  answer(*message);
}

/// Repeats the answer when asked; says so when the image has not come.
void LcmTestEstimator::hear_time(std::span<const std::uint8_t> bytes) {
  const auto message = lcm::decode_message<overfly_lcm::sim_time_t>(bytes);
  if (!message || !calibration_ || message->session != calibration_->session) return;
  if (message->ended != 0) {
    ended_ = true;
    return;
  }
  if (last_pose_ && last_pose_->frame == message->frame) {
    last_pose_->attempt = message->attempt;
    if (message->attempt > 1) publish_pose(*last_pose_);
    return;
  }
  overfly_lcm::pose_t lost{};
  lost.utime = message->utime;
  lost.t_ns = message->t_ns;
  lost.session = message->session;
  lost.frame = message->frame;
  lost.sequence = message->sequence;
  lost.attempt = message->attempt;
  publish_pose(lost);
}

void LcmTestEstimator::answer(const overfly_lcm::image_t& image) {
  overfly_lcm::pose_t pose{};
  pose.utime = image.utime;
  pose.t_ns = image.t_ns;
  pose.session = image.session;
  pose.frame = image.frame;
  pose.sequence = image.sequence;
  pose.attempt = 1;
  pose.image_received = 1;
  Image received(image.width, image.height, 1);
  received.data = image.data;
  pose.image_crc32 = crc32_of(received);
  const double angle_rad = image.data.front() / 256.0;
  pose.state = tracked_ == 0 ? overfly_lcm::pose_t::INITIALISING : overfly_lcm::pose_t::TRACKING;
  pose.position[2] = tracked_++;
  pose.orientation[2] = std::sin(angle_rad / 2.0);
  pose.orientation[3] = std::cos(angle_rad / 2.0);
  pose.scene_depth = 12.5;
  pose.counters.resize(1);
  pose.counters[0].name = "features";
  pose.counters[0].value = image.width;
  pose.ncounters = 1;
  pose.timings_ms.resize(1);
  pose.timings_ms[0].name = "tracking";
  pose.timings_ms[0].value = 1.5;
  pose.ntimings_ms = 1;
  pose.debug_sent = image.debug_wanted;
  if (image.debug_wanted != 0 && behaviour_.sends_debug) publish_debug(image);
  last_pose_ = pose;
  for (int i = 0; i < behaviour_.answers_each; ++i) publish_pose(pose);
}

void LcmTestEstimator::publish_status(std::int64_t session) {
  overfly_lcm::status_t status{};
  status.session = session;
  status.name = "counting";
  status.version = "2.1";
  status.images_received = static_cast<std::int64_t>(images_.size());
  status.cpu_s = 1.25;
  status.peak_memory_mb = 20.0;
  status.parameters.resize(1);
  status.parameters[0].name = "nFeatures";
  status.parameters[0].value = "1000";
  status.nparameters = 1;
  status.lines = {"ready"};
  status.nlines = 1;
  static_cast<void>(lcm::publish_message(*node_, prefix_ + "STATUS", status));
}

void LcmTestEstimator::publish_debug(const overfly_lcm::image_t& image) {
  overfly_lcm::debug_t debug{};
  debug.utime = image.utime;
  debug.t_ns = image.t_ns;
  debug.session = image.session;
  debug.frame = image.frame;
  debug.width = image.width / 2;
  debug.height = image.height / 2;
  debug.size = 3 * debug.width * debug.height;
  debug.data.assign(static_cast<std::size_t>(debug.size), 77);
  debug.points = {{1.0F, 2.0F, 3.0F}};
  debug.npoints = 1;
  static_cast<void>(lcm::publish_message(*node_, prefix_ + "DEBUG", debug));
}

void LcmTestEstimator::publish_pose(const overfly_lcm::pose_t& pose) {
  if (behaviour_.loses_pose && behaviour_.loses_pose(pose)) return;
  overfly_lcm::pose_t changed = pose;
  if (behaviour_.changes_pose) behaviour_.changes_pose(changed);
  static_cast<void>(lcm::publish_message(*node_, prefix_ + "POSE", changed));
}

LcmPair make_memq_pair(LcmBehaviour behaviour, LcmEstimatorOptions options) {
  options.url = "memq://";
  const auto node = lcm::Node::open(lcm::parse_url(options.url).value()).value();
  LcmPair pair;
  pair.far_end =
      std::make_shared<LcmTestEstimator>(node, options.channel_prefix, std::move(behaviour));
  pair.door = create_lcm_estimator_on(node, options).value();
  return pair;
}

LcmEstimatorOptions impatient(bool lockstep) {
  LcmEstimatorOptions options;
  options.lockstep = lockstep;
  options.start_timeout_s = 1.0;
  options.answer_timeout_s = 0.5;
  return options;
}

std::vector<VoEstimate> fly(VoPort& door, int count) {
  std::vector<VoEstimate> estimates;
  for (const VoFrame& frame : varied_frames(count)) {
    Result<VoEstimate> estimate = door.track(frame);
    if (!estimate) throw std::runtime_error(estimate.error().message);
    estimates.push_back(std::move(*estimate));
  }
  return estimates;
}

std::string multicast_missing() {
  const Status status = lcm::probe_multicast("239.255.76.67");
  return status ? "" : status.error().message;
}

std::string private_udp_url() {
  return "udpm://239.255.76.67:" + std::to_string(20000 + getpid() % 20000) + "?ttl=0";
}

LcmPair make_udp_pair(LcmBehaviour behaviour,
                      const LcmEstimatorOptions& options,
                      const std::string& far_url) {
  LcmPair pair;
  const auto node =
      lcm::Node::open(lcm::with_receive_buffer(lcm::parse_url(far_url).value())).value();
  pair.far_end =
      std::make_shared<LcmTestEstimator>(node, options.channel_prefix, std::move(behaviour));
  node->start();
  pair.door = create_lcm_estimator(options).value();
  return pair;
}

}  // namespace overfly::testing
