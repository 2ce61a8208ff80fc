// Expressions of a scene: arithmetic in the coordinates and time, read by muParser.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "fom/scene/scene.hpp"

namespace undula::fom {

/// Names that expressions may use besides constants: "x", "y" or "r", "z" (mm) and "t" (s).
std::array<std::string, 3> expression_variables(Space space);

/// A function of position and time. Besides the operators and functions of muParser (sin, cos, exp, sqrt,
/// abs, min, max, a ? b : c, &&, ...) there are `pi` and `ramp(t, T)`, which rises from 0 at t = 0 to 1 at t
/// = T as (1 - cos(pi t / T)) / 2. Copies share one parser: not for several threads.
class Expression {
public:
  /// Throws InputError, with `where`, for text that is no expression in these names, and for one that
  /// assigns.
  Expression(const std::string& text, Space space, const std::map<std::string, double>& constants,
             const std::string& where);
  ~Expression();
  Expression(const Expression&) = default;
  Expression& operator=(const Expression&) = default;

  /// Value at a position in mm. Throws NumericsError where it is not finite.
  double operator()(double x_mm, double y_mm, double t) const;

  /// The same, nothing where it is not finite.
  std::optional<double> finite_value(double x_mm, double y_mm, double t) const;

private:
  struct Evaluation;
  std::shared_ptr<Evaluation> evaluation_;
};

/// Whether `name` may stand for a constant: letters, digits and _, not a name that expressions know already.
bool is_free_name(const std::string& name);

} // namespace undula::fom
