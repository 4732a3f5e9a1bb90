// A flight log opened: its streams, its sources of truth, its events, and what is wrong with it.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/outside/source_policy.hpp"
#include "core/result.hpp"
#include "flight/logs/index/log_index.hpp"
#include "flight/logs/log_sink.hpp"

namespace overfly::flight::logs {

enum class LogFormat { kTlog, kDataFlash, kUlog, kMcap, kRosbag, kLcm, kCsv };
/// "tlog", "dataflash", "ulog", "mcap", "rosbag", "lcm", "csv"
[[nodiscard]] const char* to_string(LogFormat format);

/// A stream and its figures, which one pass over the log determines.
struct StreamInfo {
  StreamDescription description;
  std::uint64_t messages = 0;
  /// Times of the first and last message of the boot with the most messages [ns]; empty if no
  /// message has a time.
  std::optional<std::int64_t> first_ns;
  std::optional<std::int64_t> last_ns;
  double rate_hz = 0.0;  ///< mean, over all intervals within a boot; 0: fewer than two messages
  /// Intervals of more than 0.1 s and five times the mean interval before them (from the tenth on).
  std::uint64_t gaps = 0;
  std::int64_t longest_gap_ns = 0;
  std::uint64_t backward = 0;  ///< messages with an earlier time than the one before

  /// Of streams with positions or attitudes:
  std::uint64_t positions = 0;
  std::uint64_t attitudes = 0;
  /// Intervals between valid positions that are as long as a gap.
  std::uint64_t position_gaps = 0;
  std::int64_t longest_position_gap_ns = 0;
  /// Samples left out: no fix, not finite, outside of their ranges.
  std::uint64_t invalid = 0;
  /// Those of them that are not finite or outside of their ranges, and the first one.
  std::uint64_t wrong_values = 0;
  std::optional<std::pair<LogTime, WrongValue>> first_wrong_value;
  double reach_m = 0.0;  ///< largest horizontal distance from the first position
  /// Steps between positions of more than 20 m and 150 m/s.
  std::uint64_t jumps = 0;
  double largest_jump_m = 0.0;
  double lowest_m = 0.0;  ///< height above the stream's datum, or above a local origin
  double highest_m = 0.0;
  bool georeferenced = false;  ///< positions are geodetic, or local with a known origin
  /// The first origin of local positions: those before it count from it as well.
  std::optional<LocalOrigin> first_origin;
};

/// "ATT: 101 samples cannot be right and were left out, the first at 100 s: a quaternion
/// of norm 2". Empty if there are none.
[[nodiscard]] std::string wrong_values_text(const StreamInfo& stream);

/// The time from a start of a vehicle's clock to the next.
struct BootInfo {
  std::string vehicle;
  std::int64_t first_ns = 0;
  std::int64_t last_ns = 0;
  std::uint64_t messages = 0;
  std::uint32_t number = 0;  ///< as LogTime::boot
};

/// What should be taken as the flight's truth.
struct TruthChoice {
  StreamId position = 0;
  std::optional<StreamId> attitude;
  std::string reason;
};

struct OpenedLog {
  std::filesystem::path file;
  SourcePolicy sources;  ///< which files the log may name
  LogFormat format = LogFormat::kTlog;
  std::uint64_t size_bytes = 0;     ///< of all its files
  LogSlice slice;                   ///< all figures are of this part of the log
  std::vector<FileRange> parts;     ///< what must be read for the slice; empty: the whole log
  std::vector<StreamInfo> streams;  ///< in the order in which they are met: by StreamId
  std::vector<BootInfo> boots;
  std::vector<LogEvent> events;  ///< the first kMaxEvents
  /// The last mode and the last event of the mission of each vehicle before the slice, as far as
  /// that part of the log was read.
  std::vector<LogEvent> events_before;
  std::optional<TruthChoice> truth;
  /// The positions of the chosen truth stay within kGroundReachM of the first one, and within what
  /// kGroundSpeedMS reaches in their time.
  bool on_ground = false;
  std::vector<std::string> warnings;
};

inline constexpr std::size_t kMaxEvents = 10000;
inline constexpr double kGroundReachM = 30.0;
inline constexpr double kGroundSpeedMS = 3.0;

/// Detects the format by the first bytes of a file.
/// Errors: as ReadableFile::open; kUnreadable for other formats.
[[nodiscard]] Result<LogFormat> detect_format(const std::filesystem::path& file);

/// The files of a log: the file itself, and the pieces that a mapping of CSV files names.
/// Errors: as detect_format and read_csv_mapping.
[[nodiscard]] Result<std::vector<std::filesystem::path>> files_of_log(
    const std::filesystem::path& file);

struct OpenOptions {
  SourcePolicy sources{};  ///< which other files the log may name: a mapping of CSV files does
  LogSlice slice{};        ///< only messages of this time are counted
};

/// Reads a log once and lists what it contains.
///
/// Of a large log (kIndexedLogBytes) an index is saved the first time. A slice is then read without
/// the rest of the log; damage is only reported where the whole log is read. CSV files are always
/// read completely.
/// Memory: independent of the size of the log. Damaged parts are skipped and reported in warnings.
/// @param cancel  stops reading; may be null
/// Errors: as detect_format and read_csv_log; kIo; kCancelled.
[[nodiscard]] Result<OpenedLog> open_log(const std::filesystem::path& file,
                                         const std::atomic<bool>* cancel = nullptr,
                                         const OpenOptions& options = {});

/// Reads what an opened log's slice needs once more, and passes all that to a sink: also messages
/// outside of the slice. Errors: as open_log.
[[nodiscard]] Status read_log_into(const OpenedLog& log, LogSink& sink);

/// The streams to take as truth: the position source and the attitude source that goes with it.
/// @param name  of the position source: its full name, or what follows the '/' in it if that is
/// unique; of several instances without "[0]" the first. Attitudes of the same origin go with it.
/// Empty: the best source and the best attitude, simulation before
/// estimate before GPS, georeferenced before others; of equal ones the preferred stream. Errors:
/// kInvalidArgument if there is no such source, listing those that there are; kUnreadable if the
/// log has no positions.
[[nodiscard]] Result<TruthChoice> choose_truth(const std::vector<StreamInfo>& streams,
                                               const std::string& name);
/// As above. Errors name the log's file; of a slice without positions they say so.
[[nodiscard]] Result<TruthChoice> choose_truth(const OpenedLog& log, const std::string& name);

}  // namespace overfly::flight::logs
