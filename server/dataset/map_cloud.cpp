#include "server/dataset/map_cloud.hpp"

#include <bit>
#include <charconv>
#include <cmath>

#include "server/files/whole_file.hpp"

namespace overfly::server {
namespace {

constexpr double kCellPerDepth = 0.005;
/// Beyond this value a cell's number does not fit an integer; no map is that large.
constexpr double kLargestCell = 1e15;

std::array<std::int64_t, 3> cell_of(const Eigen::Vector3f& p, double cell) {
  std::array<std::int64_t, 3> key{};
  for (int i = 0; i < 3; ++i) {
    const double number = cell > 0.0 ? static_cast<double>(p[i]) / cell : 0.0;
    key[static_cast<std::size_t>(i)] = cell > 0.0 && std::abs(number) < kLargestCell
                                           ? std::llround(number)
                                           : std::bit_cast<std::int32_t>(p[i]);
  }
  return key;
}

/// The shortest decimals that parse to the same floats.
std::string point_line(const Eigen::Vector3f& p) {
  std::array<char, 64> text{};
  char* at = text.data();
  for (int i = 0; i < 3; ++i) {
    at = std::to_chars(at, text.data() + text.size(), p[i]).ptr;
    *at++ = i < 2 ? ' ' : '\n';
  }
  return {text.data(), at};
}

}  // namespace

void MapCloud::add(const EstimateSample& sample, const std::vector<Eigen::Vector3f>& points_vo) {
  if (points_vo.empty()) return;
  const auto [entry, first] = pieces_.try_emplace(sample.map_id);
  Piece& piece = entry->second;
  if (first && sample.scene_depth) piece.cell = kCellPerDepth * *sample.scene_depth;
  for (const Eigen::Vector3f& p : points_vo) {
    if (p.allFinite()) piece.points[cell_of(p, piece.cell)] = p;
  }
}

std::vector<Eigen::Vector3f> MapCloud::points(int map_id) const {
  std::vector<Eigen::Vector3f> points;
  const auto found = pieces_.find(map_id);
  if (found == pieces_.end()) return points;
  for (const auto& [cell, point] : found->second.points) points.push_back(point);
  return points;
}

Status write_ply(const std::filesystem::path& file,
                 const std::vector<Eigen::Vector3f>& points,
                 const std::string& comment) {
  std::string text = "ply\nformat ascii 1.0\ncomment " + comment + "\nelement vertex " +
                     std::to_string(points.size()) +
                     "\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
  for (const Eigen::Vector3f& p : points) {
    text += point_line(p);
  }
  return write_whole(file, text);
}

}  // namespace overfly::server
