#include "server/record/run_folder.hpp"

#include <array>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <string>
#include <system_error>
#include <utility>

#include "server/record/run_info.hpp"

namespace overfly::server {
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
fs::path log_file(const fs::path& folder) { return folder / "log.jsonl"; }
fs::path vehicle_file(const fs::path& folder) { return folder / "vehicle.jsonl"; }
fs::path vehicle_log_file(const fs::path& folder) { return folder / "vehicle.tlog"; }
fs::path truth_samples_file(const fs::path& folder) { return folder / "truth_samples.bin"; }

fs::path estimate_file(const fs::path& folder, const std::string& estimator) {
  return folder / "estimates" / (estimator + ".jsonl");
}

fs::path estimate_tum_file(const fs::path& folder, const std::string& estimator) {
  return folder / "estimates" / (estimator + ".tum");
}

fs::path estimator_output_folder(const fs::path& folder, const std::string& estimator) {
  return folder / "estimators" / estimator;
}

fs::path debug_image_file(const fs::path& folder,
                          const std::string& estimator,
                          std::int64_t frame) {
  return folder / "debug" / estimator / numbered_jpg(frame);
}

fs::path map_points_file(const fs::path& folder, const std::string& estimator, std::int64_t frame) {
  return folder / "points" / estimator / numbered(frame, ".bin");
}

CameraFiles::CameraFiles(fs::path folder, std::size_t camera, const std::string& name)
    : folder_(std::move(folder)), name_(camera == kMainCamera ? "" : name) {}

CameraFiles CameraFiles::of_main_camera(fs::path folder) {
  return {std::move(folder), kMainCamera, ""};
}

fs::path CameraFiles::rows() const {
  return name_.empty() ? folder_ / "frames.jsonl" : folder_ / "cameras" / (name_ + ".jsonl");
}

fs::path CameraFiles::truth() const {
  return name_.empty() ? folder_ / "truth.tum" : folder_ / "cameras" / (name_ + ".tum");
}

fs::path CameraFiles::image(std::int64_t frame) const {
  return folder_ / "frames" / name_ / numbered_jpg(frame);
}

fs::path CameraFiles::deep_image(std::int64_t frame) const {
  return folder_ / "frames16" / name_ / numbered(frame, ".png");
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

}  // namespace overfly::server
