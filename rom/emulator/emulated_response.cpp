#include "rom/emulator/emulated_response.hpp"

#include <algorithm>

#include "rom/emulator/emulator.hpp"

namespace undula::rom {

PeriodResponse emulate(const Emulator& emulator, const EmulatedResponse& response,
                       const EmulatorPoint& point) {
  const Eigen::VectorXd x = scaled_point(emulator, point);
  Eigen::VectorXd values = response.mean;
  for (std::size_t k = 0; k < response.coefficients.size(); ++k)
    values += response.coefficients[k](x).mean * response.modes.col(static_cast<Eigen::Index>(k));
  const auto places = static_cast<Eigen::Index>(response.places_mm.size());
  return {Eigen::Map<const Eigen::MatrixXd>(values.data(), places, response.phases),
          growth_at(emulator, point) * response.error};
}

const EmulatedResponse* find_response(const Emulator& emulator, const std::string& name) {
  const auto found = std::ranges::find(emulator.responses, name, &EmulatedResponse::name);
  return found == emulator.responses.end() ? nullptr : &*found;
}

} // namespace undula::rom
