// The trajectories of a server: listed, read, drawn as series, scored and deleted.
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

#include "core/result.hpp"
#include "server/files/recent_values.hpp"
#include "server/logs/known_formats.hpp"
#include "server/logs/log_library.hpp"
#include "server/logs/log_uploads.hpp"
#include "server/scoring/file_score.hpp"
#include "server/trajectories/served_trajectory.hpp"

namespace overfly::server {

/// Limits of a list, and of a client's request for scores.
inline constexpr std::size_t kMaxTrajectories = 2'000;
inline constexpr std::size_t kMaxEvaluated = 32;
/// Of all trajectories of a request together.
inline constexpr std::size_t kMaxEvaluatedPoses = 2'000'000;
/// Estimates times alignments times points.
inline constexpr std::size_t kMaxEvaluatedRows = 100'000;

struct EvaluationRequest {
  std::string truth;  ///< as TrajectoryReference
  std::vector<std::string> estimates;
  FileScoreRequest score;
  std::string association = "interpolate";  ///< its name
  /// Rows of each table; 0 = no tables. Else as SeriesRequest::max_points.
  std::size_t points = 0;
};

/// Thread-safe. What was read of a trajectory is kept as long as its file does not change.
class TrajectoryLibrary {
 public:
  /// @param logs        whose folders and uploads are shared
  /// @param run_folder  the folder of a run. Errors: kNotFound
  TrajectoryLibrary(LogLibrary& logs,
                    std::function<Result<std::filesystem::path>(const std::string& id)> run_folder);

  /// The answer of GET trajectories (docs/PROTOCOL.md).
  [[nodiscard]] nlohmann::json list();
  /// Errors: kNotFound; as read_trajectory and read_log_trajectory. Messages name the reference,
  /// not the file.
  [[nodiscard]] Result<std::shared_ptr<const ServedTrajectory>> read(
      const std::string& reference, const std::atomic<bool>* cancel);
  /// Positions and attitudes with their extremes. Errors: as read.
  [[nodiscard]] Result<nlohmann::json> series(const std::string& reference,
                                              std::size_t points,
                                              const std::atomic<bool>* cancel);
  /// Scores estimates as `overfly evaluate` does. An estimate that cannot be read or scored has its
  /// error in the answer.
  /// Errors: as read for the truth; kInvalidArgument beyond the limits; kCancelled.
  [[nodiscard]] Result<nlohmann::json> evaluate(const EvaluationRequest& request,
                                                const std::atomic<bool>* cancel);
  [[nodiscard]] const LogUploads& uploads() const { return logs_.uploads(); }
  /// The entry of an upload that has just been finished.
  [[nodiscard]] nlohmann::json entry_of(const std::filesystem::path& upload);
  /// Deletes an upload. Errors: kNotFound; kInvalidArgument if it was not uploaded.
  [[nodiscard]] Status remove(const std::string& reference);

 private:
  using Read = std::shared_ptr<const ServedTrajectory>;
  [[nodiscard]] Result<Read> read_file(const std::string& name,
                                       const std::string& reference,
                                       const std::atomic<bool>* cancel);
  [[nodiscard]] nlohmann::json evaluate_one(const NamedTrajectory& truth,
                                            const std::string& reference,
                                            const EvaluationRequest& request,
                                            std::size_t& poses,
                                            const std::atomic<bool>* cancel);

  LogLibrary& logs_;
  std::function<Result<std::filesystem::path>(const std::string& id)> run_folder_;
  KnownFormats formats_;
  RecentValues<ServedTrajectory> read_{6};
};

/// What an uploaded trajectory must be: read completely without errors.
[[nodiscard]] const UploadKind& trajectory_upload_kind();

}  // namespace overfly::server
