"""The head-flow curve of a model, its stated error, and measured points beside it.

    hq_curve.py MODEL.h5 MEASURED.csv PICTURE.png

Frequency and drive are those that the measured file states.
"""

import sys

import numpy as np

import undula


def main(model_file: str, measured_file: str, picture: str) -> None:
    # 1. What was measured, and how the pump was driven.
    measured = undula.read_measured(measured_file)
    model = undula.load(model_file)
    by_voltage = "voltage_V" in model.training_box
    drive = {"voltage_V": measured.voltage_V} if by_voltage else {"stroke_mm": measured.stroke_mm}

    # 2. The curve over the measured heads.
    heads = np.linspace(measured.head_mmHg.min(), measured.head_mmHg.max(), 12)
    curve = model.curve(frequency_Hz=measured.frequency_Hz, heads_mmHg=heads, **drive)

    # 3. Numbers: the model, its own error, and the distance to the fit of the data.
    fit = measured.fit(heads)
    print("head (mmHg)  flow (l/min)  error (l/min)  measured, fit (l/min)")
    for row in zip(heads, curve.flow_l_per_min, curve.error_l_per_min, fit):
        print("%11.1f  %12.3f  %13.3f  %21.3f" % row)
    rms = np.sqrt(np.mean((curve.flow_l_per_min - fit) ** 2))
    print(f"rms {rms:.3f} l/min from the fit; a sample scatters by {measured.scatter_l_per_min:.3f} l/min about it")

    # 4. The picture.
    undula.plot_curve(curve, measured=measured).figure.savefig(picture, dpi=150)


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    import matplotlib

    matplotlib.use("Agg")
    main(*sys.argv[1:])
