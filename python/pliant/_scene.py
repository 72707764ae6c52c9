"""Scenes: from level files and meshes, from bytes, or built from arrays."""
from __future__ import annotations

import json
import os
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _pliant
from ._errors import Error, argument, unknown

if TYPE_CHECKING:
    from typing import Union

    from numpy.typing import ArrayLike

    Vector = Union[Sequence[float], np.ndarray]
    Source = Union[str, "os.PathLike[str]", bytes, bytearray, memoryview]


def _content() -> list[Path]:
    """Folders with shipped levels: $PLIANT_CONTENT, the package's own, those of an installed or built command."""
    here = Path(__file__).absolute().parent
    folders = [here / "content/levels"]
    if "PLIANT_CONTENT" in os.environ:
        folders.insert(0, Path(os.environ["PLIANT_CONTENT"]) / "levels")
    from ._command import command_or_none

    command = command_or_none()
    if command is not None:
        folders.append(command.resolve().parent.parent / "share/pliant/content/levels")
    for prefix in list(here.parents)[1:4:2]:  # of a build tree; of lib/python3/dist-packages/pliant
        folders.append(prefix / "share/pliant/content/levels")
    return [folder for folder in folders if folder.is_dir()]


def levels() -> list[str]:
    """The names of the levels that ship, each of which ``Session(name)`` opens."""
    found = {file.stem for folder in _content() for file in folder.iterdir() if file.suffix in (".gltf", ".glb")}
    return sorted(found)


def level_file(name: str) -> Path:
    """The file of a level that ships."""
    for folder in _content():
        for suffix in (".glb", ".gltf"):
            if (folder / (name + suffix)).is_file():
                return folder / (name + suffix)
    raise unknown(name, "level", levels())


def _text(value: Any, where: str) -> str:
    """A key's value as the text of `--set`."""
    if isinstance(value, str):
        return value
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, np.ndarray):
        value = value.tolist()
    try:
        return json.dumps(value, allow_nan=False)
    except (TypeError, ValueError):
        raise argument(where, f"must be a number, a word or a list of them; got {value!r}") from None


def _keys(name: str, parameters: Mapping[str, Any]) -> list[tuple[str, str]]:
    """Keyword arguments as keys: {'relaxation': {'time': 0.2}} is the key relaxation.time."""
    out: list[tuple[str, str]] = []
    for key, value in parameters.items():
        if isinstance(value, Mapping):
            out += [(f"{key}.{inner}", text) for inner, text in _keys(name, value)]
        elif value is not None:
            out.append((key, _text(value, f"`{name}`: {key}")))
    return out


class Scene(_pliant.Scene):
    """What a session runs: objects, probes and tools, effects, joints. SI units, right-handed, Y up, world frame.

    ``Scene(name)`` is empty; ``Scene.load(file)`` reads a level file, a mesh, or their bytes. Keyword arguments of the
    ``add_`` functions are keys of the level format (docs/level-format.md); a nested key is a dictionary, as in
    ``relaxation={"time": 0.2}``. If one is wrong, the scene stays as it was.
    """

    def __init__(self, name: str = "scene", *, gravity: Vector | None = None, touch_rate: float | None = None,
                 soft_step: float | None = None) -> None:
        """gravity (3,) [m/s2], touch_rate [Hz], soft_step [s]."""
        super().__init__(name)
        self._simulation(touch_rate, soft_step, gravity)
        self._name = name
        self._parts: list[str] = []
        self.notes: list[str] = []

    @staticmethod
    def load(source: Source, *, format: str | None = None, max_force: float = 10.0) -> "Scene":
        """A level file, a mesh file, a shipped level's name, or the bytes of a file.

        format: suffix of bytes that are neither .glb nor .gltf, as '.stl'. max_force [N]: devices' limits in the file
        are lowered to it. What was read otherwise than expected is in ``notes``.
        """
        if isinstance(source, (bytes, bytearray, memoryview)):
            return _of_bytes(bytes(source), format, max_force)
        try:
            file = Path(source)
        except TypeError:
            raise argument("source", f"must be a file, a shipped level's name or bytes; got {type(source).__name__}") from None
        if not file.suffix and not file.exists() and len(file.parts) == 1:
            file = level_file(file.name)
        return _of_file(file, file.name, max_force)

    def copy(self) -> "Scene":
        """An independent copy."""
        return _wrap(self._copy(), self._name, list(self.notes), list(self._parts))

    def __copy__(self) -> "Scene":
        return self.copy()

    def __deepcopy__(self, memo: object) -> "Scene":
        return self.copy()

    def __reduce__(self) -> Any:
        raise TypeError("a pliant.Scene cannot be pickled; save() it, and load() the file in the other process")

    def set(self, path: str, value: Any) -> None:
        """``set("tissue.deformable.stiffness", 500)``, as `pliant run --set`; '*' stands for every node."""
        self._set(f"{path}={_text(value, path)}")

    def save(self, file: str | os.PathLike[str]) -> None:
        """Writes .gltf (with a .bin beside it) or .glb."""
        self._save(Path(file))

    def add_surface(self, name: str, vertices: ArrayLike, triangles: ArrayLike, *, stiffness: ArrayLike | None = None,
                    paint: Mapping[str, ArrayLike] | None = None, position: Vector = (0, 0, 0),
                    rotation: Vector = (1, 0, 0, 0), scale: float | Vector = 1.0, **parameters: Any) -> None:
        """A deformable surface, touched by its own force law.

        vertices (n, 3) [m]; triangles (m, 3), counter-clockwise from outside; stiffness [N/m], one number or (n,), a
        map over the vertices. paint: {'stiffness' | 'friction' | 'damping' | 'relaxation': factors (n,)}.
        position [m], rotation (w, x, y, z), scale: the placement. Others are keys of PLIANT_deformable:
        young [Pa], spring, damping_ratio, friction_static, reach [m], ...
        """
        layers = dict(paint or {})
        if stiffness is not None and np.ndim(stiffness) > 0:
            map_ = np.asarray(stiffness, dtype=float)
            if not (np.all(np.isfinite(map_)) and np.all(map_ > 0)):
                raise argument("stiffness", "must be finite and above 0 at every vertex")
            mean = float(map_.mean())
            layers["stiffness"] = map_ / mean
            stiffness = mean
        keys = _keys(name, {"stiffness": stiffness, **parameters})
        self._mesh("surface", name, vertices, triangles, layers, keys, position, rotation, scale)

    def add_soft_body(self, name: str, vertices: ArrayLike, triangles: ArrayLike, *,
                      paint: Mapping[str, ArrayLike] | None = None, position: Vector = (0, 0, 0),
                      rotation: Vector = (1, 0, 0, 0), scale: float | Vector = 1.0, **parameters: Any) -> None:
        """Tissue: finite elements that fill a closed mesh.

        vertices (n, 3) [m], triangles (m, 3). paint: {'pinned': weights (n,), ...}. Others are keys of PLIANT_soft_body:
        young [Pa], poisson, density [kg/m3], cell [m], law, ...
        """
        self._mesh("soft_body", name, vertices, triangles, paint or {}, _keys(name, parameters), position, rotation, scale)

    def add_rigid_body(self, name: str, vertices: ArrayLike, triangles: ArrayLike, *, position: Vector = (0, 0, 0),
                       rotation: Vector = (1, 0, 0, 0), scale: float | Vector = 1.0, **parameters: Any) -> None:
        """A rigid body. Keys of PLIANT_rigid_body: mass [kg], density [kg/m3], fixed, friction_static, ..."""
        self._mesh("rigid_body", name, vertices, triangles, {}, _keys(name, parameters), position, rotation, scale)

    def add_probe(self, name: str = "probe", *, position: Vector = (0, 0, 0), rotation: Vector = (1, 0, 0, 0),
                  **parameters: Any) -> None:
        """A probe. Keys of PLIANT_probe and PLIANT_haptic_device: radius [m], max_force [N], max_stiffness [N/m], ..."""
        self._add_probe(name, _keys(name, parameters), position, rotation)
        self._parts.append(name)

    def add_handle(self, body: str, **parameters: Any) -> None:
        """Makes a body a tool that is moved by its handle. Keys of PLIANT_handle: box [m], translation, rotation, ..."""
        self._add_handle(body, _keys(body, parameters))

    def add_effect(self, name: str, *, position: Vector = (0, 0, 0), rotation: Vector = (1, 0, 0, 0),
                   **parameters: Any) -> None:
        """A force in space on probes. Keys of PLIANT_effect: kind, region, radius [m], stiffness [N/m], ..."""
        self._add_effect(name, _keys(name, parameters), position, rotation)
        self._parts.append(name)

    def add_joint(self, name: str, a: str, b: str = "", *, position: Vector = (0, 0, 0),
                  rotation: Vector = (1, 0, 0, 0), **parameters: Any) -> None:
        """Connects body a to body b, or to the world. Keys of PLIANT_joint: kind, limits, stiffness, ..."""
        self._add_joint(name, a, b, _keys(name, parameters), position, rotation)
        self._parts.append(name)

    def _mesh(self, kind: str, name: str, vertices: ArrayLike, triangles: ArrayLike, paint: Mapping[str, ArrayLike],
              keys: Iterable[tuple[str, str]], position: Vector, rotation: Vector, scale: float | Vector) -> None:
        size = (float(scale),) * 3 if np.ndim(scale) == 0 else scale  # type: ignore[arg-type]
        self._add_mesh(kind, name, vertices, triangles, dict(paint), list(keys), position, rotation, size)
        self._parts.append(name)

    def __repr__(self) -> str:
        return f"<pliant.Scene '{self._name}'" + (f": {', '.join(self._parts)}>" if self._parts else ">")


def _wrap(inner: _pliant.Scene, name: str, notes: list[str], parts: list[str]) -> Scene:
    scene = Scene(name)
    scene._assign(inner)
    scene.notes = notes
    scene._parts = parts
    return scene


def _of_file(file: Path, name: str, max_force: float) -> Scene:
    inner, notes = _pliant.Scene._load(file, max_force)
    return _wrap(inner, name, notes, [])


def _of_bytes(data: bytes, format: str | None, max_force: float) -> Scene:
    if format is None:
        format = ".glb" if data[:4] == b"glTF" else ".gltf" if data.lstrip()[:1] == b"{" else None
        if format is None:
            raise argument("source", "these bytes are neither .glb nor .gltf", "give their format: format='.stl'")
    import tempfile

    if not isinstance(format, str) or not format.lstrip(".").isalnum():
        raise argument("format", f"must be the suffix of a file, as '.stl'; got {format!r}")
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / ("bytes" + ("" if format.startswith(".") else ".") + format)
        file.write_bytes(data)
        try:
            return _of_file(file, "bytes", max_force)
        except Error as error:
            sentence = str(error).replace(str(file), file.name)
            kind = type(error)
            raise kind(sentence, code=error.code, where=error.where.replace(str(file), file.name), what=error.what,
                       cure=error.cure, pointer=error.pointer) from None
