// Model files as commands take them.
#pragma once

#include <span>
#include <string>

#include "rom/curve/hq_curve.hpp"
#include "rom/fixed_domain/model.hpp"

namespace undula::apps {

/// rom::load_model, with a warning for a file of an older version that carries no seal.
rom::Model read_model(const std::string& file);

/// Throws NumericsError, naming the head, if a flow is not a number.
void require_flows(std::span<const rom::HqPoint> points);

} // namespace undula::apps
