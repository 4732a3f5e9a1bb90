#include "server/engine/scenario_document.hpp"

#include <set>
#include <utility>

#include "server/engine/scenario_layers.hpp"

namespace overfly::engine {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

flight::CourseParameters course_from(const Json& course) {
  flight::CourseParameters parameters;
  parameters.airspeed_m_s = course.at("airspeed_m_s").get<double>();
  parameters.roll_rate_max_rad_s = rad_from_deg(course.at("roll_rate_max_deg_s").get<double>());
  parameters.height_agl_m = course.at("height_agl_m").get<double>();
  parameters.bank_max_rad = rad_from_deg(course.at("bank_max_deg").get<double>());
  parameters.length_m = course.at("length_m").get<double>();
  parameters.leg_length_m = course.at("leg_length_m").get<double>();
  return parameters;
}

Status read_flight(Json& document, const FileResolver& files, Scenario& scenario) {
  Json& flight = document.at("flight");
  if (flight.contains("log")) {
    Json& log = flight.at("log");
    scenario.flight =
        Scenario::LoggedFlight{files.resolve(log.at("file")), log.at("camera_poses").get<bool>()};
    return {};
  }
  const Json& course = flight.at("course");
  flight::CourseParameters parameters = course_from(course);
  if (!(parameters.leg_length_m < parameters.length_m)) {
    return Error{
        ErrorCode::kInvalidArgument,
        "flight.course.leg_length_m = " + course.at("leg_length_m").dump() +
            ": must be less than flight.course.length_m = " + course.at("length_m").dump()};
  }
  const Json& start = course.at("start");
  scenario.start_at_runway = !start.is_object();
  if (start.is_object()) {
    parameters.start_east_m = start.at("east_m").get<double>();
    parameters.start_north_m = start.at("north_m").get<double>();
  }
  if (course.contains("heading_deg")) {
    scenario.course_heading_rad = rad_from_deg(course.at("heading_deg").get<double>());
  }
  scenario.flight = parameters;
  return {};
}

Status read_camera(Json& document, Scenario& scenario) {
  Json& camera = document.at("camera");
  const int width = camera.at("width_px").get<int>();
  const int height = camera.at("height_px").get<int>();
  const Result<FrameRate> rate = FrameRate::from_hz(camera.at("rate_hz").get<double>());
  if (!rate) return rate.error().in("camera");
  scenario.rate = *rate;
  if (camera.contains("fx_px")) {
    if (camera.contains("fov_deg") || camera.contains("fov_axis")) {
      return Error{ErrorCode::kInvalidArgument,
                   "camera.fx_px = " + camera.at("fx_px").dump() +
                       ": must not be given with camera.fov_deg or camera.fov_axis"};
    }
    PinholeCamera given;
    given.width_px = width;
    given.height_px = height;
    given.fx_px = camera.at("fx_px").get<double>();
    given.fy_px = camera.at("fy_px").get<double>();
    given.cx_px = camera.value("cx_px", 0.5 * (width - 1));
    given.cy_px = camera.value("cy_px", 0.5 * (height - 1));
    scenario.cameras.front().model = given;
    const Status valid = given.validate();
    return valid ? Status{} : Status{valid.error().in("camera")};
  }
  constexpr double kPaperFovDeg = 84.872;
  if (!camera.contains("fov_deg")) camera["fov_deg"] = kPaperFovDeg;
  if (!camera.contains("fov_axis")) camera["fov_axis"] = "horizontal";
  const std::string axis_name = camera.at("fov_axis").get<std::string>();
  const FovAxis axis = axis_name == "vertical"   ? FovAxis::kVertical
                       : axis_name == "diagonal" ? FovAxis::kDiagonal
                                                 : FovAxis::kHorizontal;
  const double fov_rad = rad_from_deg(camera.at("fov_deg").get<double>());
  const Result<PinholeCamera> made = PinholeCamera::from_fov(width, height, fov_rad, axis);
  if (!made) return made.error().in("camera");
  scenario.cameras.front().model = *made;
  return {};
}

Status read_estimators(const Json& document, Scenario& scenario) {
  std::set<std::string> names;
  for (const Json& entry : document.at("estimators")) {
    EstimatorSpec spec;
    spec.name = entry.at("name").get<std::string>();
    spec.type = entry.at("type").get<std::string>();
    spec.parameters = entry.at("parameters").get<std::map<std::string, double>>();
    if (!names.insert(spec.name).second) {
      return Error{ErrorCode::kInvalidArgument,
                   "estimators." + std::to_string(scenario.estimators.size()) + ".name = \"" +
                       spec.name + "\": must be unique"};
    }
    scenario.estimators.push_back(std::move(spec));
  }
  return {};
}

Status read_all(Json& document, const fs::path& base, Scenario& scenario) {
  const FileResolver files(document, base);
  scenario.name = document.at("name").get<std::string>();
  if (!document.contains("title")) document["title"] = scenario.name;
  scenario.title = document.at("title").get<std::string>();
  scenario.description = document.at("description").get<std::string>();
  scenario.seed = document.at("seed").get<std::uint64_t>();
  if (document.contains("epoch_utc_s")) {
    scenario.epoch_utc_ns = document.at("epoch_utc_s").get<std::int64_t>() * kNsPerS;
  }
  scenario.duration_s = number_or_none(document, "duration_s");
  scenario.pacing = document.at("pacing") == "real_time" ? Pacing::kRealTime : Pacing::kLockstep;
  scenario.record_frames = document.at("recording").at("frames").get<bool>();
  scenario.record_debug_hz = document.at("recording").at("debug_hz").get<double>();
  read_world(document, files, scenario);
  if (Status status = read_flight(document, files, scenario); !status) return status;
  if (Status status = read_camera(document, scenario); !status) return status;
  return read_estimators(document, scenario);
}

}  // namespace

Result<Scenario> scenario_from(Json document, const fs::path& base) {
  Scenario scenario;
  try {
    if (Status status = read_all(document, base, scenario); !status) return status.error();
  } catch (const Json::exception& error) {
    // The schema let through what this reader does not know: a bug, but not one to die of.
    return Error{ErrorCode::kInternal,
                 std::string("scenario schema and reader differ: ") + error.what()};
  }
  scenario.resolved = std::move(document);
  return scenario;
}

}  // namespace overfly::engine
