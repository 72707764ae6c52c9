"""Experiments on perception: procedures, trials, logs, psychometric functions. Pure numpy, no session needed.

    staircase = UpDown(start=400, step=40, down=2)      # or Constant(levels, repeats), Quest(levels)
    for level in staircase:
        staircase.answer(ask(level))                    # True: the answer was right, or 'the comparison was stiffer'
    fit = psychometric(staircase.levels, staircase.answers)

An `Experiment` names blocks of conditions, marks events, and logs every trial as a row of a tidy CSV.
"""
from __future__ import annotations

import csv
import math
import os
from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ._errors import argument

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

__all__ = ["Constant", "Experiment", "Fit", "Procedure", "Quest", "UpDown", "psychometric"]


def _normal(x: ArrayLike) -> NDArray[np.float64]:
    """The cumulative normal distribution."""
    flat = np.asarray(x, dtype=float) / math.sqrt(2.0)
    return 0.5 * (1.0 + np.vectorize(math.erf, otypes=[float])(flat))


def _logistic(x: ArrayLike) -> NDArray[np.float64]:
    return 1.0 / (1.0 + np.exp(-np.clip(np.asarray(x, dtype=float), -500.0, 500.0)))


# By name: the function, and the same to look up; both are 1/2 at 0.
_SHAPES: dict[str, Callable[[ArrayLike], NDArray[np.float64]]] = {"normal": _normal, "logistic": _logistic}


def _shape(name: str) -> Callable[[ArrayLike], NDArray[np.float64]]:
    if name not in _SHAPES:
        raise argument("shape", f"must be one of {', '.join(_SHAPES)}; got {name!r}")
    return _SHAPES[name]


class Procedure:
    """Which level comes next: iterate over it, and answer() each level before the next."""

    def __init__(self) -> None:
        self._levels: list[float] = []
        self._answers: list[bool] = []
        self._waits = False

    def _next(self) -> float | None:
        """The next level; None: it is over."""
        raise NotImplementedError

    def _heard(self, level: float, answer: bool) -> None:
        """For adaptive procedures."""

    def __iter__(self) -> Iterator[float]:
        while True:
            if self._waits:
                raise argument(type(self).__name__, "the last level has no answer", "call answer() in the loop")
            level = self._next()
            if level is None:
                return
            self._levels.append(float(level))
            self._waits = True
            yield float(level)

    def answer(self, answer: bool) -> None:
        """Of the level given last."""
        if not self._waits:
            raise argument(type(self).__name__, "no level waits for an answer", "iterate over it first")
        if not isinstance(answer, (bool, np.bool_)):
            raise argument("answer", f"must be True or False; got {answer!r}")
        self._waits = False
        self._answers.append(bool(answer))
        self._heard(self._levels[-1], bool(answer))

    @property
    def levels(self) -> NDArray[np.float64]:
        """(n,) of the answered trials."""
        return np.array(self._levels[: len(self._answers)])

    @property
    def answers(self) -> NDArray[np.bool_]:
        """(n,)"""
        return np.array(self._answers, dtype=bool)

    def __len__(self) -> int:
        return len(self._answers)

    def __repr__(self) -> str:
        return f"<{type(self).__name__}: {len(self)} answers>"


class Constant(Procedure):
    """The method of constant stimuli: every level `repeats` times, in random order within each repeat."""

    def __init__(self, levels: ArrayLike, repeats: int = 10, seed: int | None = None) -> None:
        super().__init__()
        values = np.atleast_1d(np.asarray(levels, dtype=float))
        if values.ndim != 1 or not len(values) or not np.all(np.isfinite(values)) or repeats < 1:
            raise argument("Constant", "needs finite levels, and one repeat at least")
        random = np.random.default_rng(seed)
        self._left = [float(v) for _ in range(repeats) for v in random.permutation(values)][::-1]

    def _next(self) -> float | None:
        return self._left.pop() if self._left else None


class UpDown(Procedure):
    """A staircase: `down` right answers in a row make the level harder by a step, `up` wrong ones easier.

    2 down, 1 up ends around 71 % right, 3 down around 79 % (Levitt 1971). The step is multiplied by `shrink` at each of
    the first `fast` reversals; it ends after `reversals`. harder: -1 (a smaller level is harder) or +1.
    """

    def __init__(self, start: float, step: float, *, down: int = 2, up: int = 1, reversals: int = 10, shrink: float = 0.5,
                 fast: int = 2, harder: int = -1, low: float = -math.inf, high: float = math.inf,
                 most: int = 1000) -> None:
        super().__init__()
        if not (math.isfinite(start) and step > 0 and down >= 1 and up >= 1 and reversals >= 1 and harder in (-1, 1)
                and 0 < shrink <= 1 and low <= start <= high):
            raise argument("UpDown", "needs a start within low and high, a step above 0, down, up and reversals of 1 or more")
        self._at, self._step = float(start), float(step)
        self._down, self._up, self._ends, self._most = down, up, reversals, most
        self._shrink, self._fast, self._harder = shrink, fast, harder
        self._low, self._high = low, high
        self._row = 0  # right answers in a row; below 0: wrong ones
        self._way = 0
        self.reversals: list[float] = []

    def _next(self) -> float | None:
        return None if len(self.reversals) >= self._ends or len(self) >= self._most else self._at

    def _heard(self, level: float, answer: bool) -> None:
        self._row = max(self._row, 0) + 1 if answer else min(self._row, 0) - 1
        if -self._up < self._row < self._down:
            return
        way = self._harder if answer else -self._harder
        self._row = 0
        if self._way and way != self._way:
            self.reversals.append(level)
            if len(self.reversals) <= self._fast:
                self._step *= self._shrink
        self._way = way
        self._at = min(max(self._at + way * self._step, self._low), self._high)

    @property
    def threshold(self) -> float:
        """Mean of the reversals after the fast ones; NaN: too few."""
        late = self.reversals[self._fast:]
        return float(np.mean(late)) if late else math.nan


class Quest(Procedure):
    """QUEST+ (Watson 2017): each level is the one whose answer is expected to tell most about the function.

    levels: those that may be given. thresholds, slopes, lapses: grids of the parameters (defaults: from the levels).
    P(True) = guess + (1 - guess - lapse) F((level - threshold) / slope). It ends after `trials`.
    """

    def __init__(self, levels: ArrayLike, *, trials: int = 40, thresholds: ArrayLike | None = None,
                 slopes: ArrayLike | None = None, lapses: ArrayLike = (0.02,), guess: float = 0.0,
                 shape: str = "normal") -> None:
        super().__init__()
        self._grid = np.unique(np.asarray(levels, dtype=float))
        if len(self._grid) < 2 or not np.all(np.isfinite(self._grid)) or trials < 1 or not 0 <= guess < 1:
            raise argument("Quest", "needs two finite levels at least, one trial, and a guess of 0 or more below 1")
        span = float(self._grid[-1] - self._grid[0])
        at = np.linspace(self._grid[0], self._grid[-1], 41) if thresholds is None else np.asarray(thresholds, dtype=float)
        wide = np.geomspace(span / 40, span / 2, 15) if slopes is None else np.asarray(slopes, dtype=float)
        if not np.all(wide > 0):
            raise argument("Quest", "its slopes must be above 0")
        t, s, m = np.meshgrid(at, wide, np.asarray(lapses, dtype=float), indexing="ij")
        self._t, self._s, self._m = t.ravel(), s.ravel(), m.ravel()
        z = (self._grid[:, None] - self._t) / self._s
        self._p = np.clip(guess + (1.0 - guess - self._m) * _shape(shape)(z), 1e-9, 1 - 1e-9)  # (levels, parameters)
        self._belief = np.full(len(self._t), 1.0 / len(self._t))
        self._trials = trials

    def _next(self) -> float | None:
        if len(self) >= self._trials:
            return None
        yes = self._p @ self._belief
        spread = [_entropy(self._p * self._belief / yes[:, None]), _entropy((1 - self._p) * self._belief / (1 - yes)[:, None])]
        return float(self._grid[np.argmin(yes * spread[0] + (1 - yes) * spread[1])])

    def _heard(self, level: float, answer: bool) -> None:
        p = self._p[np.searchsorted(self._grid, level)]
        self._belief *= p if answer else 1.0 - p
        self._belief /= self._belief.sum()

    def _mean(self, of: NDArray[np.float64]) -> tuple[float, float]:
        mean = float(self._belief @ of)
        return mean, math.sqrt(max(0.0, float(self._belief @ (of - mean) ** 2)))

    @property
    def threshold(self) -> tuple[float, float]:
        """Its mean and standard deviation."""
        return self._mean(self._t)

    @property
    def slope(self) -> tuple[float, float]:
        """Its mean and standard deviation."""
        return self._mean(self._s)


def _entropy(p: NDArray[np.float64]) -> NDArray[np.float64]:
    return -np.sum(p * np.log(np.maximum(p, 1e-300)), axis=1)


class Fit:
    """A psychometric function P(True) = guess + (1 - guess - lapse) F((level - threshold) / slope).

    threshold, slope, lapse: of greatest likelihood; ..._interval: by bootstrap; pse: the threshold; jnd: half of the
    distance between 25 and 75 % of F; note: a sentence where the answers do not bound them, else empty.
    """

    def __init__(self, threshold: float, slope: float, lapse: float, guess: float, shape: str, log_likelihood: float,
                 samples: NDArray[np.float64], confidence: float, levels: NDArray[np.float64],
                 answers: NDArray[np.bool_]) -> None:
        self.threshold, self.slope, self.lapse, self.guess = threshold, slope, lapse, guess
        self.shape, self.log_likelihood, self.confidence = shape, log_likelihood, confidence
        self.levels, self.answers = levels, answers
        edge = 50.0 * (1.0 - confidence)
        ends = np.percentile(samples, [edge, 100.0 - edge], axis=0) if len(samples) else np.full((2, 2), np.nan)
        self.threshold_interval: tuple[float, float] = (float(ends[0, 0]), float(ends[1, 0]))
        self.slope_interval: tuple[float, float] = (float(ends[0, 1]), float(ends[1, 1]))
        span = float(np.ptp(levels))
        low, high = float(levels.min()), float(levels.max())
        self.note = ""
        if not low <= threshold <= high:
            self.note = "the threshold is outside of the levels: give levels on both sides of it"
        elif not span / 80 < slope < 2.5 * span:
            self.note = "the answers do not bound the slope: give more levels beside the threshold"

    @property
    def pse(self) -> float:
        """The point of subjective equality."""
        return self.threshold

    @property
    def jnd(self) -> float:
        """The just noticeable difference."""
        return self.slope * (0.6744897501960817 if self.shape == "normal" else math.log(3.0))

    def __call__(self, level: ArrayLike) -> NDArray[np.float64]:
        """P(True) at levels of any shape."""
        z = (np.asarray(level, dtype=float) - self.threshold) / self.slope
        return self.guess + (1.0 - self.guess - self.lapse) * _shape(self.shape)(z)

    def shares(self) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[Any]]:
        """Each level, the share of True there, and the number of trials."""
        level, inverse, count = np.unique(self.levels, return_inverse=True, return_counts=True)
        return level, np.bincount(inverse, self.answers.astype(float)) / count, count

    def plot(self, axes: Any = None, unit: str = "", level: str = "level", answer: str = "share of True") -> Any:
        """Draws the function, its interval and the shares with matplotlib; returns the axes."""
        if axes is None:
            import matplotlib.pyplot as plt  # type: ignore[import]

            axes = plt.subplots(figsize=(5, 3.6), layout="constrained")[1]
        at, share, count = self.shares()
        span = np.linspace(at[0] - 0.05 * np.ptp(at), at[-1] + 0.05 * np.ptp(at), 300)
        axes.axvspan(*self.threshold_interval, color="tab:blue", alpha=0.15, lw=0,
                     label=f"{100 * self.confidence:.0f} % of the threshold")
        axes.plot(span, self(span), color="tab:blue", label=f"threshold {self.threshold:.4g}, JND {self.jnd:.3g} {unit}".rstrip())
        axes.scatter(at, share, s=8 + 60 * count / count.max(), color="black", zorder=3, label="answers")
        axes.set(xlabel=f"{level} [{unit}]" if unit else level, ylabel=answer, ylim=(-0.03, 1.03))
        axes.legend(loc="best", fontsize="small")
        return axes

    def __repr__(self) -> str:
        low, high = self.threshold_interval
        return (f"<psychometric {self.shape}: threshold {self.threshold:.6g} ({low:.6g} to {high:.6g}), "
                f"slope {self.slope:.4g}, JND {self.jnd:.4g}, {len(self.answers)} answers"
                f"{'; ' + self.note if self.note else ''}>")


def psychometric(levels: ArrayLike, answers: ArrayLike, *, shape: str = "normal", guess: float = 0.0,
                 lapse: float | None = None, confidence: float = 0.95, bootstrap: int = 200, seed: int = 0) -> Fit:
    """Fits a rising psychometric function by greatest likelihood, with intervals from a parametric bootstrap.

    levels (n,), answers (n,) of True and False. guess: P(True) far below, 0.5 for two-alternative forced choice.
    lapse: share of blind answers; None: fitted between 0 and 0.06. bootstrap: number of simulated experiments.
    """
    x, y = np.asarray(levels, dtype=float), np.asarray(answers)
    if x.ndim != 1 or x.shape != y.shape or len(x) < 4 or not np.all(np.isfinite(x)):
        raise argument("psychometric", "needs rows of four or more finite levels and as many answers",
                       f"their shapes are {x.shape} and {y.shape}")
    if not np.all((y == 0) | (y == 1)):
        raise argument("answers", "must be True or False")
    if not 0.0 <= guess < 1.0 or not 0.0 < confidence < 1.0 or len(np.unique(x)) < 2:
        raise argument("psychometric", "needs two different levels, 0 <= guess < 1 and 0 < confidence < 1")
    level, inverse, count = np.unique(x, return_inverse=True, return_counts=True)
    right: NDArray[Any] = np.bincount(inverse, y.astype(float))
    search = _Search(level, shape, guess, lapse)
    best, likelihood = search.best(right, count)
    random = np.random.default_rng(seed)
    p = np.clip(search.p(best), 0.0, 1.0)
    samples = [search.best(np.asarray(random.binomial(count, p), dtype=float), count, coarse=False)[0][:2] for _ in range(bootstrap)]
    return Fit(*best, guess, shape, likelihood, np.array(samples), confidence, x, y.astype(bool))


class _Search:
    """The likelihood over a grid, refined three times around its best cell."""

    def __init__(self, level: NDArray[np.float64], shape: str, guess: float, lapse: float | None) -> None:
        self.level, self.F, self.guess = level, _shape(shape), guess
        span = float(np.ptp(level))
        self.span = span
        self.t = np.linspace(level[0] - 0.5 * span, level[-1] + 0.5 * span, 61)
        self.s = np.geomspace(span / 100, 3.0 * span, 31)
        self.m = np.linspace(0.0, 0.06, 4) if lapse is None else np.array([lapse])
        self.table = self._table(self.t, self.s, self.m)

    def _table(self, t: Any, s: Any, m: Any) -> NDArray[np.float64]:
        z = (self.level - t[:, None, None]) / s[None, :, None]
        p = self.guess + (1.0 - self.guess - m[None, None, :, None]) * self.F(z)[:, :, None, :]
        return np.clip(p, 1e-12, 1.0 - 1e-12)

    def p(self, best: tuple[float, float, float]) -> NDArray[np.float64]:
        return self.guess + (1.0 - self.guess - best[2]) * self.F((self.level - best[0]) / best[1])

    def best(self, right: NDArray[Any], count: NDArray[Any], coarse: bool = True
             ) -> tuple[tuple[float, float, float], float]:
        t, s, m, table = self.t, self.s, self.m, self.table
        rounds = 4 if coarse else 2
        for i in range(rounds):
            likely = np.log(table) @ right + np.log1p(-table) @ (count - right)
            a, b, c = np.unravel_index(int(np.argmax(likely)), likely.shape)
            found, value = (float(t[a]), float(s[b]), float(m[c])), float(likely[a, b, c])
            if i + 1 == rounds:
                break
            step_t, step_s = t[1] - t[0], s[1] / s[0]
            step_m = m[1] - m[0] if len(m) > 1 else 0.0
            t = np.linspace(found[0] - step_t, found[0] + step_t, 11)
            s = np.geomspace(found[1] / step_s, found[1] * step_s, 11)
            m = np.unique(np.clip(np.linspace(found[2] - step_m, found[2] + step_m, 3), 0.0, 0.06)) if step_m else m
            table = self._table(t, s, m)
        return found, value


class Experiment:
    """Blocks of trials of one participant, with marks, logged as tidy CSV: a row a trial, a column a variable.

        with Experiment("s01", "s01.csv", clock=lambda: s.time) as e:
            for block in e.blocks(["glove", "bare"], seed=1):
                for level in e.trials(Constant(levels, 10)):
                    ...
                    e.mark("first touch")
                    e.answer(stiffer, depth_mm=3.1)
    """

    def __init__(self, participant: str, file: str | os.PathLike[str] | None = None, *,
                 clock: Callable[[], float] | None = None) -> None:
        """file: written anew at every answer; an existing one is an error. clock: [s], default: of this machine."""
        import time

        if file is not None and os.path.exists(file):
            raise argument(str(file), "exists already", "choose another name: no data is replaced")
        if file is not None and not os.path.isdir(os.path.dirname(os.path.abspath(file))):
            raise argument(str(file), "its folder is not there", "make it first")
        self.participant, self.file = participant, file
        self.rows: list[dict[str, Any]] = []
        self.marks: list[tuple[float, str]] = []
        self._clock = clock or time.monotonic
        self._block = ""
        self._procedure: Procedure | None = None
        self._began = 0.0

    def blocks(self, conditions: Sequence[str], *, seed: int | None = None) -> Iterator[str]:
        """Each condition once; with a seed in random order. Rows have it in the column `block`."""
        order = list(conditions) if seed is None else [str(c) for c in np.random.default_rng(seed).permutation(list(conditions))]
        for self._block in order:
            yield self._block
        self._block = ""

    def trials(self, procedure: Procedure) -> Iterator[float]:
        """The levels of a procedure; call answer() for each."""
        self._procedure = procedure
        for level in procedure:
            self._began = self._clock()
            self.marks = []
            yield level
        self._procedure = None

    def mark(self, name: str) -> None:
        """An event of this trial, in its row as `mark_NAME`: seconds since the trial began."""
        self.marks.append((self._clock() - self._began, name))

    def answer(self, answer: bool, **more: Any) -> None:
        """The answer to this trial, and further columns."""
        if self._procedure is None:
            raise argument("answer", "no trial is under way", "call it within a loop over trials()")
        self._procedure.answer(answer)
        row: dict[str, Any] = {"participant": self.participant, "block": self._block, "trial": len(self.rows) + 1,
                               "level": self._procedure.levels[-1], "answer": int(answer),
                               "seconds": round(self._clock() - self._began, 6)}
        row.update({f"mark_{name}": round(at, 6) for at, name in self.marks})
        row.update({key: value.item() if isinstance(value, np.generic) else value for key, value in more.items()})
        self.rows.append(row)
        if self.file is not None:
            self.save(self.file)

    def save(self, file: str | os.PathLike[str]) -> None:
        """Writes the rows; a column that a row lacks is empty there. The file appears whole."""
        columns = list(dict.fromkeys(name for row in self.rows for name in row))
        partial = f"{os.fspath(file)}.partial"
        with open(partial, "w", newline="", encoding="utf-8") as out:
            writer = csv.DictWriter(out, columns)
            writer.writeheader()
            writer.writerows(self.rows)
        os.replace(partial, file)

    def __enter__(self) -> "Experiment":
        return self

    def __exit__(self, *exception: object) -> None:
        return None

    def __repr__(self) -> str:
        return f"<Experiment of {self.participant}: {len(self.rows)} trials{f', {self.file}' if self.file else ''}>"
