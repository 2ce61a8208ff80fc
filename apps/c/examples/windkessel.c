/* A pump between a weak ventricle and a two-element Windkessel, over some heart beats.
 *
 *   windkessel MODEL.h5 FREQUENCY_HZ DRIVE
 *
 * The arteries hold the volume C P and drain through R; the pump draws from the ventricle, whose pressure is prescribed:
 *
 *   C dP/dt = Q(P - P_ventricle(t)) - P / R
 *
 * Q is the head-flow curve of the model at a frequency and a drive (mm or V, whichever drives it). The pump answers as if
 * every head lasted: it runs some hundred periods per beat. apps/python/examples/windkessel.py says what this leaves out.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "undula_pump.h"

enum { heads = 200, beats = 12, steps_per_beat = 400 };

static const double ml_per_s_per_l_per_min = 1000.0 / 60.0, pi = 3.14159265358979323846;
static const double heart_rate_per_s = 75.0 / 60.0, rest_mmHg = 8.0, peak_mmHg = 55.0, systole = 0.35;
static const double resistance = 1.2, compliance = 1.5; /* mmHg s / ml, ml / mmHg */

/* The curve, sampled once: a solver asks for thousands of flows. */
struct table {
  double low, step, flow[heads]; /* mmHg, mmHg, ml/s */
};

static double ventricle(double time_s) {
  const double phase = fmod(time_s * heart_rate_per_s, 1.0) / systole;
  const double pulse = phase < 1 ? sin(pi * phase) * sin(pi * phase) : 0.0;
  return rest_mmHg + (peak_mmHg - rest_mmHg) * pulse;
}

static double pump_flow(const struct table* pump, double head_mmHg) {
  const double place = (head_mmHg - pump->low) / pump->step;
  if (!(place >= 0 && place <= heads - 1)) {
    fprintf(stderr, "a head of %.1f mmHg: the model knows %g to %g mmHg\n", head_mmHg, pump->low,
            pump->low + (heads - 1) * pump->step);
    exit(1);
  }
  const int i = place < heads - 1 ? (int)place : heads - 2;
  return pump->flow[i] + (place - i) * (pump->flow[i + 1] - pump->flow[i]);
}

static double slope(const struct table* pump, double time_s, double pressure) {
  return (pump_flow(pump, pressure - ventricle(time_s)) - pressure / resistance) / compliance;
}

int main(int count, char** words) {
  if (count != 4) {
    fprintf(stderr, "windkessel MODEL.h5 FREQUENCY_HZ DRIVE\n");
    return 2;
  }

  /* 1. The pump: its curve over the heads that the model knows. Heads out of the box would be refused. */
  undula_pump* model = NULL;
  double low[3], high[3], head[heads];
  struct table pump;
  int status = undula_pump_open(words[1], &model);
  if (status == UNDULA_OK) status = undula_pump_box(model, low, high);
  if (status == UNDULA_OK) {
    pump.low = low[2];
    pump.step = (high[2] - low[2]) / (heads - 1);
    for (int i = 0; i < heads; ++i) head[i] = i < heads - 1 ? low[2] + i * pump.step : high[2];
    status = undula_pump_curve(model, atof(words[2]), atof(words[3]), head, heads, pump.flow, NULL, NULL);
  }
  if (status != UNDULA_OK) {
    fprintf(stderr, "%s\n", undula_last_error());
    return status;
  }
  undula_pump_close(model);
  for (int i = 0; i < heads; ++i) pump.flow[i] *= ml_per_s_per_l_per_min;

  /* 2. Beats by classical Runge-Kutta, until they repeat; means over the last one. */
  const double step = 1 / (heart_rate_per_s * steps_per_beat);
  double pressure = 70.0, mean_pressure = 0, mean_flow = 0, lowest = 1e9, highest = -1e9;
  for (int n = 0; n < beats * steps_per_beat; ++n) {
    const double t = n * step;
    if (n >= (beats - 1) * steps_per_beat) {
      mean_pressure += pressure / steps_per_beat;
      mean_flow += pump_flow(&pump, pressure - ventricle(t)) / ml_per_s_per_l_per_min / steps_per_beat;
      if (pressure < lowest) lowest = pressure;
      if (pressure > highest) highest = pressure;
    }
    const double a = slope(&pump, t, pressure);
    const double b = slope(&pump, t + step / 2, pressure + step / 2 * a);
    const double c = slope(&pump, t + step / 2, pressure + step / 2 * b);
    const double d = slope(&pump, t + step, pressure + step * c);
    pressure += step / 6 * (a + 2 * b + 2 * c + d);
  }
  printf("mean pressure %.4f mmHg (%.4f to %.4f), mean flow %.5f l/min\n", mean_pressure, lowest, highest,
         mean_flow);
  return 0;
}
