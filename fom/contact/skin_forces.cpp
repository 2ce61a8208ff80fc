#include "fom/contact/skin_forces.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/mesh/quadrature.hpp"
#include "rom/base/error.hpp"

namespace undula::fom {

namespace {

/// The pressure has kinks where the film ends, inside of an edge.
constexpr int rule_degree = 11;
/// Normals of places that touch are opposed: their product is less.
constexpr double opposed = -0.3;
/// Places beside the end of a skin's edge count as opposite to it up to this part of their depth.
constexpr double beside = 0.5;

/// Adds to forces and stiffness what acts on a few nodes together.
template <int dim>
class Sums {
public:
  Sums(const Discretisation<dim>& disc, bool derive) : derive_(derive), size_(disc.unknowns()) {}

  bool derive() const { return derive_; }

  template <int nodes>
  using Local = Eigen::Matrix<double, dim * nodes, 1>;
  template <int nodes>
  using LocalMatrix = Eigen::Matrix<double, dim * nodes, dim * nodes>;

  template <int nodes>
  static void add_force(const std::array<int, nodes>& unknowns, const Local<nodes>& force,
                        Eigen::VectorXd& sum) {
    for (int i = 0; i < nodes; ++i)
      sum.template segment<dim>(unknowns[i]) += force.template segment<dim>(i * dim);
  }
  template <int nodes>
  void add_stiffness(const std::array<int, nodes>& unknowns, const LocalMatrix<nodes>& stiffness) {
    for (int i = 0; i < nodes * dim; ++i)
      for (int j = 0; j < nodes * dim; ++j)
        triplets_.emplace_back(unknowns[i / dim] + i % dim, unknowns[j / dim] + j % dim, stiffness(i, j));
  }
  SparseMatrix stiffness() const { return derive_ ? compress(size_, triplets_) : SparseMatrix(); }

private:
  bool derive_;
  int size_;
  Triplets triplets_;
};

template <int nodes>
Eigen::Matrix<double, 2 * nodes, 1> spread(const std::array<double, nodes>& shape, const Point<2>& vector) {
  Eigen::Matrix<double, 2 * nodes, 1> all;
  for (int i = 0; i < nodes; ++i) all.template segment<2>(2 * i) = shape[i] * vector;
  return all;
}

/// A place of a skin with what an integral over the skin needs there.
struct SkinPlace {
  EdgeShape shape;
  Point<2> x, velocity, tangent; ///< the tangent as long as dx/ds
  Point<2> normal;               ///< out of the solid
  double weight = 0;             ///< cm^2 (plane: per depth) at rest
  double stretch = 0;            ///< area where it is over area at rest
};

class Assembler {
public:
  Assembler(const SkinForces<2>& forces, const Discretisation<2>& disc, const SkinMotion<2>& motion,
            bool derive)
      : forces_(forces), disc_(disc), motion_(motion), measure_{forces.axisymmetric}, sums_(disc, derive) {
    response_.loads = response_.contact = Eigen::VectorXd::Zero(disc.unknowns());
    for (const auto& skin : forces.skin) {
      auto& nodes = nodes_.emplace_back();
      for (const auto& edge : skin) nodes.push_back(displaced<2>(edge, motion.d));
      if (!motion.before) continue;
      auto& before = nodes_before_.emplace_back();
      for (const auto& edge : skin) before.push_back(displaced<2>(edge, *motion.before));
    }
  }

  SkinResponse<2> run() {
    for (const auto& load : disc_.problem.loads) add_load(load);
    for (std::size_t p = 0; p < disc_.problem.pairs.size(); ++p) {
      const auto& pair = disc_.problem.pairs[p];
      report_ = {};
      if (pair.rigid >= 0) {
        touch_rigid(pair);
      } else {
        touch_skin(pair, pair.solid, pair.other_solid, forces_.reach[p]);
        if (pair.other_solid != pair.solid) touch_skin(pair, pair.other_solid, pair.solid, forces_.reach[p]);
      }
      response_.reports.push_back(report_);
    }
    response_.stiffness = sums_.stiffness();
    return std::move(response_);
  }

private:
  static const ReferenceRule<1>& rule() {
    static const auto rule = reference_rule<1>(rule_degree);
    return rule;
  }

  /// Calls f(s, weight of ds) over the quadrature of a piece of an edge.
  template <class F>
  static void over_piece(double from, double to, F&& f) {
    for (std::size_t q = 0; q < rule().weights.size(); ++q)
      f(from + (to - from) * rule().barycentric[q][1], (to - from) * rule().weights[q]);
  }

  SkinPlace place(int solid, std::size_t edge, double s, double ds) const {
    const auto& at = forces_.skin[solid][edge];
    SkinPlace place;
    place.shape = edge_shape(s);
    const auto slope = edge_slope(s);
    const Point<2> at_rest = on_edge<2>(at.at_rest, place.shape), along = on_edge<2>(at.at_rest, slope);
    const auto& nodes = nodes_[solid][edge];
    place.x = on_edge<2>(nodes, place.shape);
    place.tangent = on_edge<2>(nodes, slope);
    place.normal = outward(place.tangent).normalized();
    place.velocity.setZero();
    for (int i = 0; i < 3; ++i) place.velocity += place.shape[i] * motion_.v.segment<2>(at.unknowns[i]);
    const double at_rest_area = along.norm() * measure_(at_rest[0]);
    place.weight = ds * at_rest_area;
    place.stretch = place.tangent.norm() * measure_(place.x[0]) / at_rest_area;
    return place;
  }

  void add_load(const SkinLoad<2>& load) {
    const auto& skin = forces_.skin[load.solid];
    for (std::size_t e = 0; e < skin.size(); ++e) {
      const auto& edge = skin[e];
      if (load.where && !load.where(edge.at_rest[2])) continue;
      Sums<2>::Local<3> force = Sums<2>::Local<3>::Zero();
      Sums<2>::LocalMatrix<3> stiffness = Sums<2>::LocalMatrix<3>::Zero();
      over_piece(0, 1, [&](double s, double ds) {
        const auto at = place(load.solid, e, s, ds);
        const Point<2> at_rest = on_edge<2>(edge.at_rest, at.shape);
        if (load.traction) force += at.weight * spread<3>(at.shape, load.traction(at_rest, motion_.time));
        if (!load.pressure) return;
        const double pressure = load.pressure(at_rest, motion_.time), around = measure_(at.x[0]);
        const auto slope = edge_slope(s);
        const Point<2> area = ds * outward(at.tangent);
        force -= pressure * around * spread<3>(at.shape, area);
        if (!sums_.derive()) return;
        const double widens = measure_.axisymmetric ? measure_(1.0) : 0.0;
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j) {
            const double turned = pressure * around * ds * at.shape[i] * slope[j];
            stiffness(2 * i, 2 * j + 1) += turned;
            stiffness(2 * i + 1, 2 * j) -= turned;
            stiffness.block<2, 1>(2 * i, 2 * j) += pressure * widens * at.shape[i] * at.shape[j] * area;
          }
      });
      Sums<2>::add_force<3>(edge.unknowns, force, response_.loads);
      if (sums_.derive()) sums_.add_stiffness<3>(edge.unknowns, stiffness);
    }
  }

  /// What two places that touch do to the nodes around them, slave's first.
  template <int nodes>
  struct Touch {
    std::array<int, nodes> unknowns;
    Eigen::Matrix<double, 2 * nodes, 1> normal, tangential; ///< derivatives of gap and slip, unit directions
    Eigen::Matrix<double, 2 * nodes, 2 * nodes> bend;       ///< second derivative of the gap
    double gap = 0, slip = 0;                               ///< cm, cm/s
  };

  template <int nodes>
  void press(const ContactPair& pair, const Touch<nodes>& touch, const SkinPlace& at, double share,
             bool on_first, bool kept, Eigen::Matrix<double, 2 * nodes, 2 * nodes>& stiffness) {
    const double depth = pair.film - touch.gap;
    if (depth <= 0 && !kept) return;
    const double pressure = share * pair.stiffness * depth, w = at.weight;
    Eigen::Matrix<double, 2 * nodes, 1> force = w * pressure * touch.normal;
    if (sums_.derive())
      stiffness +=
          w * (share * pair.stiffness * touch.normal * touch.normal.transpose() - pressure * touch.bend);
    if (pair.friction > 0) {
      const double speed = std::hypot(touch.slip, pair.creep), part = touch.slip / speed;
      force -= w * pair.friction * pressure * part * touch.tangential;
      report_.friction_power += w * pair.friction * pressure * part * touch.slip;
      if (sums_.derive())
        stiffness += w * pair.friction *
                     (pressure * motion_.rate * pair.creep * pair.creep / (speed * speed * speed) *
                          touch.tangential * touch.tangential.transpose() -
                      share * pair.stiffness * part * touch.tangential * touch.normal.transpose());
    }
    Sums<2>::add_force<nodes>(touch.unknowns, force, response_.contact);
    Point<2> on_slave = Point<2>::Zero();
    for (int i = 0; i < nodes; ++i) {
      report_.power -= force.template segment<2>(2 * i).dot(motion_.v.segment<2>(touch.unknowns[i]));
      if (i < 3) on_slave += force.template segment<2>(2 * i);
    }
    if (pair.other_solid != pair.solid) report_.force += on_first ? on_slave : Point<2>(-on_slave);
    report_.load += w * pressure;
    report_.pressure = std::max(report_.pressure, pair.stiffness * depth / at.stretch);
    report_.penetration = std::max(report_.penetration, depth);
    report_.energy += 0.5 * w * pressure * depth;
  }

  void touch_rigid(const ContactPair& pair) {
    const auto& body = disc_.problem.rigid[pair.rigid];
    const auto placement = place_rigid<2>(body, motion_.time, forces_.step),
               placement_before = place_rigid<2>(body, motion_.time_before, forces_.step);
    const auto& skin = forces_.skin[pair.solid];
    for (std::size_t e = 0; e < skin.size(); ++e) {
      Sums<2>::LocalMatrix<3> stiffness = Sums<2>::LocalMatrix<3>::Zero();
      over_piece(0, 1, [&](double s, double ds) {
        const auto at = place(pair.solid, e, s, ds);
        const auto gap = gap_to_rigid<2>(body, placement, at.x);
        const bool kept =
            motion_.before &&
            gap_to_rigid<2>(body, placement_before, on_edge<2>(nodes_before_[pair.solid][e], at.shape))
                    .distance < pair.film;
        if ((gap.distance >= pair.film && !kept) || at.normal.dot(gap.direction) >= opposed) return;
        Touch<3> touch;
        touch.unknowns = skin[e].unknowns;
        touch.gap = gap.distance;
        const Point<2> along = -outward(gap.direction);
        touch.slip = along.dot(at.velocity - gap.velocity);
        touch.normal = spread<3>(at.shape, gap.direction);
        touch.tangential = spread<3>(at.shape, along);
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j)
            touch.bend.block<2, 2>(2 * i, 2 * j) = at.shape[i] * at.shape[j] * gap.second_derivative;
        press<3>(pair, touch, at, 1.0, true, kept, stiffness);
        report_.length += ds * at.tangent.norm();
      });
      if (sums_.derive()) sums_.add_stiffness<3>(skin[e].unknowns, stiffness); // zeros hold the places
    }
  }

  struct Box {
    Point<2> low, high;
  };
  /// Around an edge, which leaves the triangle of its nodes by less than the bend.
  static Box box_of(const EdgeNodes<2>& nodes, double margin) {
    const double more = margin + (nodes[0] + nodes[1] - 2 * nodes[2]).norm();
    const Point<2> add(more, more);
    return {nodes[0].cwiseMin(nodes[1]).cwiseMin(nodes[2]) - add,
            nodes[0].cwiseMax(nodes[1]).cwiseMax(nodes[2]) + add};
  }
  static bool apart(const Box& a, const Box& b) {
    return (a.low.array() > b.high.array()).any() || (b.low.array() > a.high.array()).any();
  }

  /// The place of `candidates` that a place of a skin touches: the nearest, if it faces that place. Of one
  /// body the nearest that does: the place's own surroundings are nearer, and so may be the other side of the
  /// wall.
  struct Opposite {
    int edge = -1;
    NearestOnEdge nearest;
    double gap = 0;
  };
  static Opposite opposite(const std::vector<EdgeNodes<2>>& skin, const std::vector<int>& candidates,
                           const Point<2>& x, const Point<2>& outward_there, double reach, bool of_itself) {
    Opposite best;
    double least = std::numeric_limits<double>::infinity();
    for (const int m : candidates) {
      const auto& nodes = skin[static_cast<std::size_t>(m)];
      const auto nearest = nearest_on_edge<2>(nodes, x);
      const Point<2> along = on_edge<2>(nodes, edge_slope(nearest.s)).normalized(), normal = outward(along);
      const bool faces = normal.dot(outward_there) < opposed;
      if (of_itself && !faces) continue;
      const Point<2> away = x - on_edge<2>(nodes, edge_shape(nearest.s));
      const double gap = away.dot(normal);
      if (gap < -reach || std::abs(gap) >= least) continue;
      if (!nearest.perpendicular && std::abs(away.dot(along)) > beside * std::abs(gap)) continue;
      least = std::abs(gap);
      best = {faces ? m : -1, nearest, gap};
    }
    return best;
  }

  bool was_in_contact(const ContactPair& pair, int slave, std::size_t edge, double s, int master,
                      const std::vector<int>& candidates, double reach) const {
    const auto& nodes = nodes_before_[slave][edge];
    const Point<2> normal = outward(on_edge<2>(nodes, edge_slope(s))).normalized();
    const auto there = opposite(nodes_before_[master], candidates, on_edge<2>(nodes, edge_shape(s)), normal,
                                reach, slave == master);
    return there.edge >= 0 && there.gap < pair.film;
  }

  void touch_skin(const ContactPair& pair, int slave, int master, double reach) {
    constexpr double share = 0.5;
    const auto& skin = forces_.skin[slave];
    for (std::size_t e = 0; e < skin.size(); ++e) {
      const auto& nodes = nodes_[slave][e];
      const double length = (nodes[1] - nodes[0]).norm();
      const Box box = box_of(nodes, pair.film + reach + length);
      std::vector<int> candidates;
      for (std::size_t m = 0; m < forces_.skin[master].size(); ++m) {
        if (slave == master && m == e) continue;
        const auto& other = nodes_[master][m];
        const bool faces = outward(other[1] - other[0]).dot(outward(nodes[1] - nodes[0])) < 0;
        if ((faces || slave != master) && !apart(box, box_of(other, 0)))
          candidates.push_back(static_cast<int>(m));
      }
      if (candidates.empty()) continue;
      std::vector<Sums<2>::LocalMatrix<6>> stiffness(candidates.size(), Sums<2>::LocalMatrix<6>::Zero());
      const auto ends = pieces(nodes, master, candidates);
      for (std::size_t k = 0; k + 1 < ends.size(); ++k)
        over_piece(ends[k], ends[k + 1], [&](double s, double ds) {
          const auto at = place(slave, e, s, ds);
          const auto there = opposite(nodes_[master], candidates, at.x, at.normal, reach, slave == master);
          if (there.edge < 0) return;
          const bool kept = motion_.before && was_in_contact(pair, slave, e, s, master, candidates, reach);
          if (there.gap >= pair.film && !kept) return;
          const auto c = std::find(candidates.begin(), candidates.end(), there.edge) - candidates.begin();
          press<6>(pair, touch_of(skin[e], at, master, there), at, share, slave == pair.solid, kept,
                   stiffness[static_cast<std::size_t>(c)]);
          if (slave == pair.solid) report_.length += (slave == master ? share : 1.0) * ds * at.tangent.norm();
        });
      if (!sums_.derive()) continue;
      for (std::size_t c = 0; c < candidates.size(); ++c)
        sums_.add_stiffness<6>(together(skin[e], master, candidates[c]), stiffness[c]);
    }
  }

  /// Where to divide an edge: its ends, and the places opposite to nodes of the other skin.
  std::vector<double> pieces(const EdgeNodes<2>& nodes, int master,
                             const std::vector<int>& candidates) const {
    constexpr double shortest = 1e-10; // of an edge
    std::vector<double> ends = {0.0, 1.0};
    for (const int m : candidates)
      for (int i = 0; i < 2; ++i) {
        const auto nearest = nearest_on_edge<2>(nodes, nodes_[master][static_cast<std::size_t>(m)][i]);
        if (nearest.perpendicular && nearest.s > shortest && nearest.s < 1 - shortest)
          ends.push_back(nearest.s);
      }
    std::sort(ends.begin(), ends.end());
    ends.erase(std::unique(ends.begin(), ends.end(), [](double a, double b) { return b - a < shortest; }),
               ends.end());
    ends.back() = 1.0;
    return ends;
  }

  std::array<int, 6> together(const SkinEdge<2>& edge, int master, int other) const {
    const auto &a = edge.unknowns, &b = forces_.skin[master][static_cast<std::size_t>(other)].unknowns;
    return {a[0], a[1], a[2], b[0], b[1], b[2]};
  }

  Touch<6> touch_of(const SkinEdge<2>& edge, const SkinPlace& at, int master, const Opposite& there) const {
    const auto& nodes = nodes_[master][static_cast<std::size_t>(there.edge)];
    const auto& other = forces_.skin[master][static_cast<std::size_t>(there.edge)];
    const auto shape = edge_shape(there.nearest.s), slope = edge_slope(there.nearest.s);
    const Point<2> tangent = on_edge<2>(nodes, slope), normal = outward(tangent).normalized(),
                   along = tangent.normalized(), bend = 4 * (nodes[0] + nodes[1] - 2 * nodes[2]);
    std::array<double, 6> relative{}, turn{};
    Point<2> velocity = at.velocity;
    for (int i = 0; i < 3; ++i) {
      relative[i] = at.shape[i];
      relative[3 + i] = -shape[i];
      turn[3 + i] = slope[i];
      velocity -= shape[i] * motion_.v.segment<2>(other.unknowns[i]);
    }
    Touch<6> touch;
    touch.unknowns = together(edge, master, there.edge);
    touch.gap = there.gap;
    touch.slip = along.dot(velocity);
    touch.normal = spread<6>(relative, normal);
    touch.tangential = spread<6>(relative, along);
    touch.bend.setZero();
    const double m = tangent.squaredNorm(), curve = bend.dot(normal), g = there.gap;
    constexpr double least = 0.1; // nearer to a centre of curvature the projection is none
    if (there.nearest.perpendicular && m - g * curve > least * m) {
      const auto turned = spread<6>(turn, normal);
      const Eigen::Matrix<double, 12, 1> shift =
          (spread<6>(relative, tangent) + g * turned) / (m - g * curve);
      const double factor = 1 - g * curve / m;
      touch.bend = -factor * (shift * turned.transpose() + turned * shift.transpose()) -
                   factor * curve * shift * shift.transpose() + g / m * turned * turned.transpose();
    }
    return touch;
  }

  const SkinForces<2>& forces_;
  const Discretisation<2>& disc_;
  const SkinMotion<2>& motion_;
  Measure measure_;
  Sums<2> sums_;
  SkinResponse<2> response_;
  PairReport<2> report_;
  std::vector<std::vector<EdgeNodes<2>>> nodes_;        ///< by solid and edge, where they are
  std::vector<std::vector<EdgeNodes<2>>> nodes_before_; ///< where they were, if that is asked for
};

/// Mean length of the edges of a skin, cm.
double mean_length(const std::vector<SkinEdge<2>>& skin) {
  double sum = 0;
  for (const auto& edge : skin) sum += (edge.at_rest[1] - edge.at_rest[0]).norm();
  return sum / static_cast<double>(std::max<std::size_t>(skin.size(), 1));
}

} // namespace

template <int dim>
SkinForces<dim> prepare_skin_forces(const Discretisation<dim>& disc, double step) {
  SkinForces<dim> forces;
  if constexpr (dim == 2) {
    forces.axisymmetric = disc.problem.space == Space::axisymmetric;
    forces.step = step;
    forces.skin = skins_of(disc);
    // Of one body the other side of a thin wall is near, and no contact.
    constexpr double of_itself = 0.5, of_another = 4;
    for (const auto& pair : disc.problem.pairs)
      forces.reach.push_back((pair.solid == pair.other_solid ? of_itself : of_another) *
                             mean_length(forces.skin[pair.solid]));
  } else if (has_skin_forces(disc.problem)) {
    throw InputError("loads on skins and contact are not computed in three dimensions",
                     "FsiProblem::loads or FsiProblem::pairs", "plane or axisymmetric space", "FsiProblem");
  }
  return forces;
}

template <int dim>
SkinResponse<dim> skin_response(const SkinForces<dim>& forces, const Discretisation<dim>& disc,
                                const SkinMotion<dim>& motion, bool derive) {
  if constexpr (dim == 2)
    return Assembler(forces, disc, motion, derive).run();
  else
    return {};
}

template SkinForces<2> prepare_skin_forces(const Discretisation<2>&, double);
template SkinForces<3> prepare_skin_forces(const Discretisation<3>&, double);
template SkinResponse<2> skin_response(const SkinForces<2>&, const Discretisation<2>&, const SkinMotion<2>&,
                                       bool);
template SkinResponse<3> skin_response(const SkinForces<3>&, const Discretisation<3>&, const SkinMotion<3>&,
                                       bool);

} // namespace undula::fom
