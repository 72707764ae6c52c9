"""Drivers and laws written in Python, and real time."""
import subprocess
import sys
import time

import numpy as np
import pytest

import pliant as pl
from conftest import press, sheet


class Hand:
    """Presses ever deeper."""

    max_force = 3.0

    def __init__(self, fails_at=None):
        self.reads, self.forces, self.fails_at, self.closed = 0, [], fails_at, False

    def read(self):
        self.reads += 1
        if self.reads == self.fails_at:
            raise RuntimeError("the cable is out")
        return 0.0, 0.001 - 2e-5 * min(self.reads, 150), 0.0

    def write(self, force, torque):
        self.forces.append(force[1])

    def close(self):
        self.closed = True


def test_a_driver_in_python_feels_the_sheet(session):
    hand = Hand()
    session.connect("tip", hand)
    run = session.run(200)
    assert run.depth[-1] == pytest.approx(0.002) and max(hand.forces) == pytest.approx(run.force[-1, 1])
    session.release("tip")
    assert hand.forces[-1] == 0 and hand.closed


def test_a_driver_that_raises_ends_with_zero_force(session):
    hand = Hand(fails_at=150)
    session.connect("tip", hand)
    with pytest.raises(pl.Error, match="the cable is out") as caught:
        session.run(400)
    assert isinstance(caught.value.__cause__, RuntimeError)
    assert max(hand.forces) > 0.3 and hand.forces[-1] == 0
    with pytest.raises(pl.Error, match="restart"):
        session.step()
    session.restart()
    hand.fails_at = None
    session.run(100)


def test_wrong_poses_and_calls_from_a_driver(session):
    class Wrong(Hand):
        def read(self):
            return 0.0, 1.0

    session.connect("tip", Wrong())
    with pytest.raises(pl.Error, match=r"read\(\).*shape is \(2,\)"):
        session.step(3)

    said = []

    class Reentrant(Hand):
        def read(self):
            try:
                session.tick(0, 0, 0)
            except pl.Error as error:
                said.append(error.code)
            return None

    session.restart()
    session.release("tip")
    session.connect("tip", Reentrant())
    session.step(2)
    assert said[0] == "session.reentrant"


def test_ctrl_c_in_a_driver_is_no_error(session):
    class Interrupted(Hand):
        def read(self):
            raise KeyboardInterrupt

    session.connect("tip", Interrupted())
    with pytest.raises(KeyboardInterrupt):
        session.step(3)


def test_real_time_with_a_python_driver():
    s = pl.Session("minimal")
    hand = Hand()
    s.connect("tip", hand)
    s.keep_readings(5000)
    s.start()
    with pytest.raises(pl.Error):
        s.tick(0, 0, 0)
    until = time.monotonic() + 10
    while len(hand.forces) < 200 and time.monotonic() < until:
        time.sleep(0.01)
    assert s.running and s.bodies["sheet"].positions.shape[1] == 3
    s.stop()
    assert not s.running and hand.forces[-1] == 0 and len(hand.forces) >= 200
    felt = s.readings("tip")
    assert len(felt) >= 200 and felt.lost == 0 and (np.diff(felt.time) > 0).all() and felt.force.shape == (len(felt), 3)
    assert s.device_state("tip")["position"].shape == (3,)
    hand.fails_at = hand.reads + 5
    s.restart()
    s.start()
    while s.running and time.monotonic() < until:
        time.sleep(0.01)
    with pytest.raises(pl.Error, match="the cable is out"):
        s.stop()
    assert hand.forces[-1] == 0


def test_a_program_may_end_while_its_clocks_run():
    code = ("import pliant as pl, time\n"
            "class D:\n"
            "    def read(self): return 0, -0.001, 0\n"
            "    def write(self, f, t): pass\n"
            "s = pl.Session('minimal'); s.connect('tip', D()); s.start(); time.sleep(0.1)\n"
            "t = pl.Session('minimal'); t.connect('tip', 'simulated:touch'); t.start(); view = s.bodies['sheet'].positions\n"
            "import threading\n"
            "u = pl.Session('minimal'); threading.Thread(target=u.step, args=(10**12,), daemon=True).start()\n"
            "time.sleep(0.1)")
    assert subprocess.run([sys.executable, "-c", code], timeout=60).returncode == 0


class Softening:
    """F = k s tanh(h / s)"""

    s = 0.01

    def force(self, h):
        return self.s * np.tanh(h / self.s)

    def potential(self, h):
        return self.s**2 * np.log(np.cosh(h / self.s))

    def slope(self, h):
        return 1 / np.cosh(h / self.s) ** 2


def law_scene(spring):
    scene = pl.Scene()
    scene.add_surface("sheet", *sheet(cells=8), stiffness=300, spring=spring)
    scene.add_probe("tip")
    return scene


def test_a_law_in_python_is_felt():
    pl.register_spring("py_softening", Softening())
    with pl.Session(law_scene("py_softening")) as s:
        assert s.run(press(0.004, 60)).force[-1, 1] == pytest.approx(300 * 0.01 * np.tanh(0.4), rel=1e-6)
    paths = [press(0.003, 40)] * 3
    runs = pl.batch(law_scene("py_softening"), paths, threads=2)
    assert np.array_equal(runs[0].force, runs[2].force)
    with pytest.raises(pl.Error, match="py_softening"):
        pl.register_spring("py_softening", Softening())
    with pytest.raises(pl.ArgumentError, match="potential"):
        pl.register_spring("half", object.__new__(type("Half", (), {"force": lambda self, h: h})))


def test_a_law_that_raises_is_an_error():
    law = Softening()
    pl.register_spring("py_fails", law)
    with pl.Session(law_scene("py_fails")) as s:
        s.run(press(0.001, 40))
        law.s = None
        with pytest.raises(pl.Error, match="spring law") as caught:
            s.run(press(0.002, 40))
        assert caught.value.code == "law.raised" and isinstance(caught.value.__cause__, TypeError)
        law.s = 0.01
        s.restart()
        s.run(press(0.001, 40))
