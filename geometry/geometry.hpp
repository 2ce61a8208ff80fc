// Meshes, and the cut of a background mesh by solids. Works without PETSc and MPI.
//
//   mesh/       simplicial meshes, quadrature, Gmsh files, meshing, segments and polygons
//   cut/        the fluid parts of a background that solids cut, and their unknowns
//     exact/    cells in exact arithmetic, in any dimension: the reference
//     plane/    cells in floating point with certain signs
//   wave_pump/  the drawing of the wave pump and its meshes; hose/: a hose between rollers and a track
#pragma once

#include "geometry/cut/cut.hpp"
#include "geometry/mesh/simplex_mesh.hpp"
