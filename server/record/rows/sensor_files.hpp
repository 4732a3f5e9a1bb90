// The samples of a run's sensors in files: sensors/imu.csv, barometer.csv, gps.csv, airspeed.csv,
// magnetometer.csv and range.csv of a run folder (docs/RUN_FOLDER.md).
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>

#include "core/result.hpp"
#include "core/sensors/sensor_samples.hpp"

namespace overfly::server {

/// The folder of these files.
[[nodiscard]] std::filesystem::path sensors_folder(const std::filesystem::path& run_folder);

/// Writes the files of a new run. A sensor's file is created with its first sample, so that a
/// folder without sensors stays as it is.
class SensorFilesWriter {
 public:
  explicit SensorFilesWriter(const std::filesystem::path& run_folder);
  ~SensorFilesWriter();
  SensorFilesWriter(SensorFilesWriter&& other) noexcept;
  SensorFilesWriter& operator=(SensorFilesWriter&& other) noexcept;

  /// Appends samples; each piece of a file reaches the system in one write. The times of each
  /// sensor must not decrease from call to call.
  /// Errors: kIo naming the file, also if it exists already.
  Status add(const SensorSamples& samples);

 private:
  struct Files;
  std::unique_ptr<Files> files_;
};

/// Reads the files from start to end. Memory does not depend on their size.
class SensorFilesReader {
 public:
  /// An absent file has no samples. Errors: as ForwardReader::open; kUnreadable for a file with
  /// another first line.
  static Result<SensorFilesReader> open(const std::filesystem::path& run_folder);
  ~SensorFilesReader();
  SensorFilesReader(SensorFilesReader&& other) noexcept;
  SensorFilesReader& operator=(SensorFilesReader&& other) noexcept;

  /// The samples since the last call that are available at a time, without those that were already
  /// available at `after_ns`. Times of calls must not decrease. A last line without line feed, as
  /// left by a killed program, is not read.
  /// Errors: kIo; kUnreadable naming file, line and reason, also for a time before that of the
  /// previous line.
  [[nodiscard]] Result<SensorSamples> until(
      std::int64_t t_ns, std::int64_t after_ns = std::numeric_limits<std::int64_t>::min());
  /// The next samples of each sensor, at most `limit` of each, whatever their times. No samples:
  /// the end of all files. Errors: as until.
  [[nodiscard]] Result<SensorSamples> next(std::size_t limit);

 private:
  struct Files;
  [[nodiscard]] Result<SensorSamples> read(std::int64_t t_ns,
                                           std::int64_t after_ns,
                                           std::size_t limit);
  explicit SensorFilesReader(std::unique_ptr<Files> files);
  std::unique_ptr<Files> files_;
};

}  // namespace overfly::server
