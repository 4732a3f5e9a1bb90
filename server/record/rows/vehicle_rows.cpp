#include "server/record/rows/vehicle_rows.hpp"

#include "server/files/file_field.hpp"

namespace overfly::server {
namespace {

using Json = nlohmann::json;

template <typename T>
Json value_or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

template <typename Read>
auto known(const FileField& row, const char* name, const Read& read)
    -> std::optional<decltype(read(row))> {
  const FileField field = row.at(name);
  if (field.is_null()) return std::nullopt;
  return read(field);
}

int count_below_1000(const FileField& field) { return static_cast<int>(field.integer(0, 1000)); }
double plain_number(const FileField& field) { return field.number(); }
bool plain_boolean(const FileField& field) { return field.boolean(); }

}  // namespace

Json json_from(const VehicleStatus& status) {
  return {{"t_ns", status.t_ns},
          {"vehicle", status.vehicle},
          {"mode", status.mode.empty() ? Json(nullptr) : Json(status.mode)},
          {"armed", value_or_null(status.armed)},
          {"battery_v", value_or_null(status.battery_v)},
          {"battery_percent", value_or_null(status.battery_percent)},
          {"gps_fix", value_or_null(status.gps_fix)},
          {"satellites", value_or_null(status.satellites)},
          {"messages_per_s", status.messages_per_s},
          {"lost_messages", status.lost_messages},
          {"lost_percent", status.lost_percent},
          {"clock_rate", value_or_null(status.clock_rate)},
          {"round_trip_ms", value_or_null(status.round_trip_ms)},
          {"gaps", status.gaps}};
}

Result<VehicleStatus> vehicle_status_from(const Json& value) {
  return guarded_fields([&] {
    const FileField row(value);
    VehicleStatus status;
    status.t_ns = row.at("t_ns").integer();
    status.vehicle = row.at("vehicle").text();
    if (const FileField mode = row.at("mode"); !mode.is_null()) status.mode = mode.text();
    status.armed = known(row, "armed", plain_boolean);
    status.battery_v = known(row, "battery_v", plain_number);
    status.battery_percent = known(row, "battery_percent", count_below_1000);
    status.gps_fix = known(row, "gps_fix", count_below_1000);
    status.satellites = known(row, "satellites", count_below_1000);
    status.messages_per_s = row.at("messages_per_s").number();
    status.lost_messages = static_cast<std::uint64_t>(row.at("lost_messages").integer());
    status.lost_percent = row.at("lost_percent").number();
    status.clock_rate = known(row, "clock_rate", plain_number);
    status.round_trip_ms = known(row, "round_trip_ms", plain_number);
    status.gaps = static_cast<std::uint64_t>(row.at("gaps").integer());
    return status;
  });
}

}  // namespace overfly::server
