"""Pliant: touch soft things, feel the force at 1 kHz.

    import pliant as pl
    s = pl.Session("minimal")
    s.tick(0, 0.001, 0)                     # a probe comes from outside
    fx, fy, fz = s.tick(0, -0.002, 0)

SI units, right-handed, Y up, world frame. docs/python.md has the tour.
"""
from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ._errors import ArgumentError, Error, UnknownName

try:
    from ._pliant import (Contact, DeviceInfo, Event, Hit, Note, Reading, __version__, devices, driver_names,
                          register_spring)
except ImportError as error:
    raise ImportError(f"the compiled part of pliant does not load: {error}; build it for this interpreter: pip install . "
                      "(or ./dev python), or install the library that it names") from error
from ._scene import Scene, level_file, levels
from ._session import Body, Contacts, Felt, Hand, Named, Names, Run, Session, batch

if TYPE_CHECKING:
    from . import env, experiment
    from ._command import fit, plot, study, sweep
    from ._view import View, view

__all__ = [
    "ArgumentError", "Body", "Contact", "Contacts", "DeviceInfo", "Error", "Event", "Felt", "Hand", "Hit", "UnknownName",
    "View",    "Named", "Names", "Note", "Reading", "Run", "Scene", "Session", "__version__", "batch", "devices", "driver_names",
    "env", "experiment", "fit", "level_file", "levels", "plot", "register_spring", "study", "sweep", "view",
]

_LATER = {"fit": "_command", "plot": "_command", "study": "_command", "sweep": "_command", "env": "", "experiment": "",
          "View": "_view", "view": "_view"}


def __getattr__(name: str) -> Any:
    """Modules that a session does not need are imported when they are first used."""
    import importlib

    if name not in _LATER:
        from ._errors import unknown

        raise unknown(name, "name in pliant", __all__)
    module = importlib.import_module("." + (_LATER[name] or name), __name__)
    value = getattr(module, name) if _LATER[name] else module
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return __all__
