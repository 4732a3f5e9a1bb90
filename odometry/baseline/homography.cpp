#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>
#include <utility>

#include "core/algebra/decompositions.hpp"
#include "core/camera/camera_model.hpp"
#include "odometry/baseline/baseline_odometry.hpp"
#include "odometry/baseline/baseline_port.hpp"
#include "odometry/geometry/two_view.hpp"
#include "odometry/shell/parameter_table.hpp"

namespace overfly::odometry::baseline {
namespace {

constexpr int kLeastPoints = 20;
constexpr double kLeastKept = 0.5;  ///< share of a reference image's corners
constexpr double kInlierPx = 1.5;

const ParameterTable<HomographyParameters>& parameter_table() {
  static const ParameterTable<HomographyParameters> table{
      "baseline_homography",
      {{"features", 20, 5000, &HomographyParameters::features}},
      {},
      {{"reference_px",
        [](double value) { return value > 0.0 && std::isfinite(value); },
        "above 0 and finite",
        &HomographyParameters::reference_px}},
      {}};
  return table;
}

/// Corners of a reference image, followed from image to image.
struct Corners {
  std::vector<cv::Point2f> reference_px;
  std::vector<cv::Point2f> current_px;
};

cv::Mat grey_view(const Image& image) {
  // OpenCV has no view of constant pixels; nothing writes to it.
  return {image.height_px, image.width_px, CV_8UC1, const_cast<std::uint8_t*>(image.data.data())};
}

class HomographyOdometry final : public BaselinePort {
 public:
  explicit HomographyOdometry(const HomographyParameters& parameters) : parameters_(parameters) {}

  [[nodiscard]] std::string type() const override { return "baseline_homography"; }
  [[nodiscard]] std::map<std::string, std::string> effective_parameters() const override {
    return parameter_table().texts_of(parameters_);
  }

 private:
  void answer(const VoFrame& frame, VoEstimate& estimate) override {
    const cv::Mat image = grey_view(*frame.image);
    if (previous_.empty()) camera_ = CameraModel(frame.intrinsics, frame.distortion);
    bool found = previous_.empty() ? find_corners(image) : follow(image);
    if (found && moved_from_reference()) found = update_pose();
    estimate.sample.state = found         ? TrackingState::kTracking
                            : ever_found_ ? TrackingState::kLost
                                          : TrackingState::kInitialising;
    ever_found_ = ever_found_ || found;
    estimate.sample.T_vo_camera = T_vo_camera_;
    // The ground is the plane at the depth of one height below the first camera.
    const double down = (T_vo_camera_.rotation * Eigen::Vector3d::UnitZ()).z();
    if (down > 0.05) estimate.sample.scene_depth = 1.0 / down;
    estimate.counters["points"] = static_cast<double>(corners_.current_px.size());
    if (debug()) estimate.debug_image = debug_image(*frame.image);
    if (!found) last_flow_ = {};
    if (!found || needs_reference()) find_corners(image);
    image.copyTo(previous_);
  }

  /// A new reference image, at the present pose.
  bool find_corners(const cv::Mat& image) {
    corners_ = {};
    T_vo_reference_ = T_vo_camera_;
    cv::goodFeaturesToTrack(image, corners_.reference_px, parameters_.features, 0.01, 12.0);
    corners_.current_px = corners_.reference_px;
    corners_at_start_ = corners_.reference_px.size();
    return corners_at_start_ >= kLeastPoints;
  }

  bool follow(const cv::Mat& image) {
    if (corners_.current_px.size() < kLeastPoints) return false;
    std::vector<cv::Point2f> next = guessed();
    std::vector<std::uint8_t> status;
    std::vector<float> error;
    cv::calcOpticalFlowPyrLK(
        previous_,
        image,
        corners_.current_px,
        next,
        status,
        error,
        cv::Size(21, 21),
        4,
        cv::TermCriteria(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 30, 0.01),
        cv::OPTFLOW_USE_INITIAL_FLOW);
    last_flow_ = median_flow(corners_.current_px, next, status);
    Corners kept;
    for (std::size_t i = 0; i < next.size(); ++i) {
      if (status[i] == 0) continue;
      kept.reference_px.push_back(corners_.reference_px[i]);
      kept.current_px.push_back(next[i]);
    }
    corners_ = std::move(kept);
    return corners_.current_px.size() >= kLeastPoints;
  }

  /// Where the corners would be if they moved as between the last two images.
  [[nodiscard]] std::vector<cv::Point2f> guessed() const {
    std::vector<cv::Point2f> next = corners_.current_px;
    for (cv::Point2f& point : next) point += last_flow_;
    return next;
  }

  static cv::Point2f median_flow(const std::vector<cv::Point2f>& from,
                                 const std::vector<cv::Point2f>& to,
                                 const std::vector<std::uint8_t>& status) {
    std::vector<float> x;
    std::vector<float> y;
    for (std::size_t i = 0; i < from.size(); ++i) {
      if (status[i] == 0) continue;
      x.push_back(to[i].x - from[i].x);
      y.push_back(to[i].y - from[i].y);
    }
    if (x.empty()) return {};
    const auto middle = [](std::vector<float>& values) {
      const auto at = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
      std::nth_element(values.begin(), at, values.end());
      return *at;
    };
    return {middle(x), middle(y)};
  }

  [[nodiscard]] double median_motion_px() const {
    std::vector<double> lengths;
    for (std::size_t i = 0; i < corners_.current_px.size(); ++i) {
      lengths.push_back(cv::norm(corners_.current_px[i] - corners_.reference_px[i]));
    }
    if (lengths.empty()) return 0.0;
    const auto at = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
    std::nth_element(lengths.begin(), at, lengths.end());
    return *at;
  }

  [[nodiscard]] bool moved_from_reference() const { return median_motion_px() > 0.0; }
  [[nodiscard]] bool needs_reference() const {
    return median_motion_px() > parameters_.reference_px ||
           static_cast<double>(corners_.current_px.size()) <
               kLeastKept * static_cast<double>(corners_at_start_);
  }

  /// Points on the plane z = 1 of both cameras. Drops the corners for which the lens has no ray:
  /// they may be followed a little beyond the image.
  void ideal_points(std::vector<cv::Point2d>& reference, std::vector<cv::Point2d>& current) {
    Corners kept;
    for (std::size_t i = 0; i < corners_.current_px.size(); ++i) {
      const cv::Point2f& a = corners_.reference_px[i];
      const cv::Point2f& b = corners_.current_px[i];
      const auto ray_a = camera_.ray({a.x, a.y});
      const auto ray_b = camera_.ray({b.x, b.y});
      if (!ray_a || !ray_b) continue;
      reference.emplace_back(ray_a->x(), ray_a->y());
      current.emplace_back(ray_b->x(), ray_b->y());
      kept.reference_px.push_back(a);
      kept.current_px.push_back(b);
    }
    corners_ = std::move(kept);
  }

  /// Fits the homography and drops what does not agree with it. @return whether there is one
  bool update_pose() {
    std::vector<cv::Point2d> reference;
    std::vector<cv::Point2d> current;
    ideal_points(reference, current);
    if (current.size() < kLeastPoints) return false;
    std::vector<std::uint8_t> inlier;
    const double threshold = kInlierPx / camera_.pinhole().fx_px;
    const cv::Mat found = cv::findHomography(reference, current, cv::RANSAC, threshold, inlier);
    if (found.empty()) return false;
    Corners kept;
    for (std::size_t i = 0; i < inlier.size(); ++i) {
      if (inlier[i] == 0) continue;
      kept.reference_px.push_back(corners_.reference_px[i]);
      kept.current_px.push_back(corners_.current_px[i]);
    }
    corners_ = std::move(kept);
    if (corners_.current_px.size() < kLeastPoints) return false;
    Eigen::Matrix3d H;
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) H(row, column) = found.at<double>(row, column);
    }
    return take_motion(H);
  }

  /// The motion since the reference image: of the motions that the homography allows, the one whose
  /// plane is closest to level ground.
  bool take_motion(const Eigen::Matrix3d& found) {
    const double middle = svd(found).values(1);
    if (!(middle > 0.0)) return false;
    // R + t n^T / d of points in front of both cameras: its sign makes (H x) . z positive.
    const Eigen::Matrix3d H = (found(2, 2) < 0.0 ? -found : found) / middle;
    const Eigen::Vector3d n =
        T_vo_reference_.rotation.conjugate() * Eigen::Vector3d::UnitZ();  // down, in the reference
    double least = std::numeric_limits<double>::infinity();
    Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
    for (const Eigen::Matrix3d& candidate : rotations_of(H)) {
      // H - R has to vanish for directions within the ground.
      const Eigen::Matrix3d rest =
          (H - candidate) * (Eigen::Matrix3d::Identity() - n * n.transpose());
      if (rest.norm() >= least) continue;
      least = rest.norm();
      R = candidate;
    }
    const Eigen::Vector3d t = (H - R) * n;  // x_current = R x_reference + t, in heights
    Pose T_current_reference{Eigen::Quaterniond(R).normalized(), t};
    T_vo_camera_ = T_vo_reference_ * T_current_reference.inverse();
    T_vo_camera_.translation.z() = 0.0;  // constant height
    return T_vo_camera_.translation.allFinite();
  }

  static std::vector<Eigen::Matrix3d> rotations_of(const Eigen::Matrix3d& H) {
    std::vector<Eigen::Matrix3d> rotations;
    for (const Pose& motion : motions_of_homography(H)) {
      rotations.push_back(motion.rotation.toRotationMatrix());
    }
    // Without translation H itself is the rotation, but for noise.
    if (rotations.empty()) {
      const Svd3 parts = svd(H);
      rotations.push_back(parts.U * parts.V.transpose());
    }
    return rotations;
  }

  /// The image with the way of each corner since the reference image.
  [[nodiscard]] Image debug_image(const Image& grey) const {
    Image rgb(grey.width_px, grey.height_px, 3);
    cv::Mat canvas(rgb.height_px, rgb.width_px, CV_8UC3, rgb.data.data());
    cv::cvtColor(grey_view(grey), canvas, cv::COLOR_GRAY2RGB);
    for (std::size_t i = 0; i < corners_.current_px.size(); ++i) {
      cv::line(canvas, corners_.reference_px[i], corners_.current_px[i], {250, 210, 60});
      cv::circle(canvas, corners_.current_px[i], 3, {60, 230, 90});
    }
    return rgb;
  }

  HomographyParameters parameters_;
  CameraModel camera_;
  cv::Mat previous_;
  Corners corners_;
  std::size_t corners_at_start_ = 0;
  cv::Point2f last_flow_;
  Pose T_vo_reference_;
  Pose T_vo_camera_;  ///< vo: the first camera, units of the height
  bool ever_found_ = false;
};

}  // namespace

Result<HomographyParameters> homography_parameters_from(
    const std::map<std::string, double>& values) {
  return parameter_table().read(values);
}

std::unique_ptr<VoPort> create_homography(const HomographyParameters& parameters) {
  return std::make_unique<HomographyOdometry>(parameters);
}

}  // namespace overfly::odometry::baseline
