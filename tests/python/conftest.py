"""Of the package in the build tree: PYTHONPATH is its folder, PLIANT the command."""
import os
import pathlib

import numpy as np
import pytest

import pliant as pl

SOURCE = pathlib.Path(__file__).resolve().parents[2]
COMMAND = os.environ.get("PLIANT", "")


def press(depth=0.002, ticks=300, x=0.0, z=0.0):
    """Down to a depth [m] and kept, a row a tick."""
    y = np.minimum(np.linspace(0.001, -2 * depth, ticks), 0.001)
    return np.column_stack([np.full(ticks, x), np.maximum(y, -depth), np.full(ticks, z)])


def sheet(half=0.05, cells=20):
    """Vertices and triangles of a flat square, facing up."""
    at = np.linspace(-half, half, cells + 1)
    x, z = (a.ravel() for a in np.meshgrid(at, at))
    i = np.arange(cells * (cells + 1)).reshape(cells, -1)[:, :-1].ravel()
    j = i + cells + 1
    return np.column_stack([x, 0 * x, z]), np.concatenate([np.c_[i, j, i + 1], np.c_[i + 1, j, j + 1]])


def box(half=0.02):
    vertices = half * (2.0 * np.array([[i & 1, i >> 1 & 1, i >> 2 & 1] for i in range(8)]) - 1)
    return vertices, np.array([0, 4, 5, 0, 5, 1, 2, 3, 7, 2, 7, 6, 0, 1, 3, 0, 3, 2,
                               4, 6, 7, 4, 7, 5, 0, 2, 6, 0, 6, 4, 1, 5, 7, 1, 7, 3]).reshape(-1, 3)


@pytest.fixture
def session():
    with pl.Session("minimal") as s:
        yield s
