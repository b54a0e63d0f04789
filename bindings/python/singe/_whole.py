"""Files that are replaced whole or not at all."""

from __future__ import annotations

import contextlib
import os
import pathlib
import shutil
import tempfile
from typing import Iterator


@contextlib.contextmanager
def whole(path: pathlib.Path) -> Iterator[pathlib.Path]:
    """Where to write a file that then takes the place of `path`; after an exception `path` is as before. It is in a
    folder of its own, which nobody else can enter and whose name cannot be guessed: others may have put links into the
    folder of `path`."""
    place = pathlib.Path(tempfile.mkdtemp(prefix=f".{path.name}.", suffix=".tmp", dir=path.parent))
    try:
        yield place / path.name
        os.replace(place / path.name, path)
    finally:
        shutil.rmtree(place, ignore_errors=True)
