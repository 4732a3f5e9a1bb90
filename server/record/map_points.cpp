#include "server/record/map_points.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "core/outside/file_text.hpp"

namespace overfly::server {
namespace {

static_assert(std::endian::native == std::endian::little);
static_assert(sizeof(Eigen::Vector3f) == 12);

/// Scale, rotation (x, y, z, w) and translation.
constexpr std::size_t kHeadBytes = 64;
constexpr std::size_t kPointBytes = sizeof(Eigen::Vector3f);

}  // namespace

std::vector<Eigen::Vector3f> in_world(const MapPoints& points, const Similarity& S_world_vo) {
  std::vector<Eigen::Vector3f> points_world;
  points_world.reserve(points.points_vo.size());
  for (const Eigen::Vector3f& point : points.points_vo) {
    points_world.push_back((S_world_vo * Eigen::Vector3d(point.cast<double>())).cast<float>());
  }
  return points_world;
}

std::vector<std::uint8_t> bytes_of(const MapPoints& points) {
  const Similarity& S = points.S_world_vo;
  const std::array<double, 8> head = {S.scale,
                                      S.rotation.x(),
                                      S.rotation.y(),
                                      S.rotation.z(),
                                      S.rotation.w(),
                                      S.translation.x(),
                                      S.translation.y(),
                                      S.translation.z()};
  const std::size_t count = std::min(points.points_vo.size(), kMaxMapPoints);
  std::vector<std::uint8_t> bytes(kHeadBytes + count * kPointBytes);
  std::memcpy(bytes.data(), head.data(), kHeadBytes);
  if (count > 0) {
    std::memcpy(bytes.data() + kHeadBytes, points.points_vo.front().data(), count * kPointBytes);
  }
  return bytes;
}

Result<MapPoints> read_map_points(const std::filesystem::path& file) {
  const auto bytes = read_file_bytes(file, kHeadBytes + kMaxMapPoints * kPointBytes);
  if (!bytes) return bytes.error();
  if (bytes->size() < kHeadBytes || (bytes->size() - kHeadBytes) % kPointBytes != 0) {
    return Error{ErrorCode::kUnreadable,
                 file.string() + ": has " + std::to_string(bytes->size()) +
                     " bytes: must be 64 and 12 for each point"};
  }
  std::array<double, 8> head;
  std::memcpy(head.data(), bytes->data(), kHeadBytes);
  MapPoints points;
  Similarity& S = points.S_world_vo;
  S.scale = head[0];
  S.rotation = Eigen::Quaterniond(head[4], head[1], head[2], head[3]);
  S.translation = {head[5], head[6], head[7]};
  // Comparisons with a value that is not a number are false; maxCoeff() may skip such a value.
  const bool is_similarity = S.translation.allFinite() && S.scale > 0.0 && S.scale < 1e12 &&
                             std::abs(S.rotation.norm() - 1.0) < 1e-6 &&
                             S.translation.cwiseAbs().maxCoeff() < 1e12;
  if (!is_similarity) {
    return Error{ErrorCode::kUnreadable, file.string() + ": its alignment is no similarity"};
  }
  points.points_vo.resize((bytes->size() - kHeadBytes) / kPointBytes);
  if (!points.points_vo.empty()) {
    std::memcpy(
        points.points_vo.front().data(), bytes->data() + kHeadBytes, bytes->size() - kHeadBytes);
  }
  std::erase_if(points.points_vo, [](const Eigen::Vector3f& p) { return !p.allFinite(); });
  return points;
}

}  // namespace overfly::server
