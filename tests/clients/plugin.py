"""Shared by the tests of the engines' plug-ins: a command whose failure ends the test, and a plug-in of a build of its own."""

import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent


def run(*command, **options):
    done = subprocess.run([str(word) for word in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          **options)
    if done.returncode:
        sys.exit(f"{' '.join(map(str, command))}: {done.returncode}\n{done.stdout[-4000:]}")
    return done.stdout


def build(folder, engine, value="ON"):
    """Builds the plug-in of an engine (godot, unity, unreal) in folder/build, and says where it is."""
    run("cmake", "-S", ROOT, "-B", folder / "build", "-DCMAKE_BUILD_TYPE=Release", f"-DSINGE_{engine.upper()}={value}",
        *(f"-DSINGE_{part}=OFF" for part in ("PROGRAM", "TESTS", "PYTHON")))
    run("cmake", "--build", folder / "build", "--target", f"singe_{engine}", "-j2")
    return folder / "build" / engine
