#include "fom/scene/expression.hpp"

#include <muParser.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>
#include <string_view>

#include "rom/base/error.hpp"
#include "rom/base/smooth_ramp.hpp"
#include "rom/base/text_file.hpp"

namespace undula::fom {

std::array<std::string, 3> expression_variables(Space space) {
  if (space == Space::axisymmetric) return {"r", "z", "t"};
  return {"x", "y", "t"};
}

namespace {

/// In muParser `x = 20` gives x the value 20, whatever x is.
void refuse_assignment(const std::string& text, const std::string& where) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '=') continue;
    const bool pair = i + 1 < text.size() && text[i + 1] == '=';
    const bool compares = i > 0 && std::string_view("<>!").find(text[i - 1]) != std::string_view::npos;
    if (pair) ++i;
    if (pair || compares) continue;
    throw InputError("an expression assigns a value", '"' + text + '"',
                     '"' + text.substr(0, i) + "=" + text.substr(i) + "\": == compares", where);
  }
}

} // namespace

struct Expression::Evaluation {
  mu::Parser parser;
  std::array<double, 3> variables{};
  std::string text, where;
};

Expression::Expression(const std::string& text, Space space, const std::map<std::string, double>& constants,
                       const std::string& where)
    : evaluation_(std::make_shared<Evaluation>()) {
  auto& parser = evaluation_->parser;
  evaluation_->text = text;
  evaluation_->where = where;
  const auto names = expression_variables(space);
  refuse_assignment(text, where);
  try {
    parser.DefineConst("pi", std::numbers::pi);
    parser.DefineFun("ramp", smooth_ramp);
    for (const auto& [name, value] : constants) parser.DefineConst(name, value);
    for (std::size_t i = 0; i < names.size(); ++i) parser.DefineVar(names[i], &evaluation_->variables[i]);
    parser.SetExpr(text);
    int results = 0;
    parser.Eval(results); // finds unknown names and wrong syntax; the value may be anything
    if (results != 1) throw mu::Parser::exception_type("more than one value");
  } catch (const mu::Parser::exception_type& error) {
    std::string known = names[0] + ", " + names[1] + " (mm), " + names[2] + " (s), pi, ramp(t, T)";
    for (const auto& [name, value] : constants) known += ", " + name;
    throw InputError("not an expression: " + error.GetMsg(), '"' + text + '"',
                     "arithmetic in " + known + "; sin, cos, exp, sqrt, min, max, a ? b : c and the like",
                     where);
  }
}

Expression::~Expression() = default;

std::optional<double> Expression::finite_value(double x_mm, double y_mm, double t) const {
  evaluation_->variables = {x_mm, y_mm, t};
  const double value = evaluation_->parser.Eval();
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

double Expression::operator()(double x_mm, double y_mm, double t) const {
  const auto value = finite_value(x_mm, y_mm, t);
  if (!value)
    throw NumericsError("an expression of the scene has no finite value",
                        '"' + evaluation_->text + "\" at (" + exact_number(x_mm) + ", " + exact_number(y_mm) +
                            ") mm, t = " + exact_number(t) + " s, " + evaluation_->where,
                        "an expression that is finite in the whole domain");
  return *value;
}

bool is_free_name(const std::string& name) {
  const auto plain = [](unsigned char c) { return std::isalnum(c) || c == '_'; };
  if (name.empty() || std::isdigit(static_cast<unsigned char>(name.front())) ||
      !std::all_of(name.begin(), name.end(), plain))
    return false;
  for (const char* taken : {"x", "y", "r", "z", "t", "pi", "ramp"})
    if (name == taken) return false;
  mu::Parser parser;
  return !parser.GetFunDef().contains(name);
}

} // namespace undula::fom
