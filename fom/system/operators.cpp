#include "fom/system/operators.hpp"

namespace undula::fom {

void sum_over_ranks(MPI_Comm comm, Eigen::VectorXd& values) {
  int ranks = 1;
  MPI_Comm_size(comm, &ranks);
  if (ranks > 1)
    MPI_Allreduce(MPI_IN_PLACE, values.data(), static_cast<int>(values.size()), MPI_DOUBLE, MPI_SUM, comm);
}

namespace {

/// Room for the entries of a single rank, so that the lists need not grow.
template <int dim>
void reserve_entries(const Discretisation<dim>& disc, Triplets& mass, Triplets& physical,
                     Triplets& stabilisation) {
  const bool quadratic = disc.problem.velocity_order == 2;
  constexpr std::size_t solid_nodes = QuadraticSpace<dim>::nodes_per_cell;
  const std::size_t nodes = quadratic ? solid_nodes : dim + 1,
                    pair = quadratic ? 2 * nodes - dim - 1 : dim + 2,
                    piece = dim * (nodes + solid_nodes) + dim + 1;
  const std::size_t parts = disc.cut.parts.size(), pieces = disc.cut.interface.size();
  mass.reserve(parts * nodes * nodes * dim);
  physical.reserve(parts * nodes * nodes * (dim * dim + 2 * dim) + pieces * piece * piece);
  stabilisation.reserve(disc.cut.connections.size() * pair * pair * (dim * dim + 1) + pieces * piece * piece);
}

/// What a domain that moves by a map changes.
template <int dim>
void integrate_fluid(const Discretisation<dim>& disc, Operators<dim>& operators, Triplets& mass,
                     Triplets& physical, Triplets& stabilisation) {
  const Share share{&operators.ownership.owner, operators.rank};
  reserve_entries(disc, mass, physical, stabilisation);
  operators.geometries = part_geometries(disc);
  const std::span<const PartGeometry<dim>> geometries = operators.geometries;
  const bool linear = disc.problem.velocity_order == 1, moved = !disc.map.is_identity();
  if (linear) operators.moments.assign(disc.cut.parts.size(), PartMoments<dim>::value_type::Zero());
  operators.widening = moved ? operators.moments : PartMoments<dim>();
  for (const int part : operators.own_parts) {
    if (!linear) {
      add_quadratic_part(disc, part, geometries[part], mass, physical);
      continue;
    }
    const auto integrals = integrate_part(disc, part, geometries[part]);
    operators.moments[part] = integrals.moments;
    if (moved) operators.widening[part] = integrals.widening;
    add_fluid_mass(disc, part, integrals, mass);
    add_fluid_viscosity_and_pressure(disc, part, geometries[part], integrals, physical);
  }
  mass.insert(mass.end(), operators.solid_mass.begin(), operators.solid_mass.end());
  add_fluid_stabilisation<dim>(disc, share, geometries, stabilisation);
  operators.velocity_jumps = velocity_jumps(disc, share, geometries);
  add_interface<dim>(disc, share, geometries, physical, stabilisation);
}

} // namespace

template <int dim>
Operators<dim> build_operators(const Discretisation<dim>& disc, MPI_Comm comm, PhaseTimer& timer) {
  const auto scope = timer.measure("assemble");
  Operators<dim> operators;
  operators.comm = comm;
  int ranks = 1;
  MPI_Comm_size(comm, &ranks);
  MPI_Comm_rank(comm, &operators.rank);
  operators.ownership = distribute_unknowns(disc, ranks);
  const Share share{&operators.ownership.owner, operators.rank};
  for (std::size_t p = 0; p < disc.cut.parts.size(); ++p)
    if (disc.part_weight(static_cast<int>(p)) > 0 &&
        share.has(disc.velocity_unknown(disc.fluid_nodes.part_dofs[p][0], 0)))
      operators.own_parts.push_back(static_cast<int>(p));

  using Body = SolidBody<dim>;
  add_solid_mass<dim>(
      disc, share, [](const Body&) { return 1.0; }, operators.solid_mass);
  Triplets mass, physical, stabilisation, damping, stiffness;
  integrate_fluid(disc, operators, mass, physical, stabilisation);
  add_solid_mass<dim>(
      disc, share, [](const Body& body) { return body.properties.mass_damping; }, damping);
  add_solid_stiffness<dim>(
      disc, share,
      [](const Body& body) {
        const auto& solid = body.properties;
        return solid.stiffness_damping + (is_nonlinear(body.model) ? 0.0 : solid.damping_time);
      },
      damping);
  add_solid_stiffness<dim>(
      disc, share, [](const Body& body) { return is_nonlinear(body.model) ? 0.0 : 1.0; }, stiffness);
  operators.has_nonlinear_solid = has_nonlinear_solid(disc);
  operators.nonlinear_cells = nonlinear_cells(disc, share);
  const int size = disc.unknowns();
  operators.mass = compress(size, mass);
  operators.physical = compress(size, physical);
  operators.stabilisation = compress(size, stabilisation);
  operators.damping = compress(size, damping);
  operators.stiffness = compress(size, stiffness);
  for (const auto& [name, condition] : disc.problem.boundary)
    if (condition.kind == BoundaryCondition<dim>::Kind::opening) {
      auto functional = opening_functional(disc, share, name);
      sum_over_ranks(comm, functional);
      operators.openings.emplace(name, std::move(functional));
    }
  return operators;
}

template <int dim>
void move_operators(const Discretisation<dim>& disc, Operators<dim>& operators, PhaseTimer& timer) {
  const auto scope = timer.measure("assemble");
  Triplets mass, physical, stabilisation;
  integrate_fluid(disc, operators, mass, physical, stabilisation);
  const int size = disc.unknowns();
  operators.mass_sum.sum(size, mass, operators.mass);
  operators.physical_sum.sum(size, physical, operators.physical);
  operators.stabilisation_sum.sum(size, stabilisation, operators.stabilisation);
}

template Operators<2> build_operators(const Discretisation<2>&, MPI_Comm, PhaseTimer&);
template void move_operators(const Discretisation<2>&, Operators<2>&, PhaseTimer&);

template Operators<3> build_operators(const Discretisation<3>&, MPI_Comm, PhaseTimer&);
template void move_operators(const Discretisation<3>&, Operators<3>&, PhaseTimer&);

} // namespace undula::fom
