"""A cache that is alive in a notebook's cell: the page of `singe view`, through the kernel.

Needs the package anywidget of PyPI, and a command that was built with the view.
"""

from __future__ import annotations

import os
import pathlib
import re
import subprocess
import urllib.error
import urllib.request
import weakref
from typing import Any, Mapping, Sequence, Tuple, Union

from . import errors
from .command import command_path

_PATIENCE = 30  # s that an answer may take


class Server:
    """`singe view` of a folder or a scene, which ends with this object."""

    def __init__(self, what: Union[str, "os.PathLike[str]"]):
        self._child = subprocess.Popen([str(command_path()), "view", os.fspath(what), "--quiet"], text=True,
                                       stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                       start_new_session=True)
        self.close = weakref.finalize(self, _end, self._child)
        assert self._child.stdout and self._child.stderr
        self._address = self._child.stdout.readline().strip()
        if not re.fullmatch(r"http://127\.0\.0\.1:\d+/[0-9a-f]+/", self._address):
            said = self._child.stderr.read().strip()
            self.close()
            raise errors.CommandError(said or "singe view gave no address")

    def ask(self, path: str) -> Tuple[int, bytes]:
        """Status and bytes of what the page asks for. Only letters, digits, '.', '/', '_' and '-' are passed on."""
        if not re.fullmatch(r"[\w./-]*", path, re.ASCII) or ".." in path:
            return 404, b"no such page"
        try:
            with self._opener.open(self._address + path, timeout=_PATIENCE) as answer:
                return answer.status, answer.read()
        except urllib.error.HTTPError as error:
            return error.code, error.read()
        except OSError as error:
            return 503, f"singe view does not answer: {error}".encode()

    _opener = urllib.request.build_opener(urllib.request.ProxyHandler({}))  # a proxy has no business here


def _end(child: "subprocess.Popen[str]") -> None:
    child.terminate()
    for stream in child.stdout, child.stderr:
        if stream:
            stream.close()
    try:
        child.wait(10)
    except subprocess.TimeoutExpired:
        child.kill()
        child.wait()


def view(what: Any, height: int = 480) -> Any:
    """A widget that shows a cache, the folder of a run, or a scene file while it burns, as `singe view` does
    (docs/view.md): turn, scrub, layers, plots. `height` is in pixels.

    The view's server listens on this machine alone, and ends with the widget or the kernel; the notebook may be
    elsewhere. ImportError: the package anywidget of PyPI is not installed. CommandError: there is nothing to see, or
    the command was built without a view.
    """
    try:
        import anywidget
        import traitlets
    except ImportError as error:
        raise ImportError("singe.view needs the package anywidget: pip install anywidget") from error

    class Burn(anywidget.AnyWidget):  # type: ignore[misc]
        _esm = pathlib.Path(__file__).with_name("notebook.js").read_text(encoding="utf-8")
        height = traitlets.Int(480).tag(sync=True)

        def __init__(self, server: Server, **traits: Any):
            super().__init__(**traits)
            self.server = server
            self.on_msg(_answer)

        def close(self) -> None:
            super().close()
            self.server.close()

    return Burn(Server(getattr(what, "folder", what)), height=height)


def _answer(widget: Any, content: Mapping[str, Any], _buffers: Sequence[bytes]) -> None:
    status, body = widget.server.ask(str(content.get("path", "")))
    widget.send({"id": content.get("id"), "status": status}, [body])
