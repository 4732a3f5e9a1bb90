// The calibrations that a server keeps, by name.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>

#include "core/result.hpp"
#include "server/calibration/calibration_record.hpp"
#include "server/calibration/camera_text.hpp"

namespace overfly::server {

inline constexpr std::size_t kMostStoredCalibrations = 200;

/// Files NAME.json in one folder. Thread-safe: each file is written whole.
class CalibrationStore {
 public:
  /// @param folder  created with the first calibration; empty = nothing is kept
  explicit CalibrationStore(std::filesystem::path folder) : folder_(std::move(folder)) {}

  [[nodiscard]] bool keeps() const { return !folder_.empty(); }
  /// [{"name", "file", "width_px", "height_px", "model", "rms_px", "views", "source"}], by name. A
  /// file that is no calibration has `error` instead of what follows `file`.
  [[nodiscard]] nlohmann::json list() const;
  [[nodiscard]] nlohmann::json entry(const std::string& name) const;
  /// Errors: kInvalidArgument for a name that is not plain or longer than 60; kConflict if it
  /// exists, or with kMostStoredCalibrations; kUnsupported if nothing is kept; kIo.
  [[nodiscard]] Status save(const std::string& name, const CalibrationRecord& record) const;
  /// The file's content. Errors: kNotFound; as read_json.
  [[nodiscard]] Result<nlohmann::json> read(const std::string& name) const;
  /// The camera in the file of another program. Errors: as read; as camera_text.
  [[nodiscard]] Result<std::string> text(const std::string& name, CameraFormat format) const;
  /// Errors: kNotFound; kIo.
  [[nodiscard]] Status remove(const std::string& name) const;

 private:
  [[nodiscard]] Result<std::filesystem::path> find(const std::string& name) const;

  std::filesystem::path folder_;
  mutable std::mutex saving_;  ///< one calibration at a time: the limit, and its file's name
};

}  // namespace overfly::server
