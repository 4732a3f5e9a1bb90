// The truth of a run as samples in a file: written while it flies, and read as a flight.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/motion/truth_source.hpp"
#include "core/outside/file_text.hpp"
#include "core/result.hpp"
#include "server/files/whole_file.hpp"

namespace overfly::server {

/// Size of one sample: the time, position, rotation, velocity, angular rate and airspeed of an
/// AircraftState in this order, eight bytes each, little-endian (docs/RUN_FOLDER.md).
inline constexpr std::size_t kTruthSampleBytes = 120;

/// Samples that are recorded in addition to those that the cameras need, for inertial data [Hz].
inline constexpr std::int64_t kTruthSampleHz = 200;

class TruthSampleFile {
 public:
  /// Creates the file; must not exist. Errors: kIo.
  static Result<TruthSampleFile> create(const std::filesystem::path& file);
  /// Times must increase from call to call. The sample is in the file after flush().
  void add(const AircraftState& state);
  /// Errors: kIo naming the file.
  Status flush();

 private:
  explicit TruthSampleFile(AppendFile file) : file_(std::move(file)) {}

  AppendFile file_;
  std::vector<std::uint8_t> pending_;
};

/// Passes a flight on and records it: each requested state, and samples at kTruthSampleHz up to it.
/// @param file  must outlive the result
[[nodiscard]] std::unique_ptr<TruthSource> recorded_while_flown(std::unique_ptr<TruthSource> flight,
                                                                TruthSampleFile& file);

/// A recorded flight. Unlike other sources it may be asked for earlier times again. States at the
/// recorded times are returned bit by bit, those between them interpolated. The flight ends with
/// the last sample; a file that grows meanwhile is read on. Incomplete bytes at the end, as left by
/// a killed program, are ignored. Memory does not depend on the length of the flight.
/// @param description, log_start_ns  as TruthSource::description and log_start_ns of the flight
/// Errors: kNotFound, kUnreadable, kIo. Of the source: kUnreadable naming the file and the sample
/// with a value beyond its limit, no unit quaternion or a time that does not increase.
[[nodiscard]] Result<std::unique_ptr<TruthSource>> open_recorded_flight(
    const std::filesystem::path& file,
    const std::string& description,
    std::optional<std::int64_t> log_start_ns = std::nullopt);

}  // namespace overfly::server
