"""Seconds per operating point against the error of the flow: meshes of a scene, and reduced models, beside measured data.

    speed_error.py MEASURED.csv PICTURE.png SCENE.toml KEY=COARSE,...,FINEST FILE...

The scene is computed with every value of the key; its error is the distance from the finest one. Other files are scenes,
reduced models driven by a stroke, or curves that `undula hq --json` recorded.
"""

import sys

import undula


def main(data: str, picture: str, scene: str, variation: str, *files: str) -> None:
    # 1. Every level at the measured setting.
    measured = undula.read_measured(data)
    key, values = variation.split("=")
    found = undula.report(
        [scene, *files],
        data,
        frequency_Hz=measured.frequency_Hz,
        stroke_mm=measured.stroke_mm,
        points=3,
        vary={key: [float(v) if "." in v else int(v) for v in values.split(",")]},
    )

    # 2. Numbers. What a level is compared with stands beside its error; the finest setting has none of its own.
    print(f"{'level':56s}  s per point  rms to data  rms to its reference (l/min)")
    rows = []
    for level in found["levels"]:
        name = f"{level['level']}, {level['source'].rsplit('/', 1)[-1]}"
        error = level["rms_to_reference_l_per_min"]
        rows.append((name, level["seconds_per_point"], level["rms_to_data_l_per_min"], error))
        print("%-56s  %11.4f  %11.3f  %s" % (*rows[-1][:3], "-" if error is None else f"{error:.2g}"))

    # 3. The picture: full marks against the data, open ones against the finest setting.
    from matplotlib import pyplot

    axes = pyplot.figure(figsize=(8, 5), layout="constrained").add_subplot()
    for number, (name, seconds, to_data, error) in enumerate(rows):
        axes.plot(seconds, to_data, "o", color=f"C{number}", label=name)
        if error:
            axes.plot(seconds, error, "o", color=f"C{number}", fillstyle="none")
    axes.axhline(found["scatter_l_per_min"], linestyle=":", color="grey", label="scatter of the data")
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlabel("seconds per operating point")
    axes.set_ylabel("rms error of the flow (l/min); open: to the finest")
    axes.legend(fontsize="small")
    axes.figure.savefig(picture, dpi=150)


if __name__ == "__main__":
    if len(sys.argv) < 5 or "=" not in sys.argv[4]:
        sys.exit(__doc__)
    import matplotlib

    matplotlib.use("Agg")
    main(*sys.argv[1:])
