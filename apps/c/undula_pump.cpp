#include "apps/c/undula_pump.h"

#include <algorithm>
#include <exception>
#include <filesystem>
#include <limits>
#include <new>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "rom/base/error.hpp"
#include "rom/base/text_file.hpp"
#include "rom/curve/curve_columns.hpp"
#include "rom/curve/projected_curve.hpp"
#include "rom/curve/stated_drive.hpp"
#include "rom/emulator/emulated_curve.hpp"

using namespace undula;

struct undula_pump {
  std::string file;
  std::variant<rom::Model, rom::Emulator> model;
};

namespace {

bool by_voltage(const undula_pump& pump) {
  const auto* emulator = std::get_if<rom::Emulator>(&pump.model);
  return emulator != nullptr && emulator->driven_by_voltage;
}

rom::TrainingBox box_of(const undula_pump& pump) {
  if (const auto* emulator = std::get_if<rom::Emulator>(&pump.model)) {
    return rom::training_box(*emulator);
  }
  return std::get<rom::Model>(pump.model).box;
}

std::vector<rom::CurvePoint> curve_of(const undula_pump& pump, double frequency_Hz, double drive,
                                      std::span<const double> heads) {
  const bool voltage = by_voltage(pump);
  const rom::StatedDrive stated =
      voltage ? rom::StatedDrive{{}, drive} : rom::StatedDrive{drive, {}}; // refuses what is no drive
  const double checked = rom::drive_of(stated, voltage, "the model", pump.file);
  if (const auto* emulator = std::get_if<rom::Emulator>(&pump.model)) {
    return rom::emulated_curve(*emulator, frequency_Hz, voltage ? checked : rom::stroke_of_scenes(checked),
                               heads);
  }
  return rom::projected_curve(std::get<rom::Model>(pump.model), frequency_Hz, rom::stroke_of_scenes(checked),
                              heads);
}

std::string& last_error() {
  thread_local std::string text;
  return text;
}

/// Nothing that is thrown may leave a function that C calls.
template <class Work>
int guarded(const Work& work) noexcept {
  try {
    try {
      work();
      return UNDULA_OK;
    } catch (const InputError& error) {
      last_error() = error.what();
      return UNDULA_WRONG_INPUT;
    } catch (const std::exception& error) {
      last_error() = error.what();
    }
  } catch (...) { // not even the message has room
  }
  return UNDULA_FAILED;
}

void require(bool given, const char* name, const char* function) {
  if (!given) {
    throw InputError(std::string(name) + " is not given", "a null pointer",
                     "a pointer to what the header says", function);
  }
}

std::span<const double> heads_of(const double* head_mmHg, size_t count, const char* function) {
  if (count == 0) {
    throw InputError("no head is asked for", "count = 0", "one or more", function);
  }
  require(head_mmHg != nullptr, "head_mmHg", function);
  return {head_mmHg, count};
}

} // namespace

const char* undula_version() { return UNDULA_PUMP_VERSION; }

const char* undula_last_error() { return last_error().c_str(); }

int undula_pump_open(const char* file, undula_pump** pump) {
  return guarded([&] {
    require(pump != nullptr, "pump", "undula_pump_open");
    *pump = nullptr;
    require(file != nullptr, "file", "undula_pump_open");
    if (std::filesystem::exists(file) && rom::holds_emulator(file)) {
      *pump = new undula_pump{file, rom::load_emulator(file)};
    } else {
      *pump = new undula_pump{file, rom::load_model(file)};
    }
  });
}

void undula_pump_close(undula_pump* pump) { delete pump; }

const char* undula_pump_drive(const undula_pump* pump) {
  return pump == nullptr ? nullptr : by_voltage(*pump) ? "voltage_V" : "stroke_mm";
}

int undula_pump_box(const undula_pump* pump, double low[3], double high[3]) {
  return guarded([&] {
    require(pump != nullptr, "pump", "undula_pump_box");
    require(low != nullptr && high != nullptr, "low or high", "undula_pump_box");
    const auto box = box_of(*pump);
    std::ranges::copy(std::initializer_list{box.frequency_low_Hz, box.stroke_low_mm, box.head_low_mmHg}, low);
    std::ranges::copy(std::initializer_list{box.frequency_high_Hz, box.stroke_high_mm, box.head_high_mmHg},
                      high);
  });
}

int undula_pump_curve(const undula_pump* pump, double frequency_Hz, double drive, const double* head_mmHg,
                      size_t count, double* flow_l_per_min, double* error_l_per_min, int* inside) {
  return guarded([&] {
    require(pump != nullptr, "pump", "undula_pump_curve");
    const auto heads = heads_of(head_mmHg, count, "undula_pump_curve");
    require(flow_l_per_min != nullptr, "flow_l_per_min", "undula_pump_curve");
    if (inside == nullptr) {
      const auto unit = by_voltage(*pump) ? rom::DriveUnit{"voltage", "V"} : rom::DriveUnit{"stroke", "mm"};
      const auto outside = rom::outside_training_box(box_of(*pump), frequency_Hz, drive, heads, unit);
      if (!outside.empty()) {
        throw InputError("the point is outside of the model's box", outside.front(),
                         "a point in the box; or an array for inside", "undula_pump_curve, " + pump->file);
      }
    }
    const auto points = curve_of(*pump, frequency_Hz, drive, heads);
    for (std::size_t i = 0; i < count; ++i) {
      flow_l_per_min[i] = points[i].flow_l_per_min;
      if (error_l_per_min != nullptr) {
        error_l_per_min[i] = points[i].error_l_per_min;
      }
      if (inside != nullptr) {
        inside[i] = points[i].inside_training_box.value_or(false) ? 1 : 0;
      }
    }
  });
}

int undula_pump_quantity(const undula_pump* pump, double frequency_Hz, double drive, const double* head_mmHg,
                         size_t count, const char* name, double* values) {
  return guarded([&] {
    require(pump != nullptr, "pump", "undula_pump_quantity");
    const auto heads = heads_of(head_mmHg, count, "undula_pump_quantity");
    require(name != nullptr, "name", "undula_pump_quantity");
    require(values != nullptr, "values", "undula_pump_quantity");
    const auto columns = rom::curve_columns();
    const auto column = std::ranges::find(columns, std::string(name), &rom::CurveColumn::name);
    if (column == columns.end()) {
      std::string names;
      for (const auto& one : columns) {
        names += (names.empty() ? "" : ", ") + std::string(one.name);
      }
      throw InputError("there is no such quantity", '"' + std::string(name) + '"', names,
                       "undula_pump_quantity");
    }
    std::ranges::transform(curve_of(*pump, frequency_Hz, drive, heads), values, column->value);
  });
}
