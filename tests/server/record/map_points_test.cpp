#include "server/record/map_points.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include <filesystem>
#include <fstream>
#include <limits>

#include "tests/support/support.hpp"

namespace overfly::server {
namespace {

using ::testing::HasSubstr;

MapPoints two_points() {
  MapPoints points;
  points.S_world_vo = {2.0,
                       Eigen::Quaterniond(Eigen::AngleAxisd(kPi / 2, Eigen::Vector3d::UnitZ())),
                       Eigen::Vector3d(10.0, 20.0, 30.0)};
  points.points_vo = {Eigen::Vector3f(1.0F, 0.0F, 0.0F), Eigen::Vector3f(0.0F, 0.0F, -1.0F)};
  return points;
}

class MapPointsTest : public ::testing::Test {
 protected:
  void write(const std::vector<std::uint8_t>& bytes) const {
    std::ofstream out(file(), std::ios::binary);
    out.write(reinterpret_cast<const char*>(bytes.data()),
              static_cast<std::streamsize>(bytes.size()));
  }
  [[nodiscard]] std::filesystem::path file() const { return folder_.path() / "000007.bin"; }

 private:
  overfly::testing::TemporaryFolder folder_;
};

TEST_F(MapPointsTest, AreReadAsTheyWereWritten) {
  write(bytes_of(two_points()));
  const auto read = read_map_points(file());
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_EQ(read->points_vo, two_points().points_vo);
  const auto world = in_world(*read, read->S_world_vo);
  EXPECT_LT((world[0] - Eigen::Vector3f(10.0F, 22.0F, 30.0F)).norm(), 1e-5F);
  EXPECT_LT((world[1] - Eigen::Vector3f(10.0F, 20.0F, 28.0F)).norm(), 1e-5F);
}

TEST_F(MapPointsTest, LeavesOutPointsThatAreNotFinite) {
  MapPoints points = two_points();
  points.points_vo[0].y() = std::numeric_limits<float>::quiet_NaN();
  write(bytes_of(points));
  EXPECT_EQ(read_map_points(file())->points_vo.size(), 1U);
}

TEST_F(MapPointsTest, HaveALimit) {
  MapPoints points = two_points();
  points.points_vo.resize(kMaxMapPoints + 1, Eigen::Vector3f::Zero());
  write(bytes_of(points));
  EXPECT_EQ(read_map_points(file())->points_vo.size(), kMaxMapPoints);
  write(std::vector<std::uint8_t>(64 + 12 * (kMaxMapPoints + 1)));
  EXPECT_FALSE(read_map_points(file()).ok());
}

TEST_F(MapPointsTest, AreRefusedWhereTheFileIsDamaged) {
  const std::vector<std::uint8_t> whole = bytes_of(two_points());
  for (std::size_t size = 0; size < whole.size(); ++size) {
    write({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)});
    const auto read = read_map_points(file());
    if (size >= 64 && (size - 64) % 12 == 0) {
      EXPECT_TRUE(read.ok()) << size;
    } else {
      ASSERT_FALSE(read.ok()) << size;
      EXPECT_EQ(read.error().code, ErrorCode::kUnreadable);
      EXPECT_THAT(read.error().message, HasSubstr("000007.bin"));
    }
  }
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t i = 0; i < 8; ++i) {
    std::vector<std::uint8_t> no_similarity = whole;
    std::memcpy(no_similarity.data() + i * sizeof(double), &kNan, sizeof(double));
    write(no_similarity);
    const auto read = read_map_points(file());
    ASSERT_FALSE(read.ok()) << i;
    EXPECT_THAT(read.error().message, HasSubstr("no similarity"));
  }
  MapPoints mirrored = two_points();
  mirrored.S_world_vo.scale = -1.0;
  write(bytes_of(mirrored));
  EXPECT_THAT(read_map_points(file()).error().message, HasSubstr("no similarity"));
}

}  // namespace
}  // namespace overfly::server
