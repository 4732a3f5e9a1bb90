#include "flight/mavlink/vehicle/plan_file.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "core/outside/outside_json.hpp"
#include "core/text/number_text.hpp"

namespace overfly::flight::mavlink {
namespace {

using Json = nlohmann::json;

/// MAV_CMD.
enum : std::uint16_t {
  kNavWaypoint = 16,
  kNavLand = 21,
  kNavLoiterToAlt = 31,
  kDoLandStart = 189,
};
constexpr std::uint8_t kGlobal = 0;
constexpr std::uint8_t kGlobalAboveHome = 3;
constexpr double kMostParameter = 1e9;
constexpr double kMostHeightM = 1e6;
constexpr double kMostMetres = 200000.0;

bool is_global(int frame) {
  return frame == 0 || frame == 3 || frame == 5 || frame == 6 || frame == 10 || frame == 11;
}

/// A value of the document, cut to a line for a message.
std::string shown_value(const Json& value) {
  std::string text = value.dump(-1, ' ', true, Json::error_handler_t::replace);
  if (text.size() > 60) text = text.substr(0, 57) + "...";
  return text;
}

/// Converts the document; keeps the first error.
class PlanReader {
 public:
  explicit PlanReader(std::string origin) : origin_(std::move(origin)) {}

  Result<StoredMission> read(const Json& plan) {
    if (!plan.is_object()) return error("must be a JSON object: a plan of QGroundControl");
    if (const Json* type = member(plan, "fileType"); type == nullptr || *type != "Plan") {
      reject("fileType", type, "\"Plan\"");
    }
    const Json* const mission = member(plan, "mission");
    if (mission == nullptr || !mission->is_object()) {
      reject("mission", mission, "an object");
    } else {
      read_mission(*mission);
    }
    warn_of_rest(plan);
    if (error_) return *error_;
    return std::move(stored_);
  }

 private:
  static const Json* member(const Json& object, const char* name) {
    if (!object.is_object()) return nullptr;
    const auto found = object.find(name);
    return found == object.end() ? nullptr : &*found;
  }
  [[nodiscard]] Error error(const std::string& text) const {
    return {ErrorCode::kUnreadable, origin_ + ": " + text};
  }
  void fail(const std::string& text) {
    if (!error_) error_ = error(text);
  }
  void reject(const std::string& path, const Json* value, const std::string& must) {
    fail(path +
         (value == nullptr ? ": must be given: " : " = " + shown_value(*value) + ": must be ") +
         must);
  }

  /// A number in [-limit, limit].
  double number(const std::string& path, const Json* value, double limit) {
    const double read =
        value != nullptr && value->is_number() ? value->get<double>() : std::nan("");
    if (std::abs(read) <= limit) return read;
    reject(path, value, "a number in [" + number_text(-limit) + ", " + number_text(limit) + "]");
    return 0.0;
  }
  int whole(const std::string& path, const Json* value, int most) {
    const double read =
        value != nullptr && value->is_number() ? value->get<double>() : std::nan("");
    if (read == std::floor(read) && read >= 0.0 && read <= most) return static_cast<int>(read);
    reject(path, value, "a whole number in [0, " + std::to_string(most) + "]");
    return 0;
  }
  /// Latitude, longitude and height.
  Eigen::Vector3d place(const std::string& path, const Json* value) {
    if (value == nullptr || !value->is_array() || value->size() != 3) {
      reject(path, value, "an array of latitude, longitude and height");
      return Eigen::Vector3d::Zero();
    }
    return {number(path + ".0", &(*value)[0], 90.0),
            number(path + ".1", &(*value)[1], 180.0),
            number(path + ".2", &(*value)[2], kMostHeightM)};
  }

  void read_mission(const Json& mission) {
    if (const Json* version = member(mission, "version"); version == nullptr || *version != 2) {
      reject("mission.version", version, "2");
    }
    const Eigen::Vector3d home =
        place("mission.plannedHomePosition", member(mission, "plannedHomePosition"));
    add_place(kNavWaypoint, kGlobal, home);
    stored_.items.front().current = true;
    const Json* const items = member(mission, "items");
    if (items == nullptr || !items->is_array()) {
      reject("mission.items", items, "an array");
    } else {
      for (std::size_t i = 0; i < items->size() && !error_; ++i) {
        read_item("mission.items." + std::to_string(i), (*items)[i]);
      }
    }
  }

  void read_item(const std::string& path, const Json& item) {
    const Json* const type = member(item, "type");
    if (type != nullptr && *type == "SimpleItem") {
      read_simple(path, item);
    } else if (type != nullptr && *type == "ComplexItem") {
      read_complex(path, item);
    } else {
      reject(path + ".type", type, "\"SimpleItem\" or \"ComplexItem\"");
    }
  }

  void read_simple(const std::string& path, const Json& from) {
    MissionItem item;
    item.command =
        static_cast<std::uint16_t>(whole(path + ".command", member(from, "command"), 65535));
    item.frame = static_cast<std::uint8_t>(whole(path + ".frame", member(from, "frame"), 21));
    if (const Json* next = member(from, "autoContinue"); next != nullptr) {
      if (!next->is_boolean()) reject(path + ".autoContinue", next, "true or false");
      item.autocontinue = *next != false;
    }
    const Json* const parameters = member(from, "params");
    if (parameters == nullptr || !parameters->is_array() || parameters->size() != 7) {
      return reject(path + ".params", parameters, "an array of 7 numbers or null");
    }
    const auto read = [&](std::size_t i, double limit, double absent) {
      const Json& value = (*parameters)[i];
      if (value.is_null()) return absent;
      return number(path + ".params." + std::to_string(i), &value, limit);
    };
    for (std::size_t i = 0; i < item.parameters.size(); ++i) {
      item.parameters[i] =
          static_cast<float>(read(i, kMostParameter, std::numeric_limits<double>::quiet_NaN()));
    }
    const bool global = is_global(item.frame);
    item.x = read(4, global ? 90.0 : kMostMetres, 0.0);
    item.y = read(5, global ? 180.0 : kMostMetres, 0.0);
    item.z = static_cast<float>(read(6, kMostHeightM, 0.0));
    add(item);
  }

  void read_complex(const std::string& path, const Json& item) {
    const Json* const transect = member(item, "TransectStyleComplexItem");
    const Json* const items = transect == nullptr ? nullptr : member(*transect, "Items");
    const Json* const type = member(item, "complexItemType");
    if (items != nullptr && items->is_array()) {
      const std::string inner = path + ".TransectStyleComplexItem.Items.";
      for (std::size_t i = 0; i < items->size() && !error_; ++i) {
        read_simple(inner + std::to_string(i), (*items)[i]);
      }
    } else if (type != nullptr && *type == "fwLandingPattern") {
      read_landing(path, item);
    } else {
      reject(path + ".complexItemType",
             type,
             "a survey or corridor with its items, or \"fwLandingPattern\"");
    }
  }

  /// What QGroundControl sends to the vehicle for it: the mark of the landing sequence, a descent
  /// in circles or a waypoint at the approach, the landing.
  void read_landing(const std::string& path, const Json& item) {
    const auto is_on = [&](const char* name, bool absent) {
      const Json* const value = member(item, name);
      return value == nullptr ? absent : *value == true;
    };
    const std::uint8_t frame = is_on("altitudesAreRelative", true) ? kGlobalAboveHome : kGlobal;
    const char* const approach = item.contains("landingApproachCoordinate")
                                     ? "landingApproachCoordinate"
                                     : "loiterCoordinate";
    MissionItem mark;
    mark.frame = 2;
    mark.command = kDoLandStart;
    add(mark);
    const bool circles = is_on("useLoiterToAlt", true);
    add_place(circles ? kNavLoiterToAlt : kNavWaypoint,
              frame,
              place(path + "." + approach, member(item, approach)));
    if (circles) {
      const double radius = number(path + ".loiterRadius", member(item, "loiterRadius"), 10000.0);
      const double side = is_on("loiterClockwise", true) ? 1.0 : -1.0;
      stored_.items.back().parameters = {
          1.0F, static_cast<float>(side * std::abs(radius)), 0.0F, 1.0F};
    }
    add_place(kNavLand, frame, place(path + ".landCoordinate", member(item, "landCoordinate")));
  }

  void add_place(std::uint16_t command, std::uint8_t frame, const Eigen::Vector3d& at) {
    MissionItem item;
    item.command = command;
    item.frame = frame;
    item.x = at.x();
    item.y = at.y();
    item.z = static_cast<float>(at.z());
    add(item);
  }
  void add(const MissionItem& item) {
    if (stored_.items.size() == kMaxMissionItems) {
      return fail("more than " + std::to_string(kMaxMissionItems) + " mission items");
    }
    stored_.items.push_back(item);
  }

  void warn_of_rest(const Json& plan) {
    const auto count = [&](const char* part, const char* list) {
      const Json* const outer = member(plan, part);
      const Json* const inner = outer == nullptr ? nullptr : member(*outer, list);
      return inner != nullptr && inner->is_array() ? inner->size() : 0;
    };
    if (const std::size_t n = count("geoFence", "polygons") + count("geoFence", "circles"); n > 0) {
      stored_.warnings.push_back(origin_ + ": the geofence is not used, " + std::to_string(n) +
                                 (n == 1 ? " area" : " areas"));
    }
    if (const std::size_t n = count("rallyPoints", "points"); n > 0) {
      stored_.warnings.push_back(origin_ + ": rally points are not used, " + std::to_string(n));
    }
  }

  const std::string origin_;
  StoredMission stored_;
  std::optional<Error> error_;
};

/// The shortest decimal that gives the same float again.
Json decimal(float value) {
  if (!std::isfinite(value)) return nullptr;
  std::array<char, 64> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  double number = 0.0;
  (void)std::from_chars(text.data(), end, number);
  return number;
}

Json plan_item(const MissionItem& item, std::size_t number) {
  Json parameters = Json::array();
  for (const float value : item.parameters) parameters.push_back(decimal(value));
  parameters.insert(parameters.end(), {Json(item.x), Json(item.y), decimal(item.z)});
  return {{"type", "SimpleItem"},
          {"autoContinue", item.autocontinue},
          {"command", item.command},
          {"doJumpId", number},
          {"frame", item.frame},
          {"params", std::move(parameters)}};
}

}  // namespace

std::string plan_text(const std::vector<MissionItem>& items) {
  const MissionItem& home = items.front();
  Json list = Json::array();
  for (std::size_t i = 1; i < items.size(); ++i) list.push_back(plan_item(items[i], i));
  const Json plan = {
      {"fileType", "Plan"},
      {"version", 1},
      {"groundStation", "Overfly"},
      {"geoFence", {{"circles", Json::array()}, {"polygons", Json::array()}, {"version", 2}}},
      {"rallyPoints", {{"points", Json::array()}, {"version", 2}}},
      {"mission",
       {{"cruiseSpeed", 25},
        {"firmwareType", 3},
        {"globalPlanAltitudeMode", 1},
        {"hoverSpeed", 5},
        {"vehicleType", 1},
        {"version", 2},
        {"items", std::move(list)},
        {"plannedHomePosition", {home.x, home.y, decimal(home.z)}}}}};
  constexpr int kIndent = 4;
  return plan.dump(kIndent) + "\n";
}

Result<StoredMission> parse_plan(std::string_view text, const std::string& origin) {
  const Result<Json> plan = json_from_outside<Json>(text, origin);
  if (!plan) return plan.error();
  return PlanReader(origin).read(*plan);
}

}  // namespace overfly::flight::mavlink
