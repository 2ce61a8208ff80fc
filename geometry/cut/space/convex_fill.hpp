// A cell parted into convex pieces by the planes of the skin inside it, in floating point. What it gives is
// to be checked against the volumes of the parts by their surfaces.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/mesh/simplex_mesh.hpp"

namespace undula::geometry {

/// Small convex polygon, reused without allocation.
struct ConvexPolygon {
  static constexpr int most = 24;
  int count = 0;
  std::array<Point<3>, most> x;
};

/// What a triangle of the skin shares with the cell.
struct SkinPolygon {
  ConvexPolygon shape; ///< relative to the first corner of the cell, cm
  Point<3> normal;     ///< unit, into the solid
  double offset = 0;   ///< of the plane: normal . x = offset
  int part = -1;       ///< fluid part of the cell that it bounds
};

/// Binary space partition (Fuchs, Kedem and Naylor 1980): pieces are split by the plane of a polygon inside
/// until there is none, so that each is all fluid of one part or all solid. Reused from cell to cell.
class ConvexFill {
public:
  /// `corners` of the positively oriented cell, and the polygons, relative to its first corner. Points nearer
  /// to a plane than `tolerance` (cm) lie on it. False if that contradicts itself, or a piece has too many
  /// corners.
  bool fill(const std::array<Point<3>, 4>& corners, std::span<const SkinPolygon> polygons, double tolerance);

  struct Simplex {
    int part; ///< of the cell
    std::array<Point<3>, 4> x;
  };
  const std::vector<Simplex>& simplices() const { return simplices_; }

private:
  struct Polytope {
    static constexpr int most_points = 96, most_faces = 48, most_corners = 24;
    int points = 0, faces = 0;
    std::array<Point<3>, most_points> x;
    std::array<std::uint8_t, most_faces> count;
    std::array<std::array<std::uint8_t, most_corners>, most_faces> corner; ///< counter-clockwise from outside
  };
  /// Polygon of the skin in a piece.
  struct Member {
    int polygon;
    int side; ///< 0: inside of the piece; 1: on its boundary, the piece is solid there; -1: it is fluid
    ConvexPolygon shape;
  };
  struct Piece {
    Polytope shape;
    std::vector<Member> members;
  };

  int next_plane(const Piece& piece) const;
  bool split(int polygon, const Piece& piece, Piece& solid_side, Piece& fluid_side, bool& parted);
  bool add_leaf(const Piece& piece);
  int part_by_ray(const Polytope& shape) const;

  double tolerance_ = 0;
  std::span<const SkinPolygon> polygons_;
  std::vector<Piece> pieces_; ///< stack; kept for their memory
  Piece current_;
  std::vector<Simplex> simplices_;
};

/// Area of a convex polygon, cm^2.
double area(const ConvexPolygon& polygon);

} // namespace undula::geometry
