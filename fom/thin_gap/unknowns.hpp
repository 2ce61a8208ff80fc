// Places of the unknowns of a thin-gap step: node by node, so that the matrix is a narrow band.
#pragma once

namespace undula::fom {

/// State::x holds the pressure at the tip and then, per node: the flows (cm^3/s, outwards) through the face
/// before it in the upper and the lower gap, the pressures (dyn/cm^2) at it, and the velocities of the plate.
/// Two flows behind the last node end it. State::d holds w, theta, u of every node.
struct ThinGapUnknowns {
  int nodes = 0;
  static constexpr int per_node = 7;
  static constexpr int reach = per_node + 2; ///< largest distance of two coupled unknowns
  static constexpr int tip_pressure = 0;

  int upper_flow(int face) const { return 1 + per_node * face; } ///< face i lies before node i; 0 .. nodes
  int lower_flow(int face) const { return 2 + per_node * face; }
  int upper_pressure(int node) const { return 3 + per_node * node; }
  int lower_pressure(int node) const { return 4 + per_node * node; }
  int deflection_rate(int node) const { return 5 + per_node * node; }
  int rotation_rate(int node) const { return 6 + per_node * node; }
  int radial_rate(int node) const { return 7 + per_node * node; }
  int size() const { return 3 + per_node * nodes; }

  static constexpr int displacements_per_node = 3;
  int deflection(int node) const { return displacements_per_node * node; }
  int rotation(int node) const { return displacements_per_node * node + 1; }
  int radial(int node) const { return displacements_per_node * node + 2; }
  int displacements() const { return displacements_per_node * nodes; }
};

} // namespace undula::fom
