// The modes of a reduced model on the points of a picture.
#pragma once

#include "rom/fixed_domain/field_bases.hpp"
#include "training/reduction/bases.hpp"

namespace undula::training {

/// The meshes of fluid_picture and solid_picture with every mode on their points. Sums of modes are then the
/// fields that `undula solve` writes.
rom::FieldBases drawn_bases(const Discretisation<2>& disc, const Bases& bases);

} // namespace undula::training
