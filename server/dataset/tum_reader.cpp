// TUM data sets: monoVO (Engel, Usenko, Cremers 2016, arXiv:1607.02555) and RGB-D (Sturm et al.
// 2012).
#include <algorithm>
#include <charconv>
#include <map>
#include <system_error>

#include "server/dataset/dataset_reader.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;

/// The id as a number, or -1 if it is none.
std::int64_t number_of(std::string_view id) {
  std::int64_t number = -1;
  const auto [end, error] = std::from_chars(id.data(), id.data() + id.size(), number);
  return error == std::errc() && end == id.data() + id.size() ? number : -1;
}

Result<fs::path> images_folder(const fs::path& folder) {
  std::error_code ignored;
  const fs::path images = folder / "images";
  if (fs::is_directory(images, ignored)) return images;
  if (fs::exists(folder / "images.zip", ignored)) {
    return Error{ErrorCode::kNotFound,
                 images.string() + ": no such folder: unpack images.zip there (unzip -d " +
                     images.string() + " " + (folder / "images.zip").string() + ")"};
  }
  return Error{ErrorCode::kNotFound, images.string() + ": no such folder"};
}

/// Lines are ID TIME [EXPOSURE_MS]; images are found by id.
Status list_images(const FieldFile& file,
                   const fs::path& path,
                   const std::vector<fs::path>& files,
                   std::vector<DatasetImage>& images) {
  std::map<std::string, fs::path> by_stem;
  for (const fs::path& image : files) by_stem[image.stem().string()] = image;
  for (const FieldLine& line : file.lines()) {
    if (line.fields.size() != 2 && line.fields.size() != 3) {
      return file.bad_line(line,
                           std::to_string(line.fields.size()) +
                               " columns: must be ID TIME_S, or ID TIME_S EXPOSURE_MS");
    }
    const auto found = by_stem.find(std::string(line.fields[0]));
    if (found == by_stem.end()) return file.bad_field(line, 1, "no image of this name in images/");
    const Result<std::int64_t> t_ns = file.time_s(line, 2);
    if (!t_ns) return t_ns.error();
    DatasetImage image;
    image.file = found->second;
    const std::int64_t number = number_of(line.fields[0]);
    image.index = number >= 0 ? number : static_cast<std::int64_t>(images.size());
    image.t_ns = *t_ns;
    if (line.fields.size() == 3) {
      const auto exposure_ns = exposure_ms(file, line, 3);
      if (!exposure_ns) return exposure_ns.error();
      image.exposure_ns = *exposure_ns;
    }
    Status status = append_image(path, line, std::move(image), images);
    if (!status) return status;
  }
  return {};
}

}  // namespace

Result<ListedDataset> read_tum_mono(const DatasetOptions& options) {
  const fs::path& folder = options.folder;
  const Result<fs::path> pictures = images_folder(folder);
  if (!pictures) return pictures.error();
  const Result<std::vector<fs::path>> files = images_in(*pictures);
  if (!files) return files.error();
  const fs::path path = folder / "times.txt";
  const Result<FieldFile> file = FieldFile::read(path);
  if (!file) return file.error();
  ListedDataset listed;
  listed.dataset.layout = DatasetLayout::kTumMono;
  Status status = expect_as_many(path, file->lines().size(), *pictures, files->size());
  if (status) status = list_images(*file, path, *files, listed.dataset.images);
  if (!status) return status.error();
  std::error_code ignored;
  for (const char* name : {"pcalib.txt", "vignette.png"}) {
    if (!fs::exists(folder / name, ignored)) continue;
    listed.dataset.notes.push_back(std::string(name) +
                                   " is not applied: the estimator gets the images as they are");
  }
  const Result<CameraModel> camera = read_tum_mono_camera(folder / "camera.txt");
  if (!camera && options.camera) return listed;
  if (!camera) return camera.error();
  listed.camera = *camera;
  return listed;
}

Result<ListedDataset> read_tum_rgbd(const DatasetOptions& options) {
  const fs::path path = options.folder / "rgb.txt";
  const Result<FieldFile> file = FieldFile::read(path);
  if (!file) return file.error();
  ListedDataset listed;
  listed.dataset.layout = DatasetLayout::kTumRgbd;
  std::vector<DatasetImage>& images = listed.dataset.images;
  for (const FieldLine& line : file->lines()) {
    if (Status status = file->expect_fields(line, 2); !status) return status.error();
    const Result<std::int64_t> t_ns = file->time_s(line, 1);
    if (!t_ns) return t_ns.error();
    DatasetImage image;
    image.file = options.folder / fs::path(line.fields[1]);
    image.index = static_cast<std::int64_t>(images.size());
    image.t_ns = *t_ns;
    Status status = append_image(path, line, std::move(image), images);
    if (!status) return status.error();
  }
  return listed;
}

}  // namespace overfly::server
