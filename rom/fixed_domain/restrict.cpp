#include <algorithm>

#include "rom/base/error.hpp"
#include "rom/fixed_domain/model.hpp"

namespace undula::rom {

Operators restrict_operators(const Operators& full, int velocity_modes, int pressure_modes,
                             int displacement_modes) {
  const auto check = [](const char* field, int wanted, int available) {
    if (wanted < 0 || wanted > available)
      throw InputError(std::string("cannot keep that many ") + field + " modes", std::to_string(wanted),
                       "0 to " + std::to_string(available), "number of modes asked of the reduced model");
  };
  const int proper_modes = full.velocity_modes - full.supremizer_modes;
  check("velocity", velocity_modes, proper_modes);
  check("pressure", pressure_modes, full.pressure_modes);
  check("displacement", displacement_modes, full.displacement_modes);
  const int supremizers = std::min(full.supremizer_modes, pressure_modes);

  std::vector<int> velocity; // modes kept
  for (int i = 0; i < velocity_modes; ++i) velocity.push_back(i);
  for (int i = 0; i < supremizers; ++i) velocity.push_back(proper_modes + i);
  std::vector<int> kept = velocity; // rows of y
  for (int i = 0; i < pressure_modes; ++i) kept.push_back(full.velocity_modes + i);
  for (int i = 0; i < displacement_modes; ++i) kept.push_back(full.velocity_modes + full.pressure_modes + i);

  Operators part;
  part.velocity_modes = velocity_modes + supremizers;
  part.supremizer_modes = supremizers;
  part.pressure_modes = pressure_modes;
  part.displacement_modes = displacement_modes;
  part.mass = full.mass(kept, kept);
  part.linear = full.linear(kept, kept);
  part.stiffness = full.stiffness.topLeftCorner(displacement_modes, displacement_modes);
  for (const int k : velocity)
    part.convection.emplace_back(full.convection[static_cast<std::size_t>(k)](velocity, velocity));
  part.imposed_mass = full.imposed_mass(kept);
  part.imposed_linear = full.imposed_linear(kept);
  part.imposed_stiffness = full.imposed_stiffness(kept);
  part.head = full.head(kept);
  part.outflow = full.outflow(velocity);
  part.inflow = full.inflow(velocity);
  part.envelope = full.envelope.leftCols(displacement_modes);
  part.envelope_imposed = full.envelope_imposed;
  part.envelope_radius = full.envelope_radius;
  return part;
}

} // namespace undula::rom
