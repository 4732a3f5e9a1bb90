// sensor.yaml of the ASL layout: `key: value` and `key: [list]` lines, lists over several lines.
// Only this subset of YAML, which is all that files of the format use.
#include <Eigen/LU>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <string_view>

#include "core/outside/file_text.hpp"
#include "server/dataset/dataset_reader.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;

struct Entry {
  int line = 0;
  std::string value;  ///< without comment; a whole list on one line
};

std::string trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return std::string(text.substr(first, text.find_last_not_of(" \t\r") - first + 1));
}

/// Every `key: value`; nested ones by their inner key ("data" of T_BS).
std::map<std::string, Entry> entries_of(const std::string& text) {
  std::map<std::string, Entry> entries;
  std::string open;  // key of a list whose bracket is not closed yet
  int number = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    std::string line = text.substr(begin, end - begin);
    begin = end + 1;
    ++number;
    line = trimmed(line.substr(0, line.find('#')));
    if (!open.empty()) {
      entries[open].value += " " + line;
      if (line.find(']') != std::string::npos) open.clear();
      continue;
    }
    const std::size_t colon = line.find(':');
    if (colon == std::string::npos) continue;
    const std::string key = trimmed(line.substr(0, colon));
    const std::string value = trimmed(line.substr(colon + 1));
    entries[key] = {number, value};
    if (value.starts_with('[') && value.find(']') == std::string::npos) open = key;
  }
  return entries;
}

class SensorFile {
 public:
  SensorFile(fs::path file, const std::string& text)
      : file_(std::move(file)), entries_(entries_of(text)) {}

  [[nodiscard]] Error bad(const std::string& key, const std::string& what) const {
    const auto entry = entries_.find(key);
    if (entry == entries_.end()) {
      return {ErrorCode::kUnreadable, file_.string() + ": " + key + ": " + what};
    }
    return {ErrorCode::kUnreadable,
            file_.string() + ":" + std::to_string(entry->second.line) + ": " + key + ": " +
                entry->second.value + ": " + what};
  }

  [[nodiscard]] bool has(const std::string& key) const { return entries_.contains(key); }

  [[nodiscard]] Result<std::string> text(const std::string& key) const {
    const auto entry = entries_.find(key);
    if (entry == entries_.end()) return bad(key, "is missing");
    return entry->second.value;
  }

  /// A list of `least` to `most` finite numbers.
  [[nodiscard]] Result<std::vector<double>> numbers(const std::string& key,
                                                    std::size_t least,
                                                    std::size_t most) const {
    const Result<std::string> list = text(key);
    if (!list) return list.error();
    if (!list->starts_with('[') || !list->ends_with(']')) return bad(key, "must be a [list]");
    std::vector<double> values;
    for (std::size_t begin = 1; begin < list->size();) {
      const std::size_t end = std::min(list->find(',', begin), list->size() - 1);
      const std::string item = trimmed(std::string_view(*list).substr(begin, end - begin));
      double value = 0.0;
      const auto [stop, error] = std::from_chars(item.data(), item.data() + item.size(), value);
      if (error != std::errc() || stop != item.data() + item.size() || !std::isfinite(value)) {
        return bad(key, "'" + item + "' must be a finite number");
      }
      values.push_back(value);
      begin = end + 1;
    }
    if (values.size() >= least && values.size() <= most) return values;
    return bad(key,
               std::to_string(values.size()) + " numbers: must be " + std::to_string(least) +
                   (least == most ? "" : " to " + std::to_string(most)));
  }

 private:
  fs::path file_;
  std::map<std::string, Entry> entries_;
};

Result<Distortion> distortion_of(const SensorFile& file) {
  Distortion lens;
  if (!file.has("distortion_model")) return lens;
  const std::string name = *file.text("distortion_model");
  if (name == "none") return lens;
  if (name == "radial-tangential" || name == "radtan" || name == "plumb_bob") {
    lens.model = DistortionModel::kRadtan;
  } else if (name == "equidistant" || name == "fov") {
    lens.model = *distortion_model_from(name);
  } else {
    return file.bad("distortion_model", "must be radial-tangential, equidistant, fov or none");
  }
  const auto most = static_cast<std::size_t>(coefficient_count(lens.model));
  // Radial-tangential without k3 is customary in this format.
  const std::size_t least = lens.model == DistortionModel::kRadtan ? 4 : most;
  const auto k = file.numbers("distortion_coefficients", least, most);
  if (!k) return k.error();
  // A pinhole, for which the format has no name.
  const bool all_zero = std::all_of(k->begin(), k->end(), [](double c) { return c == 0.0; });
  if (lens.model == DistortionModel::kRadtan && all_zero) return Distortion{};
  std::copy(k->begin(), k->end(), lens.k.begin());
  return lens;
}

Result<Pose> mount_of(const SensorFile& file) {
  if (!file.has("data")) return Pose{};
  const auto v = file.numbers("data", 16, 16);
  if (!v) return v.error();
  const auto& n = *v;
  Eigen::Matrix3d R;
  R << n[0], n[1], n[2], n[4], n[5], n[6], n[8], n[9], n[10];
  if ((R.transpose() * R - Eigen::Matrix3d::Identity()).norm() > 1e-2 || R.determinant() < 0.0) {
    return file.bad("data", "T_BS must be a rigid transform");
  }
  return Pose{Eigen::Quaterniond(R).normalized(), {n[3], n[7], n[11]}};
}

}  // namespace

Result<EurocSensor> read_euroc_sensor(const fs::path& path) {
  constexpr std::uint64_t kMaxBytes = std::uint64_t{1} << 20U;
  const Result<std::string> text = read_file_text(path, kMaxBytes);
  if (!text) return text.error();
  const SensorFile file(path, *text);
  if (file.has("camera_model") && *file.text("camera_model") != "pinhole") {
    return file.bad("camera_model", "must be pinhole");
  }
  const auto intrinsics = file.numbers("intrinsics", 4, 4);
  if (!intrinsics) return intrinsics.error();
  const auto size = file.numbers("resolution", 2, 2);
  if (!size) return size.error();
  const Result<Distortion> lens = distortion_of(file);
  if (!lens) return lens.error();
  const Result<Pose> mount = mount_of(file);
  if (!mount) return mount.error();
  constexpr double kLargestSizePx = 65536.0;
  for (const double side : *size) {
    if (!(side >= 1.0 && side <= kLargestSizePx) || side != std::floor(side)) {
      return file.bad("resolution", "must be whole numbers in [1, 65536]");
    }
  }
  const auto& k = *intrinsics;
  const PinholeCamera pinhole{
      static_cast<int>((*size)[0]), static_cast<int>((*size)[1]), k[0], k[1], k[2], k[3]};
  const CameraModel camera(pinhole, *lens);
  if (Status status = camera.validate(); !status) {
    return Error{ErrorCode::kUnreadable, path.string() + ": " + status.error().message};
  }
  return EurocSensor{camera, *mount};
}

}  // namespace overfly::server
