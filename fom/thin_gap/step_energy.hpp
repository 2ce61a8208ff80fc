// Energies and powers of one step of the thin-gap level.
#pragma once

#include "fom/thin_gap/step.hpp"

namespace undula::fom {

/// Energies and powers of the step that ended in x.
EnergyTerms thin_gap_energy(const ThinGapStep& step, const Eigen::VectorXd& x, double holder_force);

} // namespace undula::fom
