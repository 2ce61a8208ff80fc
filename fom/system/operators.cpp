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

  const std::size_t parts = disc.cut.parts.size();
  operators.geometries = part_geometries(disc);
  const std::span<const PartGeometry<dim>> geometries = operators.geometries;
  const bool linear = disc.problem.velocity_order == 1;
  if (linear) operators.moments.assign(parts, PartMoments<dim>::value_type::Zero());
  if (!disc.map.is_identity()) operators.widening = operators.moments;
  const int size = disc.unknowns();
  Triplets mass, physical, stabilisation, damping, stiffness;
  reserve_entries(disc, mass, physical, stabilisation);
  for (std::size_t p = 0; p < parts; ++p) {
    if (!share.has(disc.velocity_unknown(disc.fluid_nodes.part_dofs[p][0], 0))) continue;
    const int part = static_cast<int>(p);
    operators.own_parts.push_back(part);
    if (!linear) {
      add_quadratic_part(disc, part, geometries[p], mass, physical);
      continue;
    }
    const auto integrals = integrate_part(disc, part, geometries[p]);
    operators.moments[p] = integrals.moments;
    if (!disc.map.is_identity()) operators.widening[p] = integrals.widening;
    add_fluid_mass(disc, part, integrals, mass);
    add_fluid_viscosity_and_pressure(disc, part, geometries[p], integrals, physical);
  }
  using Body = SolidBody<dim>;
  const SolidFactor<dim> everywhere = [](const Body&) { return 1.0; };
  add_solid_mass<dim>(disc, share, everywhere, mass);
  add_fluid_stabilisation<dim>(disc, share, geometries, stabilisation);
  if (disc.problem.flow == FlowModel::navier_stokes &&
      disc.problem.stabilisation.velocity_scale == VelocityScale::local)
    operators.velocity_jumps = velocity_jumps(disc, share, geometries);
  add_interface<dim>(disc, share, geometries, physical, stabilisation);
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

template Operators<2> build_operators(const Discretisation<2>&, MPI_Comm, PhaseTimer&);

} // namespace undula::fom
