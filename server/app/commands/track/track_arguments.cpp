#include "server/app/commands/track/track_arguments.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

#include "server/scenario/document/estimators/estimator_entry.hpp"
#include "server/scenario/document/scenario_file.hpp"
#include "server/scenario/document/scenario_override.hpp"
#include "server/scenario/scenario.hpp"

namespace overfly::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

Error bad_option(const std::string& option, const std::string& value, const std::string& limit) {
  return {ErrorCode::kInvalidArgument, option + " " + value + ": must be " + limit};
}

/// Comma-separated finite numbers; empty if one is invalid.
std::optional<std::vector<double>> numbers_in(std::string_view text) {
  std::vector<double> numbers;
  while (true) {
    const std::size_t comma = std::min(text.find(','), text.size());
    const std::string_view item = text.substr(0, comma);
    double value = 0.0;
    const auto [end, error] = std::from_chars(item.data(), item.data() + item.size(), value);
    if (error != std::errc() || end != item.data() + item.size() || !std::isfinite(value)) {
      return std::nullopt;
    }
    numbers.push_back(value);
    if (comma == text.size()) return numbers;
    text.remove_prefix(comma + 1);
  }
}

/// The object of one of a scenario's estimators, with the absolute path of its program.
Result<Json> scenario_entry(const std::string& text) {
  std::string file = text;
  std::string name;
  std::error_code ignored;
  const std::size_t colon = text.rfind(':');
  if (!fs::exists(file, ignored) && colon != std::string::npos) {
    file = text.substr(0, colon);
    name = text.substr(colon + 1);
  }
  const Result<server::Scenario> scenario = server::load_scenario(file);
  if (!scenario) return scenario.error();
  std::string known;
  for (const Json& entry : scenario->resolved.at("estimators")) {
    const std::string its_name = entry.at("name").get<std::string>();
    known += (known.empty() ? "" : ", ") + its_name;
    if (its_name != name && !name.empty()) continue;
    if (name.empty() && scenario->estimators.size() > 1) continue;
    Json found = entry;
    // These fields refer to the scenario's flight.
    found.erase("camera");
    found.erase("throttle_hz");
    return found;
  }
  return bad_option(
      "--scenario-estimator",
      text,
      known.empty() ? "a scenario with an estimator" : "FILE:NAME with a NAME of " + known);
}

Result<Json> base_entry(const TrackArguments& arguments) {
  if (!arguments.scenario_estimator.empty()) return scenario_entry(arguments.scenario_estimator);
  const bool outside = !arguments.command.empty() || !arguments.listen.empty();
  std::string type = arguments.estimator;
  if (type.empty()) type = outside ? "process" : "feature";
  return Json{{"name", type}, {"type", type}};
}

}  // namespace

Result<PinholeCamera> pinhole_from_text(const std::string& text) {
  const auto numbers = numbers_in(text);
  if (!numbers || (numbers->size() != 4 && numbers->size() != 6)) {
    return bad_option("--camera", text, "FX,FY,CX,CY or FX,FY,CX,CY,WIDTH,HEIGHT in pixels");
  }
  const auto& n = *numbers;
  PinholeCamera camera{0, 0, n[0], n[1], n[2], n[3]};
  if (n.size() == 4) return camera;
  for (const double side : {n[4], n[5]}) {
    if (side < 1.0 || side > 65536.0 || side != std::floor(side)) {
      return bad_option("--camera", text, "of a WIDTH and HEIGHT in [1, 65536]");
    }
  }
  camera.width_px = static_cast<int>(n[4]);
  camera.height_px = static_cast<int>(n[5]);
  return camera;
}

Result<Distortion> distortion_from_text(const std::string& text) {
  const std::string form = "none, radtan:K1,K2,P1,P2[,K3], equidistant:K1,K2,K3,K4 or fov:W";
  const std::size_t colon = std::min(text.find(':'), text.size());
  const auto model = distortion_model_from(text.substr(0, colon));
  if (!model) return bad_option("--distortion", text, form);
  Distortion lens;
  lens.model = *model;
  if (lens.none()) {
    if (colon != text.size()) return bad_option("--distortion", text, form);
    return lens;
  }
  const auto k = numbers_in(std::string_view(text).substr(std::min(colon + 1, text.size())));
  const auto most = static_cast<std::size_t>(coefficient_count(lens.model));
  const std::size_t least = lens.model == DistortionModel::kRadtan ? 4 : most;
  if (!k || k->size() < least || k->size() > most) return bad_option("--distortion", text, form);
  std::copy(k->begin(), k->end(), lens.k.begin());
  return lens;
}

Result<std::vector<std::string>> words_of(const std::string& text) {
  std::vector<std::string> words;
  bool in_word = false;
  char quote = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    char c = text[i];
    if (quote == 0 && (c == ' ' || c == '\t' || c == '\n')) {
      in_word = false;
      continue;
    }
    if (!in_word) words.emplace_back();
    in_word = true;
    if (c == quote) {
      quote = 0;
    } else if (quote == 0 && (c == '"' || c == '\'')) {
      quote = c;
    } else {
      if (c == '\\' && quote != '\'' && i + 1 < text.size()) c = text[++i];
      words.back() += c;
    }
  }
  if (quote == 0) return words;
  return bad_option("--command", text, std::string("without an open ") + quote);
}

Result<server::DatasetOptions> dataset_options_from(const TrackArguments& arguments) {
  server::DatasetOptions options;
  options.folder = arguments.images;
  options.camera_name = arguments.camera_name;
  options.sample_bits = arguments.sample_bits;
  if (!arguments.layout.empty()) options.layout = server::dataset_layout_from(arguments.layout);
  if (!arguments.times.empty()) options.times = arguments.times;
  if (arguments.time_unit == "s") options.time_unit = server::TimeUnit::kSeconds;
  if (arguments.time_unit == "ns") options.time_unit = server::TimeUnit::kNanoseconds;
  Distortion lens;
  if (!arguments.distortion.empty()) {
    const Result<Distortion> read = distortion_from_text(arguments.distortion);
    if (!read) return read.error();
    if (arguments.camera.empty()) {
      return bad_option("--distortion", arguments.distortion, "given together with --camera");
    }
    lens = *read;
  }
  if (!arguments.camera.empty()) {
    const Result<PinholeCamera> pinhole = pinhole_from_text(arguments.camera);
    if (!pinhole) return pinhole.error();
    options.camera = CameraModel(*pinhole, lens);
  }
  return options;
}

Result<server::EstimatorSpec> estimator_from(const TrackArguments& arguments) {
  Result<Json> entry = base_entry(arguments);
  if (!entry) return entry.error();
  if (!arguments.command.empty()) {
    const auto words = words_of(arguments.command);
    if (!words) return words.error();
    (*entry)["command"] = *words;
  }
  if (!arguments.listen.empty()) (*entry)["listen"] = arguments.listen;
  for (const std::string& text : arguments.parameters) {
    const Result<server::Override> parameter = server::parse_override(text);
    if (!parameter) return parameter.error().in("--parameter");
    // Names may contain dots, so this is not a path.
    (*entry)["parameters"][parameter->path] = parameter->value;
  }
  for (const std::string& text : arguments.sets) {
    const Result<server::Override> change = server::parse_override(text);
    if (!change) return change.error().in("--set");
    if (Status status = server::apply_override(*change, *entry); !status) {
      return status.error().in("--set");
    }
  }
  return server::estimator_from_json(std::move(*entry), fs::current_path());
}

}  // namespace overfly::app
