"""The studies, fits, sweeps and plots of the command `pliant`, with their results as arrays.

These run the installed command (or a built one) as a process and read the files it writes; nothing else of the package
needs it.
"""
from __future__ import annotations

import csv
import json
import os
import re
import shutil
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ._errors import Error, argument, unknown

if TYPE_CHECKING:
    from typing import Union

    from numpy.typing import ArrayLike, NDArray

    File = Union[str, "os.PathLike[str]"]


def command_or_none() -> Path | None:
    """The command: $PLIANT, the build tree's, or on the PATH."""
    here = Path(__file__).absolute().parent
    found = [os.environ.get("PLIANT", ""), str(here.parent.parent / "bin/pliant"), shutil.which("pliant") or ""]
    for each in found:
        if each and Path(each).is_file():
            return Path(each)
    return None


def _run(*arguments: object) -> str:
    import subprocess

    command = command_or_none()
    if command is None:
        raise Error("the command `pliant` is not there; install it (./dev install PREFIX) with its folder on the PATH, "
                    "or give its path in the environment variable PLIANT", code="command.missing",
                    what="the command `pliant` is not there", cure="install it, with its folder on the PATH")
    done = subprocess.run([str(command), *map(str, arguments)], capture_output=True, text=True, errors="replace")
    if done.returncode != 0:
        lines = [line for line in done.stderr.splitlines() if "error:" in line] or done.stderr.splitlines()[-1:]
        said = re.sub(r"^pliant: error: ", "", lines[-1]) if lines else f"`pliant {arguments[0]}` ended with {done.returncode}"
        raise Error(said, code="command.failed", what=said)
    return done.stdout


def table(file: File) -> dict[str, NDArray[Any]]:
    """The columns of a CSV file with a header: numbers where every cell is one (an empty cell is NaN), else words."""
    with open(file, newline="", encoding="utf-8", errors="replace") as lines:
        rows = list(csv.reader(lines))
    columns: dict[str, NDArray[Any]] = {}
    for i, name in enumerate(rows[0] if rows else []):
        cells = [row[i] if i < len(row) else "" for row in rows[1:]]
        try:
            columns[name] = np.array([float(cell) if cell else np.nan for cell in cells])
        except ValueError:
            columns[name] = np.array([cell[1:] if re.match(r"'[=+\-@]", cell) else cell for cell in cells])
    return columns


class Result(Mapping[str, Any]):
    """What a verb of the command found: its report as a mapping, its tables as arrays, its pictures as files.

    ``result["key"]`` is of the report (.json), ``result.tables["name"]["column"]`` an array, ``result.pictures`` the
    .png and .svg files, ``result.folder`` all of it.
    """

    def __init__(self, verb: str, folder: Path, report: dict[str, Any]) -> None:
        self.verb = verb
        self.folder = folder
        self.report = report
        self.tables = {file.stem: table(file) for file in sorted(folder.glob("*.csv"))}
        self.pictures = sorted([*folder.glob("*.png"), *folder.glob("*.svg")])

    def __getitem__(self, key: str) -> Any:
        if key not in self.report:
            raise unknown(str(key), f"key of the {self.verb}'s report", list(self.report))
        return self.report[key]

    def __iter__(self) -> Any:
        return iter(self.report)

    def __len__(self) -> int:
        return len(self.report)

    def __repr__(self) -> str:
        return f"<pliant.{self.verb} in {self.folder}: keys {list(self.report)}, tables {list(self.tables)}>"


def _folder(out: File | None, verb: str) -> Path:
    folder = Path(out) if out is not None else Path(tempfile.mkdtemp(prefix=f"pliant-{verb}-"))
    return folder


def _report(folder: Path, name: str) -> dict[str, Any]:
    file = folder / f"{name}.json"
    found: dict[str, Any] = json.loads(file.read_text(encoding="utf-8")) if file.is_file() else {}
    return found


def studies() -> dict[str, str]:
    """The names of the studies, and what each measures."""
    return dict(re.split(r"\s{2,}", line, maxsplit=1) for line in _run("study", "--list").splitlines() if line)


def study(name: str, *, quick: bool = True, out: File | None = None) -> Result:
    """Measures a part of the engine against a closed form (docs/studies.md). quick: less than a minute.

    out: folder of the results, replaced; default: a temporary one that is kept. Runs the command `pliant`.
    """
    if name not in studies():
        raise unknown(name, "study", list(studies()))
    folder = _folder(out, "study")
    _run("study", name, "--out", folder, "--force", *(["--quick"] if quick else []))
    return Result("study", folder, _report(folder, name))


class Fit(Result):
    """A law fitted to a press: its name, its parameters by key, and their intervals of 95 %."""

    @property
    def law(self) -> str:
        """Of the least error on held-out rows."""
        return str(self.report["best"])

    @property
    def _best(self) -> dict[str, Any]:
        return next(law for law in self.report["laws"] if law["law"] == self.law)

    @property
    def parameters(self) -> dict[str, float]:
        """Keys of a surface, as ``Scene.add_surface`` and ``Session.set`` take them."""
        return {each["key"]: each["value"] for each in self._best["parameters"]}

    @property
    def intervals(self) -> dict[str, tuple[float, float] | None]:
        """None: the parameter ended at a bound of its range."""
        found: dict[str, tuple[float, float] | None] = {}
        for each in self._best["parameters"]:
            found[each["key"]] = (each["interval"][0], each["interval"][1]) if each.get("interval") else None
        return found

    @property
    def rms(self) -> float:
        """[N] of the fitted rows."""
        return float(self._best["rms_N"])

    def __repr__(self) -> str:
        values = ", ".join(f"{key} = {value:.6g}" for key, value in self.parameters.items())
        return f"<pliant.fit {self.law}: {values}; RMS {self.rms:.3g} N>"


def fit(depth: ArrayLike | File, force: ArrayLike | None = None, time: ArrayLike | None = None, *, law: str = "auto",
        radius: float | None = None, poisson: float | None = None, out: File | None = None) -> Fit:
    """Fits a surface's force law to an indenter's data (docs/fit.md).

    depth (n,) [m], positive where it presses in, force (n,) [N], time (n,) [s], which relaxing laws need; or a CSV file
    alone. law: 'auto', 'linear', 'cubic', 'exponential', 'sls', 'hertz', ... radius [m] of a sphere. Runs the command
    `pliant`; out: folder of its report.
    """
    folder = _folder(out, "fit")
    folder.mkdir(parents=True, exist_ok=True)
    if force is None:
        if not isinstance(depth, (str, os.PathLike)):
            raise argument("fit", "has depths and no forces", "give fit(depth, force), or a CSV file")
        record = Path(depth)
        return _fit(record, folder, law, radius, poisson)
    columns = {"depth_m": np.asarray(depth, dtype=float), "force_N": np.asarray(force, dtype=float)}
    if time is not None:
        columns = {"time_s": np.asarray(time, dtype=float), **columns}
    shapes = {name: column.shape for name, column in columns.items()}
    if any(column.ndim != 1 for column in columns.values()) or len(set(shapes.values())) != 1:
        raise argument("fit", "its arrays must be rows of one length", f"their shapes are {shapes}")
    with tempfile.TemporaryDirectory() as there:
        record = Path(there) / "press.csv"
        rows = np.column_stack(list(columns.values()))
        np.savetxt(record, rows, delimiter=",", header=",".join(columns), comments="", fmt="%.17g")
        return _fit(record, folder, law, radius, poisson)


def _fit(record: Path, folder: Path, law: str, radius: float | None, poisson: float | None) -> Fit:
    options: list[object] = ["--law", law] if law != "auto" else []
    options += ["--radius", radius] if radius is not None else []
    options += ["--poisson", poisson] if poisson is not None else []
    _run("fit", record, "--report", folder, "--force", *options)
    return Fit("fit", folder, _report(folder, "fit"))


def sweep(plan: Mapping[str, Any] | File, *, jobs: int = 1, out: File | None = None) -> Result:
    """Runs a level over every combination of settings (docs/sweep.md).

    plan: a JSON file, or the same as a dictionary: {'level': 'minimal', 'options': {...}, 'axes': {...}}. jobs: runs at a
    time. ``tables['results']`` has a row a run. Runs the command `pliant`.
    """
    folder = _folder(out, "sweep")
    folder.mkdir(parents=True, exist_ok=True)
    if isinstance(plan, Mapping):
        file = folder / "plan.json"
        file.write_text(json.dumps(plan), encoding="utf-8")
    else:
        file = Path(plan)
    _run("sweep", file, "--out", folder / "lines", "--jobs", jobs)
    _run("sweep", "merge", folder / "lines", "--out", folder / "merged", "--force")
    return Result("sweep", folder / "merged", _report(folder / "merged", "report"))


def plot(*runs: File, probes: Sequence[str] = (), out: File | None = None) -> Result:
    """Draws runs over each other: force over depth and time, spectra, a table. runs: folders of `pliant run`, or their
    forces.csv; ``pictures`` has the files. Runs the command `pliant`."""
    if not runs:
        raise argument("plot", "has no runs", "give folders of runs, or their forces.csv")
    folder = _folder(out, "plot")
    _run("plot", *runs, "--out", folder, "--force", *(word for probe in probes for word in ("--probe", probe)))
    return Result("plot", folder, {})
