// The online side: head-flow curves from the file of a reduced model, in milliseconds. Needs Eigen and HDF5
// only.
//
//   base/          what all rooms share: errors, units, timers, HDF5 files
//   fixed_domain/  the reduced operators of a fixed fluid domain, and their periodic states
//   curve/         heads in, points out, with an error for each
//   emulator/      what runs come to, interpolated over a box of operating points
//
// Everything a program needs that asks a model: load_model, hq_curve, pump_period, outside_training_box;
// load_emulator, emulate.
#pragma once

#include "rom/base/error.hpp"
#include "rom/curve/hq_curve.hpp"
#include "rom/curve/pump_period.hpp"
#include "rom/emulator/emulator.hpp"
#include "rom/fixed_domain/model.hpp"
