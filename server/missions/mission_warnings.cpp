#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "core/text/number_text.hpp"
#include "server/missions/mission_report.hpp"

namespace overfly::server {
namespace {

using autopilot::FlightPhase;

/// Below this, a climb follows its demand [m].
constexpr double kLagM = 15.0;
/// Spans of one kind that are listed.
constexpr std::size_t kMostSpans = 20;

/// @param step  1, or a part of it
std::string rounded_text(double value, double step) {
  const double parts = std::round(1.0 / step);
  return number_text(std::round(value * parts) / parts);
}

/// A value of the samples with its limit.
struct Criterion {
  const char* kind;
  const char* what;
  const char* unit;
  double step;  ///< to which it is rounded
  double limit;
  bool at_least;  ///< the limit is the smallest permitted value
  /// Empty where the criterion does not apply.
  std::function<std::optional<double>(const MissionSample&)> value;
};

bool is_broken(const Criterion& criterion, double value) {
  return criterion.at_least ? value < criterion.limit : value > criterion.limit;
}

class SpanFinder {
 public:
  explicit SpanFinder(MissionReport& report) : report_(report) {}

  /// One warning for each stretch of samples beyond the limit.
  void add(const Criterion& criterion) {
    std::size_t first = 0;
    bool inside = false;
    std::size_t count = 0;
    const std::vector<MissionSample>& samples = report_.samples;
    for (std::size_t i = 0; i <= samples.size(); ++i) {
      const auto value = i < samples.size() ? criterion.value(samples[i]) : std::nullopt;
      const bool broken = value && is_broken(criterion, *value);
      if (broken && !inside) first = i;
      if (!broken && inside && count++ < kMostSpans) warn(criterion, first, i - 1);
      inside = broken;
    }
  }

 private:
  void warn(const Criterion& criterion, std::size_t first, std::size_t last) {
    std::size_t worst = first;
    for (std::size_t i = first; i <= last; ++i) {
      const double value = *criterion.value(report_.samples[i]);
      const double found = *criterion.value(report_.samples[worst]);
      if (criterion.at_least ? value < found : value > found) worst = i;
    }
    const MissionSample& sample = report_.samples[worst];
    const std::string unit = criterion.unit;
    MissionWarning warning;
    warning.kind = criterion.kind;
    warning.from_s = report_.samples[first].state.t_s;
    warning.to_s = report_.samples[last].state.t_s;
    warning.text =
        std::string(criterion.what) + " " + rounded_text(*criterion.value(sample), criterion.step) +
        unit + " at " + rounded_text(sample.state.t_s, 0.1) + " s: must be " +
        (criterion.at_least ? "at least " : "at most ") + number_text(criterion.limit) + unit;
    warning.item = sample.item;
    warning.value = *criterion.value(sample);
    warning.limit = criterion.limit;
    report_.warnings.push_back(std::move(warning));
  }

  MissionReport& report_;
};

bool is_under_way(const MissionSample& sample) {
  const FlightPhase phase = sample.state.phase;
  return phase == FlightPhase::kEnRoute || phase == FlightPhase::kLoiter ||
         phase == FlightPhase::kReturn;
}

std::vector<Criterion> criteria_of(const MissionLimits& limits) {
  const auto under_way = [](double MissionSample::*field) {
    return [field](const MissionSample& sample) {
      return is_under_way(sample) ? std::optional(sample.*field) : std::nullopt;
    };
  };
  const auto seen = [](std::optional<double> MissionSample::*field) {
    return [field](const MissionSample& sample) {
      return is_under_way(sample) ? sample.*field : std::nullopt;
    };
  };
  return {
      {"clearance",
       "height above the ground",
       " m",
       1.0,
       limits.min_clearance_m,
       true,
       under_way(&MissionSample::clearance_m)},
      {"bank",
       "bank",
       " deg",
       1.0,
       limits.max_bank_deg,
       false,
       [](const MissionSample& sample) {
         return std::optional(std::abs(deg_from_rad(sample.state.attitude.roll_rad)));
       }},
      {"overlap", "overlap", "", 0.01, limits.min_overlap, true, seen(&MissionSample::overlap)},
      {"texture",
       "texels per pixel",
       "",
       0.01,
       limits.min_texels_px,
       true,
       seen(&MissionSample::texels_px)},
      {"motion",
       "motion of the image",
       " px a frame",
       1.0,
       limits.max_motion_px,
       false,
       [](const MissionSample& sample) {
         const double motion_px = std::hypot(sample.rotation_px, sample.translation_px);
         return is_under_way(sample) ? std::optional(motion_px) : std::nullopt;
       }},
      {"imagery",
       "share of the image with imagery",
       "",
       0.01,
       limits.min_imagery,
       true,
       under_way(&MissionSample::imagery)},
      {"climb",
       "the aircraft cannot follow the heights: below its path by",
       " m",
       1.0,
       kLagM,
       false,
       [](const MissionSample& sample) {
         return is_under_way(sample) ? std::optional(sample.state.height_error_m) : std::nullopt;
       }},
  };
}

void add_turns(const MissionRequest& request, MissionReport& report) {
  const double limit = std::min(request.limits.max_bank_deg, report.roll_limit_deg);
  for (const MissionPlace& place : report.places) {
    constexpr double kRounding = 0.5;
    if (!place.turn_bank_deg || *place.turn_bank_deg <= limit + kRounding) continue;
    MissionWarning warning;
    warning.kind = "bank";
    warning.item = place.number;
    warning.text = "the turn of item " + std::to_string(place.number) + " with a radius of " +
                   rounded_text(*place.turn_radius_m, 1.0) + " m needs a bank of " +
                   rounded_text(*place.turn_bank_deg, 1.0) + " deg: must be at most " +
                   rounded_text(limit, 0.1) + " deg";
    warning.value = *place.turn_bank_deg;
    warning.limit = limit;
    report.warnings.push_back(std::move(warning));
  }
}

void add_start(const MissionRequest& request, MissionReport& report) {
  const std::string wanted = "at least " + number_text(request.limits.min_start_s) + " s and " +
                             number_text(request.limits.min_start_baseline) + " of the height long";
  if (!report.start) {
    report.warnings.push_back({"start",
                               "no straight and level part for estimators to initialise in: must "
                               "be " +
                                   wanted});
    return;
  }
  if (report.start->enough) return;
  report.warnings.push_back({"start",
                             "the longest straight and level part takes " +
                                 rounded_text(report.start->to_s - report.start->from_s, 0.1) +
                                 " s and is " + rounded_text(report.start->baseline(), 0.01) +
                                 " of the height long: must be " + wanted,
                             report.start->from_s,
                             report.start->to_s});
}

void add_end(const autopilot::MissionSetup& setup, MissionReport& report) {
  const double end_s = report.duration_s;
  const std::string when = " after " + rounded_text(end_s, 0.1) + " s";
  if (report.end == autopilot::FlightEnd::kHitGround) {
    report.warnings.push_back({"flight", "the aircraft hits the ground" + when, end_s, end_s});
  }
  if (report.end == autopilot::FlightEnd::kTimeLimit &&
      setup.duration_max_s >= autopilot::kFlightMaxS) {
    report.warnings.push_back({"flight", "the mission does not end" + when, end_s, end_s});
  }
}

}  // namespace

void add_warnings(const MissionRequest& request,
                  const autopilot::MissionSetup& setup,
                  MissionReport& report) {
  add_end(setup, report);
  add_start(request, report);
  add_turns(request, report);
  SpanFinder finder(report);
  for (const Criterion& criterion : criteria_of(request.limits)) finder.add(criterion);
  for (const std::string& text : setup.warnings) {
    report.warnings.push_back({"plan", text});
  }
}

}  // namespace overfly::server
