// Example for a camera that looks straight down on flat ground. Aligns both halves of each frame
// with the previous one (Baker, Matthews 2004); together they give translation, rotation and climb.
// Unit: the initial height. Takes bank and relief for motion. A starting point, not a competitor.
#include <Eigen/Dense>
#include <complex>
#include "vo_bridges/client/overfly_vo.hpp"

using namespace overfly_vo;
using Complex = std::complex<double>;  // x + iy in the image: a product rotates and scales
using Image = Eigen::MatrixXd;

struct NadirOdometry final : Estimator {
  double focal = 1.0;  // [px / 4]
  Image before;        // the previous frame, reduced by 4
  Complex left, right, place, heading;

  /// Position in before of the part of `now` from column x0 on; NaN if the search fails.
  Complex shift_of(const Image& now, long x0, Complex shift) const {
    const long rim = now.rows() / 6, rows = now.rows() - 2 * rim, cols = now.cols() / 2 - 2 * rim;
    const auto part = [=](const Image& of, double x, double y) -> Image {  // bilinear
      const double s = x - std::floor(x), t = y - std::floor(y);
      const auto at = of.block(rim + long(y - t), x0 + rim + long(x - s), rows + 1, cols + 1);
      const Image across = at.leftCols(cols) * (1 - s) + at.rightCols(cols) * s;
      return across.topRows(rows) * (1 - t) + across.bottomRows(rows) * t;
    };
    Eigen::MatrixX2d J(rows * cols, 2);  // derivative of the brightness by the shift
    J.col(0) = (part(now, 0.5, 0) - part(now, -0.5, 0)).reshaped();
    J.col(1) = (part(now, 0, 0.5) - part(now, 0, -0.5)).reshaped();
    const Eigen::Matrix2d H_inverse = J.transpose().lazyProduct(J).eval().inverse();
    for (int round = 0; round < 30 && std::abs(shift) < double(rim - 1); ++round) {
      const Image error = part(before, shift.real(), shift.imag()) - part(now, 0, 0);
      const Eigen::Vector2d step = H_inverse * J.transpose().lazyProduct(error.reshaped());
      shift -= Complex(step.x(), step.y());
      if (step.norm() < 1e-3) return shift;
    }
    return NAN;
  }
  std::string name() const override { return "nadir_odometry"; }
  void calibrate(const Calibration& camera) override { focal = camera.fx_px / 4; }
  Answer track(const Frame& frame) override {
    Image now = Image::Zero(frame.height_px / 4, frame.width_px / 4);
    for (long y = 0; y < 4 * now.rows(); ++y)
      for (long x = 0; x < 4 * now.cols(); ++x)
        now(y / 4, x / 4) += frame.pixels[y * frame.width_px + x];
    if (before.size() == 0) before = now, place = left = right = 0, heading = 1;
    left = shift_of(now, 0, left), right = shift_of(now, now.cols() / 2, right);
    place += heading * (left + right) / (2 * focal);
    heading *= 1.0 + (right - left) * 2.0 / double(now.cols());
    const double depth = std::abs(heading), half = std::arg(heading) / 2;
    Answer answer{std::isnan(depth) ? State::kLost : State::kTracking};  // once lost, it stays lost
    answer.position = {place.real(), place.imag(), 1 - depth};
    answer.quaternion_xyzw = {0, 0, std::sin(half), std::cos(half)};
    answer.scene_depth = depth;
    if (frame.debug_wanted) answer.debug_image = picture_of(frame);
    before = now;
    return answer;
  }
};
int main() { return run(NadirOdometry()); }
