#include "server/frame_cache/frame_key.hpp"

#include <span>
#include <type_traits>

#include "core/measure/sha256.hpp"
#include "server/files/program_identity.hpp"

namespace overfly::server {
namespace {

/// Hashes values by their bytes; texts with their lengths, so that neighbours cannot be confused.
class KeyHash {
 public:
  template <typename T>
  void add(const T& value) {
    static_assert(std::is_arithmetic_v<T> || std::is_enum_v<T>);
    hash_.add({reinterpret_cast<const std::uint8_t*>(&value), sizeof value});
  }
  void add(const std::string& text) {
    add(text.size());
    hash_.add({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  }
  void add(const CameraModel& model) {
    const auto& [width_px, height_px, fx_px, fy_px, cx_px, cy_px] = model.pinhole();
    add(width_px);
    add(height_px);
    for (const double value : {fx_px, fy_px, cx_px, cy_px}) add(value);
    const auto& [kind, coefficients] = model.distortion();
    add(kind);
    for (const double value : coefficients) add(value);
  }
  void add(const CameraMotion& motion) {
    add(motion.poses().size());
    for (const auto& [t_ns, pose] : motion.poses()) {
      add(t_ns);
      for (int i = 0; i < 4; ++i) add(pose.rotation.coeffs()[i]);
      for (int i = 0; i < 3; ++i) add(pose.translation[i]);
    }
  }
  [[nodiscard]] std::string text() { return hex_text(hash_.finish()); }

 private:
  Sha256 hash_;
};

}  // namespace

std::string picture_context(const Scenario& scenario,
                            const OpenedWorld& opened,
                            const renderer::RendererInfo& renderer) {
  KeyHash hash;
  hash.add(program_identity());
  hash.add(renderer.backend);
  // The ray-caster's image depends neither on its threads nor on the vector units.
  if (renderer.backend != "raycast") {
    hash.add(renderer.device);
    hash.add(renderer.gl_version);
  }
  hash.add(world_key(scenario));
  hash.add(opened.manifest ? opened.manifest->digest : std::string());
  for (const auto& [file, digest] : opened.world.data_hashes) {
    hash.add(file);
    hash.add(digest);
  }
  // Large files have digests of samples only; the change time of the inode cannot be set back.
  for (const terrain::WorldFile& file : opened.files) {
    hash.add(file.file.string());
    hash.add(file.identity.has_value());
    if (!file.identity) continue;
    hash.add(file.identity->size_bytes);
    hash.add(file.identity->modified_ns);
    hash.add(file.identity->changed_ns);
  }
  // They name the grids of vertical datums that are installed.
  for (const std::string& warning : opened.world.warnings) hash.add(warning);
  hash.add(opened.world.cache);
  const Geodetic& origin = opened.world.tiles->frame().origin();
  for (const double value : {origin.lat_rad, origin.lon_rad, origin.alt_ellipsoid_m}) {
    hash.add(value);
  }
  return hash.text();
}

std::string frame_key(const std::string& context, const renderer::CameraRequest& request) {
  // A field that is added to the request does not compile until it is considered here.
  const auto& [camera,
               T_world_camera,
               t_ns,
               exposure_ns,
               readout_ns,
               format,
               quality,
               atmosphere,
               velocity_world_m_s,
               tile_wait_ns] = request;
  (void)velocity_world_m_s;  // changes what is read ahead, not the image
  (void)tile_wait_ns;        // only complete pictures have keys
  KeyHash hash;
  hash.add(context);
  hash.add(camera);
  hash.add(T_world_camera);
  for (const std::int64_t time_ns : {t_ns, exposure_ns, readout_ns}) hash.add(time_ns);
  hash.add(format);
  hash.add(quality);
  const auto& [extinction_per_m, airlight_rgb] = atmosphere;
  hash.add(extinction_per_m);
  for (const float value : airlight_rgb) hash.add(value);
  return hash.text();
}

}  // namespace overfly::server
