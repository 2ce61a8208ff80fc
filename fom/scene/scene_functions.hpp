// Functions made of the expressions of one scene.
#pragma once

#include <string>

#include "fom/problem/fields.hpp"
#include "fom/scene/expression.hpp"
#include "fom/scene/scene.hpp"
#include "rom/base/units.hpp"

namespace undula::fom {

/// Empty for expressions that are left out; `cgs_per_unit` times their value. `where`: for messages. The
/// scene has to outlive this, not the functions.
class SceneFunctions {
public:
  explicit SceneFunctions(const Scene& scene) : scene_(scene) {}

  Expression expression(const std::string& text, const std::string& where) const {
    return {text, scene_.space, scene_.problem.constants, where};
  }
  VectorField<2> vector(const std::array<std::string, 2>& texts, double cgs_per_unit,
                        const std::string& where) const {
    if (texts[0].empty()) return {};
    return [first = expression(texts[0], where), second = expression(texts[1], where), cgs_per_unit](
               const Point<2>& x, double t) -> Point<2> {
      const double a = units::length_to_mm(x[0]), b = units::length_to_mm(x[1]);
      return cgs_per_unit * Point<2>(first(a, b, t), second(a, b, t));
    };
  }
  ScalarField<2> scalar(const std::string& text, double cgs_per_unit, const std::string& where) const {
    if (text.empty()) return {};
    return [value = expression(text, where), cgs_per_unit](const Point<2>& x, double t) {
      return cgs_per_unit * value(units::length_to_mm(x[0]), units::length_to_mm(x[1]), t);
    };
  }
  TimeFunction time(const std::string& text, double cgs_per_unit, const std::string& where) const {
    if (text.empty()) return {};
    return
        [value = expression(text, where), cgs_per_unit](double t) { return cgs_per_unit * value(0, 0, t); };
  }
  std::function<bool(const Point<2>&)> region(const std::string& text, const std::string& where) const {
    if (text.empty()) return {};
    return [value = expression(text, where)](const Point<2>& x) {
      return value(units::length_to_mm(x[0]), units::length_to_mm(x[1]), 0) != 0;
    };
  }

private:
  const Scene& scene_;
};

} // namespace undula::fom
