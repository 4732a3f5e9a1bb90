// Writes truth images next to the images of a data set.
#pragma once

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "renderer/camera/truth_images.hpp"
#include "server/camera/frame_maker.hpp"

namespace overfly::server {

enum class TruthKind { kDepth, kRange, kNormal, kFlow, kWorld, kMask };

/// "depth", "range", "normal", "flow", "world", "mask".
[[nodiscard]] const char* to_string(TruthKind kind);
[[nodiscard]] std::optional<TruthKind> truth_kind_from(const std::string& text);

/// Writes truth/KIND/CAMERA/NAME.EXT for each image (docs/EXPORT.md): TIFF of floats; PNG for the
/// mask; `.flo` for the flow, named after the image in which it starts, so the last image has none.
class TruthWriter {
 public:
  /// @param renderer  draws the depths; it and `tiles` must outlive the writer
  TruthWriter(std::filesystem::path folder,
              std::set<TruthKind> kinds,
              renderer::Renderer& renderer,
              const terrain::TileSource& tiles);

  /// @param frame  its shots are of the same cameras in every call
  /// @param names  of the shots' files, without extension; a shot with an empty name is skipped
  /// Errors: as the renderer's; kIo.
  [[nodiscard]] Status add(const MadeFrame& frame, const std::vector<std::string>& names);

 private:
  /// Data of a frame that its flow to the next frame needs.
  struct Before {
    std::string name;
    renderer::PointImage points;
  };
  /// State of one camera between frames.
  struct Camera {
    renderer::PixelRays rays;
    std::optional<Before> before;
  };

  Status add_shot(const std::string& name, const CameraShot& shot, Camera& camera);
  Status write_depths(const std::string& name,
                      const CameraShot& shot,
                      const DepthImage& depth,
                      const renderer::PixelRays& rays) const;
  Status write_pointwise(const std::string& name,
                         const CameraShot& shot,
                         const renderer::PointImage& points) const;
  [[nodiscard]] bool wants(TruthKind kind) const { return kinds_.contains(kind); }
  [[nodiscard]] Result<std::filesystem::path> file_of(TruthKind kind,
                                                      const std::string& camera,
                                                      const std::string& file_name) const;

  std::filesystem::path folder_;
  std::set<TruthKind> kinds_;
  renderer::Renderer& renderer_;
  const terrain::TileSource& tiles_;
  std::vector<Camera> cameras_;
};

/// Writes optical flow in the Middlebury format (Baker et al. 2011, IJCV 92(1)): "PIEH", width,
/// height, then pairs of floats, little-endian; unknown = 1.666666752e9. Errors: kIo.
[[nodiscard]] Status write_flow(const std::filesystem::path& file,
                                const renderer::VectorImage& flow);

}  // namespace overfly::server
