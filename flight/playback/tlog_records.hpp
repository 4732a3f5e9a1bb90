// A telemetry log frame by frame, to be sent again.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "core/outside/forward_reader.hpp"
#include "core/result.hpp"
#include "flight/mavlink/frame_finder.hpp"
#include "flight/playback/playback_records.hpp"

namespace overfly::flight::playback {

/// Reads the valid frames of a `.tlog` in the order of the file. Their times are those of reception
/// since the first one. First stamps that later ones prove to be wrong (logs::BootClock) count as
/// the first right one.
class TlogRecords final : public PlaybackRecords {
 public:
  /// Reads the file once, for its length.
  /// Errors: as ForwardReader::open; kUnreadable if it is no telemetry log; kIo.
  static Result<TlogRecords> open(const std::filesystem::path& file);

  /// The next record; empty at the end. Times never decrease: a frame that was received before the
  /// one in front of it has that one's time. Errors: kIo.
  [[nodiscard]] Result<std::optional<Record>> next() override;
  /// Continues with the first record at or after a time. Errors: kIo.
  Status seek(std::int64_t t_us) override;

  /// Time of the last record.
  [[nodiscard]] std::int64_t duration_us() const override { return duration_us_; }
  [[nodiscard]] std::uint64_t count() const override { return count_; }

 private:
  explicit TlogRecords(ForwardReader file);
  void rewind();
  /// Finds first_us_ and wrong_first_.
  Status find_first_stamp();

  ForwardReader file_;
  mavlink::FrameFinder finder_;
  std::uint64_t size_bytes_ = 0;
  std::size_t consumed_ = 0;       ///< of the bytes that file_ shows: those of the last record
  std::uint64_t stamp_us_ = 0;     ///< of the last record
  std::uint64_t first_us_ = 0;     ///< the first right stamp
  std::uint64_t wrong_first_ = 0;  ///< records in front of it
  std::uint64_t read_ = 0;         ///< records since the start
  std::int64_t last_us_ = 0;
  std::int64_t begin_us_ = 0;  ///< earlier records are passed over
  std::int64_t duration_us_ = 0;
  std::uint64_t count_ = 0;
};

}  // namespace overfly::flight::playback
