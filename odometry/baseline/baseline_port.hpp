// What the baselines share as estimators.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "odometry/shell/estimator_log.hpp"
#include "vo_bridges/vo_port.hpp"

namespace overfly::odometry::baseline {

class BaselinePort : public VoPort {
 public:
  [[nodiscard]] std::map<std::string, std::string> effective_parameters() const override {
    return {};
  }
  [[nodiscard]] Result<VoEstimate> track(const VoFrame& frame) final {
    const VoFrame* const previous = previous_ ? &*previous_ : nullptr;
    if (Status status = validate_vo_frame(frame, previous); !status) return status.error();
    previous_ = frame;
    previous_->image.reset();  // its size stays in the intrinsics
    previous_->sensors = {};
    VoEstimate estimate;
    estimate.sample.frame = frame.index;
    estimate.sample.t_ns = frame.t_ns;
    answer(frame, estimate);
    return estimate;
  }
  void set_debug(bool wanted) override { debug_ = wanted; }
  [[nodiscard]] std::vector<std::string> take_log() override { return log_.take(); }

 protected:
  /// Sets state, pose and what else there is to tell. @param frame  valid
  virtual void answer(const VoFrame& frame, VoEstimate& estimate) = 0;
  [[nodiscard]] bool debug() const { return debug_; }
  void log(std::string line) { log_.add(std::move(line)); }

 private:
  std::optional<VoFrame> previous_;
  bool debug_ = false;
  EstimatorLog log_;
};

}  // namespace overfly::odometry::baseline
