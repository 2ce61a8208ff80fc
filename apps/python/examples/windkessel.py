"""A pump between a weak ventricle and a two-element Windkessel, over some heart beats.

    windkessel.py MODEL.h5 FREQUENCY_HZ DRIVE [PICTURE.png]

The arteries hold the volume C P and drain through R; the pump draws from the ventricle, whose pressure is prescribed:

    C dP/dt = Q(P - P_ventricle(t)) - P / R

Q is the head-flow curve of the model at a frequency and a drive (V or mm, whichever drives it). The pump answers as if
every head lasted: it runs some hundred periods per beat. What this leaves out: the inertia of the blood in the cannulas,
the veins (pressure 0), and flow through the aortic valve. Where the ventricle rises above the arteries, that is said.
"""

import sys
from typing import Callable

import numpy as np

import undula

ML_PER_S_PER_L_PER_MIN = 1000 / 60

HEART_RATE_PER_S = 75 / 60
VENTRICLE_REST_MMHG, VENTRICLE_PEAK_MMHG = 8, 55  # a weak one: it does not open the valve
SYSTOLE = 0.35  # part of the beat
RESISTANCE_MMHG_S_PER_ML, COMPLIANCE_ML_PER_MMHG = 1.2, 1.5


def ventricle_mmHg(time_s: float) -> float:
    """Pressure of the ventricle: a squared sine in systole, at rest otherwise."""
    phase = (time_s * HEART_RATE_PER_S) % 1 / SYSTOLE
    pulse = np.sin(np.pi * phase) ** 2 if phase < 1 else 0.0
    return VENTRICLE_REST_MMHG + (VENTRICLE_PEAK_MMHG - VENTRICLE_REST_MMHG) * pulse


def sampled_pump(model, frequency_Hz: float, drive: dict, sign_of_error: int = 0) -> Callable[[float], float]:
    """The curve as a function: head (mmHg) to flow (ml/s); with its stated error added or taken off.

    Heads that the box of the model does not hold end the computation.
    """
    low, high = model.training_box["head_mmHg"]
    heads = np.linspace(low, high, 200)
    curve = model.curve(frequency_Hz=frequency_Hz, heads_mmHg=heads, **drive)
    flow = ML_PER_S_PER_L_PER_MIN * (curve.flow_l_per_min + sign_of_error * curve.error_l_per_min)

    def pump(head_mmHg: float) -> float:
        if not low <= head_mmHg <= high:
            raise ValueError(f"a head of {head_mmHg:.1f} mmHg: the model knows {low:g} to {high:g} mmHg")
        return float(np.interp(head_mmHg, heads, flow))

    return pump


def march(pump, ventricle, beats: int = 12, steps_per_beat: int = 400, start_mmHg: float = 70.0):
    """Classical Runge-Kutta. Returns times (s) and arterial pressures (mmHg), both with beats * steps + 1 entries."""
    step = 1 / (HEART_RATE_PER_S * steps_per_beat)
    time = step * np.arange(beats * steps_per_beat + 1)
    pressure = np.empty_like(time)
    pressure[0] = start_mmHg

    def slope(t, p):
        return (pump(p - ventricle(t)) - p / RESISTANCE_MMHG_S_PER_ML) / COMPLIANCE_ML_PER_MMHG

    for n in range(len(time) - 1):
        t, p = time[n], pressure[n]
        a = slope(t, p)
        b = slope(t + step / 2, p + step / 2 * a)
        c = slope(t + step / 2, p + step / 2 * b)
        d = slope(t + step, p + step * c)
        pressure[n + 1] = p + step / 6 * (a + 2 * b + 2 * c + d)
    return time, pressure


def last_beat(pump, ventricle, steps_per_beat: int = 400):
    """Arterial pressure (mmHg), pump flow (ml/s) and time (s) of the last beat."""
    time, pressure = march(pump, ventricle, steps_per_beat=steps_per_beat)
    time, pressure = time[-steps_per_beat - 1 :], pressure[-steps_per_beat - 1 :]
    flow = np.array([pump(p - ventricle(t)) for t, p in zip(time, pressure)])
    return time, pressure, flow


def main(model_file: str, frequency_Hz: float, drive: float, picture: str = "") -> None:
    # 1. The pump: the curve of the model, and the same with its stated error.
    model = undula.load(model_file)
    kind = "voltage_V" if "voltage_V" in model.training_box else "stroke_mm"
    print("pump            mean pressure (mmHg)  lowest  highest  mean flow (l/min)  lowest  highest")
    for name, sign in (("as stated", 0), ("plus its error", 1), ("minus its error", -1)):
        pump = sampled_pump(model, frequency_Hz, {kind: drive}, sign)

        # 2. Beats, until they repeat.
        time, pressure, flow = last_beat(pump, ventricle_mmHg)
        q = flow / ML_PER_S_PER_L_PER_MIN
        print(
            f"{name:15s} {pressure[:-1].mean():20.2f}  {pressure.min():6.2f}  {pressure.max():7.2f}  "
            f"{q[:-1].mean():17.3f}  {q.min():6.3f}  {q.max():7.3f}"
        )
        if sign == 0:
            shown = time, pressure, q

    # 3. What the model leaves out has to stay away.
    time, pressure, q = shown
    ventricle = np.array([ventricle_mmHg(t) for t in time])
    if (ventricle > pressure).any():
        print("the ventricle rises above the arteries: the aortic valve would open, which is not modelled")
    volume = (q[:-1].mean() * ML_PER_S_PER_L_PER_MIN - pressure[:-1].mean() / RESISTANCE_MMHG_S_PER_ML) / HEART_RATE_PER_S
    print(f"the arteries gain {volume:.2g} ml over the last beat")

    # 4. The picture.
    if picture:
        from matplotlib import pyplot

        figure, (above, below) = pyplot.subplots(2, 1, sharex=True)
        above.plot(time - time[0], pressure, label="arteries")
        above.plot(time - time[0], ventricle, label="ventricle (prescribed)")
        above.set_ylabel("pressure (mmHg)")
        above.legend()
        below.plot(time - time[0], q)
        below.set_ylabel("flow of the pump (l/min)")
        below.set_xlabel("time in the beat (s)")
        figure.savefig(picture, dpi=150)


if __name__ == "__main__":
    if len(sys.argv) not in (4, 5):
        sys.exit(__doc__)
    if len(sys.argv) == 5:
        import matplotlib

        matplotlib.use("Agg")
    main(sys.argv[1], float(sys.argv[2]), float(sys.argv[3]), *sys.argv[4:])
