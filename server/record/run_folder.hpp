// A run's folder: names of its files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace overfly::server {

/// Version of the folder's format, recorded in the manifest.
inline constexpr int kRunFormatVersion = 1;

[[nodiscard]] std::filesystem::path manifest_file(const std::filesystem::path& folder);
[[nodiscard]] std::filesystem::path scenario_file(const std::filesystem::path& folder);
[[nodiscard]] std::filesystem::path created_file(const std::filesystem::path& folder);
[[nodiscard]] std::filesystem::path timings_file(const std::filesystem::path& folder);
[[nodiscard]] std::filesystem::path metrics_file(const std::filesystem::path& folder);
[[nodiscard]] std::filesystem::path log_file(const std::filesystem::path& folder);
[[nodiscard]] std::filesystem::path vehicle_file(const std::filesystem::path& folder);
[[nodiscard]] std::filesystem::path truth_samples_file(const std::filesystem::path& folder);
/// vehicle.tlog: the messages of a live vehicle
[[nodiscard]] std::filesystem::path vehicle_log_file(const std::filesystem::path& folder);
/// estimates/NAME.jsonl and estimates/NAME.tum
[[nodiscard]] std::filesystem::path estimate_file(const std::filesystem::path& folder,
                                                  const std::string& estimator);
[[nodiscard]] std::filesystem::path estimate_tum_file(const std::filesystem::path& folder,
                                                      const std::string& estimator);
/// estimators/NAME: output of an estimator's process
[[nodiscard]] std::filesystem::path estimator_output_folder(const std::filesystem::path& folder,
                                                            const std::string& estimator);
/// debug/NAME/NNNNNN.jpg
[[nodiscard]] std::filesystem::path debug_image_file(const std::filesystem::path& folder,
                                                     const std::string& estimator,
                                                     std::int64_t frame);
/// points/NAME/NNNNNN.bin
[[nodiscard]] std::filesystem::path map_points_file(const std::filesystem::path& folder,
                                                    const std::string& estimator,
                                                    std::int64_t frame);

/// The files of one camera of a run. Only this class knows that those of the main camera have no
/// name in their paths.
class CameraFiles {
 public:
  /// @param camera  index in the run's list of cameras
  /// @param name  of that camera
  CameraFiles(std::filesystem::path folder, std::size_t camera, const std::string& name);
  static CameraFiles of_main_camera(std::filesystem::path folder);

  /// cameras/NAME.jsonl; frames.jsonl for the main camera
  [[nodiscard]] std::filesystem::path rows() const;
  /// cameras/NAME.tum; truth.tum for the main camera
  [[nodiscard]] std::filesystem::path truth() const;
  /// frames/NAME/NNNNNN.jpg; frames/NNNNNN.jpg for the main camera
  [[nodiscard]] std::filesystem::path image(std::int64_t frame) const;
  /// frames16/NAME/NNNNNN.png; frames16/NNNNNN.png for the main camera. For sensors deeper than 8
  /// bit.
  [[nodiscard]] std::filesystem::path deep_image(std::int64_t frame) const;

 private:
  std::filesystem::path folder_;
  std::string name_;  ///< empty for the main camera
};

/// The run's id.
[[nodiscard]] std::string folder_name(const std::filesystem::path& folder);

/// `2026-11-21T09:12:04.123456Z`
[[nodiscard]] std::string utc_text(std::int64_t unix_ns);
[[nodiscard]] std::int64_t utc_now_ns();

}  // namespace overfly::server
