// Hyperelastic laws at a point, in the tensors of the reference configuration.
//
// Saint Venant-Kirchhoff: psi = lambda/2 (tr E)^2 + mu E:E, the linear law in the strain of Green and
// Lagrange. Good for large rotations at small strains; it softens and turns inside out under strong
// compression. Neo-Hooke, compressible: psi = mu/2 (I1 - 3 - 2 ln J) + lambda/2 (ln J)^2 (Bonet & Wood,
// Nonlinear Continuum Mechanics for Finite Element Analysis, 2nd ed. 2008, section 6.4.3). It resists J -> 0
// without bound. With F the deformation gradient, C = F^T F, E = (C - 1)/2, I1 = tr C, J = det F. Both are
// the linear law of the same lambda and mu where strains are small.
#pragma once

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <utility>

#include "fom/problem/materials.hpp"

namespace undula::fom {

/// Entries of a symmetric 3x3 tensor that do not vanish: 11, 22, 33, 12 in plane and axisymmetric space, then
/// 23, 13. The third direction is the one across the plane, or the hoop.
inline constexpr std::array<std::pair<int, int>, 6> symmetric_entries = {
    {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {0, 2}}};
template <int dim>
inline constexpr int symmetric_size = dim == 2 ? 4 : 6;

/// Strains in this form carry twice the off-diagonal entries, so that a product with a stress is work.
template <int dim>
using SymmetricTensor = Eigen::Matrix<double, symmetric_size<dim>, 1>;
template <int dim>
using MaterialTangent = Eigen::Matrix<double, symmetric_size<dim>, symmetric_size<dim>>;

/// Lame's constants, dyn/cm^2.
struct LameConstants {
  double lambda = 0, mu = 0;
};
inline LameConstants lame_constants(const SolidProperties& solid) {
  return {solid.young * solid.poisson / ((1 + solid.poisson) * (1 - 2 * solid.poisson)),
          solid.young / (2 * (1 + solid.poisson))};
}

/// Answer of a material to a deformation, per volume at rest.
template <int dim>
struct MaterialResponse {
  double energy = 0;                     ///< erg/cm^3
  SymmetricTensor<dim> stress;           ///< second Piola-Kirchhoff stress d psi/dE, dyn/cm^2
  MaterialTangent<dim> tangent;          ///< d stress/dE, dyn/cm^2
  SymmetricTensor<dim> geometric_stress; ///< on the second derivatives of the strain in a tangent, dyn/cm^2
};

/// Symmetric part of a 3x3 tensor as a strain.
template <int dim>
SymmetricTensor<dim> strain_entries(const Eigen::Matrix3d& a) {
  SymmetricTensor<dim> entries;
  for (int k = 0; k < symmetric_size<dim>; ++k) {
    const auto [i, j] = symmetric_entries[k];
    entries[k] = i == j ? a(i, i) : a(i, j) + a(j, i);
  }
  return entries;
}

/// The tensor of a stress.
template <int dim>
Eigen::Matrix3d stress_tensor(const SymmetricTensor<dim>& entries) {
  Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
  for (int k = 0; k < symmetric_size<dim>; ++k) {
    const auto [i, j] = symmetric_entries[k];
    a(i, j) = a(j, i) = entries[k];
  }
  return a;
}

/// a A_ij A_kl + b (A_ik A_jl + A_il A_jk) / 2 for a symmetric A.
template <int dim>
MaterialTangent<dim> isotropic_tangent(const Eigen::Matrix3d& A, double a, double b) {
  MaterialTangent<dim> tangent;
  for (int m = 0; m < symmetric_size<dim>; ++m)
    for (int n = 0; n < symmetric_size<dim>; ++n) {
      const auto [i, j] = symmetric_entries[m];
      const auto [k, l] = symmetric_entries[n];
      tangent(m, n) = a * A(i, j) * A(k, l) + 0.5 * b * (A(i, k) * A(j, l) + A(i, l) * A(j, k));
    }
  return tangent;
}

/// Elasticity of the linear law: stress = tangent * strain.
template <int dim>
MaterialTangent<dim> linear_tangent(const LameConstants& lame) {
  return isotropic_tangent<dim>(Eigen::Matrix3d::Identity(), lame.lambda, 2 * lame.mu);
}

/// E of the displacement gradient H, without the rounding of 1 + H.
inline Eigen::Matrix3d green_lagrange(const Eigen::Matrix3d& H) {
  return 0.5 * (H + H.transpose() + H.transpose() * H);
}

/// ln J of the displacement gradient H likewise; not a number where J < 0.
inline double log_volume_ratio(const Eigen::Matrix3d& H) {
  const double trace = H.trace();
  return std::log1p(trace + 0.5 * (trace * trace - (H * H).trace()) + H.determinant());
}

/// Response to the displacement gradient H = F - 1. Neo-Hooke where J <= 0: not finite.
///
/// `before`: null for exact derivatives; else H at the iterate of Newton's method before. Then the stress
/// that `tangent` and `geometric_stress` rest on (of Neo-Hooke its part by the change of volume) is
/// extrapolated from there linearly, as if it were an unknown of its own. A strain of second order in the
/// increment then leaves no spurious stress in the tangent, which in thin or nearly incompressible solids
/// throws Newton off (Magisano, Leonetti & Garcea, Comput. Methods Appl. Mech. Eng. 313, 2017, pp. 986-1005).
/// Convergence stays quadratic: the stresses differ by the increment squared.
template <int dim>
MaterialResponse<dim> material_response(SolidModel model, const LameConstants& lame, const Eigen::Matrix3d& H,
                                        const Eigen::Matrix3d* before = nullptr) {
  const Eigen::Matrix3d one = Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d E = green_lagrange(H);
  MaterialResponse<dim> response;
  if (model == SolidModel::neo_hookean) {
    const double log_J = log_volume_ratio(H);
    const double tangent_log_J =
        before ? log_volume_ratio(*before) + ((one + *before).inverse() * (H - *before)).trace() : log_J;
    const Eigen::Matrix3d inverse = (one + 2 * E).inverse();
    const auto stress = [&](double volumetric) {
      const Eigen::Matrix3d S = 2 * lame.mu * (inverse * E) + lame.lambda * volumetric * inverse; // 1 - C^-1
      SymmetricTensor<dim> entries;
      for (int k = 0; k < symmetric_size<dim>; ++k)
        entries[k] = S(symmetric_entries[k].first, symmetric_entries[k].second);
      return entries;
    };
    response.energy = lame.mu * (E.trace() - log_J) + 0.5 * lame.lambda * log_J * log_J;
    response.stress = stress(log_J);
    response.geometric_stress = stress(tangent_log_J);
    response.tangent =
        isotropic_tangent<dim>(inverse, lame.lambda, 2 * (lame.mu - lame.lambda * tangent_log_J));
  } else {
    const SymmetricTensor<dim> strain = strain_entries<dim>(E);
    response.tangent = linear_tangent<dim>(lame);
    response.stress = response.geometric_stress = response.tangent * strain;
    response.energy = 0.5 * strain.dot(response.stress);
    if (before)
      response.geometric_stress =
          response.tangent *
          strain_entries<dim>(green_lagrange(*before) + (one + *before).transpose() * (H - *before));
  }
  return response;
}

} // namespace undula::fom
