// Pictures for viewers while a world is being opened: others do not wait for it, nor does the
// server's end.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <bit>
#include <filesystem>
#include <fstream>
#include <future>
#include <thread>

#include "server/record/run_info.hpp"
#include "server/views/view_service.hpp"
#include "tests/server/support/manager_fixture.hpp"
#include "tests/support/synthetic_world.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;

/// A tag of a little-endian BigTIFF: its number, type, count, and value or place.
struct Tag {
  std::uint16_t tag = 0;
  std::uint16_t type = 0;
  std::uint64_t count = 0;
  std::uint64_t value = 0;
};

template <typename Number>
void put(std::ofstream& out, Number number) {
  out.write(reinterpret_cast<const char*>(&number), sizeof(number));
}

/// A picture in UTM zone 16 of millions of small tiles of which none was ever written: opening it
/// takes a minute, and it takes no room on the disk.
void write_endless_geotiff(const fs::path& file) {
  static_assert(std::endian::native == std::endian::little);
  constexpr std::uint64_t kSide = 60000;
  constexpr std::uint64_t kTile = 16;
  constexpr std::uint64_t kTiles = (kSide / kTile) * (kSide / kTile);
  constexpr std::uint64_t kOffsetsAt = 4096;
  constexpr std::uint64_t kSizesAt = kOffsetsAt + 8 * kTiles;
  constexpr std::uint16_t kShort = 3, kLong = 4, kDouble = 12, kLong8 = 16;
  constexpr std::uint64_t kDataAt = 1024;
  std::ofstream out(file, std::ios::binary);
  out << "II+" << '\0';
  put<std::uint16_t>(out, 8);
  put<std::uint16_t>(out, 0);
  put<std::uint64_t>(out, 16);
  const Tag tags[] = {{256, kLong, 1, kSide},
                      {257, kLong, 1, kSide},
                      {258, kShort, 1, 8},
                      {259, kShort, 1, 1},
                      {262, kShort, 1, 1},
                      {277, kShort, 1, 1},
                      {322, kShort, 1, kTile},
                      {323, kShort, 1, kTile},
                      {324, kLong8, kTiles, kOffsetsAt},
                      {325, kLong8, kTiles, kSizesAt},
                      {33550, kDouble, 3, kDataAt},
                      {33922, kDouble, 6, kDataAt + 24},
                      {34735, kShort, 16, kDataAt + 72}};
  put<std::uint64_t>(out, std::size(tags));
  for (const Tag& tag : tags) {
    put(out, tag.tag);
    put(out, tag.type);
    put(out, tag.count);
    put(out, tag.value);
  }
  put<std::uint64_t>(out, 0);
  out.seekp(kDataAt);
  for (const double number : {2.0, 2.0, 0.0, 0.0, 0.0, 0.0, 583000.0, 4357000.0, 0.0}) {
    put(out, number);
  }
  for (const std::uint16_t key : {1, 1, 0, 3, 1024, 0, 1, 1, 1025, 0, 1, 1, 3072, 0, 1, 32616}) {
    put(out, key);
  }
  out.close();
  fs::resize_file(file, kSizesAt + 8 * kTiles);
}

/// Whether this program has the file open.
bool has_open(const fs::path& file) {
  std::error_code failed;
  for (fs::directory_iterator entry("/proc/self/fd", failed), end; !failed && entry != end;
       entry.increment(failed)) {
    std::error_code closed_meanwhile;
    if (fs::read_symlink(entry->path(), closed_meanwhile) == file) return true;
  }
  return false;
}

class ViewServiceTest : public testing::ManagerTest {
 protected:
  [[nodiscard]] fs::path imagery() const { return fs::canonical(root()) / "imagery.tif"; }
  /// A run over one picture, flown by a manager that is gone, with its thread and its world.
  std::string flown() {
    overfly::testing::GeoTiff picture;
    picture.image = overfly::testing::textured_image(300, 300, 1);
    picture.left = 583000.0;
    picture.top = 4357000.0;
    picture.pixel = 2.0;
    write_geotiff(imagery(), picture);
    nlohmann::json document = testing::small_document();
    document["name"] = "pictured";
    document["world"] = {{"imagery", {{{"file", imagery().string()}}}}, {"ground_height_m", 200}};
    overfly::testing::write_text(root() / "scenarios" / "pictured.json", document.dump());
    const auto runs = manager();
    const std::string id = runs->start("pictured", perfect()).value().id;
    EXPECT_EQ(wait_for_end(*runs, id).status, RunStatus::kCompleted);
    return id;
  }
};

TEST_F(ViewServiceTest, AWorldThatIsBeingOpenedIsGivenUpWhenAsked) {
  const std::string id = flown();
  const auto runs = manager();
  fs::remove(imagery());
  write_endless_geotiff(imagery());
  int asked = 0;
  const auto world = runs->world_of(id, [&] { return ++asked > 20; });
  ASSERT_FALSE(world.ok());
  EXPECT_EQ(world.error().code, ErrorCode::kCancelled) << world.error().message;
}

TEST_F(ViewServiceTest, DrawsOverOtherWorldsMeanwhile) {
  const std::string slow = flown();
  const auto runs = manager();
  const std::string other = fly(*runs);
  fs::remove(imagery());
  write_endless_geotiff(imagery());
  std::promise<ErrorCode> first;
  std::promise<Result<Picture>> second;
  std::promise<Result<Picture>> third;
  ViewService views(*runs);
  PictureRequest request;
  request.kind = PictureRequest::Kind::kCamera;
  request.run_id = slow;
  views.request(1, 1, request, [&](const Result<Picture>& picture) {
    first.set_value(picture ? ErrorCode::kInternal : picture.error().code);
  });
  while (!has_open(imagery())) std::this_thread::yield();
  request.run_id = other;
  views.request(1, 2, request, [&](Result<Picture> made) { second.set_value(made); });
  const Result<Picture> picture = second.get_future().get();
  EXPECT_TRUE(picture.ok()) << picture.error().message;
  EXPECT_TRUE(has_open(imagery())) << "the other world was opened meanwhile";
  // A newer request of the stream that waits takes its place.
  request.run_id = other;
  views.request(1, 1, request, [&](Result<Picture> made) { third.set_value(made); });
  EXPECT_EQ(first.get_future().get(), ErrorCode::kCancelled);
}

TEST_F(ViewServiceTest, EndsWhileAWorldIsBeingOpened) {
  const std::string id = flown();
  const auto runs = manager();
  fs::remove(imagery());
  write_endless_geotiff(imagery());
  for (const auto kind : {PictureRequest::Kind::kScene, PictureRequest::Kind::kCamera}) {
    auto views = std::make_unique<ViewService>(*runs);
    std::promise<Result<Picture>> answer;
    PictureRequest request;
    request.run_id = id;
    request.kind = kind;
    views->request(1, 1, request, [&](Result<Picture> picture) { answer.set_value(picture); });
    while (!has_open(imagery())) std::this_thread::yield();
    views.reset();
    const Result<Picture> picture = answer.get_future().get();
    ASSERT_FALSE(picture.ok());
    EXPECT_EQ(picture.error().code, ErrorCode::kCancelled) << picture.error().message;
  }
}

class AbandonedRequestTest : public testing::ManagerTest {};

TEST_F(AbandonedRequestTest, IsNotWorkedOn) {
  const auto runs = manager();
  ViewService views(*runs);
  for (const bool gone : {false, true}) {
    const auto abandoned = std::make_shared<const std::atomic<bool>>(gone);
    const ErrorCode expected = gone ? ErrorCode::kCancelled : ErrorCode::kNotFound;
    PictureRequest picture;
    picture.run_id = "none";
    std::promise<ErrorCode> drawn;
    views.request(
        1,
        1,
        picture,
        [&](const Result<Picture>& made) { drawn.set_value(made.error().code); },
        abandoned);
    EXPECT_EQ(drawn.get_future().get(), expected);
    PixelRequest pixel;
    pixel.run_id = "none";
    std::promise<ErrorCode> seen;
    views.probe(
        1,
        1,
        pixel,
        [&](const Result<PixelValue>& value) { seen.set_value(value.error().code); },
        abandoned);
    EXPECT_EQ(seen.get_future().get(), expected);
  }
}

}  // namespace
}  // namespace overfly::server
