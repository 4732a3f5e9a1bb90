#include "core/motion/pose_columns.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

#include "core/text/lower_case.hpp"

namespace overfly {
namespace {

/// What the columns of a pose are called in messages.
constexpr std::array<const char*, 7> kParts{"x", "y", "z", "qx", "qy", "qz", "qw"};
constexpr std::array<std::string_view, 6> kTimeNames{
    "t", "time", "stamp", "timestamp", "sec", "seconds"};
constexpr std::array<std::string_view, 8> kBeforePosition{
    "", "t", "p", "pos", "position", "poseposition", "prsr", "pworldcamera"};
constexpr std::array<std::string_view, 8> kBeforeRotation{
    "q", "quat", "quaternion", "rotation", "orientation", "poseorientation", "qrs", "qworldcamera"};
constexpr std::array<std::string_view, 3> kDirections{"east", "north", "up"};

struct Name {
  std::string plain;  ///< letters and digits, in small letters, without the unit
  std::string unit;   ///< empty if there is none
};

std::string letters_of(std::string_view text) {
  std::string letters;
  for (const char c : text) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) letters += c;
  }
  return lower_case(letters);
}

/// "t_ns", "x [m]", "Time (s)": the name and its unit.
Name name_of(std::string_view field) {
  const std::size_t bracket = field.find_first_of("[(");
  if (bracket != std::string_view::npos) {
    return {letters_of(field.substr(0, bracket)), letters_of(field.substr(bracket))};
  }
  const std::size_t last = field.find_last_of('_');
  if (last != std::string_view::npos && last > 0) {
    const std::string unit = letters_of(field.substr(last + 1));
    for (const char* known : {"s", "ms", "us", "ns", "m"}) {
      if (unit == known) return {letters_of(field.substr(0, last)), unit};
    }
  }
  return {letters_of(field), ""};
}

std::optional<TimeUnit> time_unit_from(const std::string& unit) {
  if (unit.empty() || unit == "s" || unit == "sec") return TimeUnit::kSeconds;
  if (unit == "ms") return TimeUnit::kMilliseconds;
  if (unit == "us") return TimeUnit::kMicroseconds;
  if (unit == "ns") return TimeUnit::kNanoseconds;
  return std::nullopt;
}

template <std::size_t N>
bool is_one_of(std::string_view text, const std::array<std::string_view, N>& known) {
  return std::find(known.begin(), known.end(), text) != known.end();
}

/// Which part of a pose a name stands for, as in kParts.
std::optional<std::size_t> part_of(const std::string& name) {
  for (std::size_t i = 0; i < kDirections.size(); ++i) {
    if (name == kDirections.at(i)) return i;
  }
  if (name.empty()) return std::nullopt;
  const std::string_view before = std::string_view(name).substr(0, name.size() - 1);
  const std::size_t axis = std::string_view("xyzw").find(name.back());
  if (axis == std::string_view::npos) return std::nullopt;
  if (axis < 3 && is_one_of(before, kBeforePosition)) return axis;
  if (is_one_of(before, kBeforeRotation)) return 3 + axis;
  return std::nullopt;
}

bool is_absent(std::string_view field) {
  const std::string text = lower_case(std::string(field.substr(0, 5)));
  return text.empty() || text == "nan" || text == "null";
}

}  // namespace

bool is_line_of_names(const FieldLine& line) {
  const std::string_view first = line.fields.front();
  if (first.empty()) return false;
  double number = 0.0;
  const char* end = first.data() + first.size();
  return std::from_chars(first.data(), end, number).ec != std::errc();
}

Result<Eigen::Quaterniond> unit_quaternion(const FieldFile& file,
                                           const FieldLine& line,
                                           const Eigen::Quaterniond& q) {
  constexpr double kNormTolerance = 0.01;  // three printed decimals stay within 0.001
  if (std::abs(q.norm() - 1.0) > kNormTolerance) {
    return file.bad_line(
        line, "the quaternion's norm is " + std::to_string(q.norm()) + ": must be 1 within 0.01");
  }
  return q;
}

Result<PoseColumns> PoseColumns::named_by(const FieldFile& file, const FieldLine& names) {
  PoseColumns columns;
  columns.fields_ = names.fields.size();
  for (std::size_t i = 0; i < names.fields.size(); ++i) {
    const Name name = name_of(names.fields[i]);
    const bool is_time = is_one_of(name.plain, kTimeNames);
    const std::optional<std::size_t> part = is_time ? std::nullopt : part_of(name.plain);
    const bool is_further_time = is_time && columns.time_ != 0;
    if ((!is_time && !part) || is_further_time) continue;
    std::size_t& place = is_time ? columns.time_ : columns.pose_.at(*part);
    if (place != 0) {
      return file.bad_field(
          names,
          i + 1,
          "column " + std::to_string(place) + " is the " + kParts.at(*part) + " already");
    }
    place = i + 1;
    if (!is_time) {
      if (!name.unit.empty() && *part < 3 && name.unit != "m") {
        return file.bad_field(names, i + 1, "a position must be in m");
      }
      continue;
    }
    const std::optional<TimeUnit> unit = time_unit_from(name.unit);
    if (!unit) return file.bad_field(names, i + 1, "a time must be in s, ms, us or ns");
    columns.unit_ = *unit;
  }
  std::string missing = columns.time_ == 0 ? " time" : "";
  for (std::size_t part = 0; part < kParts.size(); ++part) {
    if (columns.pose_.at(part) == 0) missing += std::string(" ") + kParts.at(part);
  }
  if (!missing.empty()) {
    return file.bad_line(names, "there must be columns named" + missing);
  }
  return columns;
}

Result<std::int64_t> PoseColumns::time_of(const FieldFile& file, const FieldLine& line) const {
  if (Status status = file.expect_fields(line, fields_); !status) return status.error();
  return file.time(line, time_, unit_);
}

bool PoseColumns::is_gap(const FieldLine& line) const {
  return std::all_of(pose_.begin(), pose_.end(), [&](std::size_t column) {
    return is_absent(line.fields.at(column - 1));
  });
}

Result<Pose> PoseColumns::pose_of(const FieldFile& file, const FieldLine& line) const {
  std::array<double, 7> v{};
  for (std::size_t part = 0; part < v.size(); ++part) {
    const Result<double> value = file.number(line, pose_.at(part));
    if (!value) return value.error();
    v.at(part) = *value;
  }
  const auto q = unit_quaternion(file, line, Eigen::Quaterniond(v[6], v[3], v[4], v[5]));
  if (!q) return q.error();
  return Pose{*q, {v[0], v[1], v[2]}};
}

}  // namespace overfly
