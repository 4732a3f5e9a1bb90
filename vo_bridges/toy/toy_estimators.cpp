#include "vo_bridges/toy/toy_estimators.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

namespace overfly {
namespace {

std::string text_of(double value) {
  std::string text = std::to_string(value);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

/// The image in RGB with a cross in the middle, so that a debug image is recognisable.
Image debug_image(const Image& grey) {
  Image rgb(grey.width_px, grey.height_px, 3);
  for (std::size_t i = 0; i < grey.data.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) rgb.data[3 * i + c] = grey.data[i];
  }
  const auto mark = [&](int x, int y) {
    const std::size_t at =
        3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(rgb.width_px) +
             static_cast<std::size_t>(x));
    rgb.data[at] = 255;
    rgb.data[at + 1] = rgb.data[at + 2] = 0;
  };
  for (int x = 0; x < rgb.width_px; ++x) mark(x, rgb.height_px / 2);
  for (int y = 0; y < rgb.height_px; ++y) mark(rgb.width_px / 2, y);
  return rgb;
}

/// Returns the truth. Loses track at an image without truth.
class ToyEstimator final : public VoPort {
 public:
  ToyEstimator(std::string type, ToyTruthAt truth, const ToyParameters& parameters)
      : type_(std::move(type)), truth_at_(std::move(truth)), parameters_(parameters) {}

  [[nodiscard]] std::string type() const override { return type_; }

  [[nodiscard]] std::map<std::string, std::string> effective_parameters() const override {
    return {{"scale", text_of(parameters_.scale)},
            {"drift", text_of(parameters_.drift)},
            {"scene_depth_m",
             parameters_.scene_depth_m ? text_of(*parameters_.scene_depth_m) : "true depth"}};
  }

  [[nodiscard]] Result<VoEstimate> track(const VoFrame& frame) override {
    const VoFrame* const previous = previous_ ? &*previous_ : nullptr;
    if (Status status = validate_vo_frame(frame, previous); !status) return status.error();
    previous_ = frame;
    previous_->image.reset();  // its size stays in the intrinsics

    VoEstimate estimate;
    estimate.sample.frame = frame.index;
    estimate.sample.t_ns = frame.t_ns;
    if (const std::optional<ToyTruth> truth = truth_at_(frame.t_ns)) {
      if (!T_vo_world_) T_vo_world_ = truth->T_world_camera.inverse();
      estimate.sample.state = TrackingState::kTracking;
      estimate.sample.T_vo_camera = *T_vo_world_ * truth->T_world_camera;
      // A step lengthened by a constant factor lengthens the whole path by it.
      const double stretch = parameters_.scale * (1.0 + parameters_.drift);
      estimate.sample.T_vo_camera.translation *= stretch;
      const double depth_m = parameters_.scene_depth_m.value_or(truth->scene_depth_m.value_or(0.0));
      if (depth_m > 0.0) estimate.sample.scene_depth = depth_m * parameters_.scale;
    } else if (T_vo_world_) {
      estimate.sample.state = TrackingState::kLost;
    }
    if (debug_) {
      estimate.debug_image = debug_image(*frame.image);
      if (estimate.sample.scene_depth) {
        const Eigen::Vector3d ahead(0.0, 0.0, *estimate.sample.scene_depth);
        estimate.map_points_vo.push_back((estimate.sample.T_vo_camera * ahead).cast<float>());
      }
    }
    return estimate;
  }

  void set_debug(bool wanted) override { debug_ = wanted; }

 private:
  std::string type_;
  ToyTruthAt truth_at_;
  ToyParameters parameters_;
  std::optional<VoFrame> previous_;
  std::optional<Pose> T_vo_world_;  // inverse of the first pose
  bool debug_ = false;
};

Result<std::unique_ptr<VoPort>> create(std::string type,
                                       ToyTruthAt truth,
                                       const ToyParameters& parameters) {
  if (Status status = check_toy_parameters(parameters); !status) return status.error();
  return std::unique_ptr<VoPort>(
      std::make_unique<ToyEstimator>(std::move(type), std::move(truth), parameters));
}

}  // namespace

Status check_toy_parameters(const ToyParameters& parameters) {
  const auto bad = [](const std::string& field, double value, const std::string& limit) {
    return Error{ErrorCode::kInvalidArgument,
                 "parameters." + field + " = " + std::to_string(value) + ": must be " + limit};
  };
  if (!(parameters.scale > 0.0) || !std::isfinite(parameters.scale)) {
    return bad("scale", parameters.scale, "above 0 and finite");
  }
  if (!(parameters.drift > -1.0 && parameters.drift <= 1.0)) {
    return bad("drift", parameters.drift, "in (-1, 1]");
  }
  const double depth_m = parameters.scene_depth_m.value_or(0.0);
  if (!(depth_m >= 0.0) || !std::isfinite(depth_m)) {
    return bad("scene_depth_m", depth_m, "0 or more and finite");
  }
  return {};
}

Result<std::unique_ptr<VoPort>> create_perfect_estimator(ToyTruthAt truth,
                                                         const ToyParameters& parameters) {
  ToyParameters perfect = parameters;
  perfect.drift = 0.0;
  return create("perfect", std::move(truth), perfect);
}

Result<std::unique_ptr<VoPort>> create_drifting_estimator(ToyTruthAt truth,
                                                          const ToyParameters& parameters) {
  return create("drifting", std::move(truth), parameters);
}

}  // namespace overfly
