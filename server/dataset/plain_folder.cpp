// A folder of images, and a file with their times.
#include <cmath>
#include <map>

#include "server/dataset/dataset_reader.hpp"
#include "server/dataset/grey_image.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;

/// Column numbers, from 1; 0 = absent.
struct Columns {
  std::size_t count = 0;
  std::size_t time = 1;
  std::size_t name = 0;
  std::size_t exposure = 0;
};

/// Detected from the first line: TIME | TIME NAME | NAME TIME | NAME TIME EXPOSURE. A name is a
/// field with an image extension, or the first of three columns (TUM monoVO's id).
Result<Columns> columns_of(const FieldFile& file) {
  const FieldLine& line = file.lines().front();
  const std::size_t count = line.fields.size();
  if (count == 1) return Columns{1, 1, 0, 0};
  if (count == 2 && is_image_name(fs::path(line.fields[1]))) return Columns{2, 1, 2, 0};
  if (count == 2) return Columns{2, 2, 1, 0};
  if (count == 3) return Columns{3, 2, 1, 3};
  return file.bad_line(line,
                       std::to_string(count) +
                           " columns: must be TIME, TIME NAME, NAME TIME or NAME TIME EXPOSURE_MS");
}

bool is_whole(std::string_view text) {
  return text.find_first_not_of("+-0123456789") == std::string_view::npos;
}

/// True if the mean step of the numbers, read as seconds, exceeds a day: they are nanoseconds.
bool counts_nanoseconds(const FieldFile& file, const Columns& columns) {
  constexpr double kDay = 86400.0;
  double first = 0.0;
  double last = 0.0;
  for (const FieldLine& line : file.lines()) {
    if (line.fields.size() != columns.count || !is_whole(line.fields[columns.time - 1])) {
      return false;
    }
    const Result<double> value = file.number(line, columns.time);
    if (!value) return false;
    if (&line == &file.lines().front()) first = *value;
    last = *value;
  }
  const auto steps = static_cast<double>(file.lines().size()) - 1.0;
  // A single time: present Unix times in seconds have ten digits.
  return steps > 0.0 ? (last - first) / steps > kDay : std::abs(first) > 1e12;
}

/// The list of times, and the images of the folder.
class PlainList {
 public:
  PlainList(const DatasetOptions& options,
            const FieldFile& file,
            const Columns& columns,
            std::vector<fs::path> images)
      : options_(options), file_(file), columns_(columns), images_(std::move(images)) {
    for (const fs::path& image : images_) by_stem_[image.stem().string()] = image;
    nanoseconds_ = options.time_unit == TimeUnit::kNanoseconds ||
                   (options.time_unit == TimeUnit::kAuto && counts_nanoseconds(file, columns));
  }

  /// @param i  index of the line
  Result<DatasetImage> image_of(const FieldLine& line, std::size_t i) const {
    if (Status status = file_.expect_fields(line, columns_.count); !status) return status.error();
    DatasetImage image;
    image.index = static_cast<std::int64_t>(i);
    const Result<std::int64_t> t_ns =
        nanoseconds_ ? file_.time_ns(line, columns_.time) : file_.time_s(line, columns_.time);
    if (!t_ns) return t_ns.error();
    image.t_ns = *t_ns;
    if (columns_.exposure != 0) {
      const auto exposure_ns = exposure_ms(file_, line, columns_.exposure);
      if (!exposure_ns) return exposure_ns.error();
      image.exposure_ns = *exposure_ns;
    }
    const Result<fs::path> file = columns_.name == 0 ? images_[i] : named(line);
    if (!file) return file.error();
    image.file = *file;
    return image;
  }

 private:
  /// The image that a line names, with or without extension.
  Result<fs::path> named(const FieldLine& line) const {
    const fs::path name(line.fields[columns_.name - 1]);
    if (is_image_name(name)) return options_.folder / name;
    const auto found = by_stem_.find(name.string());
    if (found != by_stem_.end()) return found->second;
    return file_.bad_field(
        line, columns_.name, "no image of this name in " + options_.folder.string());
  }

  const DatasetOptions& options_;
  const FieldFile& file_;
  Columns columns_;
  std::vector<fs::path> images_;
  std::map<std::string, fs::path> by_stem_;
  bool nanoseconds_ = false;
};

}  // namespace

Result<ListedDataset> read_plain_folder(const DatasetOptions& options) {
  const fs::path& path = *options.times;
  const Result<FieldFile> file = FieldFile::read(path);
  if (!file) return file.error();
  if (file->lines().empty()) {
    return Error{ErrorCode::kUnreadable, path.string() + ": contains no times"};
  }
  const Result<Columns> columns = columns_of(*file);
  if (!columns) return columns.error();
  const Result<std::vector<fs::path>> found = images_in(options.folder);
  if (!found) return found.error();
  if (columns->name == 0) {
    Status status = expect_as_many(path, file->lines().size(), options.folder, found->size());
    if (!status) return status.error();
  }
  const PlainList list(options, *file, *columns, *found);
  ListedDataset listed;
  listed.dataset.layout = DatasetLayout::kImages;
  std::vector<DatasetImage>& images = listed.dataset.images;
  for (const FieldLine& line : file->lines()) {
    Result<DatasetImage> image = list.image_of(line, images.size());
    if (!image) return image.error();
    Status status = append_image(path, line, std::move(*image), images);
    if (!status) return status.error();
  }
  return listed;
}

}  // namespace overfly::server
