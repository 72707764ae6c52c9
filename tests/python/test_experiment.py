"""Procedures, psychometric functions, logs, environments, the command's verbs, the documents."""
import csv
import math
import pathlib
import re
import subprocess
import sys

import numpy as np
import pytest

import pliant as pl
from conftest import COMMAND, SOURCE, press
from pliant.experiment import Constant, Experiment, Quest, UpDown, psychometric


def answers_of(threshold, slope, seed):
    random = np.random.default_rng(seed)
    return lambda level: bool(random.random() < 0.5 * (1 + math.erf((level - threshold) / slope / math.sqrt(2))))


def test_a_fit_finds_the_function_that_gave_the_answers_and_its_interval_covers_it():
    covered = []
    for seed in range(12):
        ask, procedure = answers_of(300, 40, seed), Constant(np.linspace(200, 400, 9), 30, seed=seed)
        for level in procedure:
            procedure.answer(ask(level))
        fit = psychometric(procedure.levels, procedure.answers, lapse=0, bootstrap=100)
        assert abs(fit.threshold - 300) < 15 and 25 < fit.slope < 60
        covered.append(fit.threshold_interval[0] < 300 < fit.threshold_interval[1])
    assert sum(covered) >= 9  # 95 % of 12; three misses have a probability of 2 %
    assert fit(fit.threshold) == pytest.approx(0.5) and fit(fit.threshold + fit.jnd) == pytest.approx(0.75)


def test_a_fit_has_the_likelihood_of_a_dense_search():
    random = np.random.default_rng(3)
    x = np.repeat(np.arange(-3.0, 4.0), 12)
    y = random.random(len(x)) < 1 / (1 + np.exp(-(x - 0.4) / 0.7))
    fit = psychometric(x, y, shape="logistic", lapse=0.0, bootstrap=0)
    t, s = np.linspace(-1, 2, 301)[:, None, None], np.linspace(0.2, 2, 181)[:, None]
    p = np.clip(1 / (1 + np.exp(-(x - t) / s)), 1e-12, 1 - 1e-12)
    best = np.log(np.where(y, p, 1 - p)).sum(axis=-1).max()
    assert fit.log_likelihood >= best - 1e-3


def test_a_fit_says_what_its_answers_do_not_bound():
    x = np.repeat([1.0, 2, 3, 4], 10)
    assert "both sides" in psychometric(x, x < 0, bootstrap=0).note
    assert "slope" in psychometric(x, x > 2.5, lapse=0, bootstrap=0).note
    assert "slope" in repr(psychometric(x, x > 2.5, lapse=0, bootstrap=0))
    assert not psychometric(x, np.tile([1, 0, 0, 0, 0] * 2, 4).astype(bool) | (x > 2.5), bootstrap=0, lapse=0.0).note


def test_a_staircase_ends_around_71_percent():
    found = []
    for seed in range(30):
        ask, stairs = answers_of(300, 40, 100 + seed), UpDown(400, 40, reversals=14)
        for level in stairs:
            stairs.answer(ask(level))
        found.append(stairs.threshold)
    assert np.mean(found) == pytest.approx(300 + 40 * 0.545, abs=10)  # where P = sqrt(1/2)


def test_quest_needs_fewer_trials():
    errors = []
    for seed in range(8):
        ask, quest = answers_of(312, 25, seed), Quest(np.linspace(200, 400, 41), trials=40)
        for level in quest:
            quest.answer(ask(level))
        errors.append((quest.threshold[0] - 312) / quest.threshold[1])
    assert np.sqrt(np.mean(np.square(errors))) < 2 and quest.threshold[1] < 15


def test_misuse_of_a_procedure_is_said(tmp_path):
    c = Constant([1, 2], 1)
    with pytest.raises(pl.ArgumentError, match="iterate"):
        c.answer(True)
    with pytest.raises(pl.ArgumentError, match="no answer"):
        for _ in c:
            pass
    for wrong in (lambda: Constant([]), lambda: UpDown(1, -1), lambda: Quest([1]), lambda: psychometric([1, 2], [0, 1]),
                  lambda: psychometric([1, 2, 3, 4], [0, 1, 2, 3]), lambda: psychometric([1, 2, 3, 4], [0] * 4, shape="x")):
        with pytest.raises(pl.ArgumentError):
            wrong()


def test_trials_are_a_tidy_csv(tmp_path):
    file = tmp_path / "s01.csv"
    with Experiment("s01", file) as e:
        for block in e.blocks(["glove", "bare"]):
            for level in e.trials(Constant([1, 2, 3], 2, seed=0)):
                e.mark("touch")
                e.answer(level > 1.5, force_N=np.float64(level), note='said "so", once')
            with pytest.raises(pl.ArgumentError):
                e.answer(True)
    rows = list(csv.DictReader(file.open()))
    assert len(rows) == 12 and {row["block"] for row in rows} == {"glove", "bare"}
    assert all(float(row["mark_touch"]) >= 0 and row["note"] == 'said "so", once' for row in rows)
    assert [int(row["trial"]) for row in rows] == list(range(1, 13))
    with pytest.raises(pl.ArgumentError, match="exists"):
        Experiment("s01", file)
    with pytest.raises(pl.ArgumentError, match="folder"):
        Experiment("s01", tmp_path / "none/s01.csv")


def test_palpation_finds_its_lump():
    from pliant.env import Palpation

    env = Palpation(presses=30)
    seen, info = env.reset(seed=5)
    assert env.observation_space.contains(seen) and env.reset(seed=5)[1]["lump"] == pytest.approx(info["lump"])
    felt = {}
    for x in np.linspace(-0.7, 0.7, 5):
        for z in np.linspace(-0.7, 0.7, 5):
            seen, reward, ended, cut, info = env.step([x, z, -1])
            felt[x, z] = seen[2]
    best = max(felt, key=felt.get)
    assert 1.2 < felt[best] < 3.2 and np.median(list(felt.values())) == pytest.approx(1, abs=0.1)
    assert math.dist(np.array(best) * env.HALF, info["lump"]) < 0.014
    seen, reward, ended, cut, info = env.step([*(info["lump"] / env.HALF), 1])
    assert reward == pytest.approx(0.98) and ended and not cut
    with pytest.raises(pl.ArgumentError, match="reset"):
        env.step([0, 0, 0])
    env.close()


def test_verbs_of_the_command_give_arrays(tmp_path, session):
    depth = np.linspace(0, 0.004, 60)
    fit = pl.fit(depth, 250 * depth + 3e6 * depth**3, law="cubic", out=tmp_path / "fit")
    assert fit.law == "cubic" and fit.parameters["stiffness"] == pytest.approx(250, rel=0.02)
    assert fit.parameters["cubic"] == pytest.approx(3e6, rel=0.05) and len(fit.tables["fit_residuals"]["force_N"]) == 60
    plan = {"level": "minimal", "options": {"seconds": 0.8}, "axes": {"sheet.deformable.stiffness": [200, 400]}}
    swept = pl.sweep(plan, out=tmp_path / "sweep").tables["results"]
    assert list(swept["sheet.deformable.stiffness"]) == [200, 400]
    assert swept["tip.max_force_N"][1] == pytest.approx(2 * swept["tip.max_force_N"][0], rel=0.05)
    subprocess.run([COMMAND, "run", "minimal", "--headless", "--seconds", "0.2", "--frames", "0", "--out", tmp_path / "run"], check=True)
    assert any(file.suffix == ".png" for file in pl.plot(tmp_path / "run", out=tmp_path / "plot").pictures)
    with pytest.raises(pl.UnknownName, match="did you mean 'walls'"):
        pl.study("wals")
    with pytest.raises(pl.Error):
        pl.fit([0, 1], [0, 1])
    with pytest.raises(pl.ArgumentError):
        pl.fit([0, 1, 2], [0, 1])


def test_the_example_finds_the_hands_threshold(tmp_path):
    ran = subprocess.run([sys.executable, SOURCE / "examples/python/discrimination.py", tmp_path / "new"], capture_output=True, text=True)
    assert ran.returncode == 0, ran.stderr
    threshold, jnd = (float(re.search(rf"{word} ([0-9.]+)", ran.stdout)[1]) for word in ("threshold", "JND"))
    assert abs(threshold - 300) < 20 and abs(jnd - 300 * 0.08 * math.sqrt(2) * 0.6745) < 8
    assert len((tmp_path / "new/trials.csv").read_text().splitlines()) == 181


def test_every_snippet_of_the_document_runs(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    text = (SOURCE / "docs/python.md").read_text()
    snippets = re.findall(r"```python\n(.*?)```", text, re.S)
    assert len(snippets) >= 6
    names = {}
    for snippet in snippets:
        exec(compile(snippet, "docs/python.md", "exec"), names)
