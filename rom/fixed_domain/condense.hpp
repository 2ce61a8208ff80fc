// Elimination of the pressure from a reduced model.
#pragma once

#include "rom/fixed_domain/model.hpp"

namespace undula::rom {

/// The same model without its pressure modes. Their rows hold no time derivative, K_pp a_p + K_px x + k_p V =
/// 0 with x = [a_u; a_v], so a_p is a fixed linear function of x and V:
///
///   K' = K_xx - K_xp K_pp^-1 K_px,   k' = k_x - K_xp K_pp^-1 k_p.
///
/// Velocity, displacement and flow of the result are those of `operators`, at the price of a system that is
/// smaller by all pressure modes. Returns `operators` unchanged where that is not possible: no pressure
/// modes, pressure rows that carry mass, stiffness or head, or a K_pp (the projected pressure stabilisation)
/// that is singular.
Operators condense_pressure(const Operators& operators);

/// a_p of states of the condensed model: `x` = [a_u; a_v] (nu + nv rows, a column per instant) and the
/// holder's velocity V (cm/s, by instant). Of operators that condense_pressure condenses.
Eigen::MatrixXd recovered_pressure(const Operators& operators, const Eigen::MatrixXd& x,
                                   const Eigen::RowVectorXd& imposed_velocity);

} // namespace undula::rom
