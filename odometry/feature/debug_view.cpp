#include "odometry/feature/debug_view.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <opencv2/imgproc.hpp>

namespace overfly::odometry::feature {
namespace {

constexpr int kLeastWidthPx = 480;  ///< minimum width of the view, if the image is that wide
constexpr double kFontScale = 0.45;
const cv::Scalar kGreen(60, 230, 90);
const cv::Scalar kRed(240, 70, 60);
const cv::Scalar kYellow(250, 210, 60);
const cv::Scalar kBlue(70, 140, 255);
const cv::Scalar kGrey(150, 150, 150);
const cv::Scalar kWhite(255, 255, 255);
const cv::Scalar kBlack(0, 0, 0);

cv::Point scaled(const Eigen::Vector2d& pixel, double scale) {
  return {static_cast<int>(std::lround(pixel.x() * scale)),
          static_cast<int>(std::lround(pixel.y() * scale))};
}

/// Tints saturated areas magenta.
void tint_burnt(cv::Mat& canvas, const Pyramid& pyramid, double scale) {
  if (pyramid.burnt.empty()) return;
  for (int y = 0; y < canvas.rows; ++y) {
    for (int x = 0; x < canvas.cols; ++x) {
      if (pyramid.burnt_at(Eigen::Vector2d(x, y) / scale)) canvas.at<cv::Vec3b>(y, x)[1] /= 2;
    }
  }
}

void draw_points(cv::Mat& canvas, const DebugContent& content, double scale) {
  for (const Eigen::Vector2d& pixel : content.missed_px) {
    cv::circle(canvas, scaled(pixel, scale), 2, kGrey, 1, cv::LINE_AA);
  }
  for (const Eigen::Vector2d& pixel : content.candidates_px) {
    cv::circle(canvas, scaled(pixel, scale), 1, kBlue, cv::FILLED);
  }
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

std::string text_of(const DebugContent& content) {
  std::array<char, 160> text{};
  const std::size_t inliers = content.tracked != nullptr ? content.tracked->points.size() : 0;
  const int searched = content.tracked != nullptr ? content.tracked->searched : 0;
  std::snprintf(text.data(),
                text.size(),
                "%s  map %d  inliers %zu / %d  keyframes %d%s",
                to_string(content.state),
                content.map_id,
                inliers,
                searched,
                content.keyframes,
                content.keyframe ? " +1" : "");
  std::string line = text.data();
  if (content.timing_ms == nullptr) return line;
  for (const char* stage : {"tracking", "mapping"}) {
    const auto spent = content.timing_ms->find(stage);
    if (spent == content.timing_ms->end()) continue;
    std::snprintf(text.data(), text.size(), "  %s %.1f ms", stage, spent->second);
    line += text.data();
  }
  return line;
}

/// Draws the text as large as fits the width, up to kFontScale.
void draw_text(cv::Mat& canvas, const DebugContent& content) {
  const std::string text = text_of(content);
  const int width_px =
      cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, kFontScale, 1, nullptr).width;
  const double font_scale = kFontScale * std::min(1.0, (canvas.cols - 16.0) / width_px);
  cv::rectangle(canvas, cv::Rect(0, canvas.rows - 22, canvas.cols, 22), kBlack, cv::FILLED);
  cv::putText(canvas,
              text,
              cv::Point(8, canvas.rows - 7),
              cv::FONT_HERSHEY_SIMPLEX,
              font_scale,
              content.state == TrackingState::kLost ? kRed : kWhite,
              1,
              cv::LINE_AA);
}

}  // namespace

Image draw_debug_view(const Pyramid& pyramid, const DebugContent& content) {
  const bool halved = pyramid.level_count() > 1 && pyramid.level(0).cols >= 2 * kLeastWidthPx;
  const int level = halved ? 1 : 0;
  const cv::Mat& grey = pyramid.level(level);
  Image image(grey.cols, grey.rows, 3);
  cv::Mat canvas(grey.rows, grey.cols, CV_8UC3, image.data.data());
  cv::cvtColor(grey, canvas, cv::COLOR_GRAY2RGB);
  const double scale = std::ldexp(1.0, -level);
  tint_burnt(canvas, pyramid, scale);
  draw_points(canvas, content, scale);
  draw_text(canvas, content);
  if (content.keyframe) {
    cv::rectangle(canvas, cv::Rect(0, 0, canvas.cols, canvas.rows), kBlue, 6);
  }
  return image;
}

}  // namespace overfly::odometry::feature
