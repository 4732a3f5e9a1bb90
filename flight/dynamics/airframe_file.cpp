#include "flight/dynamics/airframe_file.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>
#include <vector>

#include "core/motion/pose.hpp"
#include "core/outside/file_text.hpp"
#include "core/outside/outside_json.hpp"
#include "core/text/number_text.hpp"
#include "flight/dynamics/aerodynamics.hpp"
#include "flight/dynamics/environment.hpp"

namespace overfly::dynamics {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint64_t kMaxFileBytes = 1U << 20U;
constexpr std::size_t kMaxTextLength = 2000;

Error airframe_error(const std::string& origin, const std::string& fault) {
  return {ErrorCode::kInvalidArgument, origin + ": " + fault};
}

/// A value of the document, cut to a line for a message.
std::string shown(const Json& value) {
  std::string text = value.dump(-1, ' ', true, Json::error_handler_t::replace);
  if (text.size() > 60) text = text.substr(0, 57) + "...";
  return text;
}

/// Reads the fields of an airframe once each, keeps the first error, and remembers which members of
/// the document were asked for.
class FieldReader {
 public:
  FieldReader(const Json& document, std::string origin)
      : document_(document), origin_(std::move(origin)) {}

  /// A number in [low, high]. @param path  "group.field" or "field"
  void number(const std::string& path, double& value, double low, double high) {
    const Json* found = find(path);
    if (found == nullptr) return;
    const double read = found->is_number() ? found->get<double>() : std::nan("");
    if (!(read >= low && read <= high)) {
      return fail(path + " = " + shown(*found) + ": must be a number in [" + number_text(low) +
                  ", " + number_text(high) + "]");
    }
    value = read;
  }
  void angle(const std::string& path, double& value_rad, double low_deg, double high_deg) {
    double value_deg = deg_from_rad(value_rad);
    number(path, value_deg, low_deg, high_deg);
    value_rad = rad_from_deg(value_deg);
  }
  void text(const std::string& path, std::string& value) {
    const Json* found = find(path);
    if (found == nullptr) return;
    if (!found->is_string() || found->get_ref<const std::string&>().empty() ||
        found->get_ref<const std::string&>().size() > kMaxTextLength) {
      return fail(path + " = " + shown(*found) + ": must be a text of 1 to " +
                  std::to_string(kMaxTextLength) + " bytes");
    }
    value = found->get<std::string>();
  }
  /// A condition between fields.
  void require(bool holds, const std::string& fault) {
    if (!holds) fail(fault);
  }
  /// After all fields: no other member may be left.
  Status finish() {
    check_unknown(document_, "");
    if (!fault_.empty()) return airframe_error(origin_, fault_);
    return {};
  }

 private:
  const Json* find(const std::string& path) {
    asked_.insert(path);
    const Json* at = &document_;
    std::size_t begin = 0;
    while (begin <= path.size()) {
      const std::size_t end = std::min(path.find('.', begin), path.size());
      const std::string name = path.substr(begin, end - begin);
      if (begin > 0) asked_.insert(path.substr(0, begin - 1));
      if (!at->is_object() || !at->contains(name)) {
        fail(path + " is missing");
        return nullptr;
      }
      at = &(*at)[name];
      begin = end + 1;
    }
    return at;
  }
  void check_unknown(const Json& object, const std::string& prefix) {
    for (const auto& [name, value] : object.items()) {
      const std::string path = prefix + name;
      if (!asked_.contains(path)) {
        return fail(shown(path) + " is not a field of an airframe");
      }
      if (value.is_object()) check_unknown(value, path + ".");
    }
  }
  void fail(const std::string& fault) {
    if (fault_.empty()) fault_ = fault;
  }

  const Json& document_;
  std::string origin_;
  std::string fault_;
  std::set<std::string> asked_;
};

/// "FIELD = VALUE: must be at least LIMIT (REASON)".
std::string below(const std::string& path, double value, double limit, const std::string& reason) {
  return path + " = " + number_text(value) + ": must be at least " + number_text(limit) + " (" +
         reason + ")";
}

void read_mass(FieldReader& reader, Airframe& airframe) {
  reader.number("mass_kg", airframe.mass_kg, 0.05, 2000.0);
  reader.number("wing.area_m2", airframe.wing.area_m2, 0.01, 200.0);
  reader.number("wing.span_m", airframe.wing.span_m, 0.1, 50.0);
  reader.number("wing.chord_m", airframe.wing.chord_m, 0.02, 10.0);
  Inertia& inertia = airframe.inertia;
  reader.number("inertia_kg_m2.xx", inertia.xx, 1e-6, 1e6);
  reader.number("inertia_kg_m2.yy", inertia.yy, 1e-6, 1e6);
  reader.number("inertia_kg_m2.zz", inertia.zz, 1e-6, 1e6);
  reader.number("inertia_kg_m2.xz", inertia.xz, -1e6, 1e6);
  // The principal moments of a body are positive, and none exceeds the sum of the other two. Those
  // of x and z are m +- d.
  const double m = 0.5 * (inertia.xx + inertia.zz);
  const double d = std::hypot(0.5 * (inertia.xx - inertia.zz), inertia.xz);
  reader.require(m - d > 0.0 && 2.0 * m >= inertia.yy && inertia.yy >= 2.0 * d,
                 "inertia_kg_m2: no body has these moments (one principal moment exceeds the sum "
                 "of the other two, or is not positive)");
  // Lighter or more slender than any aircraft: motions too fast for the integrator.
  const double least_mass = 0.5 * airframe.wing.area_m2;
  reader.require(airframe.mass_kg >= least_mass,
                 below("mass_kg", airframe.mass_kg, least_mass, "0.5 kg per m^2 of wing"));
  const double roll_arm = 0.05 * airframe.wing.span_m;
  const double pitch_arm = std::max(0.02 * airframe.wing.span_m, 0.2 * airframe.wing.chord_m);
  const double least_roll = airframe.mass_kg * roll_arm * roll_arm;
  const double least_pitch = airframe.mass_kg * pitch_arm * pitch_arm;
  reader.require(m - d >= least_roll,
                 below("inertia_kg_m2: least moment about x and z",
                       m - d,
                       least_roll,
                       "a radius of gyration of 5 % of the span"));
  reader.require(inertia.yy >= least_pitch,
                 below("inertia_kg_m2.yy",
                       inertia.yy,
                       least_pitch,
                       "a radius of gyration of 2 % of the span and 20 % of the chord"));
}

void read_aerodynamics(FieldReader& reader, Airframe& airframe) {
  reader.number("lift.zero", airframe.lift.zero, -1.0, 2.0);
  reader.number("lift.alpha", airframe.lift.alpha, 0.5, 7.0);
  reader.number("lift.pitch_rate", airframe.lift.pitch_rate, -20.0, 50.0);
  reader.number("lift.elevator", airframe.lift.elevator, -2.0, 2.0);
  reader.number("drag.parasite", airframe.drag.parasite, 0.0, 0.5);
  reader.number("drag.oswald", airframe.drag.oswald, 0.3, 1.2);
  reader.number("drag.elevator", airframe.drag.elevator, 0.0, 1.0);
  reader.angle("stall.alpha_deg", airframe.stall.alpha_rad, 3.0, 60.0);
  reader.number("stall.sharpness", airframe.stall.sharpness, 5.0, 500.0);
  reader.number("pitch.zero", airframe.pitch.zero, -1.0, 1.0);
  reader.number("pitch.alpha", airframe.pitch.alpha, -20.0, 5.0);
  reader.number("pitch.pitch_rate", airframe.pitch.pitch_rate, -100.0, -0.1);
  reader.number("pitch.elevator", airframe.pitch.elevator, -10.0, -0.001);
  for (const auto& [name, group] :
       {std::pair<std::string, LateralCoefficients*>{"side", &airframe.side},
        {"roll", &airframe.roll},
        {"yaw", &airframe.yaw}}) {
    reader.number(name + ".beta", group->beta, -2.0, name == "side" ? 0.0 : 2.0);
    reader.number(name + ".roll_rate", group->roll_rate, -2.0, name == "roll" ? -0.01 : 2.0);
    reader.number(name + ".yaw_rate", group->yaw_rate, -2.0, name == "yaw" ? -0.001 : 2.0);
    reader.number(name + ".aileron", group->aileron, name == "roll" ? 0.001 : -2.0, 2.0);
    reader.number(name + ".rudder", group->rudder, -2.0, name == "yaw" ? -0.0001 : 2.0);
  }
}

void read_propulsion(FieldReader& reader, Airframe& airframe) {
  Propulsion& propulsion = airframe.propulsion;
  reader.number("propulsion.diameter_m", propulsion.diameter_m, 0.02, 5.0);
  reader.number("propulsion.thrust.zero", propulsion.thrust.zero, 0.001, 1.0);
  reader.number("propulsion.thrust.linear", propulsion.thrust.linear, -2.0, 2.0);
  reader.number("propulsion.thrust.quadratic", propulsion.thrust.quadratic, -2.0, 0.0);
  reader.number("propulsion.torque.zero", propulsion.torque.zero, 0.0001, 1.0);
  reader.number("propulsion.torque.linear", propulsion.torque.linear, -2.0, 2.0);
  reader.number("propulsion.torque.quadratic", propulsion.torque.quadratic, -2.0, -1e-6);
  reader.number("propulsion.motor_constant_v_s_rad", propulsion.motor_constant_v_s_rad, 1e-4, 10.0);
  reader.number("propulsion.motor_resistance_ohm", propulsion.motor_resistance_ohm, 1e-4, 100.0);
  reader.number("propulsion.no_load_current_a", propulsion.no_load_current_a, 0.0, 100.0);
  reader.number("propulsion.battery_v", propulsion.battery_v, 0.1, 1000.0);
  // Without power the propeller turns no faster than without torque. There it must brake.
  const PropellerCurve& q = propulsion.torque;
  const PropellerCurve& t = propulsion.thrust;
  const double free_ratio =
      (q.linear + std::sqrt(q.linear * q.linear - 4.0 * q.zero * q.quadratic)) /
      (-2.0 * q.quadratic);
  reader.require(t.zero + t.linear * free_ratio + t.quadratic * free_ratio * free_ratio <= 0.0,
                 "propulsion: the thrust coefficient is positive at the advance ratio " +
                     number_text(free_ratio) +
                     ", where the torque is zero: the propeller would drive without power");
  const double tip_m_s =
      propulsion.battery_v / propulsion.motor_constant_v_s_rad * 0.5 * propulsion.diameter_m;
  reader.require(tip_m_s <= 340.0,
                 "propulsion: the propeller's tips move at " + number_text(tip_m_s) +
                     " m/s without load: must be at most 340");
  const double static_n = propeller(propulsion, 0.0, 1.0, 1.225).thrust_n;
  const double most_n = 20.0 * kStandardGravityMS2 * airframe.mass_kg;
  reader.require(static_n <= most_n && t.zero >= q.zero,
                 "propulsion: static thrust of " + number_text(static_n) + " N, coefficients " +
                     number_text(t.zero) + " and " + number_text(q.zero) +
                     " of thrust and torque: must be at most " + number_text(most_n) +
                     " N (20 times the weight), with more thrust than torque");
}

void read_surface(FieldReader& reader, const std::string& name, SurfaceLimits& surface) {
  const std::string group = "actuators." + name;
  reader.angle(group + ".min_deg", surface.min_rad, -90.0, 0.0);
  reader.angle(group + ".max_deg", surface.max_rad, 0.0, 90.0);
  reader.require(surface.min_rad < 0.0 && surface.max_rad > 0.0,
                 group + ": must move to both sides: min_deg below 0, max_deg above 0");
  reader.angle(group + ".rate_deg_s", surface.rate_rad_s, 1.0, 10000.0);
  reader.number(group + ".lag_s", surface.lag_s, 0.001, 5.0);
}

}  // namespace

Result<Airframe> parse_airframe(std::string_view text, const std::string& origin) {
  const Result<Json> document = json_from_outside<Json>(text, origin);
  if (!document) return document.error();
  if (!document->is_object()) return airframe_error(origin, "must be a JSON object");
  Airframe airframe;
  FieldReader reader(*document, origin);
  reader.text("name", airframe.name);
  reader.text("source", airframe.source);
  read_mass(reader, airframe);
  read_aerodynamics(reader, airframe);
  read_propulsion(reader, airframe);
  read_surface(reader, "elevator", airframe.elevator);
  read_surface(reader, "aileron", airframe.aileron);
  read_surface(reader, "rudder", airframe.rudder);
  reader.number("actuators.throttle.rate_1_s", airframe.throttle.rate_1_s, 0.01, 1000.0);
  reader.number("actuators.throttle.lag_s", airframe.throttle.lag_s, 0.001, 10.0);
  if (Status status = reader.finish(); !status) return status.error();
  return airframe;
}

Result<Airframe> read_airframe(const std::filesystem::path& file) {
  const Result<std::string> text = read_file_text(file, kMaxFileBytes);
  if (!text) return text.error();
  return parse_airframe(*text, file.string());
}

}  // namespace overfly::dynamics
