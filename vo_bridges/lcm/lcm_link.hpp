// Communication with one estimator over LCM: session, outgoing images, incoming answers.
#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <overfly_lcm/calibration_t.hpp>
#include <overfly_lcm/sim_time_t.hpp>
#include <set>
#include <span>
#include <string>
#include <utility>

#include "core/result.hpp"
#include "middleware/lcm/messages.hpp"
#include "middleware/lcm/node.hpp"
#include "vo_bridges/lcm/lcm_answers.hpp"
#include "vo_bridges/lcm/lcm_far_end.hpp"
#include "vo_bridges/stamped_answers.hpp"

namespace overfly {

/// Counter in an answer that reports that the image was lost in transport.
inline constexpr const char* kImageLost = "images_lost";

class LcmLink {
 public:
  /// @param node    not yet started
  /// @param prefix  prefix of every channel
  /// @param hears   whether messages can be received (not if a log is written)
  /// Errors: kIo.
  static Result<std::unique_ptr<LcmLink>> open(std::shared_ptr<lcm::Node> node,
                                               const std::string& prefix,
                                               bool hears);
  /// Announces the end of the session.
  ~LcmLink();
  LcmLink(const LcmLink&) = delete;
  LcmLink& operator=(const LcmLink&) = delete;

  /// Begins the session; call it once. The estimator discards the session of a previous run.
  void begin(overfly_lcm::calibration_t calibration);
  [[nodiscard]] std::int64_t session() const { return session_.load(); }
  /// Publishes the calibration. An estimator that receives it for the first time starts a new
  /// session.
  [[nodiscard]] Status announce();
  /// Publishes samples of sensors, each once.
  [[nodiscard]] Status send(const SensorSamples& samples);
  /// Publishes an image, then the time. The image's answer is expected from now on.
  [[nodiscard]] Status send(const VoFrame& frame);
  /// Publishes the time of the image again: the estimator repeats its answer or reports that the
  /// image was lost.
  [[nodiscard]] Status ask_again();

  void set_debug(bool wanted) { debug_wanted_ = wanted; }
  [[nodiscard]] StampedAnswers& answers() { return answers_; }
  [[nodiscard]] LcmFarEnd& far_end() { return far_end_; }
  [[nodiscard]] const LcmFarEnd& far_end() const { return far_end_; }
  /// Number of answers that belong to other sessions.
  [[nodiscard]] std::int64_t outdated() const { return outdated_.load(); }

 private:
  LcmLink(std::shared_ptr<lcm::Node> node, std::string prefix)
      : node_(std::move(node)), prefix_(std::move(prefix)) {}
  Status subscribe();
  void hear_pose(std::span<const std::uint8_t> bytes);
  void hear_debug(std::span<const std::uint8_t> bytes);
  void hear_status(std::span<const std::uint8_t> bytes);
  void attach_debug(VoEstimate& estimate);
  /// Names of the counters or timings of a session.
  struct Names {
    const char* what;
    std::set<std::string> known{};
    bool bad_told = false;
    bool limit_told = false;
  };
  /// Removes figures with invalid names, and those with more names than the limit.
  void limit_names(Names& names, std::map<std::string, double>& figures);

  std::shared_ptr<lcm::Node> node_;
  const std::string prefix_;
  LcmFarEnd far_end_;
  StampedAnswers answers_;
  overfly_lcm::calibration_t calibration_{};
  overfly_lcm::sim_time_t time_{};  ///< last published
  std::atomic<std::int64_t> session_ = 0;
  std::atomic<std::int64_t> sequence_ = 0;             ///< of the last published image
  std::map<std::string, std::int64_t> sample_counts_;  ///< published, by channel
  std::atomic<int> width_px_ = 0;
  std::atomic<int> height_px_ = 0;
  std::atomic<bool> debug_wanted_ = false;
  std::atomic<std::int64_t> outdated_ = 0;
  Names counters_{"counter"};
  Names timings_{"timing"};
  /// Stamp of the last answered image; used by the node's thread only.
  std::optional<std::int64_t> answered_t_ns_;
  /// Stamp of the last debug message; used by the node's thread only.
  std::int64_t debug_t_ns_ = -1;
  DebugView debug_;
};

}  // namespace overfly
