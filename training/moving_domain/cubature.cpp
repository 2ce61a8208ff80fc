#include "training/moving_domain/cubature.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <random>

#include "fom/time/time_stepper.hpp"
#include "training/moving_domain/nonnegative_fit.hpp"

namespace undula::training {
namespace {

constexpr int snapshots_per_run = 8;
/// Random sums of the rows of all snapshots that the fit sees in place of them: as many per candidate that it
/// may choose as keep the lengths of residuals.
constexpr int sums = 3000, most_parts = 1800;

/// Rows of the unknowns that a part's items enter.
std::vector<std::vector<int>> rows_of_parts(const Discretisation<2>& disc) {
  std::vector<std::vector<int>> rows(disc.cut.parts.size());
  const auto add_nodes = [&](std::vector<int>& to, int part) {
    with_order(disc, [&](auto order) {
      for (const int node : VelocityElement<2, order>::nodes_of(disc, part))
        for (int c = 0; c < 2; ++c) to.push_back(disc.velocity_unknown(node, c));
    });
    for (const int node : disc.fluid_nodes.part_dofs[static_cast<std::size_t>(part)])
      to.push_back(disc.pressure_unknown(node));
  };
  for (std::size_t part = 0; part < rows.size(); ++part) add_nodes(rows[part], static_cast<int>(part));
  for (const auto& connection : disc.cut.connections)
    add_nodes(rows[static_cast<std::size_t>(connection.part[0])], connection.part[1]);
  for (const auto& piece : disc.cut.interface)
    for (const int node : disc.solid_spaces[static_cast<std::size_t>(piece.solid)]
                              .cell_nodes[static_cast<std::size_t>(piece.solid_cell)])
      for (int c = 0; c < 2; ++c)
        rows[static_cast<std::size_t>(piece.part)].push_back(disc.solid_unknown(piece.solid, node, c));
  for (auto& each : rows) {
    std::ranges::sort(each);
    each.erase(std::unique(each.begin(), each.end()), each.end());
  }
  return rows;
}

/// Parts that share no row, by colour: what they exert in one sum comes apart again.
std::vector<std::vector<int>> colours_of(const std::vector<std::vector<int>>& rows, int unknowns) {
  std::vector<std::vector<int>> colours;
  std::vector<std::vector<char>> taken;
  for (std::size_t part = 0; part < rows.size(); ++part) {
    std::size_t colour = 0;
    const auto free = [&](std::size_t at) {
      return std::ranges::none_of(rows[part],
                                  [&](int row) { return taken[at][static_cast<std::size_t>(row)]; });
    };
    while (colour < colours.size() && !free(colour)) ++colour;
    if (colour == colours.size()) {
      colours.emplace_back();
      taken.emplace_back(static_cast<std::size_t>(unknowns), 0);
    }
    colours[colour].push_back(static_cast<int>(part));
    for (const int row : rows[part]) taken[colour][static_cast<std::size_t>(row)] = 1;
  }
  return colours;
}

/// What the parts with a weight exert, but for what openings carry, which no cubature samples. By column:
/// inertia and everything else at a snapshot, then what a step answers to a random velocity and to a random
/// pressure. Each counts by itself: at a snapshot they nearly cancel, and a sum that is right there alone is
/// no operator.
constexpr int kinds = 4;
Eigen::Matrix<double, Eigen::Dynamic, kinds> fluid_forces(const Discretisation<2>& disc,
                                                          const Operators<2>& operators,
                                                          const Eigen::VectorXd& x,
                                                          const Eigen::VectorXd& rate,
                                                          const Eigen::MatrixXd& tried, double by_time) {
  using Columns = Eigen::Matrix<double, Eigen::Dynamic, kinds - 1>;
  Columns values(x.size(), kinds - 1);
  values << x, tried;
  Columns forces = operators.physical * values + operators.stabilisation * values;
  visit_flow_dependent(disc, operators, x, [&](int row, int column, double value) {
    forces.row(row) += value * values.row(column);
  });
  visit_opening_convection(disc, operators, x, [&](int row, int column, double value) {
    forces.row(row) -= value * values.row(column);
  });
  forces.rightCols(kinds - 2) += by_time * (operators.mass * tried);
  Eigen::Matrix<double, Eigen::Dynamic, kinds> all(x.size(), kinds);
  all << operators.mass * rate, forces;
  return all;
}

/// Every mode with the sign that a number of the generator has: velocities, then pressures.
Eigen::MatrixXd random_fields(const Eigen::MatrixXd& basis, int pressure_modes, std::mt19937_64& random) {
  Eigen::VectorXd signs(basis.cols());
  for (double& sign : signs) sign = (random() >> 63) != 0 ? 1.0 : -1.0;
  const Eigen::Index velocities = basis.cols() - pressure_modes;
  Eigen::MatrixXd fields(basis.rows(), 2);
  fields.col(0) = basis.leftCols(velocities) * signs.head(velocities);
  fields.col(1) = basis.rightCols(pressure_modes) * signs.tail(pressure_modes);
  return fields;
}

/// Random sums of rows, the same on every machine.
class Sketch {
public:
  Sketch(Eigen::Index columns)
      : matrix_(Eigen::MatrixXd::Zero(sums, columns)), total_(Eigen::VectorXd::Zero(sums)) {}

  /// Rows scaled so that their sum over all columns has the size 1. Where the columns cancel, as under a
  /// constant pressure, the sum cannot be met better than to a part of what they are made of.
  void add(const Eigen::MatrixXd& unscaled) {
    constexpr double rest_of_cancelled = 0.01;
    const double size = std::max(unscaled.rowwise().sum().norm(), rest_of_cancelled * unscaled.norm());
    if (!(size > 0)) return;
    const Eigen::MatrixXd rows = unscaled / size;
    Eigen::MatrixXd signs(sums, rows.rows());
    for (Eigen::Index k = 0; k < signs.size(); ++k) signs.data()[k] = (random_() >> 63) != 0 ? 1.0 : -1.0;
    signs /= std::sqrt(static_cast<double>(sums));
    matrix_.noalias() += signs * rows;
    total_.noalias() += signs * rows.rowwise().sum();
  }

  const Eigen::MatrixXd& matrix() const { return matrix_; }
  const Eigen::VectorXd& total() const { return total_; }

private:
  std::mt19937_64 random_;
  Eigen::MatrixXd matrix_;
  Eigen::VectorXd total_;
};

struct Normal {
  Eigen::MatrixXd gram;
  Eigen::VectorXd right;
  double square = 0;
  void add(const Eigen::MatrixXd& rows, const Eigen::VectorXd& total, double scale) {
    if (gram.size() == 0) {
      gram = Eigen::MatrixXd::Zero(rows.cols(), rows.cols());
      right = Eigen::VectorXd::Zero(rows.cols());
    }
    gram.noalias() += scale * scale * rows.transpose() * rows;
    right.noalias() += scale * scale * rows.transpose() * total;
    square += scale * scale * total.squaredNorm();
  }
};

/// A snapshot, or a part of it: runs start from rest, where maps and velocities are smaller than any in a
/// record.
struct Sample {
  Eigen::Index snapshot = 0;
  double part = 1;
};

std::vector<Sample> sampled(const RunRecord& run) {
  std::vector<Sample> chosen;
  const auto all = static_cast<Eigen::Index>(run.times.size());
  for (int k = 0; k < snapshots_per_run; ++k)
    chosen.push_back({std::max<Eigen::Index>(2, (k + 1) * all / snapshots_per_run - 1), 1});
  for (const double part : {0.02, 0.3}) chosen.push_back({all / 2, part});
  return chosen;
}

} // namespace

Cubature choose_cubature(PreparedScene& prepared, const Scene& scene, const Eigen::MatrixXd& basis,
                         int pressure_modes, std::span<const RunRecord> runs, double tolerance) {
  auto& disc = prepared.disc;
  const auto at_rest = disc.map;
  const auto rows = rows_of_parts(disc);
  const auto colours = colours_of(rows, disc.unknowns());
  PhaseTimer timer;

  // Operators of every colour; solids have their own forces.
  std::vector<std::shared_ptr<ReducedSpace>> weights;
  std::vector<Operators<2>> operators;
  disc.map = map_at(runs.front(), 2, 1.0); // any map: only the pattern stays
  for (const auto& colour : colours) {
    auto space = std::make_shared<ReducedSpace>();
    space->part_weights.assign(disc.cut.parts.size(), 0.0);
    for (const int part : colour) space->part_weights[static_cast<std::size_t>(part)] = 1.0;
    disc.reduced = space;
    operators.push_back(build_operators(disc, prepared.operators.comm, timer));
    operators.back().solid_mass.clear();
    weights.push_back(std::move(space));
  }

  const Eigen::Index modes = basis.cols(), velocities = modes - pressure_modes;
  const auto parts = static_cast<Eigen::Index>(disc.cut.parts.size());
  const auto alpha = bdf_coefficients(TimeScheme::bdf2, 2);
  const auto nonlinear = prepared.operators.nonlinear_cells;
  std::vector<std::size_t> first_cell(disc.solid_spaces.size() + 1, 0);
  for (std::size_t s = 0; s < disc.solid_spaces.size(); ++s)
    first_cell[s + 1] = first_cell[s] + disc.solid_spaces[s].cell_nodes.size();
  Sketch momentum(parts), continuity(parts), solids(static_cast<Eigen::Index>(nonlinear.size()));
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const RowMajor by_row = basis;
  std::mt19937_64 random(11);
  for (const auto& run : runs) {
    const double time_step = 1 / (run.point.frequency * scene.time.steps_per_period);
    for (const auto& [k, part] : sampled(run)) {
      const Eigen::VectorXd x = part * unknowns_at(disc, run, k);
      const Eigen::VectorXd rate = (alpha[0] * x + part * (alpha[1] * unknowns_at(disc, run, k - 1) +
                                                           alpha[2] * unknowns_at(disc, run, k - 2))) /
                                   time_step;
      disc.map = map_at(run, k, time_step);
      for (auto* values : {&disc.map.displacement, &disc.map.velocity})
        for (auto& value : *values) value *= part;
      const Eigen::MatrixXd tried = random_fields(basis, pressure_modes, random);
      std::array<Eigen::MatrixXd, kinds> exerted;
      exerted.fill(Eigen::MatrixXd::Zero(modes, parts));
      for (std::size_t colour = 0; colour < colours.size(); ++colour) {
        disc.reduced = weights[colour];
        move_operators(disc, operators[colour], timer);
        const auto forces = fluid_forces(disc, operators[colour], x, rate, tried, alpha[0] / time_step);
        for (const int of : colours[colour])
          for (const int row : rows[static_cast<std::size_t>(of)])
            for (int kind = 0; kind < kinds; ++kind)
              exerted[static_cast<std::size_t>(kind)].col(of) +=
                  forces(row, kind) * by_row.row(row).transpose();
      }
      for (const auto& each : exerted) {
        momentum.add(each.topRows(velocities));
        continuity.add(each.bottomRows(pressure_modes));
      }

      const Eigen::VectorXd d = part * displacements_at(disc, run, k);
      std::array<Eigen::MatrixXd, 2> by_cell; // forces, and how they change with a random displacement
      by_cell.fill(Eigen::MatrixXd::Zero(velocities, static_cast<Eigen::Index>(nonlinear.size())));
      disc.reduced = nullptr;
      for (std::size_t cell = 0; cell < nonlinear.size(); ++cell) {
        const auto unknowns = cell_unknowns(disc, nonlinear[cell]);
        using Values = CellResponse<2>::Values;
        const auto response =
            cell_response<2>(disc, nonlinear[cell], Values(d(unknowns)), Values(x(unknowns)), true);
        const std::array<Values, 2> forces{response.elastic + response.viscous,
                                           response.by_d * Values(tried.col(0)(unknowns))};
        for (std::size_t kind = 0; kind < forces.size(); ++kind)
          for (std::size_t i = 0; i < unknowns.size(); ++i)
            by_cell[kind].col(static_cast<Eigen::Index>(cell)) +=
                forces[kind][static_cast<Eigen::Index>(i)] *
                by_row.row(unknowns[i]).head(velocities).transpose();
      }
      for (const auto& each : by_cell) solids.add(each);
    }
  }
  disc.reduced = nullptr;
  disc.map = at_rest;

  Cubature cubature;
  // What continuity lacks is a flow that comes from nowhere: it counts more. The volume is one more row.
  constexpr double by_continuity = 3;
  Normal fluid;
  fluid.add(momentum.matrix(), momentum.total(), 1.0);
  fluid.add(continuity.matrix(), continuity.total(), by_continuity);
  Eigen::MatrixXd volumes(1, parts);
  for (Eigen::Index part = 0; part < parts; ++part)
    volumes(0, part) = disc.cut.parts[static_cast<std::size_t>(part)].measure;
  fluid.add(volumes, volumes.rowwise().sum(), std::sqrt(fluid.square) / volumes.sum());
  const auto of_parts = nonnegative_fit(fluid.gram, fluid.right, fluid.square, tolerance, most_parts);
  cubature.part_weights.assign(of_parts.weights.data(), of_parts.weights.data() + parts);
  cubature.parts = of_parts.columns;
  cubature.part_error = of_parts.error;

  cubature.cell_weights.assign(first_cell.back(), 1.0);
  cubature.cells = static_cast<int>(first_cell.back());
  if (!nonlinear.empty()) {
    Normal solid;
    solid.add(solids.matrix(), solids.total(), 1.0);
    const auto of_cells =
        nonnegative_fit(solid.gram, solid.right, solid.square, tolerance, static_cast<int>(nonlinear.size()));
    for (std::size_t cell = 0; cell < nonlinear.size(); ++cell)
      cubature.cell_weights[first_cell[static_cast<std::size_t>(nonlinear[cell].solid)] +
                            static_cast<std::size_t>(nonlinear[cell].cell)] =
          of_cells.weights[static_cast<Eigen::Index>(cell)];
    cubature.cells = of_cells.columns;
    cubature.cell_error = of_cells.error;
  }
  return cubature;
}

} // namespace undula::training
