// same_model a.h5 b.h5: exit code 0 if two model files hold the same numbers bit for bit. How long their runs
// took does not count.
#include <cstdio>
#include <exception>

#include "rom/fixed_domain/model.hpp"

namespace {

bool same(const undula::rom::Model& a, const undula::rom::Model& b) {
  const auto &x = a.operators, &y = b.operators;
  if (a.references.size() != b.references.size()) return false;
  for (std::size_t i = 0; i < a.references.size(); ++i) {
    const auto &r = a.references[i], &s = b.references[i];
    if (r.frequency_Hz != s.frequency_Hz || r.stroke_mm != s.stroke_mm || r.head_mmHg != s.head_mmHg ||
        r.flow_l_per_min != s.flow_l_per_min || r.flow_spread_l_per_min != s.flow_spread_l_per_min ||
        r.held_out != s.held_out || r.rom_flow_l_per_min != s.rom_flow_l_per_min ||
        r.velocity_error != s.velocity_error || r.envelope_error != s.envelope_error)
      return false;
  }
  return x.mass == y.mass && x.linear == y.linear && x.stiffness == y.stiffness &&
         x.convection == y.convection && x.imposed_mass == y.imposed_mass &&
         x.imposed_linear == y.imposed_linear && x.imposed_stiffness == y.imposed_stiffness &&
         x.head == y.head && x.outflow == y.outflow && x.inflow == y.inflow && x.envelope == y.envelope &&
         x.envelope_imposed == y.envelope_imposed && x.envelope_radius == y.envelope_radius &&
         a.steps_per_period == b.steps_per_period && a.error_safety == b.error_safety &&
         a.error_floor_l_per_min == b.error_floor_l_per_min;
}

} // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: same_model a.h5 b.h5\n");
    return 2;
  }
  try {
    return same(undula::rom::load_model(argv[1]), undula::rom::load_model(argv[2])) ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
