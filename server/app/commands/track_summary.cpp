#include "server/app/commands/track_summary.hpp"

#include <array>
#include <cstdio>

#include "server/app/score_table.hpp"

namespace overfly::app {
namespace {

using Json = nlohmann::json;

std::string rounded(double value, int digits) {
  std::array<char, 48> text{};
  std::snprintf(text.data(), text.size(), "%.*f", digits, value);
  return text.data();
}

std::string number(const Json& value) { return std::to_string(value.get<std::int64_t>()); }

std::string duration_text(const Json& durations) {
  if (durations.at("count") == 0) return "-";
  return rounded(durations.at("median_ms"), 1) + " ms median, " +
         rounded(durations.at("p95_ms"), 1) + " ms p95, " + rounded(durations.at("max_ms"), 1) +
         " ms at most";
}

std::string dataset_text(const Json& dataset) {
  const Json& camera = dataset.at("camera");
  std::string text = "data set: " + dataset.at("layout").get<std::string>() + ", " +
                     number(dataset.at("images")) + " images of " + number(camera.at("width_px")) +
                     " x " + number(camera.at("height_px")) + " px\n";
  for (const Json& note : dataset.at("notes")) text += "note: " + note.get<std::string>() + "\n";
  return text;
}

std::string states_text(const Json& report) {
  const Json& states = report.at("states");
  std::string text = "estimator: " + report.at("estimator").at("type").get<std::string>() +
                     "; TRACKING " + number(states.at("TRACKING")) + ", INITIALISING " +
                     number(states.at("INITIALISING")) + ", LOST " + number(states.at("LOST")) +
                     " of " + number(report.at("frames")) + " frames";
  const auto never_given = report.at("dataset").at("images").get<std::int64_t>() -
                           report.at("frames").get<std::int64_t>();
  if (never_given > 0) text += ", " + std::to_string(never_given) + " not sent";
  const Json& after_s = report.at("initialised_after_s");
  if (after_s.is_number()) text += ", first pose after " + rounded(after_s, 2) + " s";
  text += "\n";
  if (report.at("maps") > 1) {
    text += "resets: " + number(report.at("maps")) + " maps, the longest is written\n";
  }
  for (const char* count : {"unanswered", "hash_mismatches"}) {
    if (report.at(count) > 0) {
      text += std::string(count) + ": " + number(report.at(count)) + " frames\n";
    }
  }
  const Json& crash = report.at("crash");
  if (crash.is_string()) text += "CRASHED: " + crash.get<std::string>() + "\n";
  return text;
}

std::string cost_text(const Json& report) {
  const Json& timing = report.at("timing");
  std::string text = "track: " + duration_text(timing.at("track")) + "\n";
  for (const auto& [stage, durations] : timing.at("stages").items()) {
    text += "  " + stage + ": " + duration_text(durations) + "\n";
  }
  const Json& resources = report.at("resources");
  return text + "memory: " + rounded(resources.at("peak_memory_mb"), 0) + " MB at most, CPU " +
         rounded(resources.at("cpu_percent"), 0) + " % while tracking, of " +
         resources.at("of").get<std::string>() + "\n";
}

std::string score_text(const Json& score) {
  // Without the time of the outcome: it is in the data set's time base, often seconds since 1970.
  return "outcome: " + score.at("outcome").get<std::string>() + ", " + coverage_text(score) + "\n" +
         alignment_table(score.at("alignments"), score.at("unavailable"));
}

}  // namespace

std::string track_summary(const Json& report) {
  std::string text = dataset_text(report.at("dataset")) + states_text(report) + cost_text(report);
  if (report.contains("score")) text += score_text(report.at("score"));
  return text + "trajectory: " + report.at("out").get<std::string>() + "\n";
}

}  // namespace overfly::app
