"""Sessions: a running scene, its objects, and what its probes feel."""
from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Generic, TypeVar

import numpy as np

from . import _pliant
from ._errors import argument, unknown
from ._scene import Scene

if TYPE_CHECKING:
    from typing import Union

    from numpy.typing import ArrayLike, NDArray

    from ._scene import Source

    Paths = Union[ArrayLike, Mapping[str, ArrayLike]]


class Named:
    """An object, probe, tool or effect of a session; its live parameters are attributes and items.

    ``s.surfaces["liver"].stiffness = 800`` and ``s.surfaces["liver"]["relaxation.time"] = 0.2`` act before the next
    tick. As an attribute, a key's dots are underscores: ``relaxation_time``.
    """

    __slots__ = ("_session", "name", "kind", "_keys")
    _session: Session
    name: str
    kind: str

    def __init__(self, session: Session, name: str, kind: str) -> None:
        object.__setattr__(self, "_session", session)
        object.__setattr__(self, "name", name)
        object.__setattr__(self, "kind", kind)
        object.__setattr__(self, "_keys", None)

    def keys(self) -> list[str]:
        """The parameters that can be set while it runs."""
        return self._session.keys(self.name)

    def _key(self, attribute: str) -> str:
        keys: dict[str, str] | None = self._keys
        if keys is None:
            keys = {key.replace(".", "_"): key for key in self.keys()}
            object.__setattr__(self, "_keys", keys)
        if attribute not in keys:
            raise unknown(attribute, f"parameter of {self.kind.replace('_', ' ')} '{self.name}'", list(keys))
        return keys[attribute]

    @property
    def parameters(self) -> dict[str, Any]:
        """The keys that can be set while it runs, with their values now: numbers, words, lists."""
        return {key: self[key] for key in self.keys()}

    def __getitem__(self, key: str) -> Any:
        return self._session.get(self.name, key)

    def __setitem__(self, key: str, value: Any) -> None:
        self._session.set(self.name, key, value)

    def __getattr__(self, attribute: str) -> Any:
        if attribute.startswith("_"):
            raise AttributeError(attribute)
        return self._session.get(self.name, self._key(attribute))

    def __setattr__(self, attribute: str, value: Any) -> None:
        if isinstance(getattr(type(self), attribute, None), property):
            raise AttributeError(f"{attribute} of '{self.name}' is read-only")
        self._session.set(self.name, self._key(attribute), value)

    def __dir__(self) -> list[str]:
        return sorted({*super().__dir__(), *(key.replace(".", "_") for key in self.keys())})

    def __repr__(self) -> str:
        return f"<pliant.{type(self).__name__} '{self.name}' ({self.kind.replace('_', ' ')})>"

    def __reduce__(self) -> Any:
        raise TypeError("what belongs to a session cannot be pickled; pickle copies of its arrays")


class Body(Named):
    """A deformable surface, a soft or a rigid body."""

    __slots__ = ()

    @property
    def positions(self) -> NDArray[np.float32]:
        """Vertices (n, 3) [m], world frame, in the order of the file or array: a read-only live view.

        It follows every tick(), step(), run() and restore() while it is held, which costs a copy of the vertices each
        time; in real time, when this is read again. It outlives the session; ``.copy()`` keeps the values.
        """
        return self._session._vertices(self.name)

    @property
    def triangles(self) -> NDArray[np.uint32]:
        """(m, 3): rows of positions, counter-clockwise from outside. A copy."""
        return self._session._triangles(self.name)

    @property
    def forces(self) -> NDArray[np.float32]:
        """The contacts' force on each vertex, (n, 3) [N], world frame. A copy."""
        return self._session._vertex_forces(self.name)

    @property
    def to_world(self) -> NDArray[np.float64]:
        """(4, 4): from the object's frame to the world. A copy."""
        return self._session._to_world(self.name)

    @property
    def bounds(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Least and greatest corner, (3,) [m] each, world frame."""
        return self._session._bounds(self.name, False)


class Hand(Named):
    """A probe or a tool."""

    __slots__ = ()

    @property
    def reading(self) -> _pliant.Reading:
        """What it felt in the last tick."""
        return self._session._reading(self.name)

    @property
    def force(self) -> NDArray[np.float64]:
        """(3,) [N] on the hand, world frame, as sent."""
        return self.reading.force

    @property
    def torque(self) -> NDArray[np.float64]:
        """(3,) [N m] on the hand, world frame; only of tools."""
        return self.reading.torque

    @property
    def position(self) -> NDArray[np.float64]:
        """(3,) [m], world frame; of a tool, of its device."""
        return self.reading.position

    @property
    def depth(self) -> float:
        """[m] below the undeformed surface."""
        return self.reading.depth

    @property
    def touching(self) -> bool:
        return self.reading.touching


N = TypeVar("N", bound=Named)


class Names(Mapping[str, N], Generic[N]):
    """Objects by name, in the order of the scene."""

    __slots__ = ("_session", "_make", "_what", "_kinds")

    def __init__(self, session: Session, make: type[N], what: str, kinds: dict[str, str]) -> None:
        self._session, self._make, self._what, self._kinds = session, make, what, kinds

    def __getitem__(self, name: str) -> N:
        try:
            return self._make(self._session, name, self._kinds[name])
        except (KeyError, TypeError):
            raise unknown(str(name), self._what, list(self._kinds)) from None

    def __iter__(self) -> Iterator[str]:
        return iter(self._kinds)

    def __len__(self) -> int:
        return len(self._kinds)

    def _ipython_key_completions_(self) -> list[str]:
        return list(self._kinds)

    def __repr__(self) -> str:
        return "{" + ", ".join(f"'{name}': {self[name]!r}" for name in self) + "}"


class Contacts(list["_pliant.Contact"]):
    """Contacts of the newest state, and their parts as arrays."""

    def _array(self, part: Callable[[_pliant.Contact], Any], *shape: int) -> NDArray[Any]:
        return np.array([part(c) for c in self], dtype=float).reshape(len(self), *shape)

    @property
    def force(self) -> NDArray[np.float64]:
        """(n, 3) [N] on ``a``."""
        return self._array(lambda c: c.force, 3)

    @property
    def position(self) -> NDArray[np.float64]:
        """(n, 3) [m]"""
        return self._array(lambda c: c.position, 3)

    @property
    def normal(self) -> NDArray[np.float64]:
        """(n, 3) [1], towards ``a``"""
        return self._array(lambda c: c.normal, 3)

    @property
    def depth(self) -> NDArray[np.float64]:
        """(n,) [m]"""
        return self._array(lambda c: c.depth)

    @property
    def a(self) -> list[str]:
        return [c.a for c in self]

    @property
    def b(self) -> list[str]:
        return [c.b for c in self]


def event_of(*parts: Any) -> _pliant.Event:
    """Of a pickle."""
    return _pliant._event(*parts)


class Felt:
    """What one probe or tool felt, a row a tick. World frame.

    force (n, 3) [N] on the hand, torque (n, 3) [N m] or None, position (n, 3) [m], depth (n,) [m] below the undeformed
    surface, normal (n, 3), touching (n,) bool, object (n,) index into Session.objects or -1, time (n,) [s].
    """

    force: NDArray[np.float64]
    torque: NDArray[np.float64] | None
    position: NDArray[np.float64]
    depth: NDArray[np.float64]
    normal: NDArray[np.float64]
    touching: NDArray[np.bool_]
    object: NDArray[np.int32]
    time: NDArray[np.float64]
    lost: int = 0

    def __init__(self, name: str, time: NDArray[np.float64], arrays: dict[str, Any]) -> None:
        self.name = name
        self.time = time
        self.__dict__.update(arrays)

    def __len__(self) -> int:
        return len(self.time)

    def __repr__(self) -> str:
        most = float(np.linalg.norm(self.force, axis=1).max()) if len(self) else 0.0
        return f"<pliant.Felt '{self.name}': {len(self)} ticks, at most {most:.4g} N>"


class Run(Mapping[str, Felt]):
    """What a run gave: ``run["finger"]`` is that of one probe; with one probe also ``run.force``, ``run.depth``, ...

    events: the Events of the run, in order; events_lost: how many did not fit; time (n,) [s].
    """

    def __init__(self, raw: dict[str, Any]) -> None:
        self.time: NDArray[np.float64] = raw["time"]
        self.events: list[_pliant.Event] = raw["events"]
        self.events_lost: int = raw["events_lost"]
        self._felt = {name: Felt(name, self.time, arrays) for name, arrays in raw["felt"].items()}

    def __getitem__(self, name: str) -> Felt:
        try:
            return self._felt[name]
        except (KeyError, TypeError):
            raise unknown(str(name), "probe or tool", list(self._felt)) from None

    def __iter__(self) -> Iterator[str]:
        return iter(self._felt)

    def __len__(self) -> int:
        return len(self._felt)

    def _only(self, what: str) -> Felt:
        if len(self._felt) == 1:
            return next(iter(self._felt.values()))
        raise argument(f"run.{what}", f"there are several probes and tools: {', '.join(self._felt)}",
                       f"say which: run['{next(iter(self._felt), '')}'].{what}")

    @property
    def force(self) -> NDArray[np.float64]:
        """(n, 3) [N] on the hand, world frame, as sent."""
        return self._only("force").force

    @property
    def torque(self) -> NDArray[np.float64] | None:
        """(n, 3) [N m]; None: it is no tool."""
        return self._only("torque").torque

    @property
    def position(self) -> NDArray[np.float64]:
        """(n, 3) [m]"""
        return self._only("position").position

    @property
    def depth(self) -> NDArray[np.float64]:
        """(n,) [m] below the undeformed surface"""
        return self._only("depth").depth

    @property
    def normal(self) -> NDArray[np.float64]:
        """(n, 3) [1], outward"""
        return self._only("normal").normal

    @property
    def touching(self) -> NDArray[np.bool_]:
        """(n,) bool"""
        return self._only("touching").touching

    def __repr__(self) -> str:
        felt = ", ".join(repr(each)[1:-1].replace("pliant.Felt ", "") for each in self._felt.values())
        return f"<pliant.Run: {felt}{f'; {len(self.events)} events' if self.events else ''}>"


def _rows(path: ArrayLike, where: str) -> NDArray[np.float64]:
    try:
        if np.iscomplexobj(path):
            raise TypeError
        rows = np.ascontiguousarray(path, dtype=np.float64)
    except (TypeError, ValueError):
        raise argument(where, "must be rows of numbers, all of one length", "give an array (n, 3) or (n, 7)") from None
    if rows.ndim != 2 or rows.shape[1] not in (3, 7):
        raise argument(where, "must have a row a tick, (x, y, z) or (x, y, z, qw, qx, qy, qz)", f"its shape is {rows.shape}")
    return rows


def _tracks(session: _pliant.Session, path: Paths, where: str) -> dict[str, NDArray[np.float64]]:
    if isinstance(path, Mapping):
        for name in path:
            if name not in session.effectors:
                raise unknown(str(name), "probe or tool", session.effectors)
        return {name: _rows(rows, f"{where}['{name}']") for name, rows in path.items()}
    if len(session.effectors) != 1:
        raise argument(where, f"there are several probes and tools: {', '.join(session.effectors)}",
                       "give each its own: {name: array, ...}")
    return {session.effectors[0]: _rows(path, where)}


def _scene(source: Source | Scene, max_force: float, format: str | None) -> Scene:
    return source if isinstance(source, Scene) else Scene.load(source, max_force=max_force, format=format)


class Session(_pliant.Session):
    """A running scene, in lockstep: virtual time goes on only in tick(), step() and run(), with the same bits each time.

    source: a level file, a mesh, a shipped level's name (levels()), the bytes of a file, or a Scene. A file without
    probe or tool gets a probe named 'probe', of probe_radius [m]; ``notes`` says so. max_force [N] caps the limits of
    devices in files. Any thread may call it, one at a time; other Python threads go on meanwhile. World frame: metres,
    newtons, seconds, right-handed, Y up; rotations (w, x, y, z).
    """

    def __init__(self, source: Source | Scene, *, max_force: float = 10.0, probe_radius: float = 0.0,
                 format: str | None = None) -> None:
        scene = _scene(source, max_force, format).copy()
        super().__init__(scene, None if isinstance(source, Scene) else probe_radius)
        if self._probe_added:
            scene._parts.append("probe")
        self._source = scene
        kinds = dict(self._kinds())
        self._of_bodies = kinds
        self._of_surfaces = {name: kind for name, kind in kinds.items() if kind == "surface"}
        self._of_probes = {name: "tool" if name in kinds else "probe" for name in self.effectors}

    @property
    def bodies(self) -> Names[Body]:
        """Every surface, soft and rigid body, by name."""
        return Names(self, Body, "object", self._of_bodies)

    @property
    def surfaces(self) -> Names[Body]:
        """The deformable surfaces, by name."""
        return Names(self, Body, "surface", self._of_surfaces)

    @property
    def probes(self) -> Names[Hand]:
        """The probes and tools, by name."""
        return Names(self, Hand, "probe or tool", self._of_probes)

    @property
    def notes(self) -> list[str]:
        """Unexpected conversions and defaults, a sentence each."""
        added = ["the file has no probe; one named 'probe' was added"] if self._probe_added else []
        return [*self._source.notes, *added, *self._notes()]

    def run(self, path: Paths | int) -> Run:
        """A tick per row, in C++: the same bits as a loop over tick().

        path: (n, 3) [m] or (n, 7) with rotations, of the only probe or tool; {name: array} of several; or a number of
        ticks, with poses, followed paths and devices as they are. Ctrl-C ends it after the tick.
        """
        if isinstance(path, (int, np.integer)):
            if path < 0:
                raise argument("path", f"must be 0 ticks or more; got {path}")
            return Run(_pliant._run(self, {}, int(path)))
        return Run(_pliant._run(self, _tracks(self, path, "path"), None))

    def contacts(self) -> Contacts:
        """Contacts of the newest state: of probes with surfaces, and between bodies (of the newest soft step)."""
        return Contacts(self._contacts())

    def bounds_of(self, name: str | None = None) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Least and greatest corner, (3,) [m] each, of an object or of all."""
        return self._bounds(name, False)

    def readings(self, name: str) -> Felt:
        """Every tick of a probe or tool since the last call, after keep_readings(); ``lost`` did not fit."""
        raw = _pliant._take(self, name)
        return Felt(name, raw.pop("time"), raw)

    def events(self) -> list[_pliant.Event]:
        """The events since the last call, oldest first: layers that broke, yielding, detents. run() takes its own."""
        return self._events()[0]

    def figures(self) -> dict[str, float]:
        """ticks, p50_us, p99_us, max_us of a tick, overruns (in real time), soft_steps."""
        return self._figures()

    def __enter__(self) -> "Session":
        return self

    def __exit__(self, *exception: object) -> None:
        self.close()

    def __repr__(self) -> str:
        if self.closed:
            return "<pliant.Session: closed>"
        return (f"<pliant.Session of {self._source!r}: objects {self.objects}, probes and tools {self.effectors}, "
                f"{self.time:.6g} s{', running' if self.running else ''}>")

    def __reduce__(self) -> Any:
        raise TypeError("a pliant.Session cannot be pickled; send its level and the bytes of save(), and restore() them")

    def __copy__(self) -> Any:
        raise TypeError("a pliant.Session cannot be copied; open another one and restore() the bytes of save()")

    __deepcopy__ = __copy__


def batch(source: Source | Scene, paths: Sequence[Paths], threads: int | None = None, *,
          settings: Sequence[Mapping[str, float]] | None = None, max_force: float = 10.0,
          probe_radius: float = 0.0, format: str | None = None) -> list[Run]:
    """Runs each path from time 0 on threads of C++; the same bits as ``[Session(source).run(p) for p in paths]``.

    paths: as Session.run takes them. threads: at most this many; default: one per core. settings: for each path live
    parameters by 'NAME.KEY', as {'sheet.stiffness': 400}. Ctrl-C ends it.
    """
    if threads is None:
        threads = os.cpu_count() or 1
    if isinstance(threads, bool) or not isinstance(threads, (int, np.integer)) or not 1 <= threads <= 4096:
        raise argument("threads", f"must be a whole number from 1 to 4096; got {threads!r}")
    if isinstance(paths, Mapping):
        raise argument("paths", "must be a list of paths", "for one path of several probes, give [paths]")
    if settings is not None and len(settings) != len(paths):
        raise argument("settings", f"must be one for each of the {len(paths)} paths; got {len(settings)}")
    with Session(source if isinstance(source, Scene) else _scene(source, max_force, format), probe_radius=probe_radius) as sample:
        tracks = [_tracks(sample, path, f"paths[{i}]") for i, path in enumerate(paths)]
        sets = [_settings(sample, each, f"settings[{i}]") for i, each in enumerate(settings or [])]
        return [Run(raw) for raw in _pliant._batch(sample, sample._source, tracks, sets, int(threads))]


def _settings(session: Session, settings: Mapping[str, float], where: str) -> list[tuple[str, str, float]]:
    """'NAME.KEY' split: a name may have dots, and so may a key."""
    found = []
    for path, value in settings.items():
        dots = [i for i, letter in enumerate(path) if letter == "."]
        names = [path[:i] for i in dots if path[:i] in session.objects or path[:i] in session.effectors]
        if not names:
            raise unknown(path.split(".")[0], f"name in {where}", [*session.objects, *session.effectors])
        name = max(names, key=len)
        try:
            found.append((name, path[len(name) + 1:], float(value)))
        except (TypeError, ValueError):
            raise argument(f"{where}['{path}']", f"must be a number; got {value!r}") from None
    return found
