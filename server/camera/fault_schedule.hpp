// Which faults are in force at a frame, and what they do to its stamp and its delivery.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "server/scenario/scenario.hpp"

namespace overfly::engine {

/// What the faults do to one frame of one camera.
struct FrameFaults {
  std::vector<const FaultSpec*> on_lens;  ///< in the scenario's order
  bool frozen = false;
  bool dropped = false;
  std::int64_t stamp_ns = 0;       ///< that estimators are told
  std::vector<std::string> names;  ///< kinds that touch this frame, each once
};

/// Random choices depend on the fault's seed and the frame's number alone.
class FaultSchedule {
 public:
  /// @param scenario  must outlive the schedule
  explicit FaultSchedule(const Scenario& scenario);

  /// Stamps that estimators are told always grow: one that would not comes 1 us after the one
  /// before. Frames of a camera must come in order.
  [[nodiscard]] FrameFaults at(std::size_t camera, std::int64_t frame, std::int64_t t_ns);
  /// True when the camera can freeze at some time.
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
  /// What has changed since the call before.
  [[nodiscard]] std::vector<Line> at(std::int64_t t_ns);

 private:
  const Scenario& scenario_;
  std::vector<bool> in_force_;
};

}  // namespace overfly::engine
