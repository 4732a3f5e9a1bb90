#include "server/record/run_folder.hpp"

#include <array>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <string>

namespace overfly::engine {
namespace {

namespace fs = std::filesystem;

std::string numbered(std::int64_t frame, const char* suffix) {
  std::array<char, 32> name{};
  std::snprintf(name.data(), name.size(), "%06lld", static_cast<long long>(frame));
  return name.data() + std::string(suffix);
}

std::string numbered_jpg(std::int64_t frame) { return numbered(frame, ".jpg"); }

}  // namespace

fs::path manifest_file(const fs::path& folder) { return folder / "manifest.json"; }
fs::path scenario_file(const fs::path& folder) { return folder / "scenario.json"; }
fs::path created_file(const fs::path& folder) { return folder / "created.json"; }
fs::path timings_file(const fs::path& folder) { return folder / "timings.json"; }
fs::path metrics_file(const fs::path& folder) { return folder / "metrics.json"; }
fs::path frames_file(const fs::path& folder) { return folder / "frames.jsonl"; }
fs::path log_file(const fs::path& folder) { return folder / "log.jsonl"; }
fs::path truth_file(const fs::path& folder) { return folder / "truth.tum"; }

fs::path estimate_file(const fs::path& folder, const std::string& estimator) {
  return folder / "estimates" / (estimator + ".jsonl");
}

fs::path estimate_tum_file(const fs::path& folder, const std::string& estimator) {
  return folder / "estimates" / (estimator + ".tum");
}

fs::path estimator_output_folder(const fs::path& folder, const std::string& estimator) {
  return folder / "estimators" / estimator;
}

fs::path camera_frames_file(const fs::path& folder, const std::string& camera) {
  return folder / "cameras" / (camera + ".jsonl");
}

fs::path camera_truth_file(const fs::path& folder, const std::string& camera) {
  return folder / "cameras" / (camera + ".tum");
}

fs::path frame_image_file(const fs::path& folder, const std::string& camera, std::int64_t frame) {
  return folder / "frames" / camera / numbered_jpg(frame);
}

fs::path deep_frame_file(const fs::path& folder, const std::string& camera, std::int64_t frame) {
  return folder / "frames16" / camera / numbered(frame, ".png");
}

fs::path frame_image_file(const fs::path& folder, std::int64_t frame) {
  return folder / "frames" / numbered_jpg(frame);
}

fs::path debug_image_file(const fs::path& folder,
                          const std::string& estimator,
                          std::int64_t frame) {
  return folder / "debug" / estimator / numbered_jpg(frame);
}

std::string utc_text(std::int64_t unix_ns) {
  const std::time_t seconds = unix_ns / 1'000'000'000;
  const auto us = static_cast<int>(unix_ns / 1000 % 1'000'000);
  std::tm parts{};
  gmtime_r(&seconds, &parts);
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%S", &parts);
  std::array<char, 16> fraction{};
  std::snprintf(fraction.data(), fraction.size(), ".%06dZ", us);
  return std::string(text.data()) + fraction.data();
}

std::int64_t utc_now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

}  // namespace overfly::engine
