#include "server/logs/log_library.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/motion/pose.hpp"
#include "core/time.hpp"
#include "flight/logs/truth/log_trajectory.hpp"
#include "server/files/file_stamp.hpp"
#include "server/logs/log_info.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;
namespace logs = flight::logs;
using Json = nlohmann::json;

std::string limit_text(const std::optional<std::int64_t>& t_ns) {
  return t_ns ? std::to_string(*t_ns) : "-";
}

/// A column of a table; `factor` converts the unit, `steps` are kept in one unit.
Json column(const std::vector<SeriesPoint>& points,
            std::size_t channel,
            double factor,
            double steps) {
  Json values = Json::array();
  for (const SeriesPoint& point : points) {
    values.push_back(std::round(point.values[channel] * factor * steps) / steps);
  }
  return values;
}

Json times(const std::vector<SeriesPoint>& points) {
  Json values = Json::array();
  for (const SeriesPoint& point : points) values.push_back(s_from_ns(point.t_ns));
  return values;
}

Json series_json(const logs::LogSeries& series) {
  constexpr double kStepsPerDeg = 1e7;
  constexpr double kStepsPerMetre = 1e3;
  constexpr double kStepsPerAngle = 1e3;
  Json positions = {{"t_s", times(series.positions)}};
  if (series.georeferenced) {
    positions["lat_deg"] = column(series.positions, 0, 1.0, kStepsPerDeg);
    positions["lon_deg"] = column(series.positions, 1, 1.0, kStepsPerDeg);
    const bool ellipsoid = series.height == logs::HeightDatum::kEllipsoid;
    positions[ellipsoid ? "alt_ellipsoid_m" : "alt_msl_m"] =
        column(series.positions, 2, 1.0, kStepsPerMetre);
  } else {
    positions["north_m"] = column(series.positions, 0, 1.0, kStepsPerMetre);
    positions["east_m"] = column(series.positions, 1, 1.0, kStepsPerMetre);
    positions["above_origin_m"] = column(series.positions, 2, 1.0, kStepsPerMetre);
  }
  const double to_deg = deg_from_rad(1.0);
  Json steps = Json::array();
  for (const logs::LogStep& step : series.steps) {
    steps.push_back({{"t_s", s_from_ns(step.t_ns)}, {"size_m", step.size_m}});
  }
  return {{"position_source", series.position_source},
          {"attitude_source",
           series.attitude_source.empty() ? Json(nullptr) : Json(series.attitude_source)},
          {"vehicle", series.vehicle},
          {"run", series.run},
          {"georeferenced", series.georeferenced},
          {"position_count", series.position_count},
          {"attitude_count", series.attitude_count},
          {"positions", std::move(positions)},
          {"speeds",
           {{"t_s", times(series.speeds)},
            {"ground_speed_m_s", column(series.speeds, 0, 1.0, kStepsPerMetre)}}},
          {"attitudes",
           {{"t_s", times(series.attitudes)},
            {"roll_deg", column(series.attitudes, 0, to_deg, kStepsPerAngle)},
            {"pitch_deg", column(series.attitudes, 1, to_deg, kStepsPerAngle)},
            {"yaw_deg", column(series.attitudes, 2, to_deg, kStepsPerAngle)}}},
          {"steps", std::move(steps)}};
}

Json entry_json(const LogEntry& entry) {
  return {{"name", entry.name},
          {"file", entry.file.string()},
          {"format", entry.format},
          {"size_bytes", entry.size_bytes},
          {"uploaded", entry.uploaded}};
}

}  // namespace

LogLibrary::LogLibrary(std::function<ServedFolders()> folders,
                       const fs::path& uploads_folder,
                       const UploadLimits& limits)
    : folders_(std::move(folders)), uploads_(uploads_folder, limits) {}

ServedFolders LogLibrary::folders() const {
  ServedFolders folders = folders_();
  folders.uploads = uploads_.folder();
  return folders;
}

Json LogLibrary::list() {
  const LogList list = places_.list(folders());
  Json entries = Json::array();
  for (const LogEntry& entry : list.logs) entries.push_back(entry_json(entry));
  return {{"logs", std::move(entries)}, {"complete", list.complete}, {"uploads", uploads_json()}};
}

Json LogLibrary::uploads_json(std::uint64_t max_bytes) const {
  const UploadLimits& limits = uploads_.limits();
  const bool on = !uploads_.folder().empty() && limits.quota_bytes > 0;
  return {{"used_bytes", uploads_.used_bytes()},
          {"quota_bytes", on ? limits.quota_bytes : 0},
          {"max_bytes", on ? std::min({limits.max_bytes, limits.quota_bytes, max_bytes}) : 0}};
}

Result<LogPoses> LogLibrary::trajectory(const std::string& name,
                                        const std::string& source,
                                        std::size_t max_poses,
                                        const std::atomic<bool>* cancel) {
  const ServedFolders where = folders();
  const Result<fs::path> file = LogPlaces::find(where, name);
  if (!file) return file.error();
  std::string key;
  const Result<Opened> log = open(*file, {}, where.sources, cancel, key);
  if (!log) return log.error();
  const Result<logs::TruthChoice> truth = logs::choose_truth(**log, source);
  if (!truth) return truth.error();
  const logs::StreamInfo& positions = (*log)->streams[truth->position];
  if (positions.positions > max_poses) {
    return Error{ErrorCode::kUnreadable,
                 "log " + name + ": " + positions.description.name + " has " +
                     std::to_string(positions.positions) + " positions: must have at most " +
                     std::to_string(max_poses)};
  }
  logs::TrajectoryRequest request;
  request.source = source;
  auto poses = logs::read_log_trajectory(**log, request, cancel);
  if (!poses) return poses.error();
  return LogPoses{logs::world_trajectory(*poses), std::move(poses->warnings)};
}

Result<LogLibrary::Opened> LogLibrary::open(const fs::path& file,
                                            const logs::LogSlice& slice,
                                            const SourcePolicy& sources,
                                            const std::atomic<bool>* cancel,
                                            std::string& key) {
  const Result<std::vector<fs::path>> files = logs::files_of_log(file);
  if (!files) return files.error();
  for (const fs::path& piece : *files) {
    if (Status status = sources.check(piece, "log (a file that it names)"); !status) {
      return status.error();
    }
  }
  key = content_key(*files) + limit_text(slice.from_ns) + ' ' + limit_text(slice.to_ns);
  if (Opened known = opened_.find(key)) return known;
  Result<logs::OpenedLog> log = logs::open_log(file, cancel, {.sources = sources, .slice = slice});
  if (!log) return log.error();
  auto opened = std::make_shared<const logs::OpenedLog>(std::move(*log));
  opened_.keep(key, opened);
  return opened;
}

Result<Json> LogLibrary::info(const std::string& name,
                              const logs::LogSlice& slice,
                              const std::atomic<bool>* cancel) {
  const ServedFolders where = folders();
  const Result<fs::path> file = LogPlaces::find(where, name);
  if (!file) return file.error();
  std::string key;
  const Result<Opened> log = open(*file, slice, where.sources, cancel, key);
  if (!log) return log.error();
  Json json = log_info_json(**log);
  json["name"] = name;
  return json;
}

Result<Json> LogLibrary::series(const std::string& name,
                                const SeriesRequest& request,
                                const std::atomic<bool>* cancel) {
  const ServedFolders where = folders();
  const Result<fs::path> file = LogPlaces::find(where, name);
  if (!file) return file.error();
  std::string key;
  const Result<Opened> log = open(*file, request.slice, where.sources, cancel, key);
  if (!log) return log.error();
  key += '\n' + request.source + '\n' + std::to_string(request.max_points);
  if (const auto known = series_.find(key)) return *known;
  // Each interval keeps at most two points for each of three values.
  logs::LogSeriesRequest wanted{request.source, (request.max_points - 2) / (2 * kSeriesChannels)};
  const Result<logs::LogSeries> series = logs::read_log_series(**log, wanted, cancel);
  if (!series) return series.error();
  auto json = std::make_shared<const Json>(series_json(*series));
  series_.keep(key, json);
  return *json;
}

Result<Json> LogLibrary::residuals(const std::string& name,
                                   const ResidualRequest& request,
                                   const std::atomic<bool>* cancel,
                                   const flight::smoothing::SmoothingProgress& progress) {
  const ServedFolders where = folders();
  const Result<fs::path> file = LogPlaces::find(where, name);
  if (!file) return file.error();
  std::string key;
  const Result<Opened> log = open(*file, request.slice, where.sources, cancel, key);
  if (!log) return log.error();
  const std::string offset =
      request.time_offset_s ? std::to_string(*request.time_offset_s) : "auto";
  key += '\n' + request.source + '\n' + std::to_string(request.max_points) + '\n' + offset;
  if (const auto known = residuals_.find(key)) return *known;
  Result<Json> found = log_residuals(**log, request, cancel, progress);
  if (!found) return found;
  residuals_.keep(key, std::make_shared<const Json>(*found));
  return found;
}

Json LogLibrary::entry_of(const fs::path& upload) const {
  const auto format = logs::detect_format(upload);
  const FileStamp stamp = FileStamp::of(upload);
  return entry_json({std::string(kUploadsLabel) + "/" +
                         upload.lexically_relative(uploads_.folder()).generic_string(),
                     upload,
                     format ? logs::to_string(*format) : "",
                     static_cast<std::uint64_t>(stamp.size_bytes),
                     true});
}

Status LogLibrary::remove(const std::string& name) {
  const Result<fs::path> file = LogPlaces::find(folders(), name);
  if (!file) return file.error();
  return uploads_.remove(*file);
}

}  // namespace overfly::server
