// A small estimator at the other end of an LCM network, which can be made to misbehave.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <overfly_lcm/calibration_t.hpp>
#include <overfly_lcm/gps_t.hpp>
#include <overfly_lcm/image_t.hpp>
#include <overfly_lcm/imu_t.hpp>
#include <overfly_lcm/pose_t.hpp>
#include <overfly_lcm/sim_time_t.hpp>
#include <string>
#include <vector>

#include "vo_bridges/lcm/lcm_door.hpp"

namespace overfly::testing {

/// Frames whose bytes differ from pixel to pixel and from one frame to the next.
[[nodiscard]] std::vector<VoFrame> varied_frames(int count, int width_px = 64, int height_px = 48);

struct LcmBehaviour {
  std::function<bool(const overfly_lcm::image_t&)> loses_image;  ///< as if a packet were missing
  std::function<bool(const overfly_lcm::pose_t&)> loses_pose;    ///< on its way back
  std::function<void(overfly_lcm::pose_t&)> changes_pose;
  int calibrations_missed = 0;  ///< before it hears the first
  int answers_each = 1;
  bool sends_debug = true;  ///< else it only says so
};

/// Tracks from the second image of a session on: one unit forward a frame, turning by what the
/// image's first byte says.
class LcmTestEstimator {
 public:
  /// Subscribes to a node that is not started yet.
  LcmTestEstimator(std::shared_ptr<lcm::Node> node, std::string prefix, LcmBehaviour behaviour);
  /// Stops its node, whose handlers are its own.
  ~LcmTestEstimator();
  LcmTestEstimator(const LcmTestEstimator&) = delete;
  LcmTestEstimator& operator=(const LcmTestEstimator&) = delete;

  [[nodiscard]] std::vector<overfly_lcm::image_t> images() const;  ///< received
  [[nodiscard]] std::optional<overfly_lcm::calibration_t> calibration() const;
  [[nodiscard]] std::vector<overfly_lcm::imu_t> imu() const;  ///< received
  [[nodiscard]] std::vector<overfly_lcm::gps_t> gps() const;  ///< received
  [[nodiscard]] int sessions() const;
  [[nodiscard]] bool ended() const;
  /// Publishes bytes on a channel, "POSE" for example.
  void publish_raw(const std::string& channel, const std::vector<std::uint8_t>& bytes);

 private:
  void hear_calibration(std::span<const std::uint8_t> bytes);
  void hear_image(std::span<const std::uint8_t> bytes);
  void hear_imu(std::span<const std::uint8_t> bytes);
  void hear_gps(std::span<const std::uint8_t> bytes);
  void hear_time(std::span<const std::uint8_t> bytes);
  void answer(const overfly_lcm::image_t& image);
  void publish_status(std::int64_t session);
  void publish_debug(const overfly_lcm::image_t& image);
  void publish_pose(const overfly_lcm::pose_t& pose);

  mutable std::mutex mutex_;
  std::shared_ptr<lcm::Node> node_;
  std::string prefix_;
  LcmBehaviour behaviour_;
  std::optional<overfly_lcm::calibration_t> calibration_;
  std::vector<overfly_lcm::image_t> images_;
  std::vector<overfly_lcm::imu_t> imu_;
  std::vector<overfly_lcm::gps_t> gps_;
  std::optional<overfly_lcm::pose_t> last_pose_;
  int calibrations_ = 0;
  int sessions_ = 0;
  int tracked_ = 0;
  bool ended_ = false;
};

/// A door together with the estimator behind it.
struct LcmPair {
  std::shared_ptr<LcmTestEstimator> far_end;
  std::unique_ptr<VoPort> door;
};

/// Both on one memq node.
[[nodiscard]] LcmPair make_memq_pair(LcmBehaviour behaviour = {}, LcmEstimatorOptions options = {});

/// Long enough for an answer on a busy machine, short enough to wait for none.
[[nodiscard]] LcmEstimatorOptions impatient(bool lockstep = true);
/// Tracks so many varied frames. @throws std::runtime_error when one does not go well
std::vector<VoEstimate> fly(VoPort& door, int count);

/// Why UDP multicast cannot be tested here; empty where it can.
[[nodiscard]] std::string multicast_missing();
/// A multicast URL that only this process uses.
[[nodiscard]] std::string private_udp_url();
/// Each on a node of its own, under the channel prefix of the options.
/// @param far_url  of the estimator; with its own receive buffer, say
[[nodiscard]] LcmPair make_udp_pair(LcmBehaviour behaviour,
                                    const LcmEstimatorOptions& options,
                                    const std::string& far_url);

}  // namespace overfly::testing
