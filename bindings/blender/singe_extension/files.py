# SPDX-License-Identifier: GPL-3.0-or-later
"""Which files a burn may write and delete. A .blend file names the folder, and it may come from a stranger: so a burn
writes only into a folder that is empty or that a burn has marked as its own, through no symbolic link, and Free Cache
deletes single files by the names that a burn gives them, never a folder with what is in it. Needs no Blender."""

import errno
import os
import re
import stat

MARK = "# Written by Singe's extension for Blender\n"  # the first line of burn.yaml; a comment of YAML
SCENE = "burn.yaml"

_FRAME = r"burn\.(\d{4}|[1-9]\d{4,8})"
_DRAFT = r"(\.\d+-\d+\.tmp){0,2}"  # of a program that was killed while it wrote
CACHE = "cache"
EARLIER = "earlier"  # the cache of which a branch is made, until it has begun
# the names of files of a cache by folder; a folder comes after those inside it
_CACHE = {
    "cache/ply": rf"{_FRAME}\.ply{_DRAFT}",
    "cache/usd": rf"{_FRAME}\.usdc{_DRAFT}",
    "cache/gas": rf"{_FRAME}\.vdb{_DRAFT}",
    "cache/gas_detail": rf"{_FRAME}\.vdb{_DRAFT}",
    "cache/frames": rf"{_FRAME}\.png{_DRAFT}",
    "cache/exr": rf"{_FRAME}\.exr{_DRAFT}",
    "cache/checkpoints": rf"{_FRAME}\.singe{_DRAFT}",
    "cache": r"(burn\.usda|run\.json|(stats|events|probes)\.csv|checkpoint(\.previous)?\.singe|sheet\.png"
             rf"|preview\.(mp4|gif)){_DRAFT}|(cache|pictures)\.lock",
}
_MADE = {
    **_CACHE,
    **{part.replace(CACHE, EARLIER, 1): names for part, names in _CACHE.items()},
    "": r"burn\.yaml(\.part)?|log\.txt|sheet\d+(-speed\.png|(-pin\.\d{4,})?\.ply)"
        r"|collider-\d+-[0-9a-f]+(\.\d{4,})?\.ply",
}


class FolderError(Exception):
    """A folder that a burn must leave alone, with a message for the user."""


def printable(text):
    """Without what controls a terminal: names in a .blend file may have it."""
    return "".join(c if c.isprintable() or c == "\n" else "?" for c in text)


def sentence(error):
    """What went wrong, for the panel: an error of the system without its number."""
    if not isinstance(error, OSError) or not error.strerror:
        return printable(str(error)).removeprefix("Error: ").strip() or type(error).__name__  # "Error: " is Blender's
    reason = error.strerror[0].lower() + error.strerror[1:]
    return printable(f"cannot use {error.filename}: {reason}" if error.filename else reason)


def _places(folder, within=""):
    """(folder, pattern of the names of files) of each folder of a burn, or of those within one of them."""
    return [(os.path.join(folder, *part.split("/")) if part else folder, names) for part, names in _MADE.items()
            if not within or part.split("/")[0] == within]


def is_own(folder):
    """Whether a burn has marked the folder as its own."""
    path = os.path.join(folder, SCENE)
    try:
        return not os.path.islink(folder) and not os.path.islink(path) and read(path, len(MARK)) == MARK.encode()
    except OSError:
        return False


def take(folder):
    """Makes the folder of a burn and marks it; FolderError if it belongs to others."""
    for place, _ in _places(folder):
        if os.path.islink(place):
            raise FolderError(f"{place} is a symbolic link: choose another cache folder")
    if is_own(folder):
        return
    try:
        os.makedirs(folder, exist_ok=True)
        if os.listdir(folder):
            raise FolderError(f"{folder} has files that Singe did not write: choose another cache folder")
        with create(os.path.join(folder, SCENE)) as file:
            file.write(MARK.encode())
    except FileExistsError as error:
        raise FolderError(f"{error.filename} is not a folder: choose another cache folder") from None


def read(path, size=-1):
    """The bytes of a regular file; OSError if it is anything else, such as a pipe, at which a reader waits for ever."""
    with open(path, "rb", opener=lambda name, flags: os.open(name, flags | getattr(os, "O_NONBLOCK", 0))) as file:
        if not stat.S_ISREG(os.fstat(file.fileno()).st_mode):
            raise OSError(errno.EINVAL, "not a regular file", path)
        return file.read(size)


def create(path):
    """Opens a new file for bytes. An old file of that name goes; of a link only the link."""
    remove(path)
    return open(path, "xb")


def remove(path):
    """Removes a file or a link, if there is one."""
    try:
        os.unlink(path)
    except FileNotFoundError:
        pass


def free(folder):
    """Deletes the files that a burn has written into a folder, and the folders that are empty then. Returns the number
    of files; 0 if no burn has marked the folder."""
    return _free(folder, "") if is_own(folder) else 0


def set_aside(folder):
    """Makes the cache the earlier one, for a branch. FolderError if it is not of a burn."""
    take(folder)
    put_back(folder)
    _free(folder, EARLIER)
    os.rename(os.path.join(folder, CACHE), os.path.join(folder, EARLIER))


def put_back(folder):
    """Makes the earlier cache the cache again if a branch of it has not begun, and otherwise deletes it."""
    earlier, cache = os.path.join(folder, EARLIER), os.path.join(folder, CACHE)
    if not is_own(folder) or os.path.islink(earlier) or not os.path.isdir(earlier):
        return
    if os.path.exists(os.path.join(cache, "checkpoint.singe")):
        _free(folder, EARLIER)
        return
    _free(folder, CACHE)
    if not os.path.exists(cache):
        os.rename(earlier, cache)


def _free(folder, within):
    count = 0
    for place, names in _places(folder, within):
        if place != folder and (os.path.islink(place) or os.path.islink(os.path.dirname(place))):
            continue
        if not os.path.isdir(place):
            continue
        found = [name for name in os.listdir(place) if re.fullmatch(names, name)]
        # the mark goes last, so that a deletion that fails half-way can be repeated
        for name in sorted(found, key=lambda name: name == SCENE):
            path = os.path.join(place, name)
            if not stat.S_ISDIR(os.lstat(path).st_mode):
                os.unlink(path)
                count += 1
        if not os.listdir(place):
            os.rmdir(place)
    return count
