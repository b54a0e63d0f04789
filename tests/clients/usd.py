"""A burn by Singe, read by OpenUSD (PyPI's usd-core): every value, every validator, no line on standard error, what an
interrupted run leaves, and sheets that are gone. Exit code 77 where there is no OpenUSD.

usage: usd.py SINGE FOLDER    FOLDER is emptied
"""

import os
import shutil
import signal
import subprocess
import sys
import time

HERE = os.path.dirname(os.path.abspath(__file__))
VENV = os.environ.get("SINGE_CLIENTS", os.path.join(HERE, "..", "..", "build", "clients", "usd", "bin", "python"))
try:
    import numpy as np
    from pxr import Usd, UsdGeom, UsdShade, UsdValidation, UsdVol
except ImportError:
    if os.path.exists(VENV) and "--again" not in sys.argv:
        os.execv(VENV, [VENV, *sys.argv, "--again"])
    print("skipped: no OpenUSD; make check-clients installs it (PyPI's usd-core)")
    sys.exit(77)

from burn import CHECKED, FRAMES, SCALARS, VECTORS, Frame, body, make, make_gone, same

SHEETS = ("leaf", "strip")


def attribute_name(name):
    return name if name in ("points", "velocities", "normals") else "primvars:" + name


def check_values(stage, out, frames):
    for sheet, name in enumerate(SHEETS):
        mesh = UsdGeom.Mesh(stage.GetPrimAtPath("/burn/sheets/" + name))
        get = lambda attribute: np.array(mesh.GetPrim().GetAttribute(attribute).Get(frame))
        for frame in range(1, frames + 1):
            cache = Frame(out, frame, sheet=sheet)
            assert len(mesh.GetPointsAttr().Get(frame)) == len(cache.rows), (name, frame)
            assert len(mesh.GetFaceVertexCountsAttr().Get(frame)) == len(cache.triangles), (name, frame)
            if frame not in CHECKED:
                continue
            for attribute, columns in VECTORS.items():
                same(get(attribute_name(attribute)), cache.stack(columns), (name, frame, attribute))
            for attribute in SCALARS:
                same(get(attribute_name(attribute)), cache.column(attribute), (name, frame, attribute))
            same(get("faceVertexIndices"), cache.triangles.ravel(), (name, frame, "triangles"))
            for primvar in ("displayColor", "ember"):
                flat = UsdGeom.PrimvarsAPI(mesh).GetPrimvar(primvar).ComputeFlattened(frame)
                assert len(flat) == len(cache.rows), (name, frame, primvar)
            box = np.array(mesh.GetExtentAttr().Get(frame))
            points = cache.stack("x y z")
            same(box, np.stack([points.min(0), points.max(0)]), (name, frame, "extent"))
        print("%s: every value of frames %s, counts of %d" % (name, CHECKED, frames))


def check_subsets(stage, out):
    leaf = UsdGeom.Mesh(stage.GetPrimAtPath("/burn/sheets/leaf"))
    for frame in CHECKED:
        parts = [np.array(UsdGeom.Subset(leaf.GetPrim().GetChild(name)).GetIndicesAttr().Get(frame), int)
                 for name in ("fresh", "burnt")]
        faces = np.sort(np.concatenate(parts))
        assert (faces == np.arange(len(Frame(out, frame, sheet=0).triangles))).all()
    assert len(parts[0]) > 100 and len(parts[1]) > 100, [len(part) for part in parts]
    for name in ("fresh", "burnt"):
        material, _ = UsdShade.MaterialBindingAPI(leaf.GetPrim().GetChild(name)).ComputeBoundMaterial()
        assert material, name


def check_rest(stage, out):
    assert (stage.GetStartTimeCode(), stage.GetEndTimeCode(), stage.GetTimeCodesPerSecond()) == (1, FRAMES, 24)
    assert UsdGeom.GetStageMetersPerUnit(stage) == 1 and UsdGeom.GetStageUpAxis(stage) == "Z"
    fields = [prim for prim in stage.Traverse() if prim.IsA(UsdVol.OpenVDBAsset)]
    assert len(fields) == 4
    for frame in range(1, FRAMES + 1):
        for prim in fields:
            path = prim.GetAttribute("filePath").Get(frame).resolvedPath
            assert os.path.samefile(path, os.path.join(out, "gas", "burn.%04d.vdb" % frame)), path
    ball = UsdGeom.Xformable(stage.GetPrimAtPath("/burn/props/shape0"))
    x = [ball.ComputeLocalToWorldTransform(frame).ExtractTranslation()[0] for frame in (1, 13, 24)]
    assert np.allclose(x, [-0.08, -0.07, -0.08 + 0.02 * 23 / 24], atol=1e-6), x
    deforms = UsdGeom.Mesh(stage.GetPrimAtPath("/burn/props/shape1"))
    for frame in range(1, FRAMES + 1):
        same(np.array(deforms.GetPointsAttr().Get(frame)), body(frame)[0], ("body", frame))
        place = UsdGeom.Xformable(deforms).ComputeLocalToWorldTransform(frame).ExtractTranslation()
        assert np.allclose(place, (-0.1, 0.05, 0), atol=1e-7), place
    assert len(deforms.GetFaceVertexCountsAttr().Get()) == 8
    camera = UsdGeom.Camera(stage.GetPrimAtPath("/burn/camera")).GetCamera(1)
    assert abs(camera.GetFieldOfView(camera.FOVVertical) - 34) < 1e-3
    view = camera.frustum.ComputeViewDirection()
    want = np.float64([0.02 - 0.12, 0.34, 0.05 - 0.2])
    assert np.allclose(np.array(view), want / np.linalg.norm(want), atol=1e-5), view


def validate(path):
    context = UsdValidation.ValidationContext(UsdValidation.ValidationRegistry().GetOrLoadAllValidators())
    errors = context.Validate(Usd.Stage.Open(path))
    for error in errors:
        print(path, error.GetName(), error.GetMessage())
    assert not errors
    return len(UsdValidation.ValidationRegistry().GetOrLoadAllValidators())


def check_interrupted(singe, folder):
    """After a run was killed, the root file names frames that exist and are complete."""
    out = os.path.join(folder, "killed")
    scene = os.path.join(folder, "burn.yaml")
    run = subprocess.Popen([singe, "run", scene, "-o", out, "--quiet", "--no-preview"], stdout=subprocess.DEVNULL)
    sixth = os.path.join(out, "usd", "burn.0006.usdc")
    while not os.path.exists(sixth) and run.poll() is None:
        time.sleep(0.01)
    run.send_signal(signal.SIGKILL)
    run.wait()
    root = os.path.join(out, "burn.usda")
    frames = 0
    if os.path.exists(root):
        stage = Usd.Stage.Open(root)
        frames = int(stage.GetEndTimeCode())
        check_values(stage, out, frames)
    subprocess.run([singe, "run", scene, "-o", out, "--quiet", "--no-preview", "--resume"], check=True,
                   stdout=subprocess.DEVNULL)
    same_files = all(open(os.path.join(out, name), "rb").read() == open(os.path.join(folder, "out", name), "rb").read()
                     for name in ["burn.usda"] + ["usd/burn.%04d.usdc" % frame for frame in range(1, FRAMES + 1)])
    assert same_files
    print("killed after frame 6: its root names %d frames; after resuming, all files are identical" % frames)


def check_single(singe, out):
    """One file of all frames, and an archive: every value again, and the validators."""
    subprocess.run([singe, "convert", out, "--to", "usdz", "--quiet"], check=True, stdout=subprocess.DEVNULL)
    subprocess.run([singe, "convert", out, "--to", "usd", "--single", "--quiet"], check=True, stdout=subprocess.DEVNULL)
    for name in ("burn.usdc", "burn.usdz"):
        path = os.path.join(out, name)
        stage = Usd.Stage.Open(path)
        assert (stage.GetStartTimeCode(), stage.GetEndTimeCode(), stage.GetTimeCodesPerSecond()) == (1, FRAMES, 24)
        check_values(stage, out, FRAMES)
        validate(path)
    picture = stage.GetPrimAtPath("/burn/materials/print0/picture").GetAttribute("inputs:file").Get()
    assert picture.resolvedPath.endswith("burn.usdz[pictures/0.png]"), picture
    assert not stage.GetPrimAtPath("/burn/gas")
    print("burn.usdc, %d bytes, and burn.usdz, %d bytes" % tuple(
        os.path.getsize(os.path.join(out, name)) for name in ("burn.usdc", "burn.usdz")))


def check_gone(singe, folder):
    """A sheet that is burnt at the end: the last frames have no vertices, and hold nothing of those before."""
    out = make_gone(singe, folder, ["usd"])
    stage = Usd.Stage.Open(os.path.join(out, "burn.usda"))
    counts = [len(UsdGeom.Mesh(stage.GetPrimAtPath("/burn/sheets/leaf")).GetPointsAttr().Get(frame))
              for frame in range(1, 13)]
    print("vertices of a sheet that burns away:", counts)
    assert counts[0] > 0 and counts[-1] == 0


def main():
    singe, folder = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])
    shutil.rmtree(folder, ignore_errors=True)
    out = make(singe, folder, ["usd"], "--no-preview")
    root = os.path.join(out, "burn.usda")
    # USD prints past Python, so standard error goes to a file
    saved = os.dup(2)
    with open(os.path.join(folder, "stderr.txt"), "wb+") as log:
        os.dup2(log.fileno(), 2)
        try:
            stage = Usd.Stage.Open(root)
            check_values(stage, out, FRAMES)
            check_subsets(stage, out)
            check_rest(stage, out)
            count = validate(root)
            for frame in CHECKED:
                validate(os.path.join(out, "usd", "burn.%04d.usdc" % frame))
            check_single(singe, out)
            check_gone(singe, folder)
            check_interrupted(singe, folder)
        finally:
            os.dup2(saved, 2)
            log.seek(0)
            said = log.read().decode(errors="replace")
            sys.stderr.write(said)
    assert not said, "OpenUSD has something to say"
    print("OpenUSD %s: %d validators find nothing" % (".".join(map(str, Usd.GetVersion()[1:])), count))


main()
