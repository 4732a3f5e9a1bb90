// The calibrations of a server: sources of images, sessions in progress, and what was saved.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "core/result.hpp"
#include "server/calibration/session/calibration_session.hpp"
#include "server/calibration/session/calibration_store.hpp"
#include "server/files/data_files.hpp"
#include "server/imagery/live/live_address.hpp"
#include "server/scenario/camera_spec.hpp"

namespace overfly::server {

inline constexpr std::size_t kMostSessions = 2;  ///< at the same time

enum class SourceKind { kFolder, kRecording, kScenario, kUpload, kCamera };

/// What a client asks for. Names are those of sources_json, and of scenarios and their cameras.
struct DeskRequest {
  SourceKind kind = SourceKind::kUpload;
  std::string name;        ///< of the folder, recording, scenario or camera
  std::string topic;       ///< of a recording; may be empty
  std::string camera;      ///< of a scenario; empty: its first
  int views = 20;          ///< of a scenario's virtual board
  std::uint64_t seed = 1;  ///< likewise
  calibration::CalibratorOptions calibrator;
};

struct DeskOptions {
  std::function<ServedFolders()> folders;  ///< where images may be read
  /// A camera of a scenario. Errors: kNotFound; as load_scenario.
  std::function<Result<CameraSpec>(const std::string& scenario, const std::string& camera)>
      scenario_camera;
  std::vector<LiveAddress> cameras;  ///< that the operator allowed
  std::filesystem::path store;       ///< empty: nothing is saved
  std::function<void()> begin_thread;
  /// A session that nobody has looked at for so long gives way to a new one.
  std::chrono::milliseconds patience{120'000};
};

/// Thread-safe.
class CalibrationDesk {
 public:
  explicit CalibrationDesk(DeskOptions options)
      : options_(std::move(options)), store_(options_.store) {}

  /// {"folders", "recordings", "cameras", "complete"}: what sessions can take images from, other
  /// than scenarios and uploads. Reads the names in the data folders.
  [[nodiscard]] nlohmann::json sources_json() const;

  /// @return the id of the session
  /// Errors: kNotFound for a source; kInvalidArgument for a board that is not suitable; kConflict
  /// with kMostSessions of which none was left alone, or while one that gave way has yet to end.
  [[nodiscard]] Result<std::string> begin(const DeskRequest& request);
  /// @param keeps_it  it counts as being looked at. Errors: kNotFound.
  [[nodiscard]] Result<std::shared_ptr<CalibrationSession>> session(const std::string& id,
                                                                    bool keeps_it = true);
  struct Entry {
    std::string id;
    std::shared_ptr<CalibrationSession> session;
  };
  /// Those in progress, the oldest first.
  [[nodiscard]] std::vector<Entry> sessions();
  /// Ends a session and forgets its views. Errors: kNotFound.
  [[nodiscard]] Status end(const std::string& id);
  [[nodiscard]] const CalibrationStore& store() const { return store_; }

 private:
  [[nodiscard]] Result<SessionRequest> session_request(const DeskRequest& request) const;
  [[nodiscard]] Result<OpenBoardImages> folder_source(const std::string& name) const;
  [[nodiscard]] Result<OpenBoardImages> recording_source(const DeskRequest& request) const;
  [[nodiscard]] Result<OpenBoardImages> scenario_source(const DeskRequest& request) const;
  [[nodiscard]] Result<OpenBoardImages> camera_source(const std::string& name) const;
  [[nodiscard]] bool make_room();
  void close(std::vector<Entry>::iterator entry);
  void bury();

  const DeskOptions options_;
  const CalibrationStore store_;
  std::mutex mutex_;
  std::vector<Entry> entries_;
  /// Ended, but the image or estimate in progress takes time; they count as long. One that gave way
  /// may be there in addition to kMostSessions.
  std::vector<std::shared_ptr<CalibrationSession>> ending_;
};

}  // namespace overfly::server
