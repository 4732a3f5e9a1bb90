// Runs with estimators that record which images they get, for tests of several estimators.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "server/files/whole_file.hpp"
#include "server/record/run_folder.hpp"
#include "server/record/run_records.hpp"
#include "server/run/run_options.hpp"
#include "server/timing/run_clock.hpp"
#include "tests/server/support/server_fixture.hpp"

namespace overfly::server::testing {

/// CRC-32 bit by bit, from its definition (ISO 3309): independent of the program's tables.
inline std::uint32_t plain_crc32(const std::vector<std::uint8_t>& bytes) {
  std::uint32_t rest = 0xFFFFFFFFU;
  for (const std::uint8_t byte : bytes) {
    rest ^= byte;
    for (int bit = 0; bit < 8; ++bit) rest = (rest >> 1U) ^ ((rest & 1U) * 0xEDB88320U);
  }
  return ~rest;
}

/// Records the CRC of each image that it gets, and behaves as configured.
class Witness final : public VoPort {
 public:
  struct Behaviour {
    RunClock* clock = nullptr;
    std::int64_t work_ns = 0;
    bool far_end = false;                ///< reports the CRC itself, like an external estimator
    std::int64_t garbled = -1;           ///< frame whose image arrives damaged
    std::int64_t silent = -1;            ///< frame that it does not answer
    std::int64_t not_finite = -1;        ///< frame that it answers with values that are not finite
    bool not_finite_from_there = false;  ///< and all later frames
    std::vector<std::string> log = {};   ///< log lines at its first frame
    std::string unready = {};            ///< error of prepare(); empty = ready
    std::int64_t cancelled = -1;         ///< frame in which it is cancelled
    std::int64_t hangs = -1;             ///< frame at which it is ended because it hangs
    std::vector<int> maps = {};          ///< map id by frame; the last one from there on
  };
  using Seen = std::map<std::int64_t, std::uint32_t>;
  Witness(Behaviour behaviour, Seen& seen) : behaviour_(std::move(behaviour)), seen_(seen) {}

  std::string type() const override { return "witness"; }
  std::map<std::string, std::string> effective_parameters() const override {
    // Changes after the first frame, like systems whose modes override their settings.
    return {{"threshold", seen_.empty() ? "7" : "3"}, {"levels", "8"}};
  }
  Status prepare(const VoFrame& /*first*/) override {
    if (behaviour_.unready.empty()) return {};
    return Error{ErrorCode::kInternal, behaviour_.unready};
  }
  Result<VoEstimate> track(const VoFrame& frame) override {
    if (seen_.empty()) {
      const std::lock_guard lock(mutex_);
      said_ = behaviour_.log;
    }
    if (frame.index == behaviour_.cancelled) return Error{ErrorCode::kCancelled, "stopped"};
    if (frame.index == behaviour_.hangs) return Error{ErrorCode::kTimeout, "it hangs"};
    seen_[frame.index] = plain_crc32(frame.image->data);
    if (behaviour_.work_ns > 0) {
      behaviour_.clock->sleep_until_ns(behaviour_.clock->now_ns() + behaviour_.work_ns);
    }
    VoEstimate estimate;
    estimate.sample.frame = frame.index;
    estimate.sample.t_ns = frame.t_ns;
    estimate.sample.state = TrackingState::kTracking;
    estimate.sample.T_vo_camera.translation.x() = static_cast<double>(frame.index);
    if (!behaviour_.maps.empty()) {
      const auto last = static_cast<std::int64_t>(behaviour_.maps.size()) - 1;
      estimate.sample.map_id =
          behaviour_.maps[static_cast<std::size_t>(std::min(frame.index, last))];
    }
    if (behaviour_.far_end) {
      estimate.image_crc32 = seen_[frame.index] + (frame.index == behaviour_.garbled ? 1U : 0U);
    }
    const bool later = behaviour_.not_finite_from_there && frame.index > behaviour_.not_finite;
    if (frame.index == behaviour_.not_finite || later) {
      estimate.sample.frame = 77;
      estimate.sample.T_vo_camera.translation.x() = std::nan("");
      estimate.sample.scene_depth = std::numeric_limits<double>::infinity();
      estimate.counters = {{"features", std::nan("")}, {"inliers", 3.0}};
    }
    if (frame.index == behaviour_.silent) {
      estimate.sample.state = TrackingState::kLost;
      estimate.counters["unanswered"] = 1.0;
    }
    return estimate;
  }
  void set_debug(bool /*wanted*/) override {}
  std::vector<std::string> take_log() override {
    const std::lock_guard lock(mutex_);
    return std::exchange(said_, {});
  }
  std::optional<ResourceUse> resource_use() const override {
    if (!behaviour_.far_end) return std::nullopt;
    // Much of it was used before the first frame.
    return ResourceUse{30.0 + 0.5 * static_cast<double>(seen_.size()), 42.0};
  }

 private:
  Behaviour behaviour_;
  Seen& seen_;
  std::mutex mutex_;
  std::vector<std::string> said_;
};

/// A run of small_scenario with witnesses as estimators.
struct WitnessRun {
  overfly::testing::TemporaryFolder folder;
  std::map<std::string, Witness::Behaviour> behaviours;
  std::map<std::string, Witness::Seen> seen;
  std::vector<std::string> overrides;
  RunClock* clock = nullptr;

  RunOptions options() {
    RunOptions options;
    options.folder = folder.path() / "r";
    options.renderer_factory = noop_factory();
    options.clock = clock;
    options.estimator_factory = [this](const EstimatorSpec& spec) {
      return Result<std::unique_ptr<VoPort>>(
          std::make_unique<Witness>(behaviours[spec.name], seen[spec.name]));
    };
    return options;
  }
  RunResult fly() {
    const auto run = run_scenario(small_scenario(overrides), options());
    if (!run) throw std::runtime_error(run.error().message);
    return *run;
  }
  RunRecords records() const { return read_run_records(folder.path() / "r").value(); }
  nlohmann::json manifest() const { return read_json(manifest_file(folder.path() / "r")).value(); }
  nlohmann::json timings() const { return read_json(timings_file(folder.path() / "r")).value(); }
};

/// Three estimators: a, b, c.
inline constexpr const char* kThree =
    R"(estimators=[{"name":"a","type":"feature"},{"name":"b","type":"feature"},)"
    R"({"name":"c","type":"feature"}])";

}  // namespace overfly::server::testing
