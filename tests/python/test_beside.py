"""Beside the session: a window, the clocks of real time, and a program in C that holds the same force."""
import os
import pathlib
import shutil
import subprocess
import sys
import time

import numpy as np
import pytest

import pliant as pl
from conftest import SOURCE, press

WINDOW = """
import threading, time
import pliant as pl

s = pl.Session("minimal")
with pl.view(s, width=160, height=120) as v:
    s.start()
    while v.pictures < 3: time.sleep(0.01)
    ticks = s.figures()["ticks"]
    threading.Timer(0.05, v.close).start()
assert not v.open and v.wait(0) and "closed" in repr(v) and s.running and ticks > 3
s.stop()
s.restart()
with pl.view(s, width=160, height=120) as v:      # in lockstep
    before = s.render(64, 48)
    s.run([[0, 0.001, 0], [0, -0.004, 0]])
    assert (s.render(64, 48) != before).any() and s.bodies["sheet"].positions[:, 1].min() < -0.001
    while v.pictures < 2: s.tick(0, 0.001, 0)
    seen = v.pictures
    s.step(400_000)                               # a long call draws too
    assert v.pictures > seen and v.open
    try: pl.view(pl.Session("minimal"))
    except pl.Error as error: assert "already" in str(error) and error.code == "call.refused"
s.restart()
s.start()
try: pl.view(s)
except pl.Error as error: print(error)
s.close()
left = pl.view(pl.Session("minimal"), width=160, height=120)  # the program ends with it open
"""


def test_a_window_beside_the_clock(tmp_path):
    pytest.importorskip("pliant._window")
    if not shutil.which("xvfb-run"):
        pytest.skip("xvfb-run is missing; install xvfb and xauth")
    ran = subprocess.run(["xvfb-run", "-a", sys.executable, "-c", WINDOW], capture_output=True, text=True, timeout=120)
    if "no OpenGL" in ran.stderr:
        pytest.skip("no OpenGL here")
    assert ran.returncode == 0, ran.stderr
    assert "open it before start()" in ran.stdout


def test_what_cannot_have_a_window_says_so(session, monkeypatch):
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    with pytest.raises(pl.Error, match="display"):
        if pytest.importorskip("pliant._window"):
            pl.view(session)
    monkeypatch.setitem(sys.modules, "pliant._window", None)
    monkeypatch.delattr(pl, "_window", raising=False)
    with pytest.raises(pl.Error, match="has no window") as caught:
        pl.view(session)
    assert caught.value.code == "window.missing" and "\n" not in str(caught.value)


def test_the_first_look_at_running_clocks_is_new(session):
    session.follow("tip", [0, 0.2, 0.4], [[0, 0.001, 0], [0, 0.001, 0], [0, -0.003, 0]])
    session.start()
    time.sleep(0.7)  # nothing was published for a reader since 0.1 s
    assert session.bodies["sheet"].positions[:, 1].min() == pytest.approx(-0.003, abs=2e-4)
    session.stop()


def test_a_program_in_c_holds_the_same_force(tmp_path):
    library = next(iter(pathlib.Path(pl.__file__).absolute().parents[2].glob("c/libpliant.so")), None)
    if library is None or not shutil.which("cc"):
        pytest.skip("libpliant.so or a C compiler is missing")
    (tmp_path / "hold.c").write_text("""
#include <pliant.h>
#include <stdio.h>
int main(int count, char** words) {
  pliant_scene* scene;
  pliant_session* session;
  if (count < 2 || pliant_scene_load(words[1], NULL, &scene) || pliant_session_open(scene, NULL, NULL, &session)) return 1;
  pliant_reading felt = {.size = sizeof felt};
  for (double y; scanf("%la", &y) == 1; printf("%a %a %a %a\\n", felt.force.x, felt.force.y, felt.force.z, felt.depth)) {
    const pliant_pose pose = {{0.0031, y, 0.0007}, {0, 0, 0, 1}};
    if (pliant_session_move(session, "tip", pose) || pliant_session_step(session, 1) ||
        pliant_session_reading(session, "tip", &felt)) return 2;
  }
  return pliant_session_destroy(session) || pliant_scene_destroy(scene);
}
""")
    program = tmp_path / "hold"
    subprocess.run(["cc", "-std=c11", "-Wall", "-Wextra", "-Werror", f"-I{SOURCE}/include", tmp_path / "hold.c", "-o", program,
                    f"-L{library.parent}", "-lpliant", f"-Wl,-rpath,{library.parent}"], check=True)
    path = press(0.003, x=0.0031, z=0.0007)
    heights = "\n".join(float(y).hex() for y in path[:, 1])
    ran = subprocess.run([program, pl.level_file("minimal")], input=heights, capture_output=True, text=True, check=True)
    in_c = np.array([[float.fromhex(cell) for cell in row.split()] for row in ran.stdout.splitlines()])
    with pl.Session("minimal") as s:
        run = s.run(path)
    assert run.force[-1, 1] > 0.8 and np.array_equal(in_c, np.column_stack([run.force, run.depth]))


def test_everything_says_what_it_is(session):
    from pliant import env, experiment

    made = [getattr(pl, name) for name in pl.__all__] + [getattr(m, name) for m in (env, experiment) for name in m.__all__]
    plain = [kind.__name__ for kind in made if isinstance(kind, type) and kind.__repr__ is object.__repr__]
    assert not plain
    assert os.linesep not in repr(session) and repr(session.bodies) and repr(session.probes["tip"].reading)
