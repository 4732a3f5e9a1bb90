// Data sets of every layout: lists of images, calibrations, times; and their first image.
//
// The input is a folder. Its `options.txt` has layout, camera and unit of time, one on each line;
// an empty line = detected from the files. `times.txt` of layout `images`.
#include "server/dataset/dataset.hpp"
#include "server/dataset/open_dataset.hpp"

#include <fstream>

#include "tests/fuzz/input_folder.hpp"

namespace {

using namespace overfly;
using namespace overfly::server;

DatasetOptions options_from(const std::filesystem::path& folder) {
  DatasetOptions options;
  options.folder = folder;
  std::ifstream in(folder / "options.txt");
  std::string layout, unit;
  std::getline(in, layout);
  std::getline(in, options.camera_name);
  std::getline(in, unit);
  if (layout == "images") {
    options.times = folder / "times.txt";
    options.camera = CameraModel(PinholeCamera{0, 0, 50.0, 50.0, 32.0, 24.0}, Distortion{});
  } else {
    options.layout = dataset_layout_from(layout);
  }
  if (unit == "s") options.time_unit = TimeUnit::kSeconds;
  if (unit == "ns") options.time_unit = TimeUnit::kNanoseconds;
  return options;
}

/// Puts a small image where the examples of the corpus list one, so that text files are enough for
/// a complete data set.
void add_images(const std::filesystem::path& folder) {
  namespace fs = std::filesystem;
  for (const char* name :
       {"mav0/cam0/data/1.png", "images/00001.jpg", "image_0/000000.png", "a.pgm"}) {
    const fs::path file = folder / name;
    std::error_code ignored;
    if (!fs::is_directory(file.parent_path(), ignored) || fs::exists(file, ignored)) continue;
    std::ofstream(file, std::ios::binary) << "P5 4 3 255\n123456789012";
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto& folder =
      fuzz::InputFolder::of_process().fill(fuzz::files_in(fuzz::text_of(data, size)));
  add_images(folder);
  const auto dataset = open_dataset(options_from(folder));
  if (dataset) (void)read_frame(*dataset, dataset->images.size() - 1);
  return 0;
}
