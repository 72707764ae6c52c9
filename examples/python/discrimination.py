"""Stiffness discrimination: a simulated hand presses two sheets and says which is stiffer; a psychometric function.

Usage: discrimination.py [FOLDER]   (writes trials.csv and psychometric.png there)
"""
import sys
from pathlib import Path

import numpy as np
import pliant as pl
from pliant.experiment import Constant, Experiment, psychometric

out = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
out.mkdir(parents=True, exist_ok=True)
random = np.random.default_rng(7)
session = pl.Session("minimal")                                     # a sheet, and the probe `tip`
down = np.column_stack([np.zeros(80), np.linspace(0.001, -0.003, 80), np.zeros(80)])  # [m] a press, a row a tick


def press(stiffness):
    """Stiffness [N/m] that the hand perceives: force over depth, with a Weber fraction of 8 %."""
    session.restart()
    session.surfaces["sheet"].stiffness = stiffness
    run = session.run(down)
    return run.force[-1, 1] / run.depth[-1] * random.normal(1, 0.08)


with Experiment("simulated", out / "trials.csv") as experiment:
    for level in experiment.trials(Constant(np.linspace(220, 380, 9), repeats=20, seed=1)):
        reference, comparison = press(300), press(level)
        experiment.answer(comparison > reference, reference_N_m=reference, comparison_N_m=comparison)

fit = psychometric([row["level"] for row in experiment.rows], [row["answer"] for row in experiment.rows])
print(fit)                                                          # the hand's JND: 300 * 0.08 * sqrt(2) * 0.674 = 23 N/m
try:
    fit.plot(unit="N/m", level="comparison", answer="share of `stiffer`").figure.savefig(out / "psychometric.png", dpi=120)
except ImportError:
    print("no picture: matplotlib is not installed")
