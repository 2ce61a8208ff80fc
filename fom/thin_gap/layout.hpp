// The geometry of a pump as the thin-gap level sees it: heights over radius, and passages.
#pragma once

#include <vector>

#include "fom/fom.hpp"
#include "geometry/mesh/simplex_mesh.hpp"
#include "geometry/wave_pump/profile.hpp"

namespace undula::fom {

/// A passage as one flow: pressure drop = density * inertance * dq/dt + viscosity * resistance * q + losses
/// of density / 2 * (q / area)^2.
struct Passage {
  double inertance = 0;  ///< 1/cm: potential flow, or length / area
  double resistance = 0; ///< 1/cm^3: laminar friction of that flow
  double area = 0;       ///< cm^2, where it is narrowest
};

/// Nodes over the radius, from the tip to the rim, and what lies above and below them at rest.
struct ThinGapLayout {
  std::vector<double>
      radius; ///< cm, ascending, steps that grow from the tip to the clamp, even ones beyond it
  std::vector<double> thickness; ///< cm, of the plate
  std::vector<double>
      upper_height; ///< cm, from the plate to the wall above, mean around the node; [0, channel]
  std::vector<double> lower_height; ///< cm, from the plate to the wall (over the bore: the outlet) below
  int clamp = 0;                    ///< first node that moves with the holder
  int channel = 0;                  ///< node from which the inlet's channel lies above instead of a gap
  int lip = 0;                      ///< first node with the lower flange below; before it, the bore
  double step = 0;                  ///< cm between nodes
  double holder_area = 0;           ///< cm^2, of the plate below the inlet's channel: a piston
  Passage inlet;                    ///< from the inlet to the chamber above the holder
  Passage rim;                      ///< past the rim, between the chambers below and above the holder
  Passage outlet;                   ///< from the tip through the bore to the outlet
};

/// Radius between a node and the one before it, cm; the ends of the membrane for node 0 and beyond the last.
double face_radius(const ThinGapLayout& layout, int face);

/// Area of the plate that belongs to a node, cm^2.
double node_area(const ThinGapLayout& layout, int node);

/// Derives a layout from a profile. `background` fills the outline of the profile (pump_background); the
/// passages to inlet and outlet come from potential flow on it. Throws InputError naming what is missing
/// where the profile does not have the parts.
ThinGapLayout thin_gap_layout(const PumpProfile& profile, const SimplexMesh<2>& background,
                              double clamp_radius, int cells);

} // namespace undula::fom
