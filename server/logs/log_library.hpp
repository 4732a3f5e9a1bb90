// The flight logs of a server: listed, described, drawn as series, uploaded and deleted.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/motion/trajectory.hpp"
#include "core/result.hpp"
#include "flight/logs/flight_log.hpp"
#include "flight/logs/series/log_series.hpp"
#include "flight/smoothing/smooth_motion.hpp"
#include "server/files/recent_values.hpp"
#include "server/logs/log_places.hpp"
#include "server/logs/log_residuals.hpp"
#include "server/logs/log_uploads.hpp"

namespace overfly::server {

/// Limits of a client's request for series.
inline constexpr std::size_t kMinSeriesPoints = 100;
inline constexpr std::size_t kMaxSeriesPoints = 30'000;

struct SeriesRequest {
  std::string source;  ///< as flight::logs::choose_truth
  flight::logs::LogSlice slice;
  std::size_t max_points = 6000;  ///< of each table, in [kMinSeriesPoints, kMaxSeriesPoints]
};

/// The truth of a log as a trajectory: T_world_body, as `overfly log convert` writes it.
struct LogPoses {
  Trajectory trajectory;
  std::vector<std::string> warnings;
};

/// Thread-safe. What was read of a log is kept as long as its files do not change.
class LogLibrary {
 public:
  /// @param folders  where logs lie now, without uploads
  LogLibrary(std::function<ServedFolders()> folders,
             const std::filesystem::path& uploads_folder,
             const UploadLimits& limits);

  /// The answer of GET logs (docs/PROTOCOL.md).
  [[nodiscard]] nlohmann::json list();
  /// As `overfly log info --json`. Reads the whole log, or the slice.
  /// Errors: kNotFound; as flight::logs::open_log.
  [[nodiscard]] Result<nlohmann::json> info(const std::string& name,
                                            const flight::logs::LogSlice& slice,
                                            const std::atomic<bool>* cancel);
  /// Track, heights, speeds and attitudes with their extremes.
  /// Errors: kNotFound; as flight::logs::read_log_series.
  [[nodiscard]] Result<nlohmann::json> series(const std::string& name,
                                              const SeriesRequest& request,
                                              const std::atomic<bool>* cancel);
  /// The samples minus the smooth motion through them.
  /// Errors: kNotFound; as log_residuals.
  [[nodiscard]] Result<nlohmann::json> residuals(
      const std::string& name,
      const ResidualRequest& request,
      const std::atomic<bool>* cancel,
      const flight::smoothing::SmoothingProgress& progress);
  /// Errors: kNotFound; as read_log_trajectory; kUnreadable beyond `max_poses`.
  [[nodiscard]] Result<LogPoses> trajectory(const std::string& name,
                                            const std::string& source,
                                            std::size_t max_poses,
                                            const std::atomic<bool>* cancel);
  /// Where logs and trajectories lie, with the uploads.
  [[nodiscard]] ServedFolders folders() const;
  /// {"used_bytes", "quota_bytes", "max_bytes"} @param max_bytes  a further limit of one upload
  [[nodiscard]] nlohmann::json uploads_json(std::uint64_t max_bytes = UINT64_MAX) const;
  [[nodiscard]] const LogUploads& uploads() const { return uploads_; }
  /// The entry of an upload that has just been finished.
  [[nodiscard]] nlohmann::json entry_of(const std::filesystem::path& upload) const;
  /// Deletes an upload. Errors: kNotFound; kInvalidArgument if it was not uploaded.
  [[nodiscard]] Status remove(const std::string& name);

 private:
  using Opened = std::shared_ptr<const flight::logs::OpenedLog>;
  [[nodiscard]] Result<Opened> open(const std::filesystem::path& file,
                                    const flight::logs::LogSlice& slice,
                                    const SourcePolicy& sources,
                                    const std::atomic<bool>* cancel,
                                    std::string& key);

  std::function<ServedFolders()> folders_;
  LogUploads uploads_;
  LogPlaces places_;
  RecentValues<flight::logs::OpenedLog> opened_{8};
  RecentValues<nlohmann::json> series_{16};
  RecentValues<nlohmann::json> residuals_{8};
};

}  // namespace overfly::server
