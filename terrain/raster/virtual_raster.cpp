#include "terrain/raster/virtual_raster.hpp"

#include <cpl_error.h>
#include <cpl_minixml.h>
#include <gdal_priv.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "core/outside/file_text.hpp"
#include "core/outside/source_policy.hpp"
#include "core/text/lower_case.hpp"
#include "terrain/files/side_cars.hpp"
#include "terrain/raster/crs_text.hpp"
#include "terrain/raster/gdal_messages.hpp"

namespace overfly::terrain {
namespace fs = std::filesystem;
namespace {

constexpr std::uint64_t kMaxBytes = std::uint64_t{64} << 20U;
constexpr int kMaxElementDepth = 32;
constexpr std::size_t kMaxFileDepth = 16;  ///< overviews of overviews of a long strip need ten

/// Elements of https://gdal.org/drivers/raster/vrt.html that compute nothing from code and name no
/// file except SourceFilename, whose text is checked; in lower case.
/// GDAL compares names in a description without case.
constexpr std::string_view kElements =
    " vrtdataset srs geotransform gcplist gcp metadata mdi blockxsize blockysize overviewlist "
    "overview maskband vrtrasterband colorinterp nodatavalue hidenodatavalue colortable entry "
    "description unittype offset scale categorynames category simplesource averagedsource "
    "complexsource kernelfilteredsource nodatafrommasksource sourcefilename sourceband "
    "sourceproperties srcrect dstrect scaleoffset scaleratio colortablecomponent exponent "
    "srcmin srcmax dstmin dstmax clamp lut nodata usemaskband maskvaluethreshold remappedvalue "
    "kernel size coefs histograms histitem histmin histmax bucketcount includeoutofrange "
    "approximate histcounts gdalrasterattributetable fielddefn name type usage "
    "row f openoptions ooi ";

using Xml = std::unique_ptr<CPLXMLNode, decltype(&CPLDestroyXMLNode)>;

class Description {
 public:
  /// @param file  its symbolic links resolved, since GDAL also resolves names relative to a link's
  ///              target
  Description(const fs::path& file, SideCars& side_cars)
      : file_(file),
        folder_(file.parent_path()),
        inside_(SourcePolicy::inside({folder_})),
        side_cars_(side_cars) {}

  /// Errors: as check_virtual_raster.
  Status read() {
    const Result<std::string> text = read_file_text(file_, kMaxBytes);
    if (!text) return text.error();
    const GdalMessages messages;
    const Xml xml(CPLParseXMLString(text->c_str()), &CPLDestroyXMLNode);
    if (!xml) return refuse("is not XML that can be read");
    return check_list(xml.get(), 0);
  }
  [[nodiscard]] const std::set<fs::path>& sources() const { return sources_; }

 private:
  [[nodiscard]] Error refuse(const std::string& why) const {
    return {ErrorCode::kUnreadable, file_.string() + ": " + why};
  }

  Status check_list(const CPLXMLNode* node, int depth) {
    if (depth > kMaxElementDepth) return refuse("its elements are nested too deep");
    for (; node != nullptr; node = node->psNext) {
      if (node->eType != CXT_Element) continue;
      if (Status status = check_element(*node); !status) return status;
      if (Status status = check_list(node->psChild, depth + 1); !status) return status;
    }
    return {};
  }

  Status check_element(const CPLXMLNode& node) {
    const std::string name = lower_case(node.pszValue);
    if (name.starts_with("?") || name.starts_with("!")) return {};  // the declaration of XML
    if (kElements.find(" " + name + " ") == std::string_view::npos) {
      return refuse("a virtual raster may not have the element " + name.substr(0, 40));
    }
    const std::string kind = CPLGetXMLValue(&node, "subClass", "VRTSourcedRasterBand");
    if (lower_case(kind) != "vrtsourcedrasterband") {
      return refuse("a virtual raster may not be a " + kind.substr(0, 40));
    }
    const std::string option = CPLGetXMLValue(&node, "key", "");
    if (name == "ooi" && lower_case(option) != "overview_level") {
      return refuse("a virtual raster may not open its sources with " + option.substr(0, 40));
    }
    if (name == "srs") return check_crs(CPLGetXMLValue(&node, nullptr, ""));
    if (name == "gcplist") return check_crs(CPLGetXMLValue(&node, "Projection", ""));
    return name == "sourcefilename" ? check_source(node) : Status{};
  }

  [[nodiscard]] Status check_crs(const std::string& text) const {
    if (text.empty()) return {};
    Status status = check_crs_text(text, "SRS");
    return status ? status : Status(status.error().in(file_.string()));
  }

  Status check_source(const CPLXMLNode& node) {
    const std::string text = CPLGetXMLValue(&node, nullptr, "");
    const bool relative = std::string(CPLGetXMLValue(&node, "relativeToVRT", "0")) == "1";
    if (relative && names_.count(text) > 0) return {};
    const fs::path source = text;
    const bool plain = relative && text.find_first_of(":<\"?") == std::string::npos &&
                       !source.empty() && source.is_relative();
    const fs::path place = (folder_ / source).lexically_normal();
    const Status inside = plain ? inside_.check(place, "SourceFilename") : Status{};
    if (!plain || (!inside && inside.error().code == ErrorCode::kInvalidArgument)) {
      return refuse(
          "is made of a file that is not named relative to it (relativeToVRT=\"1\") and "
          "inside its folder: " +
          text.substr(0, 200));
    }
    if (!inside) {
      return Error{ErrorCode::kNotFound, place.string() + ": no such file"}.in(file_.string() +
                                                                               ": is made of");
    }
    if (Status side_cars = side_cars_.check(place, "SourceFilename", inside_); !side_cars) {
      return refuse("a file next to one of its sources leads out of its folder: " +
                    text.substr(0, 200));
    }
    // GDAL replaces the link's name by its target's, which may be absolute.
    std::error_code failed;
    if (fs::is_symlink(place, failed) && is_virtual_raster(place)) {
      return refuse("is made of a virtual raster that is a symbolic link: " + text.substr(0, 200));
    }
    names_.insert(text);
    sources_.insert(fs::weakly_canonical(place, failed));  // checked just before
    return {};
  }

  fs::path file_;
  fs::path folder_;
  SourcePolicy inside_;
  SideCars& side_cars_;
  std::set<std::string> names_;  ///< checked names
  std::set<fs::path> sources_;
};

/// @param whole_of  the rasters that contain this one
/// @param sound  those that were checked successfully
Status check_tree(const fs::path& file,
                  std::set<fs::path>& whole_of,
                  std::set<fs::path>& sound,
                  SideCars& side_cars) {
  if (sound.count(file) > 0 || !is_virtual_raster(file)) return {};
  if (!whole_of.insert(file).second || whole_of.size() > kMaxFileDepth) {
    return Error{ErrorCode::kUnreadable,
                 file.string() + ": a virtual raster is made of itself, or of others more than " +
                     std::to_string(kMaxFileDepth) + " deep"};
  }
  Description description(file, side_cars);
  if (Status status = description.read(); !status) return status;
  for (const fs::path& source : description.sources()) {
    if (Status status = check_tree(source, whole_of, sound, side_cars); !status) {
      return status.error().in(file.string() + ": is made of");
    }
  }
  whole_of.erase(file);
  sound.insert(file);
  return {};
}

/// See CheckedName; empty: none.
std::string& checked_name() {
  thread_local std::string name;
  return name;
}

/// GDAL's own functions.
int (*identify)(GDALOpenInfo*) = nullptr;
GDALDataset* (*open_unchecked)(GDALOpenInfo*) = nullptr;

GDALDataset* open_checked(GDALOpenInfo* info) {
  // Looks at what GDAL has read. Names of FIFOs and devices come here as well, of which GDAL sees
  // nothing (regular_files.hpp); to open one here would wait for its writer.
  if (identify(info) == 0) return nullptr;
  const std::string name = info->pszFilename;
  if (name != checked_name()) {
    // GDAL also takes a description in place of a name.
    if (!is_virtual_raster(name)) return nullptr;
    if (const Status status = check_virtual_raster(name); !status) {
      CPLError(CE_Failure, CPLE_OpenFailed, "%s", status.error().message.c_str());
      return nullptr;
    }
  }
  return open_unchecked(info);
}

}  // namespace

void restrict_virtual_rasters() {
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("VRT");
  if (driver == nullptr || driver->pfnOpen == &open_checked) return;
  identify = driver->pfnIdentify;
  open_unchecked = driver->pfnOpen;
  driver->pfnOpen = &open_checked;
}

CheckedName::CheckedName(const fs::path& name) { checked_name() = name.string(); }

CheckedName::~CheckedName() { checked_name().clear(); }

bool is_virtual_raster(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::string head(1024, '\0');
  in.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(in.gcount()));
  return lower_case(std::move(head)).find("<vrtdataset") != std::string::npos;
}

Status check_virtual_raster(const fs::path& file) {
  std::set<fs::path> whole_of;
  std::set<fs::path> sound;
  SideCars side_cars;
  std::error_code failed;
  const fs::path place = fs::weakly_canonical(file, failed);
  if (failed) return Error{ErrorCode::kIo, file.string() + ": " + failed.message()};
  return check_tree(place, whole_of, sound, side_cars);
}

}  // namespace overfly::terrain
