"""Fits keys of a scene to measured points, and judges the fit by a curve that it has not seen.

    calibrate.py SCENE.toml MEASURED.csv OTHER.csv CALIBRATED.toml KEY=LOW:HIGH...

The other curve is computed at the setting that its file states, before and after the fit: a fit that is worth something comes
closer to both. The picture lies beside the calibrated scene.
"""

import sys
from pathlib import Path

import undula


def show(progress: undula.Progress) -> None:
    print(f"\r{progress.label}  {progress.done}/{progress.total}", end="", file=sys.stderr)


def distance(scene: str, data: str) -> float:
    """Root mean square of computed minus measured flow over six heads, l/min, at the setting of the data."""
    measured, points = undula.read_measured(data), 6
    by_voltage = 'drive = "voltage"' in undula.check(scene)["resolved"]
    drive = {"voltage_V": measured.voltage_V} if by_voltage else {"stroke_mm": measured.stroke_mm}
    found = undula.validate(scene, data, points=points, frequency_Hz=measured.frequency_Hz, **drive)
    return found["norm_to_fit_l_per_min"] / points**0.5


def main(scene: str, data: str, other: str, calibrated: str, *ranges: str) -> None:
    # 1. The fit.
    free = {key: tuple(map(float, text.split(":"))) for key, text in (one.split("=") for one in ranges)}
    fit = undula.calibrate(scene, data, free=free, output=calibrated, points=5, force=True, progress=show)
    print(file=sys.stderr)
    for key, value in fit.optimum.items():
        print(f"{key} = {value:.4f} -+ {fit.standard_error[key]:.4f}")
    for sentence in fit.statements:
        print(f"- {sentence}")

    # 2. Both curves before and after: one was fitted, the other was not.
    print("curve      before (l/min)  after (l/min)  scatter (l/min)")
    for name, file in (("fitted", data), ("predicted", other)):
        scatter = undula.read_measured(file).scatter_l_per_min
        print(f"{name:9s}  {distance(scene, file):14.3f}  {distance(calibrated, file):13.3f}  {scatter:15.3f}")

    # 3. The picture.
    undula.plot(fit).figure.savefig(Path(calibrated).with_suffix(".png"), dpi=150)


if __name__ == "__main__":
    if len(sys.argv) < 6 or not all("=" in word for word in sys.argv[5:]):
        sys.exit(__doc__)
    import matplotlib

    matplotlib.use("Agg")
    main(*sys.argv[1:])
