#include "server/app/score_table.hpp"

#include <array>
#include <cstdarg>
#include <cstdio>

namespace overfly::app {
namespace {

using Json = nlohmann::json;

[[gnu::format(printf, 1, 2)]] std::string formatted(const char* format, ...) {
  std::array<char, 400> line{};
  va_list arguments;
  va_start(arguments, format);
  // The analyzer does not see that va_start has set it.
  // NOLINTNEXTLINE(clang-analyzer-valist.Uninitialized): va_start is above
  std::vsnprintf(line.data(), line.size(), format, arguments);
  va_end(arguments);
  return line.data();
}

/// A number in a column; a dash if there is none.
std::string figure(const Json& value, int width, int digits) {
  return value.is_number() ? formatted("%*.*f", width, digits, value.get<double>())
                           : formatted("%*s", width, "-");
}

/// The reason why an alignment has no rotation errors; empty if it has them.
std::string degenerate_text(const Json& alignment) {
  const Json& reason = alignment.at("degenerate");
  if (!reason.is_string()) return "";
  return "    degenerate: " + reason.get<std::string>() + "; no rotation error\n";
}

std::string outcome_text(const Json& score) {
  std::string text = score.at("outcome").get<std::string>();
  const Json& at = score.at("outcome_time_s");
  if (at.is_number()) text += formatted(" at %.1f s", at.get<double>());
  return text;
}

std::string notes_of(const std::string& name, const Json& camera, const Json& texture) {
  std::string notes;
  if (texture.value("texture_limited", false)) {
    notes += formatted(
        "warning: texture_limited: %s sees %.2f texels per pixel (median), below 0.5: the imagery, "
        "not the camera, limits the result\n",
        name.c_str(),
        texture.at("texels_per_pixel_median").get<double>());
  }
  if (camera.contains("late_tiles")) {
    notes += formatted(
        "warning: %s: %lld tiles were late and drawn at a coarser level, in %lld frames\n",
        name.c_str(),
        camera.at("late_tiles").at("tiles").get<long long>(),
        camera.at("late_tiles").at("frames").get<long long>());
  }
  const Json faults = camera.value("faults", Json::object());
  for (const auto& [kind, frames] : faults.items()) {
    notes += formatted(
        "fault: %s of %s, %lld frames\n", kind.c_str(), name.c_str(), frames.get<long long>());
  }
  return notes;
}

}  // namespace

std::string camera_notes(const Json& metrics) {
  const Json none = Json::object();
  std::string notes = notes_of("the camera", metrics.at("camera"), metrics.value("texture", none));
  const Json cameras = metrics.value("cameras", none);
  for (const auto& [name, camera] : cameras.items()) {
    notes += notes_of("camera " + name, camera, camera.value("texture", none));
  }
  return notes;
}

std::string score_table(const Json& metrics, const std::string& mode) {
  const Json& estimators = metrics.at("estimators");
  if (estimators.empty()) return "no estimators\n";
  std::string table = formatted("%-16s %-22s %9s %8s  %12s %12s %12s\n",
                                "estimator",
                                "outcome",
                                "coverage",
                                "dropped",
                                "position [m]",
                                "held [m]",
                                "rot. [deg]");
  for (const auto& [name, score] : estimators.items()) {
    table += formatted("%-16s %-22s %7.1f %% %8lld",
                       name.c_str(),
                       outcome_text(score).c_str(),
                       100.0 * score.at("coverage").get<double>(),
                       score.at("dropped_frames").get<long long>());
    const Json& alignments = score.at("alignments");
    if (alignments.contains(mode)) {
      const Json& alignment = alignments.at(mode);
      table += formatted("  %12.3f %12.3f ",
                         alignment.at("position_rmse_m").get<double>(),
                         alignment.at("position_rmse_hold_m").get<double>()) +
               figure(alignment.at("rotation_rmse_deg"), 12, 4) + "\n" + degenerate_text(alignment);
    } else {
      table += "  X (" + score.at("unavailable").value(mode, "not scored") + ")\n";
    }
  }
  return table + "RMSE, alignment " + mode + "\n";
}

std::string coverage_text(const Json& score) {
  return formatted("coverage %.1f %%", 100.0 * score.at("coverage").get<double>());
}

std::string outcome_line(const Json& score) {
  return outcome_text(score) + ", " + coverage_text(score);
}

std::string alignment_table(const Json& alignments, const Json& unavailable) {
  std::string table = formatted("  %-12s %12s %8s  %12s %12s %12s %14s\n",
                                "alignment",
                                "scale",
                                "poses",
                                "position [m]",
                                "held [m]",
                                "rot. [deg]",
                                "euler n. [deg]");
  for (const auto& [mode, alignment] : alignments.items()) {
    table += formatted("  %-12s %12.6g %8d  %12.3f %12.3f ",
                       mode.c_str(),
                       alignment.at("scale").get<double>(),
                       alignment.at("matched").get<int>(),
                       alignment.at("position_rmse_m").get<double>(),
                       alignment.at("position_rmse_hold_m").get<double>()) +
             figure(alignment.at("rotation_rmse_deg"), 12, 4) + " " +
             figure(alignment.at("rotation_euler_norm_rmse_deg"), 14, 4) + "\n" +
             degenerate_text(alignment);
    for (const Json& note : alignment.at("notes")) {
      table += "    " + note.get<std::string>() + "\n";
    }
  }
  for (const auto& [mode, reason] : unavailable.items()) {
    table += formatted("  %-12s X: ", mode.c_str()) + reason.get<std::string>() + "\n";
  }
  return table;
}

}  // namespace overfly::app
