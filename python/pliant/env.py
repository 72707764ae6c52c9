"""Environments with Gymnasium's interface, which need not be installed: reset(seed) and step(action)."""
from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from ._errors import argument
from ._scene import Scene
from ._session import Session

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

__all__ = ["Box", "Palpation"]

try:  # a subclass of Gymnasium's where it is installed
    from gymnasium import Env as _Base  # type: ignore[import]
    from gymnasium.spaces import Box  # type: ignore[import]
except ImportError:
    _Base = object

    class Box:  # type: ignore[no-redef]
        """Arrays between low and high, as gymnasium.spaces.Box."""

        def __init__(self, low: ArrayLike, high: ArrayLike, dtype: Any = np.float32) -> None:
            self.low, self.high = np.asarray(low, dtype=dtype), np.asarray(high, dtype=dtype)
            self.dtype, self.shape = np.dtype(dtype), self.low.shape
            self._random = np.random.default_rng()

        def seed(self, seed: int | None = None) -> None:
            self._random = np.random.default_rng(seed)

        def sample(self) -> NDArray[Any]:
            return self._random.uniform(self.low, self.high).astype(self.dtype)

        def contains(self, x: Any) -> bool:
            x = np.asarray(x)
            return x.shape == self.shape and bool(np.all(x >= self.low) and np.all(x <= self.high))

        def __repr__(self) -> str:
            return f"Box({self.low}, {self.high})"


class Palpation(_Base):  # type: ignore[misc,valid-type]
    """Find a hidden stiff lump in a sheet of 10 x 10 cm by pressing it.

    action (3,), each -1 to 1: the place (x, z) of the next press in half widths of the sheet, and whether to declare
    the lump there (above 0), which ends the episode. observation (4,): the last place, the stiffness felt there over
    the sheet's own, and the share of presses left. reward: -0.02 a press; at a declaration 1 within the lump's radius,
    falling to 0 at four radii. info: 'lump' (2,) [m], 'force' [N], 'depth' [m].
    """

    metadata: Mapping[str, Any] = {"render_modes": ["rgb_array"]}
    render_mode = "rgb_array"
    HALF = 0.05     # [m]
    RADIUS = 0.012  # [m] of the lump
    DEPTH = 0.002   # [m] of a press
    CELLS = 40

    def __init__(self, presses: int = 20, stiffness: float = 200.0, lump: float = 3.0) -> None:
        """stiffness [N/m] of the sheet; lump [1]: stiffness at its middle over the sheet's."""
        if presses < 1 or not stiffness > 0 or not lump > 1:
            raise argument("Palpation", "needs one press or more, a stiffness above 0, and a lump above 1")
        self.presses, self.stiffness, self.lump = presses, stiffness, lump
        self.action_space = Box(-np.ones(3, np.float32), np.ones(3, np.float32))
        self.observation_space = Box(np.array([-1, -1, 0, 0], np.float32), np.array([1, 1, 100, 1], np.float32))
        self._random = np.random.default_rng()
        self._session: Session | None = None
        self._left = 0
        self.place = np.zeros(2)  # [m] of the lump

    def reset(self, *, seed: int | None = None, options: Mapping[str, Any] | None = None
              ) -> tuple[NDArray[np.float32], dict[str, Any]]:
        """A new lump; with a seed the same one each time."""
        if seed is not None:
            self._random = np.random.default_rng(seed)
        self.place = self._random.uniform(-0.7, 0.7, 2) * self.HALF
        at = np.linspace(-self.HALF, self.HALF, self.CELLS + 1)
        x, z = (a.ravel() for a in np.meshgrid(at, at))
        i = np.arange(self.CELLS * (self.CELLS + 1)).reshape(self.CELLS, -1)[:, :-1].ravel()
        j = i + self.CELLS + 1
        triangles = np.concatenate([np.column_stack([i, j, i + 1]), np.column_stack([i + 1, j, j + 1])])
        near = np.exp(-((x - self.place[0]) ** 2 + (z - self.place[1]) ** 2) / (2 * (self.RADIUS / 1.5) ** 2))
        scene = Scene("palpation")
        scene.add_surface("sheet", np.column_stack([x, 0 * x, z]), triangles,
                          stiffness=self.stiffness * (1 + (self.lump - 1) * near))
        scene.add_probe("finger", max_force=50.0)
        self.close()
        self._session = Session(scene)
        self._left = self.presses
        return np.array([0, 0, 0, 1], np.float32), {"lump": self.place.copy()}

    def step(self, action: ArrayLike) -> tuple[NDArray[np.float32], float, bool, bool, dict[str, Any]]:
        """(observation, reward, terminated, truncated, info)."""
        if self._session is None or self._left == 0:
            raise argument("Palpation.step", "no episode is under way", "call reset() first")
        wanted = np.asarray(action, dtype=float)
        if wanted.shape != (3,) or not np.all(np.isfinite(wanted)):
            raise argument("action", "must be three finite numbers", f"its shape is {wanted.shape}")
        wanted = np.clip(wanted, -1.0, 1.0)
        x, z = wanted[:2] * self.HALF
        down = np.concatenate([np.linspace(0.001, -self.DEPTH, 31), np.full(60, -self.DEPTH)])
        run = self._session.run(np.column_stack([np.full_like(down, x), down, np.full_like(down, z)]))
        self._session.run([[x, 0.01, z]] * 100)  # off it, until the dent is gone
        force, depth = float(np.linalg.norm(run.force[-1])), float(run.depth[-1])
        felt = force / depth / self.stiffness if depth > 0 else 0.0
        self._left -= 1
        reward, declared = -0.02, bool(wanted[2] > 0)
        if declared:
            miss = float(math.dist((x, z), self.place))
            reward += float(np.clip((4 * self.RADIUS - miss) / (3 * self.RADIUS), 0.0, 1.0))
        if declared:
            self._left = 0
        seen = np.array([*wanted[:2], felt, self._left / self.presses], np.float32)
        return seen, reward, declared, self._left == 0 and not declared, {"lump": self.place.copy(), "force": force, "depth": depth}

    def render(self) -> NDArray[np.uint8]:
        """The sheet and the finger, uint8 (240, 320, 3)."""
        if self._session is None:
            raise argument("Palpation.render", "no episode is under way", "call reset() first")
        return self._session.render(320, 240)[:, :, :3]

    def __repr__(self) -> str:
        return f"<Palpation of at most {self.presses} presses>"

    def close(self) -> None:
        """Ends the episode's session."""
        if self._session is not None:
            self._session.close()
            self._session = None
