// check_world_sources: checks the names in a world's description before anything is opened.
#include "terrain/files/side_cars.hpp"
#include "terrain/raster/crs_text.hpp"
#include "terrain/world.hpp"

namespace overfly::terrain {
namespace {

/// Collects all errors, one a line, with the code of the most severe one: forbidden before absent.
class ErrorList {
 public:
  void add(const Status& status) {
    if (status) return;
    const Error& error = status.error();
    if (!all_) {
      all_ = error;
      return;
    }
    all_->message += "\n" + error.message;
    if (error.code != ErrorCode::kNotFound) all_->code = error.code;
  }
  [[nodiscard]] Status status() const { return all_ ? Status(*all_) : Status(); }

 private:
  std::optional<Error> all_;
};

template <typename Layer>
void check_layers(const std::vector<Layer>& layers,
                  const SourcePolicy& sources,
                  const std::string& field,
                  SideCars& side_cars,
                  ErrorList& errors) {
  for (std::size_t i = 0; i < layers.size(); ++i) {
    const std::string layer = field + "." + std::to_string(i);
    Status file = sources.check(layers[i].file, layer + ".file");
    if (file) file = side_cars.check(layers[i].file, layer + ".file", sources);
    errors.add(file);
    if (layers[i].crs) errors.add(check_crs_text(*layers[i].crs, layer + ".crs"));
  }
}

}  // namespace

Status check_world_sources(const WorldSpec& spec, const std::string& prefix) {
  ErrorList errors;
  SideCars side_cars;
  check_layers(spec.imagery, spec.sources, prefix + "imagery", side_cars, errors);
  check_layers(spec.elevation, spec.sources, prefix + "elevation", side_cars, errors);
  return errors.status();
}

}  // namespace overfly::terrain
