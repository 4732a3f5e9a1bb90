#include "terrain/download/chunk.hpp"

#include <cpl_vsi.h>

#include <array>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/outside/outside_json.hpp"
#include "terrain/place/map_plane.hpp"
#include "terrain/raster/georeference.hpp"

namespace overfly::terrain::download {
namespace fs = std::filesystem;

namespace {

using Kind = Verdict::Kind;

/// A file name in GDAL's memory for the bytes of an answer, while this object lives.
class MemoryFile {
 public:
  explicit MemoryFile(const std::vector<std::uint8_t>& bytes)
      : name_("/vsimem/overfly_chunk_" + std::to_string(reinterpret_cast<std::uintptr_t>(this))) {
    // GDAL does not write to memory that it does not own.
    auto* data = const_cast<GByte*>(bytes.data());
    VSIFCloseL(VSIFileFromMemBuffer(name_.c_str(), data, bytes.size(), FALSE));
  }
  ~MemoryFile() { VSIUnlink(name_.c_str()); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  [[nodiscard]] const char* name() const { return name_.c_str(); }

 private:
  std::string name_;
};

DatasetPtr open_image(const char* name) {
  // No sibling listing, no remote or virtual formats: the answer is untrusted data.
  const std::array<const char*, 7> drivers = {
      "GTiff", "PNG", "JPEG", "WEBP", "GIF", "BMP", nullptr};
  return DatasetPtr(
      GDALDataset::Open(name, GDAL_OF_RASTER | GDAL_OF_READONLY, drivers.data(), nullptr, nullptr));
}

/// True if coordinates in both CRSs differ by less than a centimetre around a point.
bool same_place(const OGRSpatialReference& a, const OGRSpatialReference& b, double x, double y) {
  if (a.IsSame(&b) != 0) return true;
  GdalMessages quiet;
  const auto transform = CrsTransform::create(a, b, "chunk");
  Eigen::Matrix2Xd point(2, 1);
  point << x, y;
  if (!transform || !(*transform)->apply(point)) return false;
  constexpr double kSameM = 0.01;
  return std::hypot(point(0, 0) - x, point(1, 0) - y) < kSameM;
}

Verdict judge_place(GDALDataset& dataset, const ChunkLayer& layer, const Chunk& chunk) {
  double g[6] = {};
  if (dataset.GetGeoTransform(g) != CE_None) {
    return {Kind::kFailed, "the received image has no georeference"};
  }
  const double left = layer.left + chunk.column_px * layer.pixel;
  const double top = layer.top - chunk.row_px * layer.pixel;
  // A hundredth of a pixel over the whole chunk.
  const double hair = 0.01 * layer.pixel;
  const bool here =
      std::abs(g[0] - left) < hair && std::abs(g[3] - top) < hair &&
      std::abs(g[0] + g[1] * chunk.width_px - left - layer.pixel * chunk.width_px) < hair &&
      std::abs(g[3] + g[5] * chunk.height_px - top + layer.pixel * chunk.height_px) < hair &&
      g[2] == 0.0 && g[4] == 0.0;
  if (!here) {
    char text[256];
    std::snprintf(
        text,
        sizeof(text),
        "the received image has another place: corner %.3f, %.3f with pixels of %.6g, %.6g; "
        "requested %.3f, %.3f with %.6g",
        g[0],
        g[3],
        g[1],
        g[5],
        left,
        top,
        layer.pixel);
    return {Kind::kFailed, text};
  }
  const OGRSpatialReference* crs = dataset.GetSpatialRef();
  if (crs == nullptr) return {};
  OGRSpatialReference asked;
  asked.SetFromUserInput(layer.crs.c_str());
  asked.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  OGRSpatialReference came(*crs);
  came.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  if (!same_place(came, asked, left, top)) {
    return {Kind::kFailed,
            std::string("the received image has the coordinate reference system ") +
                came.GetName() + ", requested " + layer.crs};
  }
  return {};
}

/// Reads every block, which detects a truncated body.
Verdict judge_blocks(GDALDataset& dataset) {
  GdalMessages messages;
  for (int number = 1; number <= dataset.GetRasterCount(); ++number) {
    GDALRasterBand* band = dataset.GetRasterBand(number);
    int width = 0;
    int height = 0;
    band->GetBlockSize(&width, &height);
    std::vector<std::uint8_t> block(static_cast<std::size_t>(width) * height *
                                    GDALGetDataTypeSizeBytes(band->GetRasterDataType()));
    const int columns = (dataset.GetRasterXSize() + width - 1) / width;
    const int rows = (dataset.GetRasterYSize() + height - 1) / height;
    for (int row = 0; row < rows; ++row) {
      for (int column = 0; column < columns; ++column) {
        if (band->ReadBlock(column, row, block.data()) != CE_None) {
          return {Kind::kTryAgain, "the received image is damaged: " + messages.text()};
        }
      }
    }
  }
  // Decoders that recover what they can from a truncated file only warn.
  if (!messages.empty() && messages.text().find("runcated") != std::string::npos) {
    return {Kind::kTryAgain, "the received image is truncated: " + messages.text()};
  }
  return {};
}

Verdict judge_raster(const ChunkLayer& layer, const Chunk& chunk, const char* name) {
  GdalMessages messages;
  const DatasetPtr dataset = open_image(name);
  if (!dataset) {
    return {Kind::kTryAgain, "the answer is not a readable image: " + messages.text()};
  }
  if (dataset->GetRasterXSize() != chunk.width_px || dataset->GetRasterYSize() != chunk.height_px) {
    return {Kind::kFailed,
            "the received image has " + std::to_string(dataset->GetRasterXSize()) + " x " +
                std::to_string(dataset->GetRasterYSize()) + " px, requested " +
                std::to_string(chunk.width_px) + " x " + std::to_string(chunk.height_px)};
  }
  const int bands = dataset->GetRasterCount();
  const GDALDataType type = dataset->GetRasterBand(1)->GetRasterDataType();
  if (layer.heights && (bands != 1 || (type != GDT_Float32 && type != GDT_Float64))) {
    return {Kind::kFailed,
            std::string("the received heights have ") + std::to_string(bands) + " bands of " +
                GDALGetDataTypeName(type) + ", requested one of Float32"};
  }
  if (!layer.heights && type != GDT_Byte) {
    return {Kind::kFailed,
            std::string("the received imagery is of type ") + GDALGetDataTypeName(type) +
                ", requested 8 bit"};
  }
  Verdict verdict = judge_blocks(*dataset);
  if (verdict.kind == Kind::kGood && chunk.payload == Payload::kGeoTiff) {
    verdict = judge_place(*dataset, layer, chunk);
  }
  return verdict;
}

}  // namespace

std::string words_of(const HttpReply& reply) {
  const std::string text(reply.body.begin(), reply.body.end());
  const auto json = json_from_outside<nlohmann::json>(text, "the answer");
  if (json && json->is_object() && json->contains("error")) {
    const auto& error = json->at("error");
    if (!error.is_object()) return error.dump();
    std::string words = error.contains("code") ? "code " + error["code"].dump() : "error";
    for (const char* field : {"message", "details"}) {
      if (error.contains(field) && !error[field].empty()) words += ", " + error[field].dump();
    }
    return words;
  }
  std::string words;
  const std::size_t title = text.find("<title>");
  if (title != std::string::npos) {
    words = text.substr(title + 7, text.find('<', title + 7) - title - 7);
  } else {
    words = text.substr(0, 120);
  }
  for (char& c : words) c = static_cast<unsigned char>(c) < 32 ? ' ' : c;
  return words;
}

Verdict judge_chunk(const ChunkLayer& layer, const Chunk& chunk, const HttpReply& reply) {
  const bool words = reply.content_type.find("json") != std::string::npos ||
                     reply.content_type.find("html") != std::string::npos ||
                     reply.content_type.find("xml") != std::string::npos ||
                     reply.content_type.find("text/plain") != std::string::npos;
  // An empty answer of a service under load is not a tile that does not exist.
  const bool under_load = words || reply.retry_after_s;
  if (reply.status == 204 && (!chunk.may_be_absent || under_load)) {
    return {Kind::kTryAgain, "the answer is empty"};
  }
  if (reply.status != 200) {
    const std::string status = "HTTP status " + std::to_string(reply.status);
    return {chunk.may_be_absent ? Kind::kAbsent : Kind::kFailed, status};
  }
  if (words || reply.body[0] == '{' || reply.body[0] == '<') {
    // Services under load report temporary errors as text as well as by status.
    return {Kind::kTryAgain, "the service answered with text: " + words_of(reply)};
  }
  const MemoryFile file(reply.body);
  return judge_raster(layer, chunk, file.name());
}

Status write_renamed(const fs::path& file, std::string_view bytes) {
  const fs::path part = file.string() + ".part";
  std::error_code failed;
  bool written = false;
  {
    std::ofstream out(part, std::ios::binary);
    out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    written = static_cast<bool>(out.flush());
  }
  if (written) fs::rename(part, file, failed);
  if (written && !failed) return {};
  const std::string why = written ? failed.message() : "cannot be written";
  fs::remove(part, failed);
  return Error{ErrorCode::kIo, file.string() + ": " + why};
}

Status write_chunk(const Chunk& chunk, const HttpReply& reply) {
  return write_renamed(chunk.file,
                       {reinterpret_cast<const char*>(reply.body.data()), reply.body.size()});
}

bool chunk_is_there(const ChunkLayer& layer, const Chunk& chunk) {
  std::error_code ignored;
  if (!fs::is_regular_file(chunk.file, ignored)) return false;
  if (judge_raster(layer, chunk, chunk.file.c_str()).kind == Kind::kGood) return true;
  fs::remove(chunk.file, ignored);
  return false;
}

}  // namespace overfly::terrain::download
