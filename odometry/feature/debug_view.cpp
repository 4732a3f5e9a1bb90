#include "odometry/feature/debug_view.hpp"

#include <cmath>
#include <cstdio>
#include <opencv2/imgproc.hpp>

namespace overfly::odometry {
namespace {

const cv::Scalar kGreen(60, 230, 90);
const cv::Scalar kRed(240, 70, 60);
const cv::Scalar kYellow(250, 210, 60);
const cv::Scalar kBlue(70, 140, 255);
const cv::Scalar kWhite(255, 255, 255);
const cv::Scalar kBlack(0, 0, 0);

cv::Point scaled(const Eigen::Vector2d& pixel, double scale) {
  return {static_cast<int>(std::lround(pixel.x() * scale)),
          static_cast<int>(std::lround(pixel.y() * scale))};
}

void draw_points(cv::Mat& canvas, const DebugContent& content, double scale) {
  if (content.tracked != nullptr) {
    for (const TrackedPoint& point : content.tracked->points) {
      const int radius = static_cast<int>(std::lround(2.0 * point.sigma_px / sigma_px_of(0)));
      cv::circle(canvas, scaled(point.pixel, scale), radius, kGreen, 1, cv::LINE_AA);
    }
    for (const TrackedPoint& point : content.tracked->outliers) {
      cv::circle(canvas, scaled(point.pixel, scale), 2, kRed, 1, cv::LINE_AA);
    }
  }
  if (content.followed != nullptr) {
    for (const Initialiser::Track& track : *content.followed) {
      cv::line(canvas,
               scaled(track.corner.pixel, scale),
               scaled(track.pixel, scale),
               kYellow,
               1,
               cv::LINE_AA);
      cv::circle(canvas, scaled(track.pixel, scale), 2, kYellow, 1, cv::LINE_AA);
    }
  }
}

void draw_text(cv::Mat& canvas, const DebugContent& content) {
  char text[160];
  const std::size_t inliers = content.tracked != nullptr ? content.tracked->points.size() : 0;
  const int searched = content.tracked != nullptr ? content.tracked->searched : 0;
  std::snprintf(text,
                sizeof(text),
                "%s  map %d  inliers %zu / %d  keyframes %d%s",
                to_string(content.state),
                content.map_id,
                inliers,
                searched,
                content.keyframes,
                content.keyframe ? " +1" : "");
  cv::rectangle(canvas, cv::Rect(0, canvas.rows - 22, canvas.cols, 22), kBlack, cv::FILLED);
  cv::putText(canvas,
              text,
              cv::Point(8, canvas.rows - 7),
              cv::FONT_HERSHEY_SIMPLEX,
              0.45,
              content.state == TrackingState::kLost ? kRed : kWhite,
              1,
              cv::LINE_AA);
}

}  // namespace

Image draw_debug_view(const Pyramid& pyramid, const DebugContent& content) {
  const int level = pyramid.level_count() > 1 ? 1 : 0;
  const cv::Mat& grey = pyramid.level(level);
  Image image(grey.cols, grey.rows, 3);
  cv::Mat canvas(grey.rows, grey.cols, CV_8UC3, image.data.data());
  cv::cvtColor(grey, canvas, cv::COLOR_GRAY2RGB);
  draw_points(canvas, content, std::ldexp(1.0, -level));
  draw_text(canvas, content);
  if (content.keyframe) {
    cv::rectangle(canvas, cv::Rect(0, 0, canvas.cols, canvas.rows), kBlue, 6);
  }
  return image;
}

}  // namespace overfly::odometry
