#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <utility>

#include "core/cancel.hpp"
#include "core/outside/forward_reader.hpp"
#include "core/text/number_text.hpp"
#include "core/time.hpp"
#include "flight/logs/csv/csv_reader.hpp"
#include "flight/logs/dataflash/dataflash_reader.hpp"
#include "flight/logs/flight_log.hpp"
#include "flight/logs/lcm/lcm_events.hpp"
#include "flight/logs/lcm/lcm_log_reader.hpp"
#include "flight/logs/mcap/mcap_parts.hpp"
#include "flight/logs/mcap/mcap_reader.hpp"
#include "flight/logs/rosbag/rosbag_reader.hpp"
#include "flight/logs/stream_statistics.hpp"
#include "flight/logs/tlog/tlog_reader.hpp"
#include "flight/logs/ulog/ulog_reader.hpp"

namespace overfly::flight::logs {
namespace {

/// Bytes that decide which format a file has.
constexpr std::size_t kHeadBytes = 1024;
/// Restarts beyond these are only counted.
constexpr std::size_t kMaxBoots = 1000;

struct FormatFacts {
  LogFormat format;
  const char* name;
  bool (*detect)(std::span<const std::uint8_t> head);
  Status (*read)(ForwardReader& file, LogSink& sink);  ///< null: read_csv_log, by the file's name
};

/// One line for each format. The first that recognises the first bytes of a file reads it.
constexpr std::array kLogFormats = {
    FormatFacts{LogFormat::kMcap, "mcap", is_mcap, read_mcap},
    FormatFacts{LogFormat::kRosbag, "rosbag", is_rosbag, read_rosbag},
    FormatFacts{LogFormat::kLcm, "lcm", is_lcm_log, read_lcm_log},
    FormatFacts{LogFormat::kUlog, "ulog", is_ulog, read_ulog},
    FormatFacts{LogFormat::kDataFlash, "dataflash", is_dataflash, read_dataflash},
    FormatFacts{LogFormat::kTlog, "tlog", is_tlog, read_tlog},
    FormatFacts{LogFormat::kCsv, "csv", is_csv_mapping, nullptr},
};

Result<const FormatFacts*> format_of(ForwardReader& reader, const std::filesystem::path& file) {
  const Result<std::span<const std::uint8_t>> bytes = reader.ahead(kHeadBytes);
  if (!bytes) return bytes.error();
  const std::span<const std::uint8_t> head = bytes->first(std::min(kHeadBytes, bytes->size()));
  for (const FormatFacts& facts : kLogFormats) {
    if (facts.detect(head)) return &facts;
  }
  return Error{
      ErrorCode::kUnreadable,
      file.string() +
          ": is not a flight log: its first 1024 bytes have neither a time stamp with a MAVLink "
          "frame (.tlog) nor a FMT record (DataFlash .bin) nor 'ULog' (.ulg), 'MCAP' (.mcap), "
          "'#ROSBAG V2.0' (.bag), an event of LCM nor "
          "'csv_mapping_version' (mapping of CSV files) at the start"};
}

/// Gathers the figures of all streams.
class OpeningSink final : public LogSink {
 public:
  OpeningSink(OpenedLog& log, const std::atomic<bool>* cancel) : log_(log), cancel_(cancel) {}

  [[nodiscard]] bool stream(StreamId /*id*/, const StreamDescription& description) override {
    index_.declaration();
    StreamDescription unique = description;
    for (int i = 2; !names_.insert(unique.name).second; ++i) {
      unique.name = description.name + "#" + std::to_string(i);
    }
    streams_.emplace_back(std::move(unique));
    boots_of_.push_back(0);
    return description.position != PositionKind::kNone || description.attitude;
  }
  void message(StreamId id, const std::optional<LogTime>& time) override {
    const StreamDescription& description = streams_[id].description();
    if (time && (description.origin != SourceOrigin::kNone || description.imu)) index_.time(*time);
    counted_ = log_.slice.is_whole() || (time && log_.slice.contains(time->t_ns));
    if (!counted_) return;
    streams_[id].message(time);
    if (time) count_boot(id, *time);
  }
  void local_origin(StreamId id, const LocalOrigin& origin) override {
    const auto [known, first] = origins_.try_emplace(id, origin);
    if (first || known->second != origin) index_.declaration();
    known->second = origin;
    streams_[id].local_origin(origin);
  }
  void declaration() override { index_.declaration(); }
  void event(LogEvent event) override {
    const bool inside = event.time && log_.slice.contains(event.time->t_ns);
    if (!log_.slice.is_whole() && !inside) return remember(std::move(event));
    if (log_.events.size() < kMaxEvents) {
      log_.events.push_back(std::move(event));
    } else {
      ++left_out_events_;
    }
  }
  void warning(const std::string& text) override {
    // Where parts are left out, everything that counts what is missing is wrong.
    if (log_.parts.empty()) log_.warnings.push_back(text);
  }
  void assumption(const std::string& text) override { log_.warnings.push_back(text); }
  [[nodiscard]] bool progress(std::uint64_t bytes) override {
    log_.size_bytes = std::max(log_.size_bytes, bytes);
    index_.end_block(bytes);
    return !is_cancelled(cancel_);
  }

  void finish();
  [[nodiscard]] std::optional<LogIndex> index() { return index_.finish(log_.size_bytes); }

 private:
  void take_position(StreamId id, const LogTime& time, const Eigen::Vector3d& value) override {
    if (counted_) streams_[id].position(time, value);
  }
  void take_attitude(StreamId id,
                     const LogTime& /*time*/,
                     const Eigen::Quaterniond& /*R_ned_body*/) override {
    if (counted_) streams_[id].attitude();
  }
  void take_invalid(StreamId id) override {
    if (counted_) streams_[id].invalid();
  }
  void take_wrong_value(StreamId id, const LogTime& time, const WrongValue& value) override {
    if (counted_) streams_[id].wrong_value(time, value);
  }
  [[nodiscard]] PositionKind position_kind(StreamId id) const override {
    return streams_[id].description().position;
  }
  void count_boot(StreamId id, const LogTime& time);
  void remember(LogEvent event);

  OpenedLog& log_;
  const std::atomic<bool>* cancel_;
  bool counted_ = false;  ///< the present message is in the slice
  LogIndexBuilder index_;
  std::map<StreamId, LocalOrigin> origins_;
  std::vector<StreamStatistics> streams_;
  std::set<std::string> names_;
  std::vector<std::size_t> boots_of_;  ///< of each stream, its present index in boots_
  std::vector<std::pair<BootInfo, std::uint32_t>> boots_;  ///< with the number of the boot
  std::uint64_t left_out_boots_ = 0;
  std::uint64_t left_out_events_ = 0;
};

/// Keeps the state in which a slice begins.
void OpeningSink::remember(LogEvent event) {
  const bool state = event.kind == EventKind::kMode || event.kind == EventKind::kMission;
  if (!state || !event.time || event.time->t_ns >= log_.slice.from_ns.value_or(0)) return;
  for (LogEvent& known : log_.events_before) {
    if (known.vehicle != event.vehicle || known.kind != event.kind) continue;
    known = std::move(event);
    return;
  }
  if (log_.events_before.size() < kMaxBoots) log_.events_before.push_back(std::move(event));
}

void OpeningSink::count_boot(StreamId id, const LogTime& time) {
  const std::string& vehicle = streams_[id].description().vehicle;
  std::size_t& index = boots_of_[id];
  const auto fits = [&](std::size_t i) {
    return i < boots_.size() && boots_[i].second == time.boot && boots_[i].first.vehicle == vehicle;
  };
  if (!fits(index)) {
    index = 0;
    while (index < boots_.size() && !fits(index)) ++index;
    if (index == boots_.size()) {
      if (index >= kMaxBoots) {
        ++left_out_boots_;
        return;
      }
      boots_.emplace_back(BootInfo{vehicle, time.t_ns, time.t_ns, 0, time.boot}, time.boot);
    }
  }
  BootInfo& boot = boots_[index].first;
  boot.first_ns = std::min(boot.first_ns, time.t_ns);
  boot.last_ns = std::max(boot.last_ns, time.t_ns);
  ++boot.messages;
}

void OpeningSink::finish() {
  std::uint64_t backward = 0;
  std::uint64_t gaps = 0;
  for (const StreamStatistics& statistics : streams_) {
    log_.streams.push_back(statistics.info());
    const StreamInfo& info = log_.streams.back();
    backward += info.backward;
    if (info.description.origin == SourceOrigin::kNone && !info.description.imu) continue;
    // Without messages there are no positions either.
    if (info.positions == 0) gaps += info.gaps;
    if (info.position_gaps > 0) {
      log_.warnings.push_back(counted(info.position_gaps, "gap") + " between valid positions of " +
                              info.description.name + ", the longest " +
                              short_text(s_from_ns(info.longest_position_gap_ns)) + " s long");
    }
    if (std::string text = wrong_values_text(info); !text.empty()) {
      log_.warnings.push_back(std::move(text));
    }
    if (info.jumps > 0) {
      log_.warnings.push_back(counted(info.jumps, "jump") + " of positions in " +
                              info.description.name + ", the largest by " +
                              std::to_string(static_cast<std::int64_t>(info.largest_jump_m)) +
                              " m: steps of more than 150 m/s");
    }
  }
  std::set<std::string> vehicles;
  for (const auto& [boot, number] : boots_) {
    log_.boots.push_back(boot);
    if (!vehicles.insert(boot.vehicle).second && number == 1) {
      log_.warnings.push_back(
          "the clock" + (boot.vehicle.empty() ? "" : " of " + boot.vehicle) +
          " starts again within the log: times are unique only within one of its " +
          "runs, and flights and conversions use the one with the most positions");
    }
  }
  const auto warn = [&](std::uint64_t count, const std::string& text) {
    if (count > 0) log_.warnings.push_back(std::to_string(count) + " " + text);
  };
  warn(backward, "messages have an earlier time than the one before them in their stream");
  warn(gaps, "gaps in the sources: intervals of more than five times the mean");
  warn(left_out_boots_, "messages belong to further restarts of a clock");
  warn(left_out_events_, "events were left out");
  if (const Result<TruthChoice> truth = choose_truth(log_.streams, "")) {
    log_.truth = *truth;
    const StreamInfo& source = log_.streams[truth->position];
    const double span_s = s_from_ns(source.last_ns.value_or(0) - source.first_ns.value_or(0));
    log_.on_ground = source.reach_m <= std::min(kGroundReachM, kGroundSpeedMS * span_s);
  } else {
    log_.warnings.push_back(log_.slice.is_whole() ? truth.error().message
                                                  : "no valid positions in the time asked for");
  }
  if (log_.on_ground) {
    log_.warnings.emplace_back(
        "the aircraft stays on the ground: its positions lie within 30 m of the first one, and it "
        "is slower than 3 m/s");
  }
}

}  // namespace

const char* to_string(LogFormat format) {
  for (const FormatFacts& facts : kLogFormats) {
    if (facts.format == format) return facts.name;
  }
  return "";
}

Result<LogFormat> detect_format(const std::filesystem::path& file) {
  Result<ForwardReader> reader = ForwardReader::open(file);
  if (!reader) return reader.error();
  const Result<const FormatFacts*> facts = format_of(*reader, file);
  if (!facts) return facts.error();
  return (*facts)->format;
}

Result<std::vector<std::filesystem::path>> files_of_log(const std::filesystem::path& file) {
  const Result<LogFormat> format = detect_format(file);
  if (!format) return format.error();
  std::vector<std::filesystem::path> files{file};
  if (*format != LogFormat::kCsv) return files;
  const Result<std::vector<CsvPiece>> pieces = read_csv_mapping(file);
  if (!pieces) return pieces.error();
  for (const CsvPiece& piece : *pieces) files.push_back(piece.file);
  return files;
}

Status read_log_into(const OpenedLog& log, LogSink& sink) {
  Result<ForwardReader> reader = ForwardReader::open(log.file);
  if (!reader) return reader.error();
  const Result<const FormatFacts*> facts = format_of(*reader, log.file);
  if (!facts) return facts.error();
  const bool is_csv = (*facts)->read == nullptr;
  if (!log.parts.empty()) reader->only(log.parts);
  Status status =
      is_csv ? read_csv_log(log.file, log.sources, sink) : (*facts)->read(*reader, sink);
  if (status) return status;
  // Errors of reading name the file already, and those of CSV files theirs.
  const ErrorCode code = status.error().code;
  const bool named = code == ErrorCode::kIo || (is_csv && code != ErrorCode::kCancelled);
  return named ? status : status.error().in(log.file.string());
}

Result<OpenedLog> open_log(const std::filesystem::path& file,
                           const std::atomic<bool>* cancel,
                           const OpenOptions& options) {
  const Result<LogFormat> format = detect_format(file);
  if (!format) return format.error();
  const std::optional<LogIdentity> identity = identify_log(file);
  if (!identity) return Error{ErrorCode::kIo, file.string() + ": cannot be read"};
  OpenedLog log;
  log.file = file;
  log.sources = options.sources;
  log.format = *format;
  log.size_bytes = identity->size_bytes;
  log.slice = options.slice;
  const bool indexed = log.format != LogFormat::kCsv && log.size_bytes >= kIndexedLogBytes;
  if (indexed && !log.slice.is_whole()) {
    if (const auto index = load_log_index(file, *identity)) {
      log.parts = parts_for(*index, log.slice);
    }
  }
  std::string own_index_unused;
  if (indexed && !log.slice.is_whole() && log.parts.empty() && log.format == LogFormat::kMcap) {
    auto parts = mcap_parts_for(file, log.slice, cancel);
    if (parts) {
      log.parts = std::move(*parts);
    } else if (parts.error().code == ErrorCode::kCancelled) {
      return parts.error().in(file.string());
    } else {
      own_index_unused = parts.error().message;
    }
  }
  OpeningSink sink(log, cancel);
  if (Status status = read_log_into(log, sink); !status) return status.error();
  sink.finish();
  if (!own_index_unused.empty()) {
    log.warnings.push_back("the file's own index was not used, and the whole log was read: " +
                           own_index_unused);
  }
  if (!indexed || !log.parts.empty()) return log;
  // A log that was written to in the meantime gets its index another time.
  if (const auto index = sink.index(); index && identify_log(file) == identity) {
    save_log_index(file, *identity, *index);
    if (!log.slice.is_whole()) log.parts = parts_for(*index, log.slice);
  }
  return log;
}

}  // namespace overfly::flight::logs
