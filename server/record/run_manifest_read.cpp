#include <array>
#include <limits>
#include <utility>

#include "server/files/file_field.hpp"
#include "server/record/rows/run_rows.hpp"
#include "server/record/run_folder.hpp"
#include "server/record/run_manifest.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using Manifest = RunManifest;

constexpr std::array<RunStatus, 4> kWrittenStatuses = {
    RunStatus::kRunning, RunStatus::kCompleted, RunStatus::kFailed, RunStatus::kCancelled};

RunStatus read_status(const FileField& field) {
  const std::string text = field.text();
  for (const RunStatus status : kWrittenStatuses) {
    if (text == to_string(status)) return status;
  }
  field.reject("be running, completed, failed or cancelled");
}

std::string optional_text(const FileField& object, const char* name) {
  const auto field = object.find(name);
  return field ? field->text() : "";
}

bool optional_flag(const FileField& object, const char* name) {
  const auto field = object.find(name);
  return field && field->boolean();
}

double optional_number(const FileField& object, const char* name) {
  const auto field = object.find(name);
  return field ? field->number() : 0.0;
}

std::vector<std::string> optional_texts(const FileField& object, const char* name) {
  std::vector<std::string> texts;
  const auto field = object.find(name);
  if (!field) return texts;
  for (const FileField& item : field->items()) texts.push_back(item.text());
  return texts;
}

Manifest::Renderer read_renderer_info(const FileField& field) {
  return {optional_text(field, "backend"),
          optional_text(field, "device"),
          optional_text(field, "gl_version"),
          optional_flag(field, "software"),
          optional_text(field, "device_note"),
          optional_text(field, "camera_note")};
}

/// A random seed uses all 64 bits.
std::uint64_t read_seed(const FileField& field) {
  if (!field.value().is_number_unsigned()) field.reject("be a whole number of at least 0");
  return field.value().get<std::uint64_t>();
}

/// Nanoseconds that may count from 1970, which exceed the range of FileField::integer.
std::int64_t read_clock_ns(const FileField& field) {
  const Json& value = field.value();
  constexpr auto kLast = std::uint64_t{std::numeric_limits<std::int64_t>::max()};
  const bool fits = !value.is_number_unsigned() || value.get<std::uint64_t>() <= kLast;
  if (!value.is_number_integer() || !fits) field.reject("be a whole number of 64 bits");
  return value.get<std::int64_t>();
}

Manifest::WorldFile read_world_file(const FileField& field) {
  return {optional_text(field, "file"), field.at("digest").text()};
}

/// Empty for a run that ended before its world was opened.
std::optional<Manifest::World> read_world(const FileField& field) {
  if (field.value().is_object() && field.value().empty()) return std::nullopt;
  Manifest::World world;
  world.name = optional_text(field, "name");
  world.attribution = optional_text(field, "attribution");
  world.warnings = optional_texts(field, "warnings");
  if (const auto files = field.find("data_hashes")) {
    for (const FileField& file : files->items()) world.data_hashes.push_back(read_world_file(file));
  }
  if (const auto origin = field.find("origin")) {
    world.origin = geodetic_from_deg(origin->at("lat_deg").number(),
                                     origin->at("lon_deg").number(),
                                     origin->at("alt_ellipsoid_m").number());
  }
  if (const auto manifest = field.find("manifest")) world.manifest = read_world_file(*manifest);
  world.light = optional_text(field, "light");
  world.detail = optional_text(field, "detail");
  return world;
}

CameraModel read_camera_model(const FileField& camera) {
  const Result<CameraModel> model = camera_model_from(camera.value());
  if (!model) camera.reject("be a camera (" + model.error().message + ")");
  return *model;
}

Pose read_mount(const FileField& field) {
  const Result<Pose> pose = pose_from(field.value());
  if (!pose) field.reject("be a pose (" + pose.error().message + ")");
  return *pose;
}

/// Field `camera` of a folder of an earlier version, which has no field `cameras`.
Manifest::Camera read_only_camera(const FileField& field) {
  Manifest::Camera camera;
  camera.model = read_camera_model(field);
  camera.rate_hz = optional_number(field, "rate_hz");
  if (const auto mount = field.find("T_body_camera")) camera.T_body_camera = read_mount(*mount);
  return camera;
}

Manifest::Camera read_camera(const FileField& field) {
  Manifest::Camera camera;
  camera.name = field.at("name").plain_name();
  camera.model = read_camera_model(field);
  camera.rate_hz = optional_number(field, "rate_hz");
  camera.T_body_camera = read_mount(field.at("T_body_camera"));
  camera.rgb = optional_text(field, "color") == "rgb";
  if (const auto bits = field.find("bits")) camera.bits = static_cast<int>(bits->integer(1, 64));
  if (const auto calibrated = field.find("calibrated")) {
    camera.calibrated = read_calibrated_intrinsics(*calibrated);
  }
  if (!optional_flag(field, "sensor")) return camera;
  Manifest::Sensor& sensor = camera.sensor.emplace();
  if (const auto readout = field.find("readout_ns")) sensor.readout_ns = readout->integer();
  sensor.gain_dn_per_e = optional_number(field, "gain_dn_per_e");
  if (const auto bits = field.find("adc_bits")) {
    sensor.adc_bits = static_cast<int>(bits->integer(0, 64));
  }
  return camera;
}

/// Adds the cameras up to the first invalid one.
void read_cameras(const FileField& manifest, std::vector<Manifest::Camera>& cameras) {
  if (const auto list = manifest.find("cameras")) {
    for (const FileField& camera : list->items()) cameras.push_back(read_camera(camera));
  }
  const auto only = cameras.empty() ? manifest.find("camera") : std::nullopt;
  if (only) cameras.push_back(read_only_camera(*only));
}

std::optional<Manifest::Parameters> read_parameters(const FileField& estimator, const char* name) {
  const auto field = estimator.find(name);
  if (!field) return std::nullopt;
  if (!field->value().is_object()) field->reject("be an object");
  Manifest::Parameters parameters;
  for (const auto& [key, value] : field->value().items()) {
    parameters[key] = field->at(key).text();
  }
  return parameters;
}

Manifest::Estimator read_estimator_entry(const FileField& field) {
  Manifest::Estimator estimator;
  estimator.name = field.at("name").plain_name();
  estimator.type = field.at("type").text();
  estimator.camera = optional_text(field, "camera");
  estimator.test_estimator = optional_flag(field, "test_estimator");
  estimator.start_error = optional_text(field, "start_error");
  estimator.parameters = read_parameters(field, "parameters");
  estimator.parameters_at_end = read_parameters(field, "parameters_at_end");
  return estimator;
}

/// Reads the valid fields and keeps the violations of the others.
class ManifestReader {
 public:
  ManifestReader(const Json& manifest, ReadManifest& read) : manifest_(manifest), read_(read) {}

  void read_all() {
    Manifest& values = read_.values;
    field(ManifestPart::kHead, [&] {
      const FileField version = manifest_.at("format_version");
      if (version.integer() != kRunFormatVersion) {
        version.reject("be " + std::to_string(kRunFormatVersion));
      }
      values.status = read_status(manifest_.at("status"));
    });
    required("scenario", [&](const FileField& text) { values.scenario = text.text(); });
    required("title", [&](const FileField& text) { values.title = text.text(); });
    required("error", [&](const FileField& error) {
      if (!error.is_null()) values.error = error.text();
    });
    required("duration_ns", [&](const FileField& n) { values.duration_ns = n.integer(); });
    required("frames", [&](const FileField& n) { values.frames = n.integer(); });
    required("frames_total", [&](const FileField& n) { values.frames_total = n.integer(); });
    required("pacing", [&](const FileField& text) { values.pacing = text.text(); });
    optional("texture_limited", [&](const FileField& f) { values.texture_limited = f.boolean(); });
    field(ManifestPart::kEstimators, [&] {
      for (const FileField& estimator : manifest_.at("estimators").items()) {
        values.estimators.push_back(read_estimator_entry(estimator));
      }
    });
    field(ManifestPart::kCameras, [&] { read_cameras(manifest_, values.cameras); });
    field(ManifestPart::kWorld, [&] { values.world = read_world(manifest_.at("world")); });
    optional("version", [&](const FileField& text) { values.version = text.text(); });
    optional("commit", [&](const FileField& text) { values.commit = text.text(); });
    optional("seed", [&](const FileField& seed) { values.seed = read_seed(seed); });
    optional("epoch_utc_ns", [&](const FileField& f) { values.epoch_utc_ns = read_clock_ns(f); });
    optional("renderer", [&](const FileField& f) { values.renderer = read_renderer_info(f); });
    optional("flight", [&](const FileField& flight) {
      values.flight = Manifest::Flight{optional_text(flight, "description"),
                                       optional_texts(flight, "warnings")};
      if (const auto start = flight.find("log_start_ns")) {
        values.flight->log_start_ns = read_clock_ns(*start);
      }
    });
  }

 private:
  template <typename Read>
  void field(ManifestPart part, const Read& read) {
    try {
      read();
    } catch (const FieldViolation& violation) {
      read_.violations.push_back({part, violation.what()});
    }
  }
  template <typename Read>
  void required(const char* name, const Read& read) {
    field(ManifestPart::kOther, [&] { read(manifest_.at(name)); });
  }
  template <typename Read>
  void optional(const char* name, const Read& read) {
    field(ManifestPart::kOther, [&] {
      if (const auto value = manifest_.find(name)) read(*value);
    });
  }

  FileField manifest_;
  ReadManifest& read_;
};

}  // namespace

std::string ReadManifest::problem() const {
  return violations.empty() ? "" : file.string() + ": " + violations.front().text;
}

Status ReadManifest::check(ManifestPart part) const {
  for (const Violation& violation : violations) {
    if (violation.part != part) continue;
    return Error{ErrorCode::kUnreadable, file.string() + ": " + violation.text};
  }
  return {};
}

Result<ReadManifest> read_run_manifest(const fs::path& folder, std::uint64_t max_bytes) {
  ReadManifest read;
  read.file = manifest_file(folder);
  const Result<Json> document = read_json(read.file, max_bytes);
  if (!document) return document.error();
  if (document->is_object()) {
    ManifestReader(*document, read).read_all();
  } else {
    for (const ManifestPart part : {ManifestPart::kHead,
                                    ManifestPart::kCameras,
                                    ManifestPart::kEstimators,
                                    ManifestPart::kWorld}) {
      read.violations.push_back({part, "must be an object"});
    }
  }
  return read;
}

}  // namespace overfly::server
