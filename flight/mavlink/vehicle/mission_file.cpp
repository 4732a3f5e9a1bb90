#include <array>
#include <cmath>
#include <string>

#include "core/outside/file_text.hpp"
#include "core/text/number_text.hpp"
#include "core/text/text_fields.hpp"
#include "flight/mavlink/vehicle/mission.hpp"
#include "flight/mavlink/vehicle/plan_file.hpp"

namespace overfly::flight::mavlink {
namespace {

/// A whole number in [least, most].
Result<int> whole_field(
    const FieldFile& file, const FieldLine& line, std::size_t column, int least, int most) {
  const Result<double> value = file.number(line, column);
  if (!value) return value.error();
  if (*value != std::floor(*value) || *value < least || *value > most) {
    return file.bad_field(
        line,
        column,
        "must be a whole number in [" + std::to_string(least) + ", " + std::to_string(most) + "]");
  }
  return static_cast<int>(*value);
}

/// A number in [-limit, limit].
Result<double> limited_field(const FieldFile& file,
                             const FieldLine& line,
                             std::size_t column,
                             double limit) {
  Result<double> value = file.number(line, column);
  if (value && std::abs(*value) > limit) {
    return file.bad_field(
        line, column, "must be in [" + number_text(-limit) + ", " + number_text(limit) + "]");
  }
  return value;
}

Result<MissionItem> item_of(const FieldFile& file, const FieldLine& line, std::size_t index) {
  if (Status status = file.expect_fields(line, 12); !status) return status.error();
  const auto wanted = static_cast<int>(index);
  MissionItem item;
  const Result<int> number = whole_field(file, line, 1, wanted, wanted);
  if (!number) return number.error();
  const Result<int> current = whole_field(file, line, 2, 0, 1);
  if (!current) return current.error();
  const Result<int> frame = whole_field(file, line, 3, 0, 21);
  if (!frame) return frame.error();
  const Result<int> command = whole_field(file, line, 4, 0, 65535);
  if (!command) return command.error();
  for (std::size_t i = 0; i < item.parameters.size(); ++i) {
    const Result<double> value = limited_field(file, line, 5 + i, 1e9);
    if (!value) return value.error();
    item.parameters[i] = static_cast<float>(*value);
  }
  // In frame 2 both are plain numbers, in local frames metres.
  const bool global =
      *frame == 0 || *frame == 3 || *frame == 5 || *frame == 6 || *frame == 10 || *frame == 11;
  const Result<double> x = limited_field(file, line, 9, global ? 90.0 : 200000.0);
  if (!x) return x.error();
  const Result<double> y = limited_field(file, line, 10, global ? 180.0 : 200000.0);
  if (!y) return y.error();
  const Result<double> z = limited_field(file, line, 11, 1e6);
  if (!z) return z.error();
  const Result<int> autocontinue = whole_field(file, line, 12, 0, 1);
  if (!autocontinue) return autocontinue.error();
  item.frame = static_cast<std::uint8_t>(*frame);
  item.command = static_cast<std::uint16_t>(*command);
  item.current = *current == 1;
  item.autocontinue = *autocontinue == 1;
  item.x = *x;
  item.y = *y;
  item.z = static_cast<float>(*z);
  return item;
}

/// Larger than any plan of kMaxMissionItems.
constexpr std::uint64_t kMaxPlanBytes = std::uint64_t{16} << 20U;

}  // namespace

/// The first character that is no space begins a JSON object.
bool is_plan_file(const std::filesystem::path& file) {
  const Result<ReadableFile> opened = ReadableFile::open(file);
  if (!opened) return false;
  std::array<std::uint8_t, 256> start{};
  const Result<std::size_t> read = opened->read_some(0, start);
  if (!read) return false;
  for (std::size_t i = 0; i < *read; ++i) {
    if (start[i] == ' ' || start[i] == '\t' || start[i] == '\r' || start[i] == '\n') continue;
    return start[i] == '{';
  }
  return false;
}

Result<StoredMission> read_mission_file(const std::filesystem::path& file) {
  if (is_plan_file(file)) {
    const Result<std::string> text = read_file_text(file, kMaxPlanBytes);
    if (!text) return text.error();
    return parse_plan(*text, file.string());
  }
  const Result<FieldFile> fields = FieldFile::read(file);
  if (!fields) return fields.error();
  const std::vector<FieldLine>& lines = fields->lines();
  if (lines.empty() || lines[0].fields.size() != 3 || lines[0].fields[0] != "QGC" ||
      lines[0].fields[1] != "WPL" || lines[0].fields[2] != "110") {
    return Error{ErrorCode::kUnreadable,
                 file.string() +
                     ": the first line must be 'QGC WPL 110', or the file a plan of "
                     "QGroundControl: a mission file"};
  }
  if (lines.size() < 2 || lines.size() - 1 > kMaxMissionItems) {
    return Error{ErrorCode::kUnreadable,
                 file.string() + ": " + std::to_string(lines.size() - 1) +
                     " mission items: must be in [1, " + std::to_string(kMaxMissionItems) + "]"};
  }
  StoredMission mission;
  mission.items.reserve(lines.size() - 1);
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const Result<MissionItem> item = item_of(*fields, lines[i], i - 1);
    if (!item) return item.error();
    mission.items.push_back(*item);
  }
  return mission;
}

}  // namespace overfly::flight::mavlink
