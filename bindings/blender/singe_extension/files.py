# SPDX-License-Identifier: GPL-3.0-or-later
"""Which files a burn may write and delete. A .blend file names the folder, and it may come from a stranger: so a burn
writes only into a folder that is empty or that a burn has marked as its own, through no symbolic link. Free Cache deletes
single files: those that run.json and burn.yaml list, and which have a name that a burn gives; never a folder with what is
in it. Needs no Blender."""

import errno
import json
import os
import re
import stat

MARK = "# Written by Singe's extension for Blender\n"  # the first line of burn.yaml; a comment of YAML
SCENE = "burn.yaml"
CACHE = "cache"
EARLIER = "earlier"  # the cache of which a branch is made, until it has begun

_DRAFT = r"(?P<draft>(\.\d+-\d+\.tmp){0,2})"  # of a program that was killed while it wrote
# the endings of a frame's files, by the folder in a cache
_FRAMES = {"ply": "ply", "usd": "usdc", "gas": "vdb", "gas_detail": "vdb", "frames": "png", "exr": "exr",
           "checkpoints": "singe"}
_SINGLE = (r"burn\.usda|run\.json|(stats|events|probes)\.csv|checkpoint(\.previous)?\.singe|sheet\.png"
           r"|preview\.(mp4|gif)")
_BEFORE_ITS_FIRST_FRAME = r"run\.json|(cache|pictures)\.lock"  # what a run has before run.json lists anything
_INPUT = r"sheet\d+(-speed\.png|(-pin\.\d{4,})?\.ply)|collider-\d+-[0-9a-f]+(\.\d{4,})?\.ply"
_OWN = r"burn\.yaml(\.part)?|log\.txt"


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


def _places(cache):
    """The folders of a cache; one comes after those inside it."""
    return [os.path.join(cache, kind) for kind in _FRAMES] + [cache]


def is_own(folder):
    """Whether a burn has marked the folder as its own."""
    path = os.path.join(folder, SCENE)
    try:
        return not os.path.islink(folder) and not os.path.islink(path) and read(path, len(MARK)) == MARK.encode()
    except OSError:
        return False


def take(folder):
    """Makes the folder of a burn and marks it; FolderError if it belongs to others."""
    for place in (*_places(os.path.join(folder, CACHE)), *_places(os.path.join(folder, EARLIER)), folder):
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


def _object(path, skip=0):
    """The object of JSON in a file, which may be anything: {} if it is no such object."""
    try:
        found = json.loads(read(path)[skip:])
    except (OSError, ValueError, RecursionError):
        return {}
    return found if isinstance(found, dict) else {}


def _scene_of(cache):
    """The scene that the cache's run.json lists; {} if it lists none, or that of another program's run."""
    scene = _object(os.path.join(cache, "run.json")).get("scene")
    return scene if isinstance(scene, dict) and scene.get("name") == "burn" else {}


def _frames_of(scene):
    frames = scene.get("frames")
    return frames if isinstance(frames, int) else 0


def _is_within(place):
    """Whether this is a folder of a cache, to which no link leads."""
    return os.path.isdir(place) and not os.path.islink(place) and not os.path.islink(os.path.dirname(place))


def _names(place):
    """The names of the files and links in a folder."""
    return [name for name in sorted(os.listdir(place)) if not stat.S_ISDIR(os.lstat(os.path.join(place, name)).st_mode)]


def _made_in_cache(cache):
    """The files of a cache that its run.json lists, and what a killed run has left half-written; run.json is the last."""
    scene, made = _scene_of(cache), []
    single = f"{_SINGLE}|{_BEFORE_ITS_FIRST_FRAME}" if scene else _BEFORE_ITS_FIRST_FRAME
    for kind, ending in _FRAMES.items():
        place = os.path.join(cache, kind)
        for name in _names(place) if _is_within(place) else ():
            found = re.fullmatch(rf"burn\.(\d{{4}}|[1-9]\d{{4,8}})\.{ending}{_DRAFT}", name)
            if found and (found["draft"] or int(found[1]) <= _frames_of(scene)):
                made.append(os.path.join(place, name))
    for name in _names(cache) if _is_within(cache) else ():
        half = re.fullmatch(rf"({_SINGLE}){_DRAFT}", name)
        if re.fullmatch(single, name) or half and half["draft"]:
            made.append(os.path.join(cache, name))
    return sorted(made, key=lambda path: os.path.basename(path) == "run.json")


def _words(scene):
    """All strings of a scene."""
    words, left = set(), [scene]
    while left:
        value = left.pop()
        if isinstance(value, str):
            words.add(value)
        elif isinstance(value, (dict, list)):
            left += value.values() if isinstance(value, dict) else value
    return words


def inputs(folder):
    """The names of the files beside burn.yaml that a burn has written for the program to read: those that its scene
    names, or those of the scene of an earlier run in this folder."""
    scenes = [_object(os.path.join(folder, SCENE), len(MARK)),
              *(_scene_of(os.path.join(folder, part)) for part in (CACHE, EARLIER))]
    lists, found = [(_words(scene), _frames_of(scene)) for scene in scenes], set()
    for name in _names(folder):
        numbered = re.fullmatch(r"(.+)\.(\d{4,})\.ply", name)
        word, frame = (f"{numbered[1]}.####.ply", int(numbered[2])) if numbered else (name, 0)
        if re.fullmatch(_INPUT, name) and any(word in words and frame <= frames for words, frames in lists):
            found.add(name)
    return found


def free(folder):
    """Deletes the files that a burn has written into a folder, and the folders that are empty then. Returns the number
    of files; 0 if no burn has marked the folder."""
    if not is_own(folder):
        return 0
    names = [*inputs(folder), *(name for name in _names(folder) if re.fullmatch(_OWN, name))]
    count = sum(_free(os.path.join(folder, part)) for part in (CACHE, EARLIER))
    # the mark goes last, so that a deletion that fails half-way can be repeated
    for name in sorted(names, key=lambda name: name == SCENE):
        os.unlink(os.path.join(folder, name))
    if not os.listdir(folder):
        os.rmdir(folder)
    return count + len(names)


def set_aside(folder):
    """Makes the cache the earlier one, for a branch. FolderError if it is not of a burn."""
    take(folder)
    put_back(folder)
    _free(os.path.join(folder, EARLIER))
    os.rename(os.path.join(folder, CACHE), os.path.join(folder, EARLIER))


def put_back(folder):
    """Makes the earlier cache the cache again if a branch of it has not begun, and otherwise deletes it."""
    earlier, cache = os.path.join(folder, EARLIER), os.path.join(folder, CACHE)
    if not is_own(folder) or os.path.islink(earlier) or not os.path.isdir(earlier):
        return
    if os.path.exists(os.path.join(cache, "checkpoint.singe")):
        _free(earlier)
        return
    _free(cache)
    if not os.path.exists(cache):
        os.rename(earlier, cache)


def _free(cache):
    """Deletes what a run has made in a cache, and the folders that are empty then. Returns the number of files."""
    made = _made_in_cache(cache)
    for path in made:
        os.unlink(path)
    for place in _places(cache):
        if _is_within(place) and not os.listdir(place):
            os.rmdir(place)
    return len(made)
