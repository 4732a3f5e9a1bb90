#include "server/app/commands/doctor/doctor_camera.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <system_error>
#include <vector>

#include "server/app/exit_code.hpp"
#include "server/app/stop_signal.hpp"
#include "server/camera/camera_check.hpp"
#include "server/scenario/document/scenario_file.hpp"

namespace overfly::app {
namespace {

namespace fs = std::filesystem;

/// A temporary folder, removed by the destructor.
class WorkFolder {
 public:
  WorkFolder()
      : path_(fs::temp_directory_path() / ("overfly-camera-" + std::to_string(getpid()))) {}
  ~WorkFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;
  [[nodiscard]] const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

struct Findings {
  std::vector<server::CameraCheckRow> rows;
  /// Backends that do not work on this machine, with the reason.
  std::vector<std::string> left_out;

  [[nodiscard]] bool passed() const {
    return !rows.empty() &&
           std::all_of(rows.begin(), rows.end(), [](const auto& row) { return row.fault.empty(); });
  }
};

Result<Findings> check_scenario_file(const DoctorCameraArguments& arguments,
                                     const server::CameraCheckOptions& options) {
  const auto scenario = server::load_scenario(arguments.scenario);
  if (!scenario) return scenario.error();
  auto rows = server::check_camera(*scenario, options);
  if (!rows) return rows.error();
  return Findings{std::move(*rows), {}};
}

/// Runs every backend over the same terrain, so that a difference shows which one is wrong.
Result<Findings> check_backends(const server::CameraCheckOptions& options) {
  const WorkFolder work;
  auto scenario = server::camera_check_scenario(work.path());
  if (!scenario) return scenario.error();
  Findings findings;
  for (const char* backend : {"raycast", "egl"}) {
    scenario->renderer.camera = backend;
    const auto rows = server::check_camera(*scenario, options);
    if (!rows && rows.error().code == ErrorCode::kUnsupported) {
      findings.left_out.push_back(std::string(backend) + ": " + rows.error().message);
    } else if (!rows) {
      return rows.error();
    } else {
      findings.rows.insert(findings.rows.end(), rows->begin(), rows->end());
    }
  }
  return findings;
}

nlohmann::json json_from(const Findings& findings, double limit_px) {
  nlohmann::json rows = nlohmann::json::array();
  for (const server::CameraCheckRow& row : findings.rows) {
    nlohmann::json pairs = nlohmann::json::array();
    for (const server::CameraCheckPair& pair : row.pairs) {
      const renderer::Registration& residual = pair.residual;
      pairs.push_back({{"frame", pair.frame},
                       {"patches", residual.patches},
                       {"lost", residual.lost},
                       {"median_px", residual.median_px},
                       {"p95_px", residual.p95_px},
                       {"mean_px", {residual.mean_px.x(), residual.mean_px.y()}},
                       {"median_grey", residual.median_grey},
                       {"p95_grey", residual.p95_grey}});
    }
    rows.push_back({{"camera", row.camera},
                    {"backend", row.backend},
                    {"worst_median_px", row.worst_median_px},
                    {"worst_p95_px", row.worst_p95_px},
                    {"fault", row.fault},
                    {"pairs", std::move(pairs)}});
  }
  return {{"limit_px", limit_px},
          {"passed", findings.passed()},
          {"left_out", findings.left_out},
          {"cameras", std::move(rows)}};
}

void print_camera_table(const Findings& findings, double limit_px) {
  std::printf("%-16s %-8s %7s %8s %10s %8s %10s %8s\n",
              "camera",
              "backend",
              "frame",
              "patches",
              "median px",
              "p95 px",
              "mean px",
              "grey");
  for (const server::CameraCheckRow& row : findings.rows) {
    for (const server::CameraCheckPair& pair : row.pairs) {
      const renderer::Registration& r = pair.residual;
      std::printf("%-16s %-8s %7lld %8d %10.4f %8.4f %+.3f%+.3f %8.2f\n",
                  row.camera.c_str(),
                  row.backend.c_str(),
                  static_cast<long long>(pair.frame),
                  r.patches,
                  r.median_px,
                  r.p95_px,
                  r.mean_px.x(),
                  r.mean_px.y(),
                  r.median_grey);
    }
    if (!row.fault.empty()) {
      std::printf(
          "FAULT   %s, %s: %s\n", row.camera.c_str(), row.backend.c_str(), row.fault.c_str());
    }
  }
  for (const std::string& text : findings.left_out) std::printf("skipped %s\n", text.c_str());
  std::printf(findings.passed()
                  ? "Depth and pose map each image onto the next within %g px (median).\n"
                  : "Depth and pose do NOT map each image onto the next within %g px (median).\n",
              limit_px);
}

}  // namespace

int check_cameras(const DoctorCameraArguments& arguments) {
  server::CameraCheckOptions options;
  options.pairs = arguments.pairs;
  options.limit_px = arguments.limit_px;
  options.cancel = &catch_stop_signals();
  options.notice = [](const std::string& text) { std::cerr << text << "\n"; };
  const Result<Findings> findings = arguments.scenario.empty()
                                        ? check_backends(options)
                                        : check_scenario_file(arguments, options);
  if (!findings) return report(findings.error());
  if (arguments.json) {
    std::cout << json_from(*findings, arguments.limit_px).dump(2) << "\n";
  } else {
    print_camera_table(*findings, arguments.limit_px);
  }
  return findings->passed() ? kExitOk : kExitUnsupported;
}

}  // namespace overfly::app
