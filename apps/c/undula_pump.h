/* The head-flow curve of a pump, from a model file, for programs in C and whatever calls C: models of the circulation above
 * all. Library libundula_pump: rom/ alone, without MPI and PETSc. docs/c_api.md explains by example.
 *
 * Functions that can fail return a status; undula_last_error() then tells what, the value seen, what is allowed, and where.
 * Units stand in the names. Numbers are those of `undula hq --json`, to the last digit.
 *
 * A pump that is open may be asked by several threads at once. Nothing is printed. Before version 1 a new minor version
 * may change what is here: compare UNDULA_PUMP_VERSION with undula_version().
 */
#ifndef UNDULA_PUMP_H
#define UNDULA_PUMP_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

#if defined(__GNUC__)
#define UNDULA_PUMP_API __attribute__((visibility("default")))
#else
#define UNDULA_PUMP_API
#endif

#define UNDULA_PUMP_VERSION "0.1.0"

/* As the exit codes of the program. */
enum undula_status { UNDULA_OK = 0, UNDULA_FAILED = 1, UNDULA_WRONG_INPUT = 2 };

/* A model: a reduced model driven by a stroke, or an emulator driven by a stroke or a voltage. */
typedef struct undula_pump undula_pump;

/* Version of the library: "0.1.0". */
UNDULA_PUMP_API const char* undula_version(void);

/* What went wrong in the last call of this thread that did not return UNDULA_OK, several lines; "" before the first one.
 * Valid until the next call of the thread. */
UNDULA_PUMP_API const char* undula_last_error(void);

/* Reads a model file (HDF5) made by `undula train`. Sets *pump, to be closed; NULL where that fails. */
UNDULA_PUMP_API int undula_pump_open(const char* file, undula_pump** pump);

/* NULL is allowed. */
UNDULA_PUMP_API void undula_pump_close(undula_pump* pump);

/* What drives the model: "stroke_mm" or "voltage_V". Valid as long as the pump. NULL for NULL. */
UNDULA_PUMP_API const char* undula_pump_drive(const undula_pump* pump);

/* The box of the runs that the model was made from: frequency in Hz, drive in mm or V, head in mmHg. */
UNDULA_PUMP_API int undula_pump_box(const undula_pump* pump, double low[3], double high[3]);

/* The head-flow curve at one frequency and drive: mean flows out of the outlet at `count` heads.
 *
 *   frequency_Hz, drive   > 0; drive as undula_pump_drive says
 *   head_mmHg             count heads, pressure at the outlet minus that at the inlet
 *   flow_l_per_min        count; NaN where the numerics failed
 *   error_l_per_min       count, or NULL: stated error against the level that the model was made from; infinite: unknown
 *   inside                count, or NULL: 1 where the point lies in the box, else 0
 *
 * With inside == NULL a point out of the box is wrong input: nobody would see that it is extrapolated. */
UNDULA_PUMP_API int undula_pump_curve(const undula_pump* pump, double frequency_Hz, double drive,
                                      const double* head_mmHg, size_t count, double* flow_l_per_min,
                                      double* error_l_per_min, int* inside);

/* Another number of the same points, by name ("holder_power_mW", "efficiency_percent", "clearance_min_mm", ...; those of
 * Curve in docs/python_reference.md); NaN: the model does not know it. Heads out of the box are answered. */
UNDULA_PUMP_API int undula_pump_quantity(const undula_pump* pump, double frequency_Hz, double drive,
                                         const double* head_mmHg, size_t count, const char* name,
                                         double* values);

#ifdef __cplusplus
}
#endif

#endif
