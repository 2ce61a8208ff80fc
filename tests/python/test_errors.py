"""Wrong input raises an exception with what, seen, allowed and where; long calls can be interrupted; nothing leaks."""

import ctypes
import signal
import threading
import time

import numpy as np
import pytest
import undula
from conftest import PROJECTED, SOURCE


@pytest.fixture(scope="module")
def model():
    return undula.load(PROJECTED)


def assert_four_parts(error, *texts):
    message = str(error.value)
    for part in ("\n  seen:    ", "\n  allowed: ", "\n  where:   ", *texts):
        assert part in message
    assert isinstance(error.value, ValueError)


@pytest.mark.parametrize(
    "question, texts",
    [
        (dict(frequency_Hz=0, stroke_mm=0.5, heads_mmHg=50), ("frequency", "> 0")),
        (dict(frequency_Hz=120, stroke_mm=-1, heads_mmHg=50), ("stroke", "-1 mm", "> 0")),
        (dict(frequency_Hz=120, stroke_mm=float("nan"), heads_mmHg=50), ("stroke", "nan")),
        (dict(frequency_Hz=float("inf"), stroke_mm=0.5, heads_mmHg=50), ("frequency", "inf")),
        (dict(frequency_Hz=120, stroke_mm=0.5, heads_mmHg=[50, float("nan")]), ("head", "finite")),
        (dict(frequency_Hz=120, stroke_mm=0.5, heads_mmHg=[]), ("heads_mmHg", "0 values")),
        (dict(frequency_Hz=120, stroke_mm=0.5, heads_mmHg=[[1, 2], [3, 4]]), ("heads_mmHg", "2 dimensions")),
        (dict(frequency_Hz=120, heads_mmHg=50), ("driven by a stroke", "no stroke")),
        (dict(frequency_Hz=120, voltage_V=40, heads_mmHg=50), ("driven by a stroke", "voltage of 40 V", "wave_pump_fixed.h5")),
        (dict(frequency_Hz=120, voltage_V=40, stroke_mm=0.5, heads_mmHg=50), ("a stroke and a voltage",)),
    ],
)  # fmt: skip
def test_what_is_no_question_is_refused(model, question, texts):
    with pytest.raises(undula.InputError) as error:
        model.curve(**question)
    assert_four_parts(error, *texts)


def test_an_emulator_takes_its_own_drive_alone(emulator_by_voltage):
    emulator = undula.load(emulator_by_voltage)
    with pytest.raises(undula.InputError) as error:
        emulator.curve(frequency_Hz=120, stroke_mm=0.5, heads_mmHg=50)
    assert_four_parts(error, "driven by a voltage", "no voltage, but a stroke of 0.5 mm", "model.h5")
    for question in (dict(frequency_Hz=-1, voltage_V=40), dict(frequency_Hz=120, voltage_V=0)):
        with pytest.raises(undula.InputError) as error:
            emulator.curve(heads_mmHg=50, **question)
        assert_four_parts(error, "> 0")
    with pytest.raises(undula.InputError) as error:
        emulator.curve(frequency_Hz=120, voltage_V=40, heads_mmHg=float("inf"))
    assert_four_parts(error, "finite")


def test_periods_of_no_point_are_refused(model):
    with pytest.raises(undula.InputError) as error:
        model.period(frequency_Hz=120, stroke_mm=0, head_mmHg=50)
    assert_four_parts(error, "stroke")


def test_files_that_are_no_models_are_refused(tmp_path):
    with pytest.raises(undula.InputError) as error:
        undula.load(tmp_path / "none.h5")
    assert_four_parts(error, "no such file", "none.h5")
    damaged = bytearray(PROJECTED.read_bytes())
    damaged[len(damaged) // 2] ^= 1
    (tmp_path / "damaged.h5").write_bytes(damaged)
    with pytest.raises(undula.InputError) as error:
        undula.load(tmp_path / "damaged.h5")
    assert_four_parts(error, "damaged.h5")
    (tmp_path / "text.h5").write_text("no HDF5")
    with pytest.raises(undula.InputError) as error:
        undula.load(tmp_path / "text.h5")
    assert_four_parts(error, "text.h5")
    with pytest.raises(TypeError):
        undula.load(17)


@pytest.mark.parametrize("file", sorted((SOURCE / "tests/data/bad/data").iterdir()), ids=lambda file: file.name)
def test_measured_data_that_are_none_are_refused(file):
    with pytest.raises(undula.InputError) as error:
        undula.read_measured(file)
    assert_four_parts(error, file.name)


def test_warnings_may_be_errors(model):
    import warnings

    with warnings.catch_warnings():
        warnings.simplefilter("error", undula.CurveWarning)
        with pytest.raises(undula.CurveWarning):
            model.curve(frequency_Hz=120, stroke_mm=0.53, heads_mmHg=90)


def test_a_long_call_is_interrupted_and_the_model_answers_afterwards(model):
    question = dict(frequency_Hz=120, stroke_mm=0.53)
    begin = time.monotonic()
    before = model.curve(heads_mmHg=np.linspace(40, 60, 20), **question)
    per_head = (time.monotonic() - begin) / 20
    heads = np.linspace(0, 70, int(60 / per_head))  # a minute's work
    handler = signal.signal(signal.SIGALRM, signal.default_int_handler)
    begin = time.monotonic()
    signal.setitimer(signal.ITIMER_REAL, 0.3)
    try:
        with pytest.raises(KeyboardInterrupt):
            model.curve(heads_mmHg=heads, **question)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, handler)
    assert time.monotonic() - begin < 10
    after = model.curve(heads_mmHg=np.linspace(40, 60, 20), **question)
    assert (before.flow_l_per_min == after.flow_l_per_min).all()


def test_other_threads_run_meanwhile_and_may_ask_the_same_model(model):
    heads = np.linspace(0, 70, 100)
    alone = model.curve(frequency_Hz=120, stroke_mm=0.53, heads_mmHg=heads).flow_l_per_min
    answers = [None, None]

    def ask(i):
        answers[i] = model.curve(frequency_Hz=120, stroke_mm=0.53, heads_mmHg=heads).flow_l_per_min

    threads = [threading.Thread(target=ask, args=(i,)) for i in range(2)]
    for thread in threads:
        thread.start()
    ticks = 0
    while any(thread.is_alive() for thread in threads):
        time.sleep(0.001)
        ticks += 1
    assert ticks > 10
    assert (answers[0] == alone).all() and (answers[1] == alone).all()


class MallInfo(ctypes.Structure):
    """struct mallinfo2 of glibc."""

    _fields_ = [
        (name, ctypes.c_size_t)
        for name in "arena ordblks smblks hblks hblkhd usmblks fsmblks uordblks fordblks keepcost".split()
    ]


def bytes_in_use():
    mallinfo = ctypes.CDLL(None).mallinfo2
    mallinfo.restype = MallInfo
    info = mallinfo()
    return info.uordblks + info.hblkhd


def test_a_thousand_queries_leak_nothing(model, emulator_by_voltage):
    import gc

    emulator = undula.load(emulator_by_voltage)

    def ask(count):
        for i in range(count):
            model.curve(frequency_Hz=120, stroke_mm=0.53, heads_mmHg=[40 + i % 20]).columns()
            emulator.curve(frequency_Hz=120, voltage_V=45, heads_mmHg=[40, 50]).columns()
            with pytest.raises(undula.InputError):
                emulator.curve(frequency_Hz=0, voltage_V=45, heads_mmHg=50)
        gc.collect()

    ask(100)
    before = bytes_in_use()
    ask(1000)
    assert bytes_in_use() - before < 64 * 1000  # 64 bytes per round: no array, no message, no state
