"""Sessions: the bits of C++, views, states, threads, errors."""
import copy
import ctypes
import gc
import os
import pickle
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import pliant as pl
from conftest import COMMAND, SOURCE, box, press, sheet


def test_a_followed_script_gives_the_forces_of_the_command(tmp_path):
    ran = subprocess.run([COMMAND, "run", "minimal", "--headless", "--seconds", "1.5", "--frames", "0", "--out", tmp_path / "run"],
                         capture_output=True, text=True)
    assert ran.returncode == 0, ran.stderr
    rows = [line.split(",") for line in (tmp_path / "run/forces.csv").read_text().splitlines()]
    columns = [rows[0].index(name) for name in ("depth_m", "fx", "fy", "fz")]
    script = np.loadtxt(SOURCE / "content/levels/minimal.csv", delimiter=",", skiprows=2)
    with pl.Session("minimal") as s:
        s.follow("tip", script[:, 0], script[:, 1:4])
        run = s.run(1500)
    assert run.force[:, 1].max() > 0.5
    assert len(rows) == 1501
    for row, depth, force in zip(rows[1:], run.depth, run.force):
        wrote = [row[c] for c in columns]
        # Each number of the file is the shortest that stands for nine digits of ours.
        assert wrote == [f"{float(f'{value:.9g}'):.9g}" if value else "0" for value in (depth, *force)], row


def test_run_has_the_bits_of_the_loop(session):
    path = press()
    loop = np.array([session.tick(*p) for p in path])
    session.restart()
    run = session.run(path)
    assert loop.any() and np.array_equal(loop, run.force)
    assert run.depth[-1] == session.probes["tip"].depth and run.touching[-1] and not run.touching[0]
    assert np.array_equal(session.tick(path[-1]), session.probes["tip"].force)


@pytest.mark.parametrize("level, threads", [("minimal", 1), ("minimal", 3), ("stack", 2)])
def test_a_batch_has_the_bits_of_the_loop(level, threads):
    with pl.Session(level) as s:
        above = s.bounds_of(None)[1]
        name = s.effectors[0]
    paths = [{name: np.array([above[0] * 0, above[1] - 0.0005 * k, 0.0]) + press(0.003, 120) * [0, 1, 0]} for k in range(5)]
    alone = []
    for path in paths:
        with pl.Session(level) as s:
            views = [body.positions for body in s.bodies.values()]  # to look changes nothing
            forces = [s.tick({name: p})[name] for p in path[name][:60]]
            alone.append(s.run({name: path[name][60:]})[name])
            alone[-1].force = np.concatenate([[f[:3] for f in forces], alone[-1].force])
            assert all(np.isfinite(view).all() for view in views)
    together = pl.batch(level, paths, threads=threads)
    assert any(each.force.any() for each in alone)
    for a, b in zip(alone, together):
        assert np.array_equal(a.force, b[name].force) and np.array_equal(a.depth, b[name].depth[60:])
        assert np.array_equal(a.time, b[name].time[60:])


def test_a_batch_sets_parameters():
    stiff = [None, 200, 500, None, 900]
    runs = pl.batch("minimal", [press()] * 5, threads=2, settings=[{"sheet.stiffness": k} if k else {} for k in stiff])
    assert [run.force[-1, 1] for run in runs] == pytest.approx([0.002 * (k or 300) for k in stiff])
    for wrong, words in (({"shet.stiffness": 1}, "did you mean 'sheet'"), ({"sheet.stifness": 1}, "did you mean stiffness"),
                         ({"sheet.stiffness": "x"}, "must be a number"), ({"sheet": 1}, "unknown name")):
        with pytest.raises(pl.Error, match=words):
            pl.batch("minimal", [press()], settings=[wrong])
    with pytest.raises(pl.ArgumentError, match="one for each"):
        pl.batch("minimal", [press()], settings=[{}, {}])


def test_a_state_comes_back_bit_for_bit(session):
    session.run(press(0.002, 100))
    state = session.save()
    first = session.run(press(0.003, 50)).force
    session.restore(state)
    assert np.array_equal(session.run(press(0.003, 50)).force, first)
    with pl.Session("minimal") as other:
        other.restore(state)
        assert np.array_equal(other.run(press(0.003, 50)).force, first)
    with pytest.raises(pl.Error):
        session.restore(state[:-3])
    with pytest.raises(pl.Error):
        session.restore(b"not a state")


def test_a_view_is_live_read_only_and_outlives_its_session():
    s = pl.Session("minimal")
    view = s.bodies["sheet"].positions
    assert view.dtype == np.float32 and view.shape[1] == 3 and not view.flags.writeable
    rest = view.copy()
    s.run(press(0.003))
    assert view[:, 1].min() < -0.0029 and s.bodies["sheet"].positions.base is not None
    assert np.array_equal(view, s.bodies["sheet"].positions)
    assert np.shares_memory(view, s.bodies["sheet"].positions)
    s.restart()
    assert np.array_equal(view, rest)
    s.run(press(0.003))
    dented = view.copy()
    with pytest.raises(ValueError):
        view[0] = 0
    with pytest.raises(ValueError):
        view.flags.writeable = True
    del s
    gc.collect()
    junk = [np.full(view.shape, 7, np.float32) for _ in range(50)]
    assert np.array_equal(view, dented) and junk
    assert rest.flags.writeable


def test_another_thread_counts_while_run_goes(session):
    counted, ends = [0], threading.Event()

    def count():
        while not ends.is_set():
            counted[0] += 1

    thread = threading.Thread(target=count)
    thread.start()
    before = counted[0]
    session.run(np.tile([0.0, -0.002, 0.0], (50_000, 1)))
    during = counted[0] - before
    ends.set()
    thread.join()
    assert during > 1000


def test_threads_take_turns_on_one_session(session):
    said = []

    def work(k):
        try:
            for _ in range(200):
                session.tick(0, -0.001 * k, 0)
                session.bodies["sheet"].positions.sum()
                session.contacts()
        except pl.Error as error:
            said.append(error.code)

    threads = [threading.Thread(target=work, args=(k,)) for k in range(4)]
    for t in threads:
        t.start()
    for t in threads:
        t.join()
    assert not said and session.time == pytest.approx(0.8)

    threads = [threading.Thread(target=work, args=(k,)) for k in range(4)]
    for t in threads:
        t.start()
    session.close()  # while they work
    for t in threads:
        t.join()
    assert set(said) <= {"session.closed"}


def test_many_sessions_leave_nothing():
    scene = pl.Scene("small")
    scene.add_surface("sheet", *sheet(cells=2), stiffness=300)
    scene.add_probe("tip")

    def resident():
        ctypes.CDLL(None).malloc_trim(0)
        with open("/proc/self/statm") as f:
            return int(f.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")

    def some(n):
        for _ in range(n):
            s = pl.Session(scene)
            s.tick(0, -0.001, 0)
            s.bodies["sheet"].positions
        gc.collect()

    some(50)
    before = resident()
    some(400)  # each takes some 10 ms
    assert resident() - before < 4e5  # [bytes]: 1 kB a session


def test_live_parameters(session):
    sheet_ = session.surfaces["sheet"]
    session.run(press(0.002))
    sheet_.stiffness = 900
    assert sheet_.stiffness == 900 and sheet_["stiffness"] == 900
    assert session.run(press(0.002)).force[-1, 1] == pytest.approx(1.8, rel=1e-6)
    sheet_["damping_ratio"] = 2
    sheet_.shape = "hertz"
    assert (sheet_.shape, sheet_.spring) == ("hertz", "linear")
    sheet_.spring, sheet_.cubic = "cubic", 2e6
    assert sheet_.spring == "cubic" and sheet_.parameters["cubic"] == 2e6 and list(sheet_.parameters) == sheet_.keys()
    assert session.run(press(0.002)).force[-1, 1] == pytest.approx(900 * 0.002 + 2e6 * 0.002**3, rel=1e-6)
    assert session.probes["tip"].coupling == [1000, 5]
    assert "stiffness" in dir(sheet_) and "relaxation.time" in sheet_.keys()
    for wrong in (-1, "high", float("nan"), [1, 2], True, None, 1j):
        with pytest.raises(pl.Error, match="stiffness"):
            sheet_.stiffness = wrong
    with pytest.raises(AttributeError, match="read-only"):
        sheet_.positions = 3
    with pytest.raises(pl.UnknownName, match="did you mean 'stiffness'"):
        sheet_.stifness = 3
    assert not hasattr(sheet_, "stifness")


def test_contacts_have_names_and_arrays(session):
    assert len(session.contacts()) == 0 and session.contacts().force.shape == (0, 3)
    session.run(press(0.002))
    (contact,) = session.contacts()
    assert (contact.a, contact.b) == ("tip", "sheet") and contact.depth == pytest.approx(0.002)
    assert np.array_equal(session.contacts().force[0], contact.force)
    assert session.bodies["sheet"].forces.sum(axis=0) == pytest.approx(-contact.force, abs=1e-5)
    hit = session.ray([0.03, 1, 0.03], [0, -1, 0])
    assert hit.object == "sheet" and hit.distance == pytest.approx(1, abs=1e-6)
    assert session.closest_point([0, 1, 0], within=0.1) is None


def test_events_of_layers_and_pickled_runs():
    script = np.loadtxt(SOURCE / "content/levels/layers_needle.csv", delimiter=",", skiprows=2)
    with pl.Session("layers") as s:
        assert len(s.effectors) > 1
        with pytest.raises(pl.ArgumentError, match="several probes"):
            s.tick(0, 0, 0)
        s.follow("needle", script[:, 0], script[:, 1:4])
        run = s.run(4000)
        with pytest.raises(pl.ArgumentError, match="say which"):
            run.force
    assert [e.layer for e in run.events if e.kind == "broke" and e.probe == "needle"] == ["skin", "ligament"]
    assert [e.kind for e in run.events if e.probe == "finger"] == ["yielded"]  # on its level's script
    again = pickle.loads(pickle.dumps(run))
    assert repr(again.events) == repr(run.events) and np.array_equal(again["needle"].force, run["needle"].force)


def test_rigid_bodies_and_forces():
    scene = pl.Scene("table", soft_step=0.005)
    scene.add_rigid_body("table", *box(0.1), fixed=True, position=(0, -0.1, 0))
    scene.add_rigid_body("cube", *box(0.02), mass=0.1, position=(0, 0.02, 0))
    with pl.Session(scene) as s:
        assert s.effectors == []
        with pytest.raises(pl.Error, match="no probe"):
            s.tick(0, 0, 0)
        s.step(200)
        up = sum(c.force[1] * (1 if c.a == "cube" else -1) for c in s.contacts())
        assert up == pytest.approx(0.981, rel=0.02)
        cube = s.bodies["cube"].positions
        before = cube.copy()
        s.set_body_force("cube", [0.6, 0, 0])
        s.step(200)
        assert (cube - before)[:, 0].min() > 0.005


@pytest.mark.parametrize("call, kind, words", [
    (lambda s: s.surfaces["shet"], KeyError, "did you mean 'sheet'"),
    (lambda s: s.probes["x"], pl.UnknownName, "there are: tip"),
    (lambda s: pl.Session("mnimal"), pl.UnknownName, "did you mean 'minimal'"),
    (lambda s: pl.Session("there/is/none.glb"), pl.Error, "no such file"),
    (lambda s: pl.Session(b"glTF broken"), pl.Error, "GLB header"),
    (lambda s: pl.Session(b'{"asset": {}}'), pl.Error, "bytes.gltf"),
    (lambda s: pl.Session(b"solid"), ValueError, "format="),
    (lambda s: pl.Session(3), pl.ArgumentError, "got int"),
    (lambda s: s.tick(0, float("nan"), 0), pl.Error, "not finite"),
    (lambda s: s.tick(1, 2), pl.ArgumentError, "got .int, int."),
    (lambda s: s.tick("a"), pl.ArgumentError, "got .str."),
    (lambda s: s.tick([1, 2]), pl.ArgumentError, r"shape is \(2,\)"),
    (lambda s: s.tick({"x": [0, 0, 0]}), pl.UnknownName, "they are: tip"),
    (lambda s: s.tick(0, 0, 0, 0, 0, 0, 0), pl.Error, "unit length"),
    (lambda s: s.run([[0, 0]]), pl.ArgumentError, r"\(1, 2\)"),
    (lambda s: s.run([[0, 0, 0], [1, 2]]), pl.ArgumentError, "all of one length"),
    (lambda s: s.run([[0, 0, 0], [0, np.inf, 0]]), pl.Error, "row 1"),
    (lambda s: s.run("path"), pl.ArgumentError, "numbers"),
    (lambda s: s.run(-1), pl.ArgumentError, "0 ticks"),
    (lambda s: s.run({"x": [[0, 0, 0]]}), pl.UnknownName, "there are: tip"),
    (lambda s: s.step(-1), pl.ArgumentError, "0 or more"),
    (lambda s: s.move("tip", [0, 0]), pl.ArgumentError, "position"),
    (lambda s: s.move("tip", "abc"), pl.ArgumentError, "position"),
    (lambda s: s.follow("tip", [0, 1], [[0, 0, 0]]), pl.ArgumentError, "row for each time"),
    (lambda s: s.restore(b""), pl.Error, "state"),
    (lambda s: s.render(0, 5), pl.Error, "16384"),
    (lambda s: s.connect("tip", "nodriver"), pl.Error, "nodriver"),
    (lambda s: s.connect("tip", object()), pl.ArgumentError, "read"),
    (lambda s: s.set_point_force("sheet", 99999, [0, 0, 0]), pl.Error, "sheet"),
    (lambda s: pl.batch("minimal", [press()], threads=0), pl.ArgumentError, "threads"),
    (lambda s: pl.batch("minimal", [press(), press() * np.nan]), pl.Error, r"paths\[1\], row 0"),
    (lambda s: pl.Scene().add_surface("a", [[0, 0]], [[0, 1, 2]]), pl.ArgumentError, r"\(n, 3\)"),
    (lambda s: pl.Scene().add_surface("a", [[0, 0, 0]], [[0, 1, 2]]), pl.ArgumentError, "holds 1"),
    (lambda s: pl.Scene().add_surface("a", *sheet(), stifness=3), pl.UnknownName, "did you mean stiffness"),
    (lambda s: pl.Scene().add_surface("a", *sheet(), stiffness=[1, 2]), pl.ArgumentError, "each of the 441"),
    (lambda s: pl.Scene().add_surface("a", *sheet(), paint={"x": [1]}), pl.UnknownName, "layers are"),
    (lambda s: pl.Scene().add_probe("a", radius=object()), pl.ArgumentError, "radius"),
    (lambda s: pl.Sesion, AttributeError, "did you mean 'Session'"),
])
def test_what_is_wrong_is_said(session, call, kind, words):
    with pytest.raises(kind, match=words) as caught:
        call(session)
    assert isinstance(caught.value, pl.Error) and "\n" not in str(caught.value) and caught.value.code
    again = pickle.loads(pickle.dumps(caught.value))
    assert str(again) == str(caught.value) and again.code == caught.value.code
    assert session.tick(0, 0.01, 0) == (0, 0, 0)  # and all is well


def test_a_closed_session_says_so():
    s = pl.Session("minimal")
    sheet_, tip, view = s.surfaces["sheet"], s.probes["tip"], s.bodies["sheet"].positions
    s.close()
    s.close()
    for call in (lambda: s.tick(0, 0, 0), lambda: s.time, lambda: sheet_.positions, lambda: tip.force, lambda: s.save(),
                 lambda: s.render(), lambda: s.contacts(), lambda: s.run(3), lambda: s.start(), lambda: sheet_.stiffness):
        with pytest.raises(pl.Error) as caught:
            call()
        assert caught.value.code == "session.closed"
    assert s.closed and "closed" in repr(s) and view.sum() == pytest.approx(view.copy().sum())


def test_what_was_not_initialised_is_refused():
    for kind, use in ((pl.Session, lambda s: s.tick(0, 0, 0)), (pl.Session, lambda s: s.closed), (pl.Scene, lambda s: s.copy()),
                      (pl.Scene, pl.Session), (pl.Scene, lambda s: s.add_probe())):
        with pytest.raises((pl.Error, AttributeError)):
            use(kind.__new__(kind))
    for kind in (pl.Contact, pl.Reading, pl.Event, pl.Hit, pl.Note, pl.DeviceInfo):
        for make in (kind, lambda: kind.__new__(kind), lambda: object.__new__(kind)):
            with pytest.raises(TypeError):
                make()


def test_what_cannot_be_copied_says_so(session):
    for what in (session, session.surfaces["sheet"], pl.Scene("a")):
        with pytest.raises(TypeError, match="pickle"):
            pickle.dumps(what)
    with pytest.raises(TypeError, match="restore"):
        copy.copy(session)
    scene = copy.deepcopy(pl.Scene("a"))
    scene.add_probe("x")
    assert "x" in repr(scene)


def test_a_picture_is_drawn_without_a_display(session):
    try:
        before = session.render(96, 64)
    except pl.Error as error:
        pytest.skip(f"no OpenGL here: {error}")
    assert before.shape == (64, 96, 4) and before.dtype == np.uint8 and before[:, :, :3].std() > 1
    session.run(press(0.004))
    view = session.bodies["sheet"].positions
    assert not np.array_equal(session.render(96, 64), before)
    session.run(np.tile([0, -0.003, 0], (300, 1)))
    assert view[:, 1].min() == pytest.approx(-0.003, abs=1e-4)
    drawn = []
    thread = threading.Thread(target=lambda: drawn.append(session.render(96, 64, eye=(0, 0.2, 0.01))))
    thread.start()
    thread.join()
    session.restart()
    assert session.render(96, 64).shape == drawn[0].shape
    session.close()


def test_bytes_and_files_open_alike(tmp_path):
    scene = pl.Scene("mine", gravity=(0, -1, 0))
    scene.add_surface("a.b", *sheet(), stiffness=np.linspace(200, 400, 441), friction_static=0.9, friction_sliding=0.8,
                      relaxation={"time": 0.25})
    scene.add_probe("tip", radius=0.002, max_force=2.5)
    scene.save(tmp_path / "mine.glb")
    forces = [pl.Session(source).run(press()).force for source in (scene, tmp_path / "mine.glb", (tmp_path / "mine.glb").read_bytes())]
    assert forces[0].any() and np.allclose(forces[0], forces[1], rtol=1e-4) and np.array_equal(forces[1], forces[2])


def test_ctrl_c_ends_a_long_call():
    code = ("import pliant as pl, numpy as np, sys; s = pl.Session('minimal'); print('ready', flush=True)\n"
            "try: s.step(10**9)\n"
            "except KeyboardInterrupt: print('first', flush=True)\n"
            "try: pl.batch('minimal', [np.zeros((8_000_000, 3))] * 2, threads=2)\n"
            "except KeyboardInterrupt: print('second', s.tick(0, -0.001, 0)[1])")
    child = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True)
    assert child.stdout.readline() == "ready\n"
    time.sleep(0.3)
    child.send_signal(signal.SIGINT)
    assert child.stdout.readline() == "first\n"
    time.sleep(1.0)
    child.send_signal(signal.SIGINT)
    assert child.stdout.readline().startswith("second 0.")
    assert child.wait(20) == 0


def test_a_fork_has_no_session_of_its_parent(session):
    view = session.bodies["sheet"].positions
    reader, writer = os.pipe()
    child = os.fork()
    if child == 0:
        try:
            session.tick(0, 0, 0)
            said = "ticked"
        except pl.Error as error:
            said = error.code
        with pl.Session("minimal") as mine:
            said += f" {mine.run(press()).force[-1, 1] > 0} {view.shape[1]}"
        os.write(writer, said.encode())
        os._exit(0)
    os.close(writer)
    assert os.read(reader, 100) == b"session.forked True 3"
    assert os.waitpid(child, 0)[1] == 0
    assert session.run(press()).force[-1, 1] > 0


def test_the_import_is_quick():
    code = ("import numpy, time; t = time.process_time(); import pliant; print(time.process_time() - t)")
    assert min(float(subprocess.run([sys.executable, "-c", code], capture_output=True, text=True).stdout) for _ in range(3)) < 0.1


def test_a_refused_call_changes_nothing():
    s = pl.Session("three_probes")
    before = {name: s.probes[name].position for name in s.probes}
    with pytest.raises(pl.Error):
        s.tick({"probe_a": (0.5, 0.5, 0.5), "probe_b": (np.nan, 0, 0)})
    with pytest.raises(pl.UnknownName):
        s.tick({"probe_a": (0.5, 0.5, 0.5), "probe_x": (0, 0, 0)})
    path = np.tile([0.0, 0.2, 0.0], (5, 1))
    path[3, 1] = np.inf
    with pytest.raises(pl.Error, match="row 3"):
        s.run({"probe_a": path})
    assert s.time == 0
    assert all(np.array_equal(s.probes[name].position, at) for name, at in before.items())


def test_a_state_goes_on_in_a_fresh_session():
    s, q = pl.Session("minimal"), pl.Session("minimal")
    down = np.column_stack([np.zeros(60), np.linspace(0.002, -0.001, 60), np.zeros(60)])
    s.run(down)
    state = s.save()
    q.restore(state)
    assert q.save() == state
    held = np.tile([0, -0.001, 0], (50, 1))
    once, again = s.run(held), q.run(held)
    assert once.force[-1, 1] > 0.2
    assert np.array_equal(once.force, again.force)
