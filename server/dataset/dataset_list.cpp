// What the readers of all layouts share.
#include <algorithm>
#include <cmath>
#include <system_error>
#include <utility>

#include "core/motion/time_order.hpp"
#include "core/text/natural_order.hpp"
#include "server/dataset/dataset_reader.hpp"
#include "server/dataset/grey_image.hpp"
#include "server/files/plain_name.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;

}  // namespace

Status check_camera_name(const std::string& name) {
  if (is_plain_name(name)) return {};
  return Error{ErrorCode::kInvalidArgument,
               "camera name = \"" + name.substr(0, 100) +
                   "\": must be 1 to 200 letters, digits, '_', '-' or '.', not beginning with '.'"};
}

Status append_image(const fs::path& list_file,
                    const FieldLine& line,
                    DatasetImage image,
                    std::vector<DatasetImage>& images) {
  image.line = line.number;
  image.listed_at = list_file.string() + ":" + std::to_string(line.number);
  images.push_back(std::move(image));
  return {};
}

Status order_images(Dataset& dataset) {
  std::vector<DatasetImage>& images = dataset.images;
  if (images.empty()) return {};
  std::vector<TimedLine> times;
  for (const DatasetImage& image : images) times.push_back({image.t_ns, image.line});
  const std::string& first = images.front().listed_at;
  const TimeOrder order = order_by_time(first.substr(0, first.rfind(':')), "images", times);
  std::vector<DatasetImage> ordered;
  for (const std::size_t i : order.kept) ordered.push_back(std::move(images[i]));
  images = std::move(ordered);
  dataset.warnings.insert(dataset.warnings.end(), order.warnings.begin(), order.warnings.end());
  const bool moved = !std::is_sorted(order.kept.begin(), order.kept.end());
  for (std::size_t i = 0; moved && i < images.size(); ++i) {
    images[i].index = static_cast<std::int64_t>(i);
  }
  for (std::size_t i = 1; i < images.size(); ++i) {
    if (images[i].index > images[i - 1].index) continue;
    return Error{ErrorCode::kUnreadable,
                 images[i].listed_at + ": image number " + std::to_string(images[i].index) +
                     ": must be above " + std::to_string(images[i - 1].index) +
                     ", the previous one"};
  }
  return {};
}

Result<std::int64_t> exposure_ms(const FieldFile& list, const FieldLine& line, std::size_t column) {
  const Result<double> ms = list.number(line, column);
  if (!ms) return ms.error();
  constexpr double kLongestMs = 1e6;
  if (*ms < 0.0 || *ms > kLongestMs) {
    return list.bad_field(line, column, "an exposure must be in [0, 1e6] ms");
  }
  return std::llround(*ms * 1e6);
}

Result<std::vector<fs::path>> images_in(const fs::path& folder) {
  std::error_code failure;
  std::vector<fs::path> files;
  for (fs::directory_iterator entry(folder, failure), end; !failure && entry != end;
       entry.increment(failure)) {
    if (is_image_name(entry->path())) files.push_back(entry->path());
  }
  if (failure) {
    return Error{ErrorCode::kNotFound, folder.string() + ": cannot be read: " + failure.message()};
  }
  std::sort(files.begin(), files.end(), [](const fs::path& a, const fs::path& b) {
    return before_naturally(a.filename().string(), b.filename().string());
  });
  return files;
}

Status expect_as_many(const fs::path& list_file,
                      std::size_t lines,
                      const fs::path& folder,
                      std::size_t images) {
  if (lines == images) return {};
  return Error{ErrorCode::kUnreadable,
               list_file.string() + ": " + std::to_string(lines) + " times, but " +
                   folder.string() + " contains " + std::to_string(images) +
                   " images: the numbers must be equal"};
}

}  // namespace overfly::server
