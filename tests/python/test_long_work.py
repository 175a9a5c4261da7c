"""Long work says how far it is, can be stopped, and lets the rest of Python run."""
import multiprocessing
import os
import signal
import subprocess
import sys
import threading
import time

import pytest

import loopwright

LONG = """;!vermiculation-1
;;Gauge: 12
;;Yarn-A: wool 2/28 Nm
;;Loop-Length: 5.9 mm
;;Size: 40 wales x 40 courses
;;Edges: held
g
"""


def test_progress_goes_forward_and_ends_at_rest(examples):
    said = []
    cloth = loopwright.relax(examples / "structures/rib.verm", periodic=True, progress=said.append)
    assert cloth.converged and {p.phase for p in said} == {"grow-in", "relax"}
    shares = [p.share for p in said]
    assert shares == sorted(shares) and 0 <= shares[0] and shares[-1] <= 1
    assert said[-1].step > 5 and said[-1].residual >= cloth.residual


def test_false_stops_and_gives_what_was_reached(examples):
    cloth = loopwright.relax(examples / "structures/rib.verm", periodic=True, progress=lambda p: p.step < 4)
    assert cloth.stopped and cloth.converged is False and cloth.whole
    asked = []
    piece = loopwright.relax(loopwright.read_text(LONG), progress=lambda p: asked.append(p) or False)
    assert piece.stopped and len(asked) == 1  # who has said stop is not asked again
    points = []
    test = loopwright.stretch(examples / "structures/rib.verm", periodic=True, to=[0.3],
                              progress=lambda p: points.append(p.phase) or p.phase != "stretch" or p.share < 0.2)
    assert test.stopped and set(points) == {"grow-in", "relax", "stretch"} and 1 <= len(test) < 6


def test_what_the_callback_raises_comes_through(examples):
    def fail(progress):
        raise RuntimeError(f"enough at {progress.step}")

    with pytest.raises(RuntimeError, match="enough at 0"):
        loopwright.relax(examples / "structures/rib.verm", periodic=True, progress=fail)


def test_the_bar_draws_in_one_line(examples, capsys):
    loopwright.relax(examples / "structures/rib.verm", periodic=True, progress=loopwright.progress_bar())
    said = capsys.readouterr().err
    assert "\r" in said and "\n" not in said and "relax" in said and "#" in said


def test_other_threads_run_meanwhile(examples):
    ticks, done = [], threading.Event()

    def tick():
        while not done.is_set():
            ticks.append(time.perf_counter())
            time.sleep(0.002)

    clock = threading.Thread(target=tick)
    clock.start()
    begin = time.perf_counter()
    try:
        loopwright.relax(loopwright.read_text(LONG), window=(12, 12), from_template=True, progress=stop_after(1.5))
    finally:
        end = time.perf_counter()
        done.set()
        clock.join()
    during = [t for t in ticks if begin < t < end]
    assert end - begin > 0.3 and len(during) > 20 * (end - begin)  # 500 a second on an idle machine


def stop_after(seconds):
    begin = time.perf_counter()
    return lambda progress: time.perf_counter() - begin < seconds


def test_ctrl_c_stops_after_the_current_step():
    code = ("import loopwright, sys\n"
            f"program = loopwright.read_text({LONG!r})\n"
            "print('begun', flush=True)\n"
            "try:\n    loopwright.relax(program, from_template=True)\n"
            "except KeyboardInterrupt:\n    print('stopped'); sys.exit(3)\n")
    child = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True)
    assert child.stdout.readline() == "begun\n"
    time.sleep(1)
    assert child.poll() is None, "the work is too short for this test"
    child.send_signal(signal.SIGINT)
    said, _ = child.communicate(timeout=30)
    assert (child.returncode, said) == (3, "stopped\n")


def test_ctrl_c_stops_a_forked_process_too():
    def work(begun):
        signal.signal(signal.SIGINT, signal.default_int_handler)
        begun.set()
        try:
            loopwright.relax(loopwright.read_text(LONG), from_template=True)
        except KeyboardInterrupt:
            sys.exit(3)

    loopwright.relax(loopwright.read_text(LONG), periodic=True)
    context = multiprocessing.get_context("fork")
    begun = context.Event()
    child = context.Process(target=work, args=(begun,))
    child.start()
    assert begun.wait(10)
    time.sleep(1)
    os.kill(child.pid, signal.SIGINT)
    child.join(30)
    assert child.exitcode == 3


def width_of(length):
    loopwright.set_threads(1)
    program = loopwright.read_text(LONG, loop_length_mm=length)
    return loopwright.relax(program, periodic=True).measure()["width_mm"]


@pytest.mark.parametrize("start", ["fork", "spawn"])
def test_a_sweep_in_processes_is_the_same_as_in_one(start):
    lengths = [5.5, 6.5]
    here = [width_of(length) for length in lengths]
    loopwright.set_threads(0)
    loopwright.relax(loopwright.read_text(LONG), periodic=True)  # this process has its threads before it is copied
    with multiprocessing.get_context(start).Pool(2) as pool:
        assert pool.map_async(width_of, lengths).get(timeout=60) == here


def drawn_in(cloth):
    try:
        return cloth.render(size=(64, 64)).tobytes()
    except loopwright.Error as fault:
        return str(fault)


@pytest.mark.parametrize("start", ["fork", "spawn"])
def test_a_picture_in_another_process_is_drawn_or_refused(start, rib):
    """A copy of a process that has drawn would hang in the driver."""
    here = drawn_in(rib)
    with multiprocessing.get_context(start).Pool(1) as pool:
        there = pool.apply_async(drawn_in, (rib,)).get(timeout=60)
    assert there == here if start == "spawn" else "get_context('spawn')" in there


def test_threads_of_python_may_work_at_once(examples, tmp_path):
    names = ["rib", "garter", "moss", "plain"] * 2
    alone = {name: loopwright.relax(examples / f"structures/{name}.verm", periodic=True).measure() for name in names}
    found, faults = [None] * len(names), []

    def work(k):
        try:
            cloth = loopwright.relax(examples / f"structures/{names[k]}.verm", periodic=True)
            cloth.save(tmp_path / f"{k}.h5")
            found[k] = loopwright.load(tmp_path / f"{k}.h5").measure()
        except Exception as fault:  # told below, where pytest sees it
            faults.append(fault)

    workers = [threading.Thread(target=work, args=(k,)) for k in range(len(names))]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    assert not faults and found == [alone[name] for name in names]


def test_cloth_goes_through_pickle(rib):
    import pickle

    again = pickle.loads(pickle.dumps(rib))
    assert again.measure() == rib.measure() and again.numbers == rib.numbers
    assert (again.yarns[0].control_points == rib.yarns[0].control_points).all()
