// manifest.json of a run: how the run was made.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/camera/camera_model.hpp"
#include "core/earth/geodesy.hpp"
#include "core/motion/pose.hpp"
#include "core/result.hpp"
#include "server/files/whole_file.hpp"
#include "server/record/calibrated_intrinsics.hpp"
#include "server/record/run_info.hpp"

namespace overfly::server {

struct RunManifest {
  struct Renderer {
    std::string backend;
    std::string device;
    std::string gl_version;
    bool software = false;
    std::string device_note;  ///< why not the requested device; else empty
    std::string camera_note;  ///< why this backend rendered the camera; empty without a choice
  };
  struct Flight {
    std::string description;
    std::vector<std::string> warnings;
    /// t = 0 by the clock of the log that was flown [ns]; empty if it has none.
    std::optional<std::int64_t> log_start_ns{};
  };
  struct WorldFile {
    std::string file;
    std::string digest;  ///< of the file as it was opened for this run
  };
  struct World {
    std::string name;
    std::string attribution;
    std::vector<std::string> warnings;
    std::vector<WorldFile> data_hashes;
    std::optional<Geodetic> origin;     ///< of the world frame
    std::optional<WorldFile> manifest;  ///< empty if the scenario lists the layers itself
    std::string light;                  ///< for people; empty if not used
    std::string detail;                 ///< likewise
  };
  struct Sensor {
    std::int64_t readout_ns = 0;
    double gain_dn_per_e = 0.0;
    int adc_bits = 0;
  };
  struct Camera {
    std::string name;
    CameraModel model;
    double rate_hz = 0.0;
    Pose T_body_camera{R_body_camera_nadir(), Eigen::Vector3d::Zero()};
    bool rgb = false;
    int bits = 8;
    std::optional<Sensor> sensor;
    /// What estimators were given in place of `model`; empty: they were given the true model.
    std::optional<CalibratedIntrinsics> calibrated;
  };
  using Parameters = std::map<std::string, std::string>;
  struct Estimator {
    std::string name;
    std::string type;
    std::string camera;
    bool test_estimator = false;
    std::string start_error;  ///< why it did not start; else empty
    /// As read back before the first frame and after the last; empty until then.
    std::optional<Parameters> parameters;
    std::optional<Parameters> parameters_at_end;
  };

  RunStatus status = RunStatus::kRunning;
  std::string error;  ///< why the run failed; else empty
  std::string scenario;
  std::string title;
  std::string version;
  std::string commit;
  std::uint64_t seed = 0;
  std::string pacing;
  std::optional<std::int64_t> epoch_utc_ns;  ///< of t = 0; empty until the first frame
  std::int64_t duration_ns = 0;
  std::int64_t frames = 0;
  std::int64_t frames_total = 0;
  bool texture_limited = false;
  std::optional<Renderer> renderer;  ///< empty until it is opened
  std::optional<Flight> flight;      ///< likewise
  std::optional<World> world;        ///< likewise
  std::vector<Camera> cameras;       ///< the main camera first; empty until they are known
  std::vector<Estimator> estimators;
};

/// The content of manifest.json.
[[nodiscard]] nlohmann::json json_from(const RunManifest& manifest);

/// Parts of the file that are needed, and can be invalid, independently of each other.
enum class ManifestPart {
  kHead,  ///< format version and status
  kCameras,
  kEstimators,
  kWorld,
  kOther,
};

/// A manifest read from a file. Invalid fields keep their defaults; unknown fields are ignored.
struct ReadManifest {
  std::filesystem::path file;
  RunManifest values;
  struct Violation {
    ManifestPart part;
    std::string text;  ///< field, value and what it must be
  };
  std::vector<Violation> violations;

  /// The first violation, with the file; empty if there is none.
  [[nodiscard]] std::string problem() const;
  /// Errors: kUnreadable naming file and field if the part is invalid.
  [[nodiscard]] Status check(ManifestPart part) const;
};

/// Errors: as read_json. An invalid field is no error.
[[nodiscard]] Result<ReadManifest> read_run_manifest(const std::filesystem::path& folder,
                                                     std::uint64_t max_bytes = kMaxDocumentBytes);

/// The manifest's fields of a run's info, and the inverse.
void put_run_info(const RunInfo& info, RunManifest& manifest);
/// Sets what the manifest says about flight and world.
void put_description(const RunManifest& manifest, RunInfo* info);
[[nodiscard]] RunInfo run_info_from(const RunManifest& manifest);

}  // namespace overfly::server
