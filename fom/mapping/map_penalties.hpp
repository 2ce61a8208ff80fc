// Penalties of the problems that make the map of the domain.
#pragma once

namespace undula::fom {

/// Nitsche's, on the skin: well above the trace constants of linear elements.
constexpr double map_skin_penalty = 20;

/// Ghost penalty: bounds the trace constants of cut elements.
constexpr double map_ghost_penalty = 0.1;

} // namespace undula::fom
