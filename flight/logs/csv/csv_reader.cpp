#include "flight/logs/csv/csv_reader.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "core/motion/pose.hpp"
#include "flight/logs/boot_clock.hpp"
#include "flight/logs/csv/csv_rows.hpp"
#include "flight/logs/csv/csv_samples.hpp"
#include "flight/logs/held_messages.hpp"
#include "flight/logs/ned_attitude.hpp"

namespace overfly::flight::logs {
namespace {

/// Sums of times below this cannot overflow; BootClock's own limit is lower.
constexpr double kCsvLatestNs = 4e18;
constexpr std::uint64_t kRowsBetweenProgress = 4096;

enum class FieldKind { kBlank, kNumber, kOther };

struct CsvField {
  FieldKind kind = FieldKind::kBlank;
  double value = 0.0;
};

/// A decimal number, or "nan" and "inf" in any case.
CsvField field_from(std::string_view text) {
  if (text.empty()) return {};
  if (text.front() == '+') text.remove_prefix(1);
  double value = 0.0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (text.empty() || error != std::errc() || stop != end) return {FieldKind::kOther, 0.0};
  return {FieldKind::kNumber, value};
}

/// Whole numbers are exact; others are rounded as a double.
std::optional<std::int64_t> time_from(std::string_view text, const CsvPiece& piece) {
  const CsvField field = field_from(text);
  const double unit_ns = static_cast<double>(piece.time_unit_ns);
  if (field.kind != FieldKind::kNumber || !(std::abs(field.value) * unit_ns < kCsvLatestNs)) {
    return std::nullopt;
  }
  std::int64_t whole = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, whole);
  const std::int64_t t_ns = error == std::errc() && stop == end
                                ? whole * piece.time_unit_ns
                                : std::llround(field.value * unit_ns);
  return t_ns + piece.time_offset_ns;
}

bool is_angle(double angle_rad, double limit_rad) {
  return std::abs(angle_rad) <= limit_rad * (1.0 + 1e-9);
}

/// One pass over the rows of a piece.
class PiecePass {
 public:
  PiecePass(const CsvPiece& piece, StreamId id, bool wanted, LogSink& sink)
      : piece_(piece), id_(id), wanted_(wanted), sink_(sink) {}

  Status find_columns(const CsvRows& rows) {
    const auto find = [&](const std::string& name, std::size_t& index) -> Status {
      const Result<std::size_t> found = rows.column(name);
      if (!found) return found.error();
      index = *found;
      return {};
    };
    if (Status status = find(piece_.time_column, time_index_); !status) return status;
    if (piece_.valid_column) {
      if (Status status = find(*piece_.valid_column, valid_index_); !status) return status;
    }
    for (std::size_t i = 0; i < kCsvQuantities; ++i) {
      if (!piece_.columns[i]) continue;
      if (Status status = find(piece_.columns[i]->name, indices_[i]); !status) return status;
    }
    return {};
  }

  void take(const std::vector<std::string_view>& fields);
  void report(const CsvRows& rows);

 private:
  void pass(const std::vector<std::string_view>& fields, const std::optional<LogTime>& time);
  void pass_held();
  void take_samples(const std::vector<std::string_view>& fields, const LogTime& time);
  [[nodiscard]] double value(CsvQuantity quantity) const {
    return values_[static_cast<std::size_t>(quantity)];
  }

  const CsvPiece& piece_;
  StreamId id_;
  bool wanted_;
  LogSink& sink_;
  BootClock clock_;
  HeldMessages<std::vector<std::string>> held_;  ///< fields of rows
  std::size_t time_index_ = 0;
  std::size_t valid_index_ = 0;
  std::array<std::size_t, kCsvQuantities> indices_{};
  std::array<double, kCsvQuantities> values_{};
  std::optional<LogTime> last_;
  std::uint64_t without_time_ = 0;
  std::uint64_t repeated_ = 0;
  std::uint64_t blank_ = 0;
  std::uint64_t not_numbers_ = 0;
};

void PiecePass::take(const std::vector<std::string_view>& fields) {
  const std::optional<std::int64_t> t_ns = time_from(fields[time_index_], piece_);
  if (!t_ns) {
    ++without_time_;
    sink_.message(id_, std::nullopt);
    return;
  }
  const std::optional<LogTime> time = clock_.take(*t_ns);
  if (held_.must_hold(clock_)) return held_.hold(time, {fields.begin(), fields.end()});
  pass_held();
  pass(fields, time);
}

void PiecePass::pass_held() {
  held_.release(clock_, [this](const auto& time, const std::vector<std::string>& fields) {
    pass({fields.begin(), fields.end()}, time);
  });
}

void PiecePass::pass(const std::vector<std::string_view>& fields,
                     const std::optional<LogTime>& time) {
  sink_.message(id_, time);
  if (!time) return;
  if (std::exchange(last_, time) == time) {
    ++repeated_;
    return;
  }
  if (wanted_) take_samples(fields, *time);
}

void PiecePass::take_samples(const std::vector<std::string_view>& fields, const LogTime& time) {
  if (piece_.valid_column) {
    const CsvField valid = field_from(fields[valid_index_]);
    if (valid.kind != FieldKind::kNumber || !(valid.value >= piece_.valid_at_least)) {
      return sink_.no_sample(id_);
    }
  }
  for (std::size_t i = 0; i < kCsvQuantities; ++i) {
    if (!piece_.columns[i]) continue;
    const CsvField field = field_from(fields[indices_[i]]);
    if (field.kind != FieldKind::kNumber) {
      ++(field.kind == FieldKind::kBlank ? blank_ : not_numbers_);
      return;
    }
    values_[i] = field.value * piece_.columns[i]->factor;
  }
  // Longitudes may count from 0 to 360 deg.
  double& lon_deg = values_[static_cast<std::size_t>(CsvQuantity::kLon)];
  if (lon_deg > 180.0 && lon_deg <= 360.0) lon_deg -= 360.0;
  if (piece_.has_samples()) {
    sink_.samples(id_, time, static_cast<int>(id_), csv_samples_of(piece_, values_, time.t_ns));
  }
  if (piece_.has_position()) {
    sink_.position(
        id_,
        time,
        {value(CsvQuantity::kLat), value(CsvQuantity::kLon), value(CsvQuantity::kAltMsl)});
  }
  if (piece_.has_quaternion()) {
    sink_.attitude(id_,
                   time,
                   {value(CsvQuantity::kQw),
                    value(CsvQuantity::kQx),
                    value(CsvQuantity::kQy),
                    value(CsvQuantity::kQz)});
  }
  if (!piece_.has_angles()) return;
  const RollPitchYaw angles{
      value(CsvQuantity::kRoll), value(CsvQuantity::kPitch), value(CsvQuantity::kYaw)};
  if (is_angle(angles.roll_rad, 2.0 * kPi) && is_angle(angles.pitch_rad, kPi / 2.0) &&
      is_angle(angles.yaw_rad, 2.0 * kPi)) {
    sink_.attitude(id_, time, R_ned_body_from(angles));
  } else {
    sink_.wrong_value(id_, time, {.angles = angles});
  }
}

void PiecePass::report(const CsvRows& rows) {
  pass_held();
  const auto warn = [&](std::uint64_t count, const std::string& text) {
    if (count > 0) sink_.warning(std::to_string(count) + " " + text + " in " + piece_.name);
  };
  warn(rows.uneven(), "rows with another number of fields than the header were left out");
  warn(rows.too_long(), "lines of more than 65536 bytes were left out");
  warn(without_time_, "rows without a readable time were left out");
  warn(clock_.implausible(), "rows with an implausible time were left out");
  warn(repeated_, "rows repeat the time of the row before and were left out");
  warn(blank_, "rows with a blank field were left out");
  warn(not_numbers_, "rows with a field that is not a number were left out");
}

StreamDescription description_of(const CsvPiece& piece, int preference) {
  StreamDescription description;
  description.name = piece.name;
  description.position = piece.has_position() ? PositionKind::kGeodetic : PositionKind::kNone;
  description.sensors = piece.has_samples();
  description.attitude = piece.has_angles() || piece.has_quaternion();
  description.origin = piece.origin;
  description.preference = preference;
  return description;
}

}  // namespace

Status read_csv_log(const std::filesystem::path& mapping,
                    const SourcePolicy& sources,
                    LogSink& sink) {
  const Result<std::vector<CsvPiece>> pieces = read_csv_mapping(mapping);
  if (!pieces) return pieces.error();
  std::uint64_t bytes_before = 0;
  for (std::size_t i = 0; i < pieces->size(); ++i) {
    const CsvPiece& piece = (*pieces)[i];
    const std::string field = mapping.string() + ": pieces." + std::to_string(i) + ".file";
    if (Status status = sources.check(piece.file, field); !status) return status;
    Result<CsvRows> rows = CsvRows::open(piece.file);
    if (!rows) return rows.error();
    const auto id = static_cast<StreamId>(i);
    const bool wanted = sink.stream(id, description_of(piece, static_cast<int>(i)));
    PiecePass pass(piece, id, wanted, sink);
    if (Status status = pass.find_columns(*rows); !status) return status;
    for (std::uint64_t row = 0;; ++row) {
      const Result<bool> more = rows->next();
      if (!more) return more.error();
      if (!*more) break;
      if (!rows->fields().empty()) pass.take(rows->fields());
      if (row % kRowsBetweenProgress == 0 && !sink.progress(bytes_before + rows->position())) {
        return Error{ErrorCode::kCancelled, "reading was cancelled"};
      }
    }
    pass.report(*rows);
    bytes_before += rows->position();
    if (!sink.progress(bytes_before)) {
      return Error{ErrorCode::kCancelled, "reading was cancelled"};
    }
  }
  return {};
}

}  // namespace overfly::flight::logs
