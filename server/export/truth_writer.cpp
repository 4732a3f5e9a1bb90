#include "server/export/truth_writer.hpp"

#include <bit>
#include <cmath>
#include <cstring>
#include <utility>

#include "server/export/dataset_writer.hpp"
#include "server/files/number_text.hpp"
#include "server/files/png_file.hpp"
#include "server/files/whole_file.hpp"
#include "terrain/raster/image_file.hpp"

namespace overfly::server {

namespace fs = std::filesystem;

const char* to_string(TruthKind kind) {
  switch (kind) {
    case TruthKind::kDepth:
      return "depth";
    case TruthKind::kRange:
      return "range";
    case TruthKind::kNormal:
      return "normal";
    case TruthKind::kFlow:
      return "flow";
    case TruthKind::kWorld:
      return "world";
    case TruthKind::kMask:
      break;
  }
  return "mask";
}

std::optional<TruthKind> truth_kind_from(const std::string& text) {
  for (const TruthKind kind : {TruthKind::kDepth,
                               TruthKind::kRange,
                               TruthKind::kNormal,
                               TruthKind::kFlow,
                               TruthKind::kWorld,
                               TruthKind::kMask}) {
    if (text == to_string(kind)) return kind;
  }
  return std::nullopt;
}

TruthWriter::TruthWriter(fs::path folder,
                         std::set<TruthKind> kinds,
                         renderer::Renderer& renderer,
                         const terrain::TileSource& tiles)
    : folder_(std::move(folder)), kinds_(std::move(kinds)), renderer_(renderer), tiles_(tiles) {}

Status TruthWriter::add(const MadeFrame& frame, const std::vector<std::string>& names) {
  if (kinds_.empty()) return {};
  for (std::size_t i = 0; i < frame.shots.size(); ++i) {
    const CameraShot& shot = frame.shots[i];
    if (i >= cameras_.size()) {
      cameras_.push_back({renderer::PixelRays(shot.request.camera), std::nullopt});
    }
    if (names[i].empty()) continue;
    Status status = add_shot(names[i], shot, cameras_[i]);
    if (!status) return status.error().in("truth of frame " + std::to_string(frame.frame));
  }
  return {};
}

Result<fs::path> TruthWriter::file_of(TruthKind kind,
                                      const std::string& camera,
                                      const std::string& file_name) const {
  const fs::path folder = folder_ / "truth" / to_string(kind) / camera;
  if (Status status = make_folder(folder); !status) return status.error();
  return folder / file_name;
}

Status TruthWriter::add_shot(const std::string& name, const CameraShot& shot, Camera& camera) {
  const Result<DepthImage> depth = renderer_.render_depth(shot.request);
  if (!depth) return depth.error();
  if (Status status = write_depths(name, shot, *depth, camera.rays); !status) return status;
  renderer::PointImage points = renderer::world_points(camera.rays, shot.request, *depth);
  if (Status status = write_pointwise(name, shot, points); !status) return status;
  if (!wants(TruthKind::kFlow)) return {};
  if (camera.before) {
    const auto file = file_of(TruthKind::kFlow, shot.name, camera.before->name + ".flo");
    if (!file) return file.error();
    Status status =
        write_flow(*file, renderer::optical_flow(camera.before->points, shot.request, *depth));
    if (!status) return status;
  }
  camera.before = Before{name, std::move(points)};
  return {};
}

Status TruthWriter::write_depths(const std::string& name,
                                 const CameraShot& shot,
                                 const DepthImage& depth,
                                 const renderer::PixelRays& rays) const {
  if (wants(TruthKind::kDepth)) {
    const auto file = file_of(TruthKind::kDepth, shot.name, name + ".tif");
    if (!file) return file.error();
    if (Status status = terrain::write_tiff(*file, depth); !status) return status;
  }
  if (wants(TruthKind::kRange)) {
    const auto file = file_of(TruthKind::kRange, shot.name, name + ".tif");
    if (!file) return file.error();
    return terrain::write_tiff(*file, renderer::range_image(rays, depth));
  }
  return {};
}

Status TruthWriter::write_pointwise(const std::string& name,
                                    const CameraShot& shot,
                                    const renderer::PointImage& points) const {
  if (wants(TruthKind::kWorld)) {
    const auto file = file_of(TruthKind::kWorld, shot.name, name + ".tif");
    if (!file) return file.error();
    if (Status status = terrain::write_tiff(*file, points); !status) return status;
  }
  if (wants(TruthKind::kNormal)) {
    const auto file = file_of(TruthKind::kNormal, shot.name, name + ".tif");
    if (!file) return file.error();
    const renderer::VectorImage normals =
        renderer::surface_normals(points, tiles_, shot.request, renderer::NormalFrame::kWorld);
    if (Status status = terrain::write_tiff(*file, normals); !status) return status;
  }
  if (wants(TruthKind::kMask)) {
    const auto file = file_of(TruthKind::kMask, shot.name, name + ".png");
    if (!file) return file.error();
    return write_png_file(*file, renderer::validity_mask(points, tiles_));
  }
  return {};
}

Status write_flow(const fs::path& file, const renderer::VectorImage& flow) {
  static_assert(std::endian::native == std::endian::little);
  constexpr float kUnknown = 1.666666752e9F;
  std::vector<std::uint8_t> bytes(12 + flow.data.size() * sizeof(float));
  std::memcpy(bytes.data(), "PIEH", 4);
  const std::int32_t size[2] = {flow.width_px, flow.height_px};
  std::memcpy(bytes.data() + 4, size, 8);
  for (std::size_t i = 0; i < flow.data.size(); ++i) {
    const float value = std::isfinite(flow.data[i]) ? flow.data[i] : kUnknown;
    std::memcpy(bytes.data() + 12 + 4 * i, &value, 4);
  }
  return write_whole(file, std::span<const std::uint8_t>(bytes));
}

}  // namespace overfly::server
