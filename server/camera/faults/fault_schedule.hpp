// Which faults are active at a frame, and how they change its stamp and delivery.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "server/scenario/scenario.hpp"

namespace overfly::server {

/// Effect of the faults on one frame of one camera.
struct FrameFaults {
  std::vector<const FaultSpec*> on_lens;  ///< in the scenario's order
  bool frozen = false;
  bool dropped = false;
  std::int64_t stamp_ns = 0;       ///< as given to estimators
  std::vector<std::string> names;  ///< kinds that affect this frame, each once
};

/// Random choices depend only on the fault's seed and the frame's number.
class FaultSchedule {
 public:
  /// @param scenario  must outlive the schedule
  explicit FaultSchedule(const Scenario& scenario);

  /// Stamps given to estimators always increase: one that would not is set to 1 us after the
  /// previous one. Frames of a camera must come in order.
  [[nodiscard]] FrameFaults at(std::size_t camera, std::int64_t frame, std::int64_t t_ns);
  /// True if the camera can freeze at some time.
  [[nodiscard]] bool may_freeze(std::size_t camera) const;

 private:
  [[nodiscard]] bool drops(const FaultSpec& fault, std::int64_t frame) const;

  const Scenario& scenario_;
  std::vector<std::optional<std::int64_t>> last_stamp_ns_;  ///< by camera
};

/// One line when a fault begins and one when it ends.
class FaultNews {
 public:
  explicit FaultNews(const Scenario& scenario)
      : scenario_(scenario), in_force_(scenario.faults.size(), false) {}

  struct Line {
    bool begins = true;
    std::string text;
  };
  /// Changes since the previous call.
  [[nodiscard]] std::vector<Line> at(std::int64_t t_ns);

 private:
  const Scenario& scenario_;
  std::vector<bool> in_force_;
};

}  // namespace overfly::server
