#include "terrain/files/outside_access.hpp"

#include <cpl_http.h>
#include <cpl_string.h>
#include <cpl_vsi_virtual.h>
#include <gdal_priv.h>
#include <ogr_srs_api.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "terrain/files/network.hpp"

namespace overfly::terrain {
namespace {

/// Raster formats of one local file (and side-cars of its name). Excluded are formats that name
/// other files or addresses inside (WMS, MRF, ERS, HDF5 with external storage, ...), databases, and
/// text formats that are read completely when opened.
constexpr std::array<std::string_view, 20> kDrivers = {
    "GTiff", "COG",     "VRT",     "MEM",    "PNG",         "JPEG", "BMP",
    "PNM",   "GIF",     "WEBP",    "JPEGXL", "JP2OpenJPEG", "HFA",  "EHdr",
    "ENVI",  "AAIGrid", "SRTMHGT", "DTED",   "USGSDEM",     "SAGA"};

/// GDAL's own drivers need these for data in memory.
constexpr std::array<std::string_view, 3> kFileSystems = {
    "/vsimem/", "/vsisubfile/", "/vsisparse/"};

/// An empty file system.
class ClosedFileSystem final : public VSIFilesystemHandler {
 public:
  VSIVirtualHandle* Open(const char* name, const char*, bool, CSLConstList) override {
    CPLError(CE_Failure, CPLE_NotSupported, "%.200s: only plain local files are read", name);
    errno = ENOENT;
    return nullptr;
  }
  int Stat(const char*, VSIStatBufL*, int) override {
    errno = ENOENT;
    return -1;
  }
};

template <typename Names>
bool is_among(const Names& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

void remove_drivers() {
  GDALDriverManager& manager = *GetGDALDriverManager();
  for (int i = manager.GetDriverCount() - 1; i >= 0; --i) {
    GDALDriver* driver = manager.GetDriver(i);
    if (is_among(kDrivers, driver->GetDescription())) continue;
    manager.DeregisterDriver(driver);
    GDALDestroyDriver(driver);
  }
}

void close_file_systems() {
  // GDAL owns the installed handler; the replaced one may still be in use.
  static std::vector<VSIFilesystemHandler*> replaced;
  const CPLStringList prefixes(VSIFileManager::GetPrefixes());
  for (int i = 0; i < prefixes.size(); ++i) {
    const std::string prefix = prefixes[i];
    if (is_among(kFileSystems, prefix)) continue;
    replaced.push_back(VSIFileManager::GetHandler(prefix.c_str()));
    VSIFileManager::InstallHandler(prefix, new ClosedFileSystem());
  }
}

CPLHTTPResult* refuse_fetch(
    const char* url, CSLConstList, GDALProgressFunc, void*, CPLHTTPFetchWriteFunc, void*, void*) {
  auto* result = static_cast<CPLHTTPResult*>(CPLCalloc(1, sizeof(CPLHTTPResult)));
  result->nStatus = 1;
  result->pszErrBuf = CPLStrdup("network access is disabled in this program");
  CPLError(CE_Failure, CPLE_NotSupported, "%.200s: %s", url, result->pszErrBuf);
  return result;
}

}  // namespace

void close_outside_access() {
  remove_drivers();
  close_file_systems();
}

void turn_network_off() {
  // PROJ's own contexts follow the environment, those of GDAL follow its switch.
  ::setenv("PROJ_NETWORK", "OFF", 1);
  OSRSetPROJEnableNetwork(FALSE);
  CPLHTTPSetFetchCallback(&refuse_fetch, nullptr);
}

}  // namespace overfly::terrain
