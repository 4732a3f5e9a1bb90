#include "renderer/egl/camera_pass.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "renderer/camera/air_light.hpp"
#include "renderer/camera/frame_statistics.hpp"
#include "renderer/camera/image_motion.hpp"
#include "renderer/camera/image_parts.hpp"
#include "renderer/ground/ground_mesh.hpp"

namespace overfly::renderer::egl {

namespace {

/// True if the image is a single pinhole image at one instant.
bool is_plain(const CameraRequest& request) {
  const bool instant = request.exposure_ns == 0 && request.readout_ns == 0;
  return request.camera.distortion().none() && request.quality == RenderQuality::kTrilinear &&
         (instant || request.T_world_camera.still());
}

GroundLook look_of(const CameraRequest& request) {
  GroundLook look;
  look.format = request.format;
  look.tile_wait_ns = request.tile_wait_ns;
  look.extinction_per_m = request.atmosphere.extinction_per_m;
  look.airlight = light_in(request.format, request.atmosphere.airlight_rgb);
  return look;
}

TargetFormat float_target(PixelFormat format) {
  return channel_count(format) == 1 ? TargetFormat::kGreyFloat : TargetFormat::kRgbaFloat;
}

TargetFormat target_of(PixelFormat format) {
  if (is_linear(format)) return float_target(format);
  return format == PixelFormat::kGrey8 ? TargetFormat::kGrey8 : TargetFormat::kRgba8;
}

Image rounded(const ImageBuffer<float>& image) {
  Image bytes(image.width_px, image.height_px, image.channels);
  std::transform(image.data.begin(), image.data.end(), bytes.data.begin(), [](float value) {
    return static_cast<std::uint8_t>(std::lround(255.0F * std::clamp(value, 0.0F, 1.0F)));
  });
  return bytes;
}

void note(const FrameStatistics& statistics, CameraFrame& frame) {
  frame.texels_per_pixel_min = statistics.texels_per_pixel_min;
  frame.texels_per_pixel_median = statistics.texels_per_pixel_median;
  frame.void_fraction = statistics.void_fraction;
  frame.axis_depth_m = statistics.axis_depth_m;
}

void prepare_depth_test(bool needed) {
  if (!needed) {
    glDisable(GL_DEPTH_TEST);
    return;
  }
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_GREATER);
  glDepthMask(GL_TRUE);
  glClearDepth(0.0);
  glClear(GL_DEPTH_BUFFER_BIT);
}

/// The pose of a part's pinhole image at a time.
View view_of(const CameraRequest& request, const ImagePart& part, std::int64_t t_ns) {
  View view = View::from(part.source, request.T_world_camera.at(t_ns));
  view.R_camera_world = part.R_source_camera * view.R_camera_world;
  return view;
}

}  // namespace

Result<RenderTarget*> CameraPass::draw_picture(const CameraRequest& request,
                                               const GroundMesh& mesh,
                                               const PinholeCamera& camera,
                                               const GroundLook& look,
                                               TargetFormat format) {
  Result<RenderTarget*> target = targets_.get(camera.width_px, camera.height_px, format);
  if (!target.ok()) return target;
  (*target)->bind();
  if (format == TargetFormat::kDepthM) {
    glClearColor(std::numeric_limits<float>::infinity(), 0.0F, 0.0F, 0.0F);
  } else {
    const std::array<float, 3> sky = sky_light(request);
    glClearColor(sky[0], sky[1], sky[2], 1.0F);
  }
  glClear(GL_COLOR_BUFFER_BIT);
  prepare_depth_test(mesh.needs_depth_test);
  if (Status s = ground_.draw(mesh, camera, textures_, look); !s) return s.error();
  return target;
}

Status CameraPass::draw(const CameraRequest& request, CameraFrame& frame) {
  Status status;
  if (is_plain(request)) {
    const Result<RenderTarget*> target = draw_plain(request, frame);
    if (!target.ok()) {
      status = target.error();
    } else if (is_linear(request.format)) {
      (*target)->read(frame.radiance);
    } else {
      (*target)->read(frame.image);
    }
  } else {
    status = draw_composed(request, frame);
  }
  frame.late_tiles = textures_.end_view();
  return status;
}

Result<bool> CameraPass::draw_into(PixelRing& ring,
                                   const CameraRequest& request,
                                   CameraFrame& frame) {
  if (!is_plain(request) || is_linear(request.format)) {
    if (Status status = draw(request, frame); !status) return status.error();
    return false;
  }
  const Result<RenderTarget*> target = draw_plain(request, frame);
  if (target.ok()) ring.push(**target);
  frame.late_tiles = textures_.end_view();
  if (!target.ok()) return target.error();
  return true;
}

Result<RenderTarget*> CameraPass::draw_plain(const CameraRequest& request, CameraFrame& frame) {
  const View view = View::from(request.camera.pinhole(), request.T_world_camera.at(request.t_ns));
  const GroundMesh mesh = build_ground_mesh(patches_, view, {});
  Result<RenderTarget*> target =
      draw_picture(request, mesh, view.camera, look_of(request), target_of(request.format));
  if (!target.ok()) return target;
  // Starts the GPU; the frame is measured meanwhile.
  glFlush();
  const auto has_imagery = [&](const terrain::TileId& tile, double u, double v) {
    return textures_.has_imagery(tile, request.format, u, v);
  };
  note(measure_frame(mesh, view, request.camera, patches_.tiles(), has_imagery), frame);
  return target;
}

const TapRays& CameraPass::rays_of(const CameraModel& camera, RenderQuality quality) {
  if (!rays_ || !rays_->fits(camera, quality)) rays_.emplace(camera, quality);
  return *rays_;
}

Status CameraPass::draw_composed(const CameraRequest& request, CameraFrame& frame) {
  const terrain::TileSource& tiles = patches_.tiles();
  const PinholeCamera& size = request.camera.pinhole();
  const std::vector<ExposureInstant> instants = exposure_instants(request, tiles);
  const TapRays& rays = rays_of(request.camera, request.quality);
  ImageBuffer<float> image(size.width_px, size.height_px, channel_count(request.format));
  GroundLook look = look_of(request);
  for (const ImagePart& part : divide_image(request, rows_of_one_pose(request, tiles))) {
    look.lod_bias = part.lod_bias;
    for (const ExposureInstant& instant : instants) {
      const View view = view_of(request, part, part.t_ns + instant.offset_ns);
      const GroundMesh mesh = build_ground_mesh(patches_, view, {});
      const Result<RenderTarget*> target =
          draw_picture(request, mesh, part.source, look, float_target(request.format));
      if (!target.ok()) return target.error();
      (*target)->read(picture_);
      add_part(part, picture_, rays, instant.weight, image);
    }
  }
  const View view =
      View::from(covering_pinhole(request.camera), request.T_world_camera.at(request.t_ns));
  const GroundMesh mesh = build_ground_mesh(patches_, view, {});
  note(measure_frame(mesh, view, request.camera, tiles, imagery_query(tiles)), frame);
  if (is_linear(request.format)) {
    frame.radiance = std::move(image);
  } else {
    frame.image = rounded(image);
  }
  return {};
}

Result<DepthImage> CameraPass::depth(const CameraRequest& request) {
  CameraRequest instant = request;
  instant.quality = RenderQuality::kTrilinear;
  const PinholeCamera& size = request.camera.pinhole();
  DepthImage depth(size.width_px, size.height_px, 1);
  GroundLook look;
  look.output = GroundLook::Output::kDepthM;
  const auto parts = divide_image(instant, rows_of_one_pose(instant, patches_.tiles()));
  for (const ImagePart& part : parts) {
    const GroundMesh mesh = build_ground_mesh(patches_, view_of(instant, part, part.t_ns), {});
    const Result<RenderTarget*> target =
        draw_picture(instant, mesh, part.source, look, TargetFormat::kDepthM);
    if (!target.ok()) return target.error();
    if (parts.size() == 1 && part.direct) {
      (*target)->read(depth);
      return depth;
    }
    (*target)->read(picture_);
    write_depth(part, picture_, rays_of(instant.camera, instant.quality), depth);
  }
  return depth;
}

}  // namespace overfly::renderer::egl
