// The plate of the thin-gap level by itself: its forces summed over the nodes of a layout, in vacuo.
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <vector>

#include "fom/thin_gap/layout.hpp"
#include "fom/thin_gap/plate.hpp"
#include "tests/verification/support/names.hpp"

namespace undula::verification {

/// A plate, clamped from node `layout.clamp` on. Vectors hold w, theta, u of the nodes before it (cm, rad).
struct ThinGapPlate {
  ThinGapLayout layout;
  SolidProperties material;
  SolidModel model = SolidModel::linear;
  bool disc = false; ///< the first node stands on the axis and neither turns nor moves radially

  int size() const { return 3 * layout.clamp; }

  /// Internal forces, dyn (w, u) and dyn cm (theta).
  Eigen::VectorXd forces(const Eigen::VectorXd& d) const {
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(size());
    for (int inner = 0; inner < layout.clamp; ++inner) {
      const auto f = element_forces(inner, node(d, inner), node(d, inner + 1));
      add(sum, inner, f.inner);
      add(sum, inner + 1, f.outer);
    }
    return sum;
  }

  /// Derivative of the forces at d, by central differences of one element after the other (exact but for
  /// rounding: the forces are of third order at most and the steps are small).
  Eigen::MatrixXd stiffness(const Eigen::VectorXd& d, double step) const {
    Eigen::MatrixXd K = Eigen::MatrixXd::Zero(size(), size());
    for (int inner = 0; inner < layout.clamp; ++inner)
      for (int k = 0; k < 6; ++k) {
        const int column = 3 * inner + k;
        if (column >= size() || held(column)) continue;
        Eigen::VectorXd moved = Eigen::VectorXd::Zero(size());
        for (const double sign : {1.0, -1.0}) {
          std::array<PlateNode<double>, 2> ends = {node(d, inner), node(d, inner + 1)};
          auto& end = ends[k / 3];
          (k % 3 == 0 ? end.w : k % 3 == 1 ? end.theta : end.u) += sign * step;
          const auto f = element_forces(inner, ends[0], ends[1]);
          const auto scaled = [&](const PlateNode<double>& a) {
            return PlateNode<double>{sign * a.w, sign * a.theta, sign * a.u};
          };
          add(moved, inner, scaled(f.inner));
          add(moved, inner + 1, scaled(f.outer));
        }
        K.col(column) += moved / (2 * step);
      }
    for (int i = 0; i < size(); ++i)
      if (held(i)) {
        K.row(i).setZero();
        K(i, i) = 1;
      }
    return K;
  }

  /// Masses as the level lumps them, g and g cm^2.
  Eigen::VectorXd masses() const {
    Eigen::VectorXd m(size());
    for (int i = 0; i < layout.clamp; ++i) {
      const double h = layout.thickness[i], mass = material.density * h * node_area(layout, i);
      m.segment<3>(3 * i) << mass, mass * h * h / 12, mass;
    }
    return m;
  }

  /// Forces of a uniform pressure (dyn/cm^2), lumped as the level does.
  Eigen::VectorXd load(double pressure) const {
    Eigen::VectorXd f = Eigen::VectorXd::Zero(size());
    for (int i = 0; i < layout.clamp; ++i) f[3 * i] = pressure * node_area(layout, i);
    return f;
  }

  /// Deflection under a load, by Newton from d. Throws nothing: the caller looks at the residual.
  Eigen::VectorXd solve(const Eigen::VectorXd& load_vector, Eigen::VectorXd d, int iterations) const {
    for (int k = 0; k < iterations; ++k) {
      Eigen::VectorXd residual = forces(d) - load_vector;
      for (int i = 0; i < size(); ++i)
        if (held(i)) residual[i] = 0;
      d -= stiffness(d, 1e-5 * layout.thickness.front()).partialPivLu().solve(residual);
    }
    return d;
  }

  /// The `count` lowest angular frequencies, rad/s, of bending (the stretching is left out).
  std::vector<double> frequencies(int count) const {
    const Eigen::MatrixXd all = stiffness(Eigen::VectorXd::Zero(size()), 1e-5);
    const Eigen::VectorXd all_masses = masses();
    const int n = 2 * layout.clamp; // w and theta
    const auto from = [](int i) { return 3 * (i / 2) + i % 2; };
    Eigen::MatrixXd K(n, n);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        K(i, j) = all(from(i), from(j)) / std::sqrt(all_masses[from(i)] * all_masses[from(j)]);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(0.5 * (K + K.transpose()),
                                                                Eigen::EigenvaluesOnly);
    std::vector<double> omega;
    for (int k = 0; k < count; ++k) omega.push_back(std::sqrt(solver.eigenvalues()[k]));
    return omega;
  }

private:
  bool held(int unknown) const { return disc && (unknown == 1 || unknown == 2); }

  PlateForces<double> element_forces(int inner, const PlateNode<double>& a,
                                     const PlateNode<double>& b) const {
    const auto& r = layout.radius;
    const PlateElement element{0.5 * (r[inner] + r[inner + 1]), r[inner + 1] - r[inner],
                               0.5 * (layout.thickness[inner] + layout.thickness[inner + 1])};
    const PlateNode<double> rest{0, 0, 0};
    return plate_forces<double>(element, material, model, {a, b}, {rest, rest});
  }
  PlateNode<double> node(const Eigen::VectorXd& d, int i) const {
    if (i >= layout.clamp) return {0, 0, 0};
    return {d[3 * i], d[3 * i + 1], d[3 * i + 2]};
  }
  void add(Eigen::VectorXd& sum, int i, const PlateNode<double>& f) const {
    if (i < layout.clamp) sum.segment<3>(3 * i) += Eigen::Vector3d(f.w, f.theta, f.u);
  }
};

/// Evenly spaced nodes from `inner` to `outer` with thickness h, clamped at the last one.
inline ThinGapLayout uniform_plate(double inner, double outer, double h, int cells) {
  ThinGapLayout layout;
  for (int i = 0; i <= cells; ++i) {
    layout.radius.push_back(inner + (outer - inner) * i / cells);
    layout.thickness.push_back(h);
  }
  layout.clamp = cells;
  layout.channel = cells;
  layout.step = (outer - inner) / cells;
  return layout;
}

} // namespace undula::verification
