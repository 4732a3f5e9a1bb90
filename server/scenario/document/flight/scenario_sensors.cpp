#include "server/scenario/document/flight/scenario_sensors.hpp"

namespace overfly::server {

Status read_sensors(const nlohmann::json& document, Scenario& scenario) {
  const auto sensors = document.find("sensors");
  if (sensors == document.end()) return {};
  scenario.sensors.with_each([&]<typename Model>(const char* name, std::optional<Model>& model) {
    const auto sensor = sensors->find(name);
    if (sensor == sensors->end()) return;
    model.emplace();
    for (const auto& field : flight::fields_of<Model>()) {
      (*model).*field.value = sensor->at(field.name).template get<double>();
    }
  });
  if (Status valid = scenario.sensors.validate(); !valid) {
    return Error{valid.error().code, "sensors." + valid.error().message};
  }
  return {};
}

}  // namespace overfly::server
