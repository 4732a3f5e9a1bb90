// camera.txt of the TUM monoVO data set, as described in DSO's documentation: model and intrinsics,
// size, rectification mode, size of the rectified image. Only the first two lines describe the
// camera.
#include <cmath>

#include "server/dataset/dataset_reader.hpp"

namespace overfly::server {
namespace {

struct Lens {
  DistortionModel model = DistortionModel::kNone;
  std::size_t first = 1;  ///< column of fx, from 1
  std::size_t coefficients = 0;
};

/// A line without a name has five numbers: the FOV model, or a pinhole if the fifth is 0.
Result<Lens> lens_of(const FieldFile& file, const FieldLine& line) {
  const std::string name(line.fields.front());
  if (name == "Pinhole") return Lens{DistortionModel::kNone, 2, 1};
  if (name == "FOV") return Lens{DistortionModel::kFov, 2, 1};
  if (name == "RadTan") return Lens{DistortionModel::kRadtan, 2, 4};
  if (name == "EquiDistant" || name == "KannalaBrandt") {
    return Lens{DistortionModel::kEquidistant, 2, 4};
  }
  if (line.fields.size() == 5) return Lens{DistortionModel::kFov, 1, 1};
  return file.bad_field(
      line, 1, "must be Pinhole, FOV, RadTan, EquiDistant, KannalaBrandt, or five numbers");
}

Result<int> pixels(const FieldFile& file, const FieldLine& line, std::size_t column) {
  const Result<double> value = file.number(line, column);
  if (!value) return value.error();
  if (!(*value >= 1.0 && *value <= 65536.0) || *value != std::floor(*value)) {
    return file.bad_field(line, column, "must be a whole number in [1, 65536]");
  }
  return static_cast<int>(*value);
}

Result<std::vector<double>> numbers_from(const FieldFile& file,
                                         const FieldLine& line,
                                         std::size_t first) {
  std::vector<double> values;
  for (std::size_t column = first; column <= line.fields.size(); ++column) {
    const Result<double> value = file.number(line, column);
    if (!value) return value.error();
    values.push_back(*value);
  }
  return values;
}

Result<Distortion> lens_distortion(const FieldFile& file,
                                   const FieldLine& line,
                                   const Lens& lens,
                                   const std::vector<double>& values) {
  Distortion distortion;
  const bool zero = lens.coefficients == 1 && values[4] == 0.0;
  if (lens.model == DistortionModel::kNone && !zero) {
    return file.bad_line(line, "a Pinhole must have only coefficients of 0");
  }
  if (zero) return distortion;
  distortion.model = lens.model;
  std::copy(values.begin() + 4, values.end(), distortion.k.begin());
  return distortion;
}

}  // namespace

Result<CameraModel> read_tum_mono_camera(const std::filesystem::path& path) {
  const Result<FieldFile> file = FieldFile::read(path);
  if (!file) return file.error();
  if (file->lines().size() < 2) {
    return Error{ErrorCode::kUnreadable,
                 path.string() + ": must have a line of intrinsics and one of the size"};
  }
  const FieldLine& first = file->lines()[0];
  const FieldLine& second = file->lines()[1];
  const Result<Lens> lens = lens_of(*file, first);
  if (!lens) return lens.error();
  Status status = file->expect_fields(first, lens->first + 3 + lens->coefficients);
  if (status) status = file->expect_fields(second, 2);
  if (!status) return status.error();
  const Result<int> width = pixels(*file, second, 1);
  if (!width) return width.error();
  const Result<int> height = pixels(*file, second, 2);
  if (!height) return height.error();
  const auto values = numbers_from(*file, first, lens->first);
  if (!values) return values.error();
  PinholeCamera pinhole{*width, *height, (*values)[0], (*values)[1], (*values)[2], (*values)[3]};
  if (pinhole.cx_px < 1.0 && pinhole.cy_px < 1.0) {
    pinhole.fx_px *= *width;
    pinhole.fy_px *= *height;
    pinhole.cx_px = pinhole.cx_px * *width - 0.5;
    pinhole.cy_px = pinhole.cy_px * *height - 0.5;
  }
  const Result<Distortion> distortion = lens_distortion(*file, first, *lens, *values);
  if (!distortion) return distortion.error();
  const CameraModel camera(pinhole, *distortion);
  if (Status valid = camera.validate(); !valid) {
    return file->bad_line(first, valid.error().message);
  }
  return camera;
}

}  // namespace overfly::server
