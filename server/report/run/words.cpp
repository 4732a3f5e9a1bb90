#include "server/report/run/words.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/text/percent.hpp"
#include "core/time.hpp"

namespace overfly::server::report {
namespace {

constexpr const char* kNoFigure = "\xE2\x80\x93";
constexpr int kSignificant = 4;
constexpr double kLeastShown = 1e-6;

std::string fixed_text(double value, int decimals) {
  char text[400];
  std::snprintf(text, sizeof text, "%.*f", decimals, value);
  const std::string digits = text;
  const bool minus_zero = digits.find_first_not_of("-0.") == std::string::npos;
  return minus_zero && digits.front() == '-' ? digits.substr(1) : digits;
}

std::string seconds_words(double t_s) { return fixed_text(t_s, 1) + "\xC2\xA0s"; }

/// The last row at or before t, and the rows around it.
const FrameRow* row_at(const std::vector<FrameRow>& rows, std::int64_t t_ns) {
  const auto after =
      std::upper_bound(rows.begin(), rows.end(), t_ns, [](std::int64_t t, const FrameRow& row) {
        return t < row.t_ns;
      });
  return after == rows.begin() ? nullptr : &*std::prev(after);
}

/// Rate of the body's rotation over half a second around a time [deg/s].
std::optional<double> turn_rate_deg_s(const std::vector<FrameRow>& rows, std::int64_t t_ns) {
  constexpr std::int64_t kHalfNs = kNsPerS / 4;
  const FrameRow* before = row_at(rows, t_ns - kHalfNs);
  const FrameRow* after = row_at(rows, t_ns + kHalfNs);
  if (before == nullptr || after == nullptr || after->t_ns == before->t_ns) return std::nullopt;
  const double angle_rad =
      rotation_angle_rad(before->T_world_body.rotation, after->T_world_body.rotation);
  return deg_from_rad(angle_rad) / s_from_ns(after->t_ns - before->t_ns);
}

/// " at 58.5 s, after 1462 m"
std::string when_words(const evaluation::Score& score) {
  if (!score.outcome_time_s) return "";
  std::string words = " at " + seconds_words(*score.outcome_time_s);
  if (score.outcome_distance_m) {
    words += ", after " + fixed_text(*score.outcome_distance_m, 0) + "\xC2\xA0m";
  }
  return words;
}

}  // namespace

std::string figure_text(double value) {
  if (!std::isfinite(value)) return kNoFigure;
  if (value == 0.0) return "0";
  const double size = std::abs(value);
  if (size < kLeastShown) return value < 0.0 ? "> -1e-6" : "< 1e-6";
  if (size >= 1e9) {
    char text[40];
    std::snprintf(text, sizeof text, "%.3e", value);
    return text;
  }
  const int whole = static_cast<int>(std::floor(std::log10(size))) + 1;
  return fixed_text(value, std::clamp(kSignificant - whole, 0, 9));
}

std::string figure_text(const std::optional<double>& value) {
  return value ? figure_text(*value) : kNoFigure;
}

std::string outcome_text(const evaluation::Score& score) {
  const std::string relocalised = relocalised_words(score);
  return evaluation::to_string(score.outcome) + when_words(score) +
         (relocalised.empty() ? "" : "; " + relocalised);
}

std::string outcome_words(const EstimatorMetrics& metrics) {
  const evaluation::Score& score = metrics.score;
  const std::string at = when_words(score);
  switch (score.outcome) {
    case evaluation::Outcome::kCompleted:
      return "completed the flight";
    case evaluation::Outcome::kNotInitialised:
      return "never initialised";
    case evaluation::Outcome::kInitLate:
      return "initialised late," + at + ", and then completed the flight";
    case evaluation::Outcome::kLost:
      return "was lost" + at;
    case evaluation::Outcome::kReset:
      return "began a new map" + at + " (resets: " + std::to_string(score.reset_count) + ")";
    case evaluation::Outcome::kDiverged:
      return "diverged: its scale had changed by more than a factor of two" + at +
             " while it reported to track";
    case evaluation::Outcome::kCrashed:
      return "ended by itself" + at;
    case evaluation::Outcome::kTimeout:
      return "stopped answering and was ended" + at;
  }
  return "";
}

std::string relocalised_words(const evaluation::Score& score) {
  const int times = score.relocalisations.value_or(0);
  if (times == 0 || !score.relocalised_at_s) return "";
  const std::string count = times == 1 ? "" : " " + std::to_string(times) + " times, first";
  return "found its map again" + count + " at " + seconds_words(*score.relocalised_at_s);
}

std::string circumstances(const ReportRun& run, const ReportEstimate& estimate) {
  const evaluation::Score& score = run.metrics_of(estimate).score;
  if (!score.outcome_time_s) return "";
  const std::int64_t t_ns = ns_from_s(*score.outcome_time_s);
  const std::vector<FrameRow>& rows = run.frames.at(estimate.camera);
  const FrameRow* row = row_at(rows, t_ns);
  if (row == nullptr) return "";
  const RollPitchYaw attitude = attitude_from(row->T_world_body.rotation);
  std::string text = "Then: bank " + fixed_text(deg_from_rad(attitude.roll_rad), 0) +
                     " deg, pitch " + fixed_text(deg_from_rad(attitude.pitch_rad), 0) + " deg";
  if (const auto rate = turn_rate_deg_s(rows, t_ns)) {
    text += ", rotating at " + fixed_text(*rate, 0) + " deg/s";
  }
  if (row->axis_depth_m) {
    text += ", ground " + fixed_text(*row->axis_depth_m, 0) + " m away along the optical axis";
  } else {
    text += ", no ground on the optical axis";
  }
  text += ", " + figure_text(row->texels_per_pixel_median) + " texels per pixel";
  if (row->void_fraction > 0.0) {
    text += ", " + percent_text(row->void_fraction) + " of the image without imagery";
  }
  if (row->saturated_fraction > 0.0) {
    text += ", " + percent_text(row->saturated_fraction) + " of the pixels saturated";
  }
  for (std::size_t i = 0; i < row->faults.size(); ++i) {
    text += (i == 0 ? ", faults: " : ", ") + row->faults[i];
  }
  return text + ".";
}

std::string name_of(const ReportRun& run, const ReportEstimate& estimate) {
  return run.label.empty() ? estimate.name : run.label + ": " + estimate.name;
}

std::optional<double> percent_of_path(const ReportRun& run, double position_m) {
  const double path_m = run.metrics.flight.path_length_m;
  if (!(path_m > 0.0)) return std::nullopt;
  return 100.0 * position_m / path_m;
}

}  // namespace overfly::server::report
