"""A window beside a session."""
from __future__ import annotations

import time
from typing import TYPE_CHECKING

from ._errors import Error

if TYPE_CHECKING:
    from ._session import Session


class View:
    """A window on a session, drawn by a thread of its own until close() or its user closes it; made by view().

    The clocks of real time never wait for it. In lockstep it shows the state between calls, and in long ones some 20
    times a second. The left button turns the camera, the right one moves it, the wheel zooms, Home returns.
    """

    def __init__(self, session: Session, width: int = 960, height: int = 640) -> None:
        try:
            from . import _window
        except ImportError as error:
            raise Error(f"this pliant has no window: {error}; install libglfw3 (and to build it libglfw3-dev), or use "
                        "Session.render()", code="window.missing", what="this pliant has no window",
                        cure="install libglfw3") from None
        self.session = session
        session._open_window(_window._open, width, height, session._source._name)

    @property
    def open(self) -> bool:
        """False once it is closed; raises pliant.Error if its display or its pictures failed."""
        return self.session._window()[0]

    @property
    def pictures(self) -> int:
        """How many it has drawn."""
        return self.session._window()[1]

    def wait(self, seconds: float = float("inf")) -> bool:
        """Until its user closes it, at most so long [s]; whether it is closed. Ctrl-C ends it."""
        end = time.monotonic() + seconds
        while self.open:
            if time.monotonic() >= end:
                return False
            time.sleep(0.02)
        return True

    def close(self) -> None:
        """Closes the window; the session goes on."""
        self.session._close_window()

    def __enter__(self) -> "View":
        return self

    def __exit__(self, kind: object, *exception: object) -> None:
        try:
            while kind is None and not self.session.closed and self.session.running and not self.wait(0.1):
                pass
        finally:
            self.close()

    def __repr__(self) -> str:
        return f"<pliant.View of {self.session._source._name}: {'open' if self.open else 'closed'}, {self.pictures} pictures>"


def view(session: Session, *, width: int = 960, height: int = 640) -> View:
    """A window on a session, of so many pixels; open it before start(). One at a time.

        with pl.view(s):
            s.start()

    While the clocks run, the end of such a block waits until the window is closed; the clocks then go on until stop().
    """
    return View(session, width, height)
