// Where the messages of a time are in a large log, so that a slice of it is read without the rest.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "core/outside/forward_reader.hpp"
#include "flight/logs/log_sink.hpp"

namespace overfly::flight::logs {

/// Limits by the vehicle's clock [ns]; the whole log without them.
struct LogSlice {
  std::optional<std::int64_t> from_ns;
  std::optional<std::int64_t> to_ns;

  [[nodiscard]] bool is_whole() const { return !from_ns && !to_ns; }
  [[nodiscard]] bool contains(std::int64_t t_ns) const {
    return (!from_ns || t_ns >= *from_ns) && (!to_ns || t_ns <= *to_ns);
  }
};

/// Whole records of a log, about 1 MiB.
struct LogBlock {
  FileRange bytes;
  /// Times of the messages of sources; empty: there are none.
  std::optional<std::int64_t> first_ns;
  std::optional<std::int64_t> last_ns;
  /// It declares what is needed to understand later blocks: formats, streams, origins.
  bool declares = false;
};

using LogIndex = std::vector<LogBlock>;

/// Makes the index of a log while it is read from start to end.
class LogIndexBuilder {
 public:
  /// A message of a source in the present block.
  void time(const LogTime& time);
  /// The present block declares something.
  void declaration() { block_.declares = true; }
  /// All records in front of this offset were read.
  void end_block(std::uint64_t offset);
  /// @return empty if a clock starts again: times are then not unique
  [[nodiscard]] std::optional<LogIndex> finish(std::uint64_t size_bytes);

 private:
  LogIndex blocks_;
  LogBlock block_{{0, 0}, {}, {}, true};
  bool restarts_ = false;
};

/// The parts of a log that are read for a slice: blocks that declare something, those of the slice,
/// and those of 10 s on both sides of it, in which clocks are found again (BootClock) and attitudes
/// around the first and last position.
[[nodiscard]] std::vector<FileRange> parts_for(const LogIndex& index, const LogSlice& slice);

/// Logs from this size on have an index: smaller ones are read in a fraction of a second.
inline constexpr std::uint64_t kIndexedLogBytes = std::uint64_t{64} << 20U;

/// Identifies the content of a file without reading all of it.
struct LogIdentity {
  std::uint64_t size_bytes = 0;
  std::int64_t modified_ns = 0;
  std::uint64_t hash = 0;  ///< of its first and last 64 KiB
  friend bool operator==(const LogIdentity&, const LogIdentity&) = default;
};
/// Empty if the file cannot be read.
[[nodiscard]] std::optional<LogIdentity> identify_log(const std::filesystem::path& log);

/// The index that was saved for a log: FILE.overfly-index in its folder, or a file in the cache
/// folder
/// ($OVERFLY_CACHE, $XDG_CACHE_HOME/overfly or ~/.cache/overfly).
/// @return empty if there is none, or if it is damaged or belongs to other content
[[nodiscard]] std::optional<LogIndex> load_log_index(const std::filesystem::path& log,
                                                     const LogIdentity& identity);
/// Saves it in the log's folder, or else in the cache folder: also if the log's folder is marked as
/// read-only, but the user may write there nevertheless. Where neither can be written, the next
/// slice is read without it.
void save_log_index(const std::filesystem::path& log,
                    const LogIdentity& identity,
                    const LogIndex& index);

}  // namespace overfly::flight::logs
