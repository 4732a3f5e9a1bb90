#include "server/calibration/session/image_sources.hpp"

#include <utility>

#include "core/time.hpp"
#include "flight/logs/images/logged_picture.hpp"
#include "server/calibration/virtual_camera.hpp"
#include "server/dataset/grey_image.hpp"
#include "server/imagery/grey_picture.hpp"
#include "server/imagery/image_source.hpp"
#include "server/imagery/live/live_images.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;
using Next = Result<std::unique_ptr<BoardImage>>;

Next board_image(std::string name, Result<Image> image) {
  return std::make_unique<BoardImage>(BoardImage{std::move(name), std::move(image)});
}

std::string image_title(const char* what, std::int64_t number) {
  return std::string(what) + " " + std::to_string(number);
}

/// The server's folders and temporary files are no business of its clients.
Error error_for_client(const Error& error) {
  if (error.code == ErrorCode::kIo) {
    return {error.code, "the server cannot read or store the image: is its disk full?"};
  }
  if (error.code == ErrorCode::kInvalidArgument) {
    return {error.code, "must have at most " + std::to_string(kMostBoardImagePixels) + " pixels"};
  }
  return {ErrorCode::kUnreadable, "cannot be read as PNG, JPEG, PGM or PPM"};
}

class FolderBoards final : public BoardImages {
 public:
  explicit FolderBoards(std::vector<fs::path> files) : files_(std::move(files)) {}

  [[nodiscard]] Next next(std::chrono::milliseconds /*patience*/) override {
    const fs::path& file = files_[next_++];
    const std::string name = file.filename().string();
    Result<Image> image = read_grey_image(file, 16, kMostBoardImagePixels);
    if (!image) image = error_for_client(image.error());
    return board_image(name, std::move(image));
  }
  [[nodiscard]] bool ended() const override { return next_ == files_.size(); }
  [[nodiscard]] std::optional<std::size_t> total() const override { return files_.size(); }

 private:
  std::vector<fs::path> files_;
  std::size_t next_ = 0;
};

/// The images of a recording that are at least kStepNs apart.
class RecordedBoards final : public BoardImages {
 public:
  explicit RecordedBoards(std::unique_ptr<ImageSource> source) : source_(std::move(source)) {
    constexpr std::int64_t kStepNs = kNsPerS / 10;
    const std::vector<std::int64_t>& stamps = source_->stamps_ns();
    for (std::size_t i = 0; i < stamps.size(); ++i) {
      const bool apart = chosen_.empty() || stamps[i] - stamps[chosen_.back()] >= kStepNs;
      if (apart) chosen_.push_back(i);
    }
  }

  [[nodiscard]] Next next(std::chrono::milliseconds /*patience*/) override {
    const std::size_t index = chosen_[next_++];
    return board_image(image_title("image", static_cast<std::int64_t>(index) + 1),
                       source_->read(index));
  }
  [[nodiscard]] bool ended() const override { return next_ == chosen_.size(); }
  [[nodiscard]] std::optional<std::size_t> total() const override { return chosen_.size(); }
  [[nodiscard]] bool moving() const override { return true; }

 private:
  std::unique_ptr<ImageSource> source_;
  std::vector<std::size_t> chosen_;
  std::size_t next_ = 0;
};

class VirtualBoards final : public BoardImages {
 public:
  explicit VirtualBoards(VirtualCamera camera) : camera_(std::move(camera)) {}

  [[nodiscard]] Next next(std::chrono::milliseconds /*patience*/) override {
    const std::size_t view = next_++;
    return board_image(image_title("virtual view", static_cast<std::int64_t>(view) + 1),
                       camera_.image(view));
  }
  [[nodiscard]] bool ended() const override { return next_ == camera_.views(); }
  [[nodiscard]] std::optional<std::size_t> total() const override { return camera_.views(); }
  [[nodiscard]] std::optional<CameraModel> truth() const override { return camera_.model(); }

 private:
  VirtualCamera camera_;
  std::size_t next_ = 0;
};

class CameraBoards final : public BoardImages {
 public:
  explicit CameraBoards(std::unique_ptr<LiveImages> images) : images_(std::move(images)) {}

  [[nodiscard]] Next next(std::chrono::milliseconds patience) override {
    Result<std::optional<Image>> image = images_->next(patience);
    if (!image && image.error().code == ErrorCode::kIo) return image.error();
    if (image && !*image) return std::unique_ptr<BoardImage>();
    const std::string name = image_title("image", ++number_);
    if (!image) return board_image(name, image.error());
    return board_image(name, std::move(**image));
  }
  [[nodiscard]] bool ended() const override { return false; }
  [[nodiscard]] bool moving() const override { return true; }

 private:
  std::unique_ptr<LiveImages> images_;
  std::int64_t number_ = 0;
};

}  // namespace

std::unique_ptr<BoardImages> folder_images(std::vector<fs::path> files) {
  return std::make_unique<FolderBoards>(std::move(files));
}

Result<std::unique_ptr<BoardImages>> recording_images(const fs::path& file,
                                                      const std::string& topic,
                                                      const SourcePolicy& sources,
                                                      const std::atomic<bool>* cancel) {
  CameraSpec camera;
  camera.images.emplace();
  camera.images->source = file;
  camera.images->topic = topic;
  auto source = open_image_source(camera, sources, cancel);
  if (!source) return source.error();
  return std::unique_ptr<BoardImages>(std::make_unique<RecordedBoards>(std::move(*source)));
}

Result<std::unique_ptr<BoardImages>> virtual_images(const CameraSpec& camera,
                                                    const calibration::Board& board,
                                                    int views,
                                                    std::uint64_t seed) {
  auto made = VirtualCamera::create({camera.model, camera.sensor, views, seed}, board);
  if (!made) return made.error();
  return std::unique_ptr<BoardImages>(std::make_unique<VirtualBoards>(std::move(*made)));
}

Result<std::unique_ptr<BoardImages>> camera_images(const LiveAddress& address,
                                                   const std::atomic<bool>* cancel) {
  auto images = open_live_images(address, cancel);
  if (!images) return images.error();
  return std::unique_ptr<BoardImages>(std::make_unique<CameraBoards>(std::move(*images)));
}

Result<bool> UploadedImages::push(std::string name, std::vector<std::uint8_t> file) {
  const std::lock_guard lock(mutex_);
  if (finished_) return Error{ErrorCode::kConflict, "the session takes no more images"};
  if (files_.size() >= kMostWaiting) return false;
  files_.push_back({std::move(name), std::move(file)});
  changed_.notify_all();
  return true;
}

void UploadedImages::finish() {
  const std::lock_guard lock(mutex_);
  finished_ = true;
  changed_.notify_all();
}

Next UploadedImages::next(std::chrono::milliseconds patience) {
  File file;
  {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, patience, [&] { return finished_ || !files_.empty(); });
    if (files_.empty()) return std::unique_ptr<BoardImage>();
    file = std::move(files_.front());
    files_.pop_front();
  }
  flight::logs::LoggedPicture picture;
  picture.encoding = "compressed";
  picture.data = file.bytes;
  Result<Image> image = grey_picture(picture, kMostBoardImagePixels);
  if (!image) image = error_for_client(image.error());
  return board_image(std::move(file.name), std::move(image));
}

bool UploadedImages::ended() const {
  const std::lock_guard lock(mutex_);
  return finished_ && files_.empty();
}

}  // namespace overfly::server
