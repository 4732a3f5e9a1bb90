#include "flight/logs/dataflash/dataflash_reader.hpp"

#include <array>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/text/number_text.hpp"
#include "core/time.hpp"
#include "flight/logs/boot_clock.hpp"
#include "flight/logs/dataflash/format_table.hpp"
#include "flight/logs/dataflash/record_plan.hpp"
#include "flight/logs/held_messages.hpp"

namespace overfly::flight::logs {
namespace {

/// More than the longest record (255 bytes) and the header of the next one.
constexpr std::size_t kWindowBytes = 4096;
/// A log has some hundred streams; damaged declarations could make any number.
constexpr std::size_t kMaxRecordStreams = 4096;
/// SIM and SIM2 are compared only if they are closer than this.
constexpr std::int64_t kMaxOriginNs = 20'000'000;

/// Everything known about the records of one type.
struct RecordKind {
  RecordPlan plan;
  struct Stream {
    StreamId id = 0;
    bool wanted = false;
  };
  std::array<std::optional<Stream>, 256> streams;  ///< by instance
  bool declares = false;                           ///< FMT, FMTU, UNIT, MULT
  bool origin = false;                             ///< ORGN
};

class DataflashPass {
 public:
  explicit DataflashPass(LogSink& sink) : sink_(sink) { update_kind(kFormatType); }

  /// Length of the record at the start of `bytes`; 0 if there is none.
  /// @param last  the file ends with these bytes
  [[nodiscard]] std::size_t record_bytes(std::span<const std::uint8_t> bytes, bool last) const;
  void take(std::span<const std::uint8_t> record);
  void skip(std::size_t bytes);
  void report();

 private:
  void update_kind(std::uint8_t type);
  /// Null if there are too many streams.
  RecordKind::Stream* stream_of(RecordKind& kind, std::span<const std::uint8_t> record);
  /// Passes what a record contains to the sink.
  void pass(const RecordKind& kind,
            const RecordKind::Stream& stream,
            const std::optional<LogTime>& time,
            std::span<const std::uint8_t> record);
  void pass_held();
  /// Follows a record that says how others are read.
  void declare(const RecordKind& kind, std::span<const std::uint8_t> record);
  void take_samples(const RecordKind& kind,
                    const RecordKind::Stream& stream,
                    const LogTime& time,
                    std::span<const std::uint8_t> record);
  void take_sensor(const RecordPlan& plan,
                   const RecordKind::Stream& stream,
                   const LogTime& time,
                   std::span<const std::uint8_t> record);
  void take_origin(const RecordPlan& plan, std::span<const std::uint8_t> record);
  void take_simulator_origin(const RecordPlan& plan,
                             const RecordKind::Stream& stream,
                             const LogTime& time,
                             std::span<const std::uint8_t> record);

  struct SimulatedPoint {
    StreamId id = 0;
    LogTime time;
    Eigen::Vector3d position_ned_m;
    Eigen::Vector3d velocity_ned_m_s;
  };

  LogSink& sink_;
  FormatTable table_;
  std::array<std::unique_ptr<RecordKind>, 256> kinds_;
  StreamId stream_count_ = 0;
  BootClock clock_;
  HeldMessages<std::vector<std::uint8_t>> held_;
  std::optional<LocalOrigin> estimator_origin_;
  std::vector<StreamId> estimator_streams_;
  std::optional<SimulatedPoint> simulated_;
  bool simulator_origin_known_ = false;
  std::uint64_t skipped_bytes_ = 0;
  std::uint64_t damaged_places_ = 0;
  std::uint64_t left_out_records_ = 0;
  std::uint64_t overtaken_records_ = 0;  ///< held ones whose type was declared again
  bool is_ardu_plane_ = false;           ///< by the first text of its logs
  bool in_step_ = true;
};

void DataflashPass::update_kind(std::uint8_t type) {
  auto kind = std::make_unique<RecordKind>();
  kind->plan = plan_of(*table_.format(type));
  const std::string& name = kind->plan.format.name;
  kind->declares = type == kFormatType || name == "FMTU" || name == "UNIT" || name == "MULT";
  kind->origin = name == "ORGN";
  // A new declaration of the same records goes on with their streams.
  if (kinds_[type] && kinds_[type]->plan.format.name == name &&
      kinds_[type]->plan.format.instance == kind->plan.format.instance) {
    kind->streams = kinds_[type]->streams;
  }
  kinds_[type] = std::move(kind);
}

std::size_t DataflashPass::record_bytes(std::span<const std::uint8_t> bytes, bool last) const {
  if (bytes.size() < kRecordHeaderBytes || bytes[0] != kRecordStart1 || bytes[1] != kRecordStart2) {
    return 0;
  }
  const RecordFormat* const format = table_.format(bytes[2]);
  if (format == nullptr || format->size_bytes > bytes.size()) return 0;
  const std::span<const std::uint8_t> rest = bytes.subspan(format->size_bytes);
  if (rest.size() < 2) return last ? format->size_bytes : 0;
  return rest[0] == kRecordStart1 && rest[1] == kRecordStart2 ? format->size_bytes : 0;
}

void DataflashPass::skip(std::size_t bytes) {
  skipped_bytes_ += bytes;
  if (std::exchange(in_step_, false)) ++damaged_places_;
}

RecordKind::Stream* DataflashPass::stream_of(RecordKind& kind,
                                             std::span<const std::uint8_t> record) {
  const RecordFormat& format = kind.plan.format;
  std::size_t instance = 0;
  if (format.instance) {
    instance = static_cast<std::uint8_t>(integer_in(format.fields[*format.instance], record));
  }
  std::optional<RecordKind::Stream>& stream = kind.streams[instance];
  if (stream) return &*stream;
  if (stream_count_ >= kMaxRecordStreams) return nullptr;
  StreamDescription description = kind.plan.description;
  if (format.instance) {
    description.name.append("[").append(std::to_string(instance)).append("]");
    description.preference = 10 * description.preference + static_cast<int>(instance);
  } else {
    description.preference *= 10;
  }
  stream = RecordKind::Stream{stream_count_++, false};
  stream->wanted = sink_.stream(stream->id, description);
  if (description.position == PositionKind::kLocal &&
      description.origin == SourceOrigin::kEstimate) {
    estimator_streams_.push_back(stream->id);
    if (estimator_origin_) sink_.local_origin(stream->id, *estimator_origin_);
  }
  return &*stream;
}

void DataflashPass::take(std::span<const std::uint8_t> record) {
  in_step_ = true;
  RecordKind& kind = *kinds_[record[2]];
  const RecordKind::Stream* const stream = stream_of(kind, record);
  if (stream == nullptr) {
    ++left_out_records_;
    return;
  }
  std::optional<LogTime> time = clock_.latest();
  if (kind.plan.time) {
    const std::int64_t ticks = integer_in(*kind.plan.time, record);
    constexpr std::int64_t kMaxTicks = std::int64_t{1} << 52U;
    const bool possible = ticks >= 0 && ticks < kMaxTicks / kind.plan.ns_per_time_unit * 1000;
    time = clock_.take(possible ? ticks * kind.plan.ns_per_time_unit : -1);
  }
  if (held_.must_hold(clock_)) {
    sink_.declaration();
    held_.hold(time, {record.begin(), record.end()});
  } else {
    pass_held();
    pass(kind, *stream, time, record);
  }
  if (kind.declares) declare(kind, record);
}

void DataflashPass::pass_held() {
  held_.release(clock_,
                [this](const std::optional<LogTime>& time, std::span<const std::uint8_t> record) {
                  RecordKind& kind = *kinds_[record[2]];
                  // Its type may have been declared again meanwhile, with other fields.
                  if (kind.plan.format.size_bytes != record.size()) {
                    ++overtaken_records_;
                    return;
                  }
                  const RecordKind::Stream* const stream = stream_of(kind, record);
                  if (stream == nullptr) {
                    ++left_out_records_;
                    return;
                  }
                  pass(kind, *stream, time, record);
                });
}

void DataflashPass::declare(const RecordKind& kind, std::span<const std::uint8_t> record) {
  const FormatTable::Change change = table_.take(kind.plan.format, record);
  if (!change.any) return;
  update_kind(change.type);
  sink_.declaration();
}

void DataflashPass::pass(const RecordKind& kind,
                         const RecordKind::Stream& stream,
                         const std::optional<LogTime>& time,
                         std::span<const std::uint8_t> record) {
  sink_.message(stream.id, time);
  if (time) take_samples(kind, stream, *time, record);
  if (kind.plan.event) {
    std::string text = event_text(kind.plan, record, is_ardu_plane_);
    if (!is_ardu_plane_ && text.starts_with("ArduPlane")) {
      is_ardu_plane_ = true;
      sink_.declaration();
    }
    sink_.event({"", time, *kind.plan.event, std::move(text)});
  }
  if (kind.origin) take_origin(kind.plan, record);
}

void DataflashPass::take_samples(const RecordKind& kind,
                                 const RecordKind::Stream& stream,
                                 const LogTime& time,
                                 std::span<const std::uint8_t> record) {
  const RecordPlan& plan = kind.plan;
  if (plan.description.origin == SourceOrigin::kSimulation && !simulator_origin_known_) {
    take_simulator_origin(plan, stream, time, record);
  }
  if (!stream.wanted) return;
  if (plan.sensor.kind != SensorRecord::kNone) take_sensor(plan, stream, time, record);
  if (plan.fix && number_in(*plan.fix, record) < 3.0) return sink_.no_sample(stream.id);
  if (plan.description.position != PositionKind::kNone) {
    sink_.position(stream.id, time, vector_in(plan.position, record));
  }
  if (plan.description.attitude) sink_.attitude(stream.id, time, attitude_in(plan, record));
}

void DataflashPass::take_sensor(const RecordPlan& plan,
                                const RecordKind::Stream& stream,
                                const LogTime& time,
                                std::span<const std::uint8_t> record) {
  const SensorSamples samples = samples_in(plan.sensor, record, time.t_ns);
  if (samples.empty()) return;
  constexpr int kInstances = 256;
  const auto instance = plan.format.instance
                            ? static_cast<int>(static_cast<std::uint8_t>(
                                  integer_in(plan.format.fields[*plan.format.instance], record)))
                            : 0;
  sink_.samples(stream.id, time, kInstances * plan.sensor.rank + instance, samples);
}

void DataflashPass::take_origin(const RecordPlan& plan, std::span<const std::uint8_t> record) {
  const RecordField* const type = plan.format.field("Type");
  const RecordField* const lat = plan.format.field("Lat");
  const RecordField* const lon = plan.format.field("Lng");
  const RecordField* const alt = plan.format.field("Alt");
  if (type == nullptr || lat == nullptr || lon == nullptr || alt == nullptr) return;
  if (integer_in(*type, record) != 0) return;  // 1: home, which is no origin of coordinates
  estimator_origin_ = LocalOrigin{number_in(*lat, record),
                                  number_in(*lon, record),
                                  number_in(*alt, record),
                                  LocalGrid::kArduPilot};
  for (const StreamId id : estimator_streams_) sink_.local_origin(id, *estimator_origin_);
}

void DataflashPass::take_simulator_origin(const RecordPlan& plan,
                                          const RecordKind::Stream& stream,
                                          const LogTime& time,
                                          std::span<const std::uint8_t> record) {
  if (plan.description.position == PositionKind::kLocal && plan.velocity) {
    simulated_ = SimulatedPoint{
        stream.id, time, vector_in(plan.position, record), vector_in(*plan.velocity, record)};
    return;
  }
  if (plan.description.position != PositionKind::kGeodetic || !simulated_) return;
  const std::int64_t step_ns = time.t_ns - simulated_->time.t_ns;
  if (time.boot != simulated_->time.boot || step_ns < -kMaxOriginNs || step_ns > kMaxOriginNs) {
    return;
  }
  const Eigen::Vector3d geodetic = vector_in(plan.position, record);
  const Eigen::Vector3d ned_m =
      simulated_->position_ned_m + simulated_->velocity_ned_m_s * s_from_ns(step_ns);
  if (!geodetic.allFinite() || !ned_m.allFinite() || (geodetic.x() == 0.0 && geodetic.y() == 0.0)) {
    return;
  }
  simulator_origin_known_ = true;
  sink_.local_origin(simulated_->id, origin_of_local(LocalGrid::kArduPilot, geodetic, ned_m));
}

void DataflashPass::report() {
  pass_held();
  const auto warn = [&](std::uint64_t count, const std::string& text) {
    if (count > 0) sink_.warning(std::to_string(count) + " " + text);
  };
  warn(skipped_bytes_,
       "bytes in " + counted(damaged_places_, "place") +
           " belong to no complete record and were skipped");
  warn(left_out_records_,
       "records were left out: only " + std::to_string(kMaxRecordStreams) + " streams are read");
  warn(overtaken_records_,
       "records were left out: their type was declared again before their time was known");
  warn(clock_.implausible(), "stamps of records are implausible and were not used");
  warn(table_.unusable(), "FMT records declare nothing usable");
  warn(table_.redeclared(), "FMT records declare a type again, with other fields");
}

}  // namespace

bool is_dataflash(std::span<const std::uint8_t> head) {
  for (; head.size() >= kFormatRecordBytes; head = head.subspan(1)) {
    if (head[0] == kRecordStart1 && head[1] == kRecordStart2 && head[2] == kFormatType) {
      const std::optional<RecordFormat> format = read_format(head.first(kFormatRecordBytes));
      if (format && !format->fields.empty()) return true;
    }
  }
  return false;
}

Status read_dataflash(ForwardReader& file, LogSink& sink) {
  DataflashPass pass(sink);
  while (true) {
    const Result<std::span<const std::uint8_t>> bytes = file.ahead(kWindowBytes);
    if (!bytes) return bytes.error();
    if (bytes->empty()) break;
    const bool last = bytes->size() < kWindowBytes;
    std::size_t used = 0;
    while (bytes->size() - used >= (last ? 1 : kWindowBytes)) {
      const std::span<const std::uint8_t> rest = bytes->subspan(used);
      const std::size_t length = pass.record_bytes(rest, last);
      if (length == 0) {
        pass.skip(1);
        ++used;
      } else {
        pass.take(rest.first(length));
        used += length;
      }
    }
    file.skip(used);
    if (!sink.progress(file.position())) {
      return Error{ErrorCode::kCancelled, "reading was cancelled"};
    }
  }
  pass.report();
  return {};
}

}  // namespace overfly::flight::logs
