#include "apps/output/curve_band.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>

#include "apps/output/curve_report.hpp"
#include "apps/output/text_table.hpp"
#include "rom/base/error.hpp"
#include "rom/base/text_file.hpp"
#include "training/calibration/identifiability.hpp"

namespace undula::apps {
namespace {

void warn_of_shift(const Posterior& posterior) {
  double largest = 0;
  for (std::size_t i = 0; i < posterior.shift.size(); ++i) {
    largest = std::max(largest, std::abs(posterior.shift[i]) / posterior.half_width[i]);
  }
  if (largest > 0.5) {
    spdlog::warn(
        "the scene is not calibrated to the given data, which would move the curve by up to {} of its band: "
        "undula calibrate --tolerances",
        decimals(largest, 1));
  }
}

} // namespace

UncertaintyBand part_of_band(const UncertaintyBand& band, std::size_t first, std::size_t count) {
  const auto part = [&](const std::vector<double>& values) {
    const auto begin = values.begin() + static_cast<std::ptrdiff_t>(first);
    return std::vector<double>(begin, begin + static_cast<std::ptrdiff_t>(count));
  };
  UncertaintyBand curve{part(band.half_width), part(band.low), part(band.high), {}};
  for (const InputEffect& input : band.inputs) {
    curve.inputs.push_back(
        {input.key, input.value, input.tolerance, part(input.up), part(input.down), input.note});
  }
  return curve;
}

double CurveBand::half_width_of_samples(std::size_t head) const {
  return std::hypot(half_width(head), deviations_of_95_percent * scatter_l_per_min);
}

GivenFlows given_flows(std::span<const TargetCurve> targets) {
  return {targets, measured_flows(targets), deviations(targets), {}, {}};
}

CurveBand narrowed_band(const GivenFlows& given, const UncertaintyBand& curve) {
  if (!given.computed.allFinite()) {
    throw NumericsError("a flow that the band has to be narrowed by cannot be computed",
                        "a head of the given curves", "finer steps in time, or data at other heads");
  }
  CurveBand narrowed;
  narrowed.tolerances = curve;
  for (const TargetCurve& target : given.targets) {
    narrowed.scatter_l_per_min = std::max(narrowed.scatter_l_per_min, target.scatter_l_per_min);
  }
  narrowed.posterior = condition_on_data(given.band, given.measured - given.computed, given.deviation, curve);
  warn_of_shift(*narrowed.posterior);
  return narrowed;
}

std::string replace_by_draws(const PosteriorEnsemble& ensemble, const Eigen::MatrixXd& flows,
                             std::span<const std::vector<CurvePoint>> curves, std::span<CurveBand> bands) {
  Eigen::Index column = 0;
  int inside = 0, all = 0;
  for (std::size_t k = 0; k < curves.size(); ++k) {
    std::vector<double> half_width;
    for (std::size_t head = 0; head < curves[k].size(); ++head, ++column) {
      double square = 0;
      int counted = 0;
      for (const double flow : flows.col(column)) {
        const double distance = flow - curves[k][head].flow_l_per_min;
        if (!std::isfinite(distance)) {
          continue; // a head that fails
        }
        square += distance * distance;
        inside += std::abs(distance) <= bands[k].half_width(head) ? 1 : 0;
        ++counted;
      }
      all += counted;
      half_width.push_back(deviations_of_95_percent * std::sqrt(square / std::max(counted, 1)));
    }
    bands[k].half_width_of_draws = half_width;
  }
  return std::to_string(ensemble.values.rows()) + " draws (" + std::to_string(ensemble.refused) +
         " without an end), misfit " + decimals(ensemble.misfit.mean(), 2) + "; the linear band holds " +
         decimals(100.0 * inside / std::max(all, 1), 0) + " % of their flows. The bands above are theirs\n";
}

std::string posterior_table(const CurveBand& band) {
  const Posterior& posterior = *band.posterior;
  std::vector<std::vector<std::string>> rows;
  for (const PosteriorInput& input : posterior.inputs) {
    rows.push_back(
        {input.key, plain_number(input.value), "-+" + plain_number(input.tolerance),
         "-+" + plain_number(input.tolerance_given),
         std::isfinite(input.tolerance_by_data) ? "-+" + plain_number(input.tolerance_by_data) : "nothing",
         plain_number(input.shift)});
  }
  std::string text =
      text_table({"input", "value", "stated", "data given", "by the data alone", "shift"}, rows);
  for (Eigen::Index i = 0; i < posterior.correlation.rows(); ++i) {
    for (Eigen::Index j = 0; j < i; ++j) {
      if (std::abs(posterior.correlation(i, j)) > strong_correlation) {
        text += posterior.inputs[static_cast<std::size_t>(j)].key + " and " +
                posterior.inputs[static_cast<std::size_t>(i)].key + " cannot be told apart: correlation " +
                decimals(posterior.correlation(i, j), 3) + "\n";
      }
    }
  }
  return text + "misfit of the " + std::to_string(posterior.flows) +
         " given flows: " + decimals(posterior.misfit, 2) + " of the scatter of the data\n";
}

nlohmann::ordered_json posterior_json(const CurveBand& band) {
  const Posterior& posterior = *band.posterior;
  nlohmann::ordered_json result = {{"flows", posterior.flows},
                                   {"misfit", posterior.misfit},
                                   {"scatter_l_per_min", band.scatter_l_per_min},
                                   {"inputs", nlohmann::ordered_json::array()},
                                   {"shift_l_per_min", posterior.shift},
                                   {"correlation", nlohmann::ordered_json::array()}};
  for (const PosteriorInput& input : posterior.inputs) {
    result["inputs"].push_back({{"key", input.key},
                                {"value", input.value},
                                {"tolerance", input.tolerance},
                                {"tolerance_given", input.tolerance_given},
                                {"tolerance_by_data", finite_or_null(input.tolerance_by_data)},
                                {"shift", input.shift}});
  }
  for (Eigen::Index i = 0; i < posterior.correlation.rows(); ++i) {
    const Eigen::VectorXd row = posterior.correlation.row(i);
    result["correlation"].push_back(std::vector<double>(row.begin(), row.end()));
  }
  return result;
}

} // namespace undula::apps
