#include "server/app/commands/doctor/doctor_checks.hpp"

#include <unistd.h>

#include <cstdlib>
#include <system_error>

#include "middleware/lcm/findings.hpp"
#include "middleware/ros1/findings.hpp"
#include "renderer/renderer.hpp"
#include "server/app/install_paths.hpp"
#include "server/scenario/document/scenario_list.hpp"
#include "terrain/raster/installation.hpp"

namespace overfly::app {
namespace {

namespace fs = std::filesystem;

Check check_drawing() {
  const Result<renderer::RendererInfo> egl = renderer::probe_egl();
  if (!egl) {
    return {"drawing (EGL)",
            CheckLevel::kFault,
            egl.error().message,
            "apt-get install libegl1 libegl-mesa0 libgl1 libgl1-mesa-dri"};
  }
  return {
      "drawing (EGL)",
      CheckLevel::kOk,
      egl->device + ", OpenGL " + egl->gl_version + (egl->software ? " (software rendering)" : ""),
      ""};
}

Check check_devices() {
  std::string text;
  bool fault = false;
  for (const renderer::GraphicsDevice& device : renderer::list_graphics_devices()) {
    text += (text.empty() ? "" : "; ") + std::to_string(device.index) + " = ";
    if (!device.pci_address.empty()) text += device.pci_address + ", ";
    fault = fault || !device.fault.empty();
    text += device.fault.empty() ? device.info.device : "does not work (" + device.fault + ")";
    if (device.fault.empty() && device.info.software) text += " (software)";
  }
  const char* const name = "devices (EGL)";
  if (text.empty()) return {name, CheckLevel::kOk, "none to choose from", ""};
  if (!fault) return {name, CheckLevel::kOk, text, ""};
  return {name,
          CheckLevel::kWarning,
          text,
          "check the driver's EGL library and the rights of /dev/dri/*, /dev/nvidia*"};
}

Check check_raster_drivers() {
  const terrain::Installation found = terrain::probe_installation();
  std::string missing;
  for (const std::string& name : found.missing_drivers) missing += " " + name;
  if (!found.geotiff_jpeg) missing += " JPEG-in-GTiff";
  if (missing.empty()) return {"rasters (GDAL)", CheckLevel::kOk, "GDAL " + found.gdal_version, ""};
  const bool geotiff_gone = missing.find(" GTiff") != std::string::npos;
  return {"rasters (GDAL)",
          geotiff_gone ? CheckLevel::kFault : CheckLevel::kWarning,
          "GDAL " + found.gdal_version + " lacks the drivers" + missing,
          "apt-get install --reinstall libgdal32, and unset GDAL_SKIP and GDAL_DRIVER_PATH"};
}

Check check_projections() {
  if (terrain::probe_installation().projection_database) {
    return {"projections (PROJ)", CheckLevel::kOk, "database found", ""};
  }
  return {"projections (PROJ)",
          CheckLevel::kFault,
          "the database proj.db cannot be read",
          "apt-get install proj-data, and unset PROJ_LIB and PROJ_DATA"};
}

/// The nearest existing folder at or above a path.
fs::path existing_parent(fs::path folder) {
  std::error_code ignored;
  while (!fs::exists(folder, ignored) && folder.has_relative_path()) folder = folder.parent_path();
  return folder;
}

Check check_folder(const std::string& name,
                   const fs::path& folder,
                   std::uintmax_t wanted_bytes,
                   const std::string& remedy) {
  std::error_code failure;
  const fs::path place = existing_parent(fs::absolute(folder, failure));
  if (access(place.c_str(), W_OK | X_OK) != 0 || !fs::is_directory(place, failure)) {
    return {name, CheckLevel::kFault, folder.string() + ": cannot be written to", remedy};
  }
  const fs::space_info space = fs::space(place, failure);
  const std::string free_text =
      failure ? "unknown space" : std::to_string(space.available >> 20U) + " MiB free";
  if (!failure && space.available < wanted_bytes) {
    return {name,
            CheckLevel::kWarning,
            folder.string() + ": only " + free_text,
            "free at least " + std::to_string(wanted_bytes >> 20U) + " MiB, or " + remedy};
  }
  return {name, CheckLevel::kOk, folder.string() + ": writable, " + free_text, ""};
}

/// Where the built-in worlds are stored (terrain/synthesize.hpp).
fs::path cache_folder() {
  const auto variable = [](const char* name) -> std::string {
    const char* value = std::getenv(name);
    return value != nullptr ? value : "";
  };
  if (std::string own = variable("OVERFLY_CACHE"); !own.empty()) return own;
  if (const std::string xdg = variable("XDG_CACHE_HOME"); !xdg.empty()) {
    return fs::path(xdg) / "overfly";
  }
  return fs::path(variable("HOME")) / ".cache" / "overfly";
}

Check check_dashboard() {
  const fs::path web = web_folder();
  if (!web.empty()) return {"dashboard", CheckLevel::kOk, web.string(), ""};
  return {"dashboard",
          CheckLevel::kWarning,
          "not built: `overfly serve` answers REST and WebSocket only",
          "run scripts/build, or name its folder with --web"};
}

Check check_scenarios() {
  const fs::path folder = scenarios_folder();
  const auto entries = server::list_scenarios(folder);
  if (entries.empty()) {
    return {"scenarios",
            CheckLevel::kWarning,
            folder.string() + ": none found",
            "name their folder with --scenarios"};
  }
  std::string blocked;
  for (const auto& entry : entries) {
    if (!entry.error.empty()) blocked += (blocked.empty() ? "" : ", ") + entry.name;
  }
  const std::string found = folder.string() + ": " + std::to_string(entries.size());
  if (blocked.empty()) return {"scenarios", CheckLevel::kOk, found, ""};
  return {"scenarios",
          CheckLevel::kWarning,
          found + ", of which cannot be flown here: " + blocked,
          "`overfly scenario list` shows the reasons; OVERFLY_DATA sets the data folder"};
}

Check check_lcm() {
  const lcm::Findings found = lcm::findings();
  return {"estimators on LCM",
          found.usable ? CheckLevel::kOk : CheckLevel::kWarning,
          found.finding,
          found.remedy};
}

Check check_ros1() {
  const ros1::Findings found = ros1::findings();
  return {"estimators on ROS 1",
          found.works ? CheckLevel::kOk : CheckLevel::kWarning,
          found.finding,
          found.remedy};
}

}  // namespace

std::vector<Check> all_checks(const fs::path& runs_folder) {
  constexpr std::uintmax_t kWorldBytes = std::uintmax_t{1} << 30U;
  constexpr std::uintmax_t kRunBytes = std::uintmax_t{256} << 20U;
  return {check_drawing(),
          check_devices(),
          check_raster_drivers(),
          check_projections(),
          check_folder("cache of built-in worlds",
                       cache_folder(),
                       kWorldBytes,
                       "set OVERFLY_CACHE to another folder"),
          check_folder("run folders", runs_folder, kRunBytes, "name another folder"),
          check_dashboard(),
          check_scenarios(),
          check_lcm(),
          check_ros1()};
}

nlohmann::json json_from(const std::vector<Check>& checks) {
  nlohmann::json list = nlohmann::json::array();
  for (const Check& check : checks) {
    const char* level = check.level == CheckLevel::kOk        ? "ok"
                        : check.level == CheckLevel::kWarning ? "warning"
                                                              : "fault";
    list.push_back({{"name", check.name},
                    {"level", level},
                    {"finding", check.finding},
                    {"remedy", check.remedy}});
  }
  return {{"checks", std::move(list)}};
}

}  // namespace overfly::app
