// A run's folder: names of its files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace overfly::engine {

/// Version of the folder's format, recorded in the manifest.
inline constexpr int kRunFormatVersion = 1;

[[nodiscard]] std::filesystem::path manifest_file(const std::filesystem::path& folder);
[[nodiscard]] std::filesystem::path scenario_file(const std::filesystem::path& folder);
[[nodiscard]] std::filesystem::path created_file(const std::filesystem::path& folder);
[[nodiscard]] std::filesystem::path timings_file(const std::filesystem::path& folder);
[[nodiscard]] std::filesystem::path metrics_file(const std::filesystem::path& folder);
[[nodiscard]] std::filesystem::path frames_file(const std::filesystem::path& folder);
[[nodiscard]] std::filesystem::path log_file(const std::filesystem::path& folder);
[[nodiscard]] std::filesystem::path truth_file(const std::filesystem::path& folder);
/// estimates/NAME.jsonl and estimates/NAME.tum
[[nodiscard]] std::filesystem::path estimate_file(const std::filesystem::path& folder,
                                                  const std::string& estimator);
[[nodiscard]] std::filesystem::path estimate_tum_file(const std::filesystem::path& folder,
                                                      const std::string& estimator);
/// estimators/NAME: output of an estimator's process
[[nodiscard]] std::filesystem::path estimator_output_folder(const std::filesystem::path& folder,
                                                            const std::string& estimator);
/// cameras/NAME.jsonl and cameras/NAME.tum, for all cameras except the main one
[[nodiscard]] std::filesystem::path camera_frames_file(const std::filesystem::path& folder,
                                                       const std::string& camera);
[[nodiscard]] std::filesystem::path camera_truth_file(const std::filesystem::path& folder,
                                                      const std::string& camera);
/// frames/NAME/NNNNNN.jpg; for the main camera (empty name) frames/NNNNNN.jpg
[[nodiscard]] std::filesystem::path frame_image_file(const std::filesystem::path& folder,
                                                     const std::string& camera,
                                                     std::int64_t frame);
/// frames16/NAME/NNNNNN.png, likewise, for sensors deeper than 8 bit
[[nodiscard]] std::filesystem::path deep_frame_file(const std::filesystem::path& folder,
                                                    const std::string& camera,
                                                    std::int64_t frame);
/// frames/NNNNNN.jpg and debug/NAME/NNNNNN.jpg
[[nodiscard]] std::filesystem::path frame_image_file(const std::filesystem::path& folder,
                                                     std::int64_t frame);
[[nodiscard]] std::filesystem::path debug_image_file(const std::filesystem::path& folder,
                                                     const std::string& estimator,
                                                     std::int64_t frame);

/// The run's id.
[[nodiscard]] std::string folder_name(const std::filesystem::path& folder);

/// `2026-11-21T09:12:04.123456Z`
[[nodiscard]] std::string utc_text(std::int64_t unix_ns);
[[nodiscard]] std::int64_t utc_now_ns();

}  // namespace overfly::engine
