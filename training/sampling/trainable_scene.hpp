// What a reduced model can be trained on.
#pragma once

#include "fom/scene/scene.hpp"
#include "training/training.hpp"

namespace undula::training {

/// Throws InputError, with section and what to write, for a scene that states physics a projection would
/// leave out: a problem of its own, thin gaps, a fluid's domain that moves, contact, a nonlinear solid,
/// slip, penalties that depend on the flow, a scaled stroke. An emulator leaves nothing out: any pump. To be
/// called before the first run.
void require_trainable(const Scene& scene);

/// Finite elements on a domain that moves by a map: what a moving model is projected from.
bool has_mapped_domain(const Scene& scene);

} // namespace undula::training
