"""Stages of OpenUSD (PyPI's usd-core) become scenes: every point, face and uv of stages with odd units, axes, transforms,
instances and animation; what the command makes of them; and what is said of broken ones. Exit code 77 where there is no
OpenUSD.

usage: usd_in.py SINGE FOLDER    FOLDER is emptied; the environment's SINGE_LIBRARY names the package's library
"""

import json
import os
import pathlib
import shutil
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
VENV = os.environ.get("SINGE_CLIENTS", str(HERE.parent.parent / "build/clients/usd/bin/python"))
try:
    import numpy as np
    from pxr import Gf, Sdf, Usd, UsdGeom, UsdPhysics, UsdShade, UsdSkel, UsdUtils, Vt
except ImportError:
    if os.path.exists(VENV) and "--again" not in sys.argv:
        os.execv(VENV, [VENV, *sys.argv, "--again"])
    print("skipped: no OpenUSD; make check-clients installs it (PyPI's usd-core)")
    sys.exit(77)
sys.path.insert(0, str(HERE.parent.parent / "bindings/python"))
from singe import errors, usd, usd_bodies  # noqa: E402
from singe.picture import png  # noqa: E402
import singe  # noqa: E402

SINGE, FOLDER = sys.argv[1], pathlib.Path(sys.argv[2])

# ---- what all stages hold: a leaf that is curved, of quads, two triangles and a face of five corners; metres, z up
ROWS, COLUMNS = 5, 7
POINTS = np.array([[0.02 * i, 0.02 * j, 0.1 + 0.3 * (0.02 * i)**2 + 0.001 * j] for j in range(ROWS)
                   for i in range(COLUMNS)])
UV = np.array([[i / (COLUMNS - 1), j / (ROWS - 1)] for j in range(ROWS) for i in range(COLUMNS)])


def faces():
    made = []
    for j in range(ROWS - 1):
        for i in range(COLUMNS - 1):
            a, b = j * COLUMNS + i, j * COLUMNS + i + 1
            quad = [a, b, b + COLUMNS, a + COLUMNS]
            made += [quad[:3], [quad[0], *quad[2:]]] if i == j == 0 else [quad]
    # the last two cells of the first row become one face, with its middle points as corners
    last, before = made[COLUMNS - 1], made[COLUMNS]
    made[COLUMNS - 1:COLUMNS + 1] = [[last[0], last[1], before[1], before[2], last[2], last[3]]] \
        if last[1] == before[0] else [last, before]
    return made


FACES = faces()


def of_stage(points, up, unit):
    """World points in a stage's axes and units."""
    x, y, z = np.asarray(points, float).T / unit
    return np.stack([x, z, -y] if up == "Y" else [x, y, z], 1)


def new(name, up="Z", unit=1.0):
    stage = Usd.Stage.CreateNew(str(FOLDER / name))
    UsdGeom.SetStageUpAxis(stage, up)
    UsdGeom.SetStageMetersPerUnit(stage, unit)
    stage.SetDefaultPrim(UsdGeom.Xform.Define(stage, "/World").GetPrim())
    return stage


def leaf(stage, path, points, faces=None, uv="vertex", name="st"):
    """The leaf as a mesh, with uv of one interpolation."""
    faces = FACES if faces is None else faces
    mesh = UsdGeom.Mesh.Define(stage, path)
    mesh.CreatePointsAttr(Vt.Vec3fArray.FromNumpy(np.asarray(points, np.float32)))
    mesh.CreateFaceVertexCountsAttr([len(face) for face in faces])
    mesh.CreateFaceVertexIndicesAttr([v for face in faces for v in face])
    if uv:
        variable = UsdGeom.PrimvarsAPI(mesh).CreatePrimvar(name, Sdf.ValueTypeNames.TexCoord2fArray, uv)
        variable.Set(Vt.Vec2fArray.FromNumpy(UV.astype(np.float32)))
        if uv == "faceVarying":
            variable.SetIndices([v for face in faces for v in face])
    return mesh


def paint(stage, mesh, picture, path="/World/Look", varname="st", change=None):
    """A UsdPreviewSurface with a picture."""
    material = UsdShade.Material.Define(stage, path)
    surface, texture = (UsdShade.Shader.Define(stage, f"{path}/{one}") for one in ("Surface", "Picture"))
    surface.CreateIdAttr("UsdPreviewSurface")
    texture.CreateIdAttr("UsdUVTexture")
    texture.CreateInput("file", Sdf.ValueTypeNames.Asset).Set(picture)
    surface.CreateInput("diffuseColor", Sdf.ValueTypeNames.Color3f).ConnectToSource(
        texture.CreateOutput("rgb", Sdf.ValueTypeNames.Float3))
    reader = UsdShade.Shader.Define(stage, f"{path}/Reader")
    reader.CreateIdAttr("UsdPrimvarReader_float2")
    # by the material's interface, as programs write it
    material.CreateInput("uv", Sdf.ValueTypeNames.String).Set(varname)
    reader.CreateInput("varname", Sdf.ValueTypeNames.String).ConnectToSource(material.GetInput("uv"))
    output = reader.CreateOutput("result", Sdf.ValueTypeNames.Float2)
    if change:
        moved = UsdShade.Shader.Define(stage, f"{path}/Moved")
        moved.CreateIdAttr("UsdTransform2d")
        moved.CreateInput("in", Sdf.ValueTypeNames.Float2).ConnectToSource(output)
        for name, kind, value in (("scale", "Float2", change[0]), ("rotation", "Float", change[1]),
                                  ("translation", "Float2", change[2])):
            moved.CreateInput(name, getattr(Sdf.ValueTypeNames, kind)).Set(value)
        output = moved.CreateOutput("result", Sdf.ValueTypeNames.Float2)
    texture.CreateInput("st", Sdf.ValueTypeNames.Float2).ConnectToSource(output)
    material.CreateSurfaceOutput().ConnectToSource(surface.CreateOutput("surface", Sdf.ValueTypeNames.Token))
    UsdShade.MaterialBindingAPI.Apply(mesh.GetPrim()).Bind(material)
    return material


# ---- what was written

def read_ply(path):
    """Points, faces, uv of their corners, and the names of attributes."""
    header, body = path.read_bytes().split(b"end_header\n", 1)
    lines = [line.split() for line in header.decode().splitlines()]
    counts = [int(line[2]) for line in lines if line[0] == "element"]
    kinds = [(line[2], {"double": "<f8", "float": "<f4"}[line[1]]) for line in lines
             if line[0] == "property" and line[1] != "list"]
    vertices = np.frombuffer(body, kinds, counts[0])
    words, at, found, uv = np.frombuffer(body[vertices.nbytes:], "<u4"), 0, [], []
    for _ in range(counts[1]):
        n = int(words[at])
        found.append([int(v) for v in words[at + 1:at + 1 + n]])
        at += 1 + n
        if any("texcoord" in line for line in lines):
            uv.append(words[at + 1:at + 1 + 2 * n].view("<f4").reshape(n, 2))
            at += 1 + 2 * n
    assert at == len(words)
    return np.stack([vertices[c] for c in "xyz"], 1), found, uv, [name for name, _ in kinds[3:]], vertices


def turned(face):
    """A face from its smallest vertex on: where a face begins does not matter, how it turns does."""
    k = face.index(min(face))
    return face[k:] + face[:k]


def read(stage, sheets, check=False, **options):
    """The scene of a stage, as its lines say it. check: the command finds nothing wrong with it."""
    stage.Save() if isinstance(stage, Usd.Stage) else None
    path = stage.GetRootLayer().realPath if isinstance(stage, Usd.Stage) else str(stage)
    made = usd.scene(path, FOLDER / (pathlib.Path(path).name + ".scene"), sheets, **options)
    scene, key = {}, None
    for line in made.read_text().splitlines():
        if line.startswith("  - "):
            scene[key].append(json.loads(line[4:]))
        elif not line.startswith("#"):
            key, value = line.split(":", 1)
            scene[key] = float(value) if value.strip() else []
    if check:
        done = subprocess.run([SINGE, "check", str(made)], capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
    return scene, made


def same_leaf(made, sheet, points=POINTS, faces=None, uv=UV):
    got, found, corners, _, _ = read_ply(made.parent / sheet["mesh"])
    error = np.abs(got - points).max()
    assert error < 2e-7, error
    assert [turned(face) for face in found] == [turned(list(face)) for face in (FACES if faces is None else faces)]
    if uv is not None:
        for face, values in zip(found, corners):
            assert np.abs(values - uv[face]).max() < 1e-6
    return error


# ---- the stages

def plain():
    stage = new("plain.usda")
    leaf(stage, "/World/Leaf", POINTS)
    scene, made = read(stage, ["/World/Leaf"])
    same_leaf(made, scene["sheets"][0])
    assert set(scene) == {"sheets"}, scene


def turned_and_scaled():
    """Centimetres, y up, two levels of transforms, a crate file; named by the prim above."""
    stage = new("turned.usdc", "Y", 0.01)
    outer, inner = (UsdGeom.Xform.Define(stage, path) for path in ("/World/Set", "/World/Set/Desk"))
    outer.AddTranslateOp().Set((3, 4, 5))
    outer.AddRotateXYZOp().Set((20, 30, 40))
    inner.AddScaleOp().Set((2, 0.5, 4))
    matrix = np.array(UsdGeom.XformCache().GetLocalToWorldTransform(inner.GetPrim()))
    local = (np.c_[of_stage(POINTS, "Y", 0.01), np.ones(len(POINTS))] @ np.linalg.inv(matrix))[:, :3]
    leaf(stage, "/World/Set/Desk/Leaf", local, uv="faceVarying")
    scene, made = read(stage, ["/World/Set"])
    same_leaf(made, scene["sheets"][0])


def mirrored():
    """A negative scale turns faces over, and so does leftHanded; both together do not."""
    stage = new("mirrored.usda", "Z", 0.0254)
    backwards = [face[::-1] for face in FACES]
    for name, sign, left, wound in (("A", -1, False, backwards), ("B", 1, True, backwards), ("C", -1, True, FACES)):
        mesh = leaf(stage, f"/World/{name}", of_stage(POINTS, "Z", 0.0254) * [sign, 1, 1], wound)
        UsdGeom.Xformable(mesh).AddScaleOp().Set((sign, 1, 1))
        mesh.CreateOrientationAttr("leftHanded" if left else "rightHanded")
    scene, made = read(stage, ["/World/A", "/World/B", "/World/C"])
    for sheet in scene["sheets"]:
        same_leaf(made, sheet)


def painted():
    """A picture beside the stage, uv by another name through a UsdTransform2d, a colour, several materials."""
    stage = new("painted.usda", "Y", 1)
    mesh = leaf(stage, "/World/Leaf", of_stage(POINTS, "Y", 1), uv="varying", name="map1")
    paint(stage, mesh, "./page.png", varname="map1", change=((0.5, 2), 90.0, (0.25, 0.125)))
    plain = leaf(stage, "/World/Plain", of_stage(POINTS + [0, 0, 0.1], "Y", 1), uv=None)
    plain.CreateDisplayColorAttr([(0.25, 0.5, 1)])
    parts = leaf(stage, "/World/Parts", of_stage(POINTS + [0, 0, 0.2], "Y", 1))
    subset = UsdGeom.Subset.CreateGeomSubset(parts, "half", "face", [0, 1, 2])
    paint(stage, subset, "page.png", "/World/Half")
    scene, made = read(stage, ["/World"], check=True)
    first, second, third = scene["sheets"]
    same_leaf(made, first, uv=np.stack([-2 * UV[:, 1] + 0.25, 0.5 * UV[:, 0] + 0.125], 1))
    assert (made.parent / first["picture"]).read_bytes() == (FOLDER / "page.png").read_bytes()
    assert second["colour"] == [0.25, 0.5, 1] and "picture" not in second and third["picture"] == first["picture"]


def holes():
    """Holes, a scalar of the points, a range that is no shot, uv that fit nothing and that no picture needs."""
    stage = new("holes.usda")
    stage.SetStartTimeCode(0)
    stage.SetEndTimeCode(1e6)
    leaf(stage, "/World/Bare", POINTS).GetPrim().GetAttribute("primvars:st").Set([(0, 0)])
    mesh = leaf(stage, "/World/Leaf", POINTS)
    mesh.CreateHoleIndicesAttr([1, 9])
    values = UsdGeom.PrimvarsAPI(mesh).CreatePrimvar("damp", Sdf.ValueTypeNames.FloatArray, "vertex")
    values.Set([0.5 * v for v in range(len(POINTS))])
    scene, made = read(stage, ["/World/Leaf"])
    same_leaf(made, scene["sheets"][0], faces=[face for f, face in enumerate(FACES) if f not in (1, 9)])
    assert set(scene) == {"sheets"}, scene
    scene, made = read(stage, ["/World/Bare", "/World/Leaf"])
    same_leaf(made, scene["sheets"][0], uv=None)
    assert read_ply(made.parent / "Bare.ply")[2] == []
    *_, names, vertices = read_ply(made.parent / "Leaf.ply")
    assert names == ["damp"] and vertices["damp"][7] == 3.5


def instances():
    """The leaf of another file, twice, as instances of a prototype, one of them moved."""
    asset = new("asset.usda")
    leaf(asset, "/World/Leaf", POINTS)
    asset.Save()
    stage = new("instances.usda")
    for name, x in (("One", 0), ("Two", 0.3)):
        copy = UsdGeom.Xform.Define(stage, f"/World/{name}")
        copy.GetPrim().GetReferences().AddReference("./asset.usda", "/World")
        copy.GetPrim().SetInstanceable(True)
        copy.AddTranslateOp().Set((x, 0, 0))
    scene, made = read(stage, ["/World/One/Leaf", "/World/Two"])
    assert [sheet["name"] for sheet in scene["sheets"]] == ["Leaf", "Leaf_2"]
    for sheet, x in zip(scene["sheets"], (0, 0.3)):
        same_leaf(made, sheet, POINTS + [x, 0, 0])


def scattered():
    """A point instancer of two prototypes, in centimetres, y up: turned, scaled and masked copies; a moving one."""
    stage = new("scattered.usda", "Y", 0.01)
    stage.SetStartTimeCode(1)
    stage.SetEndTimeCode(3)
    leaf(stage, "/World/Asset/Leaves/Kinds/Leaf", of_stage(POINTS, "Y", 0.01))
    lifted = leaf(stage, "/World/Asset/Leaves/Kinds/Lifted", of_stage(POINTS, "Y", 0.01))
    UsdGeom.Xformable(lifted).AddTranslateOp().Set((0, 7, 0))
    UsdGeom.Xform.Define(stage, "/World/Asset").AddTranslateOp().Set((100, 0, 0))
    many = UsdGeom.PointInstancer.Define(stage, "/World/Asset/Leaves")
    many.CreatePrototypesRel().SetTargets(["/World/Asset/Leaves/Kinds/Leaf", "/World/Asset/Leaves/Kinds/Lifted"])
    many.CreateProtoIndicesAttr([0, 1, 0, 1])
    many.CreatePositionsAttr([(0, 0, 0), (50, 0, 0), (0, 0, 90), (0, 30, 0)])
    many.CreateOrientationsAttr([Gf.Quath(1), Gf.Quath(np.sqrt(0.5), 0, np.sqrt(0.5), 0), Gf.Quath(1), Gf.Quath(1)])
    many.CreateScalesAttr([(1, 1, 1), (2, 2, 2), (1, 1, 1), (1, 1, 1)])
    many.CreateInvisibleIdsAttr([2])
    scene, made = read(stage, ["/World/Asset"])
    assert [sheet["name"] for sheet in scene["sheets"]] == ["Leaf", "Lifted", "Lifted_2"], scene
    first, second, third = scene["sheets"]
    same_leaf(made, first, POINTS + [1, 0, 0])
    # a quarter about the stage's y, our z
    x, y, z = (POINTS + [0, 0, 0.07]).T
    points = read_ply(made.parent / second["mesh"])[0]
    wanted = 2 * np.stack([-y, x, z], 1) + [1.5, 0, 0]
    assert np.abs(points - wanted).max() < 1e-4, np.abs(points - wanted).max()  # orientations are half floats
    same_leaf(made, third, POINTS + [1, 0, 0.37])
    assert not stage.GetPrimAtPath("/World/Asset/Leaves/copy1") and "copy1" not in (FOLDER / "scattered.usda").read_text()

    balls = UsdGeom.PointInstancer.Define(stage, "/World/Balls")
    UsdGeom.Sphere.Define(stage, "/World/Balls/Ball").CreateRadiusAttr(3)
    balls.CreatePrototypesRel().SetTargets(["/World/Balls/Ball"])
    balls.CreateProtoIndicesAttr([0, 0])
    balls.CreatePositionsAttr().Set([(0, 0, 0), (10, 0, 0)], 1)
    balls.GetPositionsAttr().Set([(0, 0, 0), (10, 4, 0)], 3)
    scene, made = read(stage, ["/World/Asset"], colliders=["/World/Balls"], check=True)
    still, moving = scene["colliders"]
    assert moving["radius"] == 0.03 and [entry["position"] for entry in moving["path"]] == [
        [0.1, 0, 0], [0.1, 0, 0.02], [0.1, 0, 0.04]], moving
    assert all(entry["position"] == [0, 0, 0] for entry in still["path"])


def scattered_in_instances():
    """A point instancer inside an instance, and one inside the prototype of another."""
    asset = new("bush.usda")
    twig = UsdGeom.PointInstancer.Define(asset, "/World/Twig")
    leaf(asset, "/World/Twig/Leaf", POINTS)
    twig.CreatePrototypesRel().SetTargets(["/World/Twig/Leaf"])
    twig.CreateProtoIndicesAttr([0, 0])
    twig.CreatePositionsAttr([(0, 0, 0), (0, 0, 0.1)])
    asset.Save()
    stage = new("bushes.usda")
    bush = UsdGeom.Xform.Define(stage, "/World/Bush")
    bush.GetPrim().GetReferences().AddReference("./bush.usda", "/World")
    bush.GetPrim().SetInstanceable(True)
    bush.AddTranslateOp().Set((0, 2, 0))
    scene, made = read(stage, ["/World/Bush"])
    assert len(scene["sheets"]) == 2
    same_leaf(made, scene["sheets"][1], POINTS + [0, 2, 0.1])
    garden = UsdGeom.PointInstancer.Define(stage, "/World/Garden")
    stage.DefinePrim("/World/Garden/Bush").GetReferences().AddReference("./bush.usda", "/World")
    garden.CreatePrototypesRel().SetTargets(["/World/Garden/Bush"])
    garden.CreateProtoIndicesAttr([0, 0, 0])
    garden.CreatePositionsAttr([(0, 0, 0), (1, 0, 0), (2, 0, 0)])
    scene, made = read(stage, ["/World/Garden"], check=True)
    assert len(scene["sheets"]) == 6
    same_leaf(made, scene["sheets"][5], POINTS + [2, 0, 0.1])


def deformable():
    """A body of the proposed schema: what burns, what is drawn, mass and stiffness from it, in centimetres and grams."""
    stage = new("body.usda", "Y", 0.01)
    UsdPhysics.SetStageKilogramsPerUnit(stage, 0.001)
    body = UsdGeom.Xform.Define(stage, "/World/Cloth").GetPrim()
    body.AddAppliedSchema("PhysicsDeformableBodyAPI")
    cloth = leaf(stage, "/World/Cloth/Sim", of_stage(POINTS, "Y", 0.01))
    cloth.GetPrim().AddAppliedSchema("PhysicsSurfaceDeformableSimAPI")
    cloth.CreateVelocitiesAttr([(0, 100, 0)] * len(POINTS))
    cloth.GetPrim().CreateAttribute("physics:thicknesses", Sdf.ValueTypeNames.FloatArray).Set([0.02])
    leaf(stage, "/World/Cloth/Hull", of_stage(POINTS, "Y", 0.01)).GetPrim().AddAppliedSchema("PhysicsCollisionAPI")
    drawn = leaf(stage, "/World/Cloth/Drawn", of_stage(POINTS, "Y", 0.01))
    paint(stage, drawn, "./page.png")
    stuff = UsdShade.Material.Define(stage, "/World/Cotton")
    for name, value in (("density", 0.6), ("surfaceBendStiffness", 2000.0)):  # g/cm3, g cm2/s2
        stuff.GetPrim().CreateAttribute("physics:" + name, Sdf.ValueTypeNames.Float).Set(value)
    UsdShade.MaterialBindingAPI.Apply(cloth.GetPrim()).Bind(stuff, UsdShade.Tokens.weakerThanDescendants, "physics")
    scene, made = read(stage, ["/World"], check=True)
    sheet, = scene["sheets"]
    same_leaf(made, sheet)
    same_leaf(made, {"mesh": sheet["render_mesh"]["mesh"]})
    assert sheet["picture"] == "page.png" and sheet["velocity"] == [0, 0, 1], sheet
    assert np.allclose([sheet["material"]["grammage"], sheet["material"]["bending"]], [0.12, 2e-4]), sheet
    # a mass of the body comes before a density, masses of points before both
    body.CreateAttribute("physics:mass", Sdf.ValueTypeNames.Float).Set(2.0)
    first, made = read(stage, ["/World"])
    masses = cloth.GetPrim().CreateAttribute("physics:masses", Sdf.ValueTypeNames.FloatArray)
    masses.Set([0.1] * len(POINTS))
    second, made = read(stage, ["/World"])
    ratio = second["sheets"][0]["material"]["grammage"] / first["sheets"][0]["material"]["grammage"]
    assert abs(ratio - 0.1 * len(POINTS) / 2) < 1e-6, ratio


def taken_on():
    """A frame of a burn as deformable bodies, and a sheet of those again."""
    cache = singe.read_cache(FOLDER / "out/burn")
    target = FOLDER / "bodies.usda"
    usd_bodies.write(cache, target)
    frame = cache[-1]
    stage = Usd.Stage.Open(str(target))
    mesh = UsdGeom.Mesh(stage.GetPrimAtPath("/World/Leaf"))
    assert np.array_equal(np.array(mesh.GetPointsAttr().Get(), np.float32), frame.position)
    assert np.array_equal(np.array(mesh.GetVelocitiesAttr().Get(), np.float32), frame.velocity)
    scene, made = read(target, ["/World"], check=True)
    sheet, = scene["sheets"]
    points, faces, uv, names, _ = read_ply(made.parent / sheet["mesh"])
    assert np.array_equal(points, frame.position) and np.array_equal(faces, frame.triangles)
    material = cache.scene["sheets"][0]["material"]
    assert abs(sheet["material"]["grammage"] / material["grammage"] - 1) < 0.1, sheet
    assert abs(sheet["material"]["bending"] / (material["thickness"]**2 / material["compliance"]["green"]) - 1) < 1e-6
    assert {"temperature", "burnt"} <= set(names), names


def euler(x, y, z):
    """Columns, about x, then y, then z, as scenes turn things."""
    return np.array(Gf.Matrix3d(Gf.Rotation((1, 0, 0), x) * Gf.Rotation((0, 1, 0), y) * Gf.Rotation((0, 0, 1), z))).T


def moving():
    """48 time codes and 24 frames a second, from code 10 to 18: five frames. Shapes on paths, a mesh that deforms."""
    stage = new("moving.usda", "Y", 0.01)
    leaf(stage, "/World/Leaf", of_stage(POINTS, "Y", 0.01))
    stage.SetTimeCodesPerSecond(48)
    stage.SetFramesPerSecond(24)
    stage.SetStartTimeCode(10)
    stage.SetEndTimeCode(18)
    ball = UsdGeom.Sphere.Define(stage, "/World/Solids/Ball")
    ball.CreateRadiusAttr(2)
    move = UsdGeom.Xformable(ball).AddTranslateOp()
    move.Set((0, 5, 0), 10)
    move.Set((8, 5, -4), 18)
    box = UsdGeom.Cube.Define(stage, "/World/Solids/Box")
    box.CreateSizeAttr(4)
    UsdGeom.Xformable(box).AddTranslateOp().Set((0, -20, 0))
    UsdGeom.Xformable(box).AddRotateXYZOp().Set((15, 25, 35))
    UsdGeom.Xformable(box).AddScaleOp().Set((1, 2, 3))
    rod = UsdGeom.Capsule.Define(stage, "/World/Solids/Rod")
    rod.CreateAxisAttr("X")
    rod.CreateHeightAttr(6)
    rod.CreateRadiusAttr(1)
    UsdGeom.Xformable(rod).AddTranslateOp().Set((0, -30, 0))
    table = UsdGeom.Plane.Define(stage, "/World/Solids/Table")
    table.CreateAxisAttr("Y")
    UsdGeom.Xformable(table).AddTranslateOp().Set((0, -40, 0))
    cube = UsdGeom.Mesh.Define(stage, "/World/Solids/Soft")
    corners = np.array([[x, y, z] for x in (-1, 1) for y in (-51, -49) for z in (-1, 1)], float)
    for code, wide in ((10, 1), (18, 2)):
        cube.CreatePointsAttr().Set(Vt.Vec3fArray.FromNumpy((corners * [wide, 1, 1]).astype(np.float32)), code)
    cube.CreateFaceVertexCountsAttr([4] * 6)
    cube.CreateFaceVertexIndicesAttr([0, 1, 3, 2, 4, 6, 7, 5, 0, 4, 5, 1, 2, 3, 7, 6, 0, 2, 6, 4, 1, 5, 7, 3])
    match = UsdGeom.Xform.Define(stage, "/World/Match")
    match.AddTranslateOp().Set((0, 10, 0))
    scene, made = read(stage, ["/World/Leaf"], colliders=["/World/Solids"], fire=["/World/Match", "/World/Solids/Ball"],
                       check=True)
    assert scene["fps"] == 24 and scene["frames"] == 5
    solids = {one["kind"]: one for one in scene["colliders"]}
    path = solids["sphere"]["path"]
    assert solids["sphere"]["radius"] == 0.02 and len(path) == 5
    for frame, entry in enumerate(path):
        assert abs(entry["time"] - frame / 24) < 1e-8
        assert np.allclose(entry["position"], [0.02 * frame, 0.01 * frame, 0.05], atol=1e-9), entry
    # the box: its own axes in the world, whatever order they come in
    matrix = np.array(UsdGeom.XformCache(10).GetLocalToWorldTransform(box.GetPrim()))[:3, :3]
    ours = euler(*solids["box"]["rotation"]) * solids["box"]["half_size"]
    theirs = (of_stage(2 * matrix, "Z", 100) @ [[1, 0, 0], [0, 0, 1], [0, -1, 0]]).T
    assert np.allclose(ours, theirs, atol=1e-7), (ours, theirs)
    along = euler(*solids["capsule"]["rotation"])[:, 2]
    assert np.allclose(np.abs(along), [1, 0, 0]) and solids["capsule"]["height"] == 0.06
    up = euler(*solids["plane"]["rotation"])[:, 2]
    assert np.allclose(up, [0, 0, 1]) and np.allclose(solids["plane"]["position"], [0, 0, -0.4])
    for frame in range(5):
        points = read_ply(made.parent / f"Soft.{frame + 1:04d}.ply")[0]
        wanted = corners * [1 + frame / 4, 1, 1] * 0.01
        assert np.abs(points - np.stack([wanted[:, 0], -wanted[:, 2], wanted[:, 1]], 1)).max() < 1e-7
    match, carried = scene["sources"]
    assert match["kind"] == "spot" and np.allclose(match["position"], [0, 0, 0.1])
    assert carried["kind"] == "ball" and carried["radius"] == 0.02 and len(carried["path"]) == 5


def skinned():
    """A cube that a skeleton's one joint lifts: points of each frame."""
    stage = new("skinned.usda")
    stage.SetStartTimeCode(1)
    stage.SetEndTimeCode(3)
    leaf(stage, "/World/Leaf", POINTS)
    UsdSkel.Root.Define(stage, "/World/Body")
    bones = UsdSkel.Skeleton.Define(stage, "/World/Body/Bones")
    bones.CreateJointsAttr(["hip"])
    bones.CreateBindTransformsAttr([Gf.Matrix4d(1)])
    bones.CreateRestTransformsAttr([Gf.Matrix4d(1)])
    dance = UsdSkel.Animation.Define(stage, "/World/Body/Dance")
    dance.CreateJointsAttr(["hip"])
    dance.CreateRotationsAttr([Gf.Quatf(1)])
    dance.CreateScalesAttr([(1, 1, 1)])
    for code in (1, 2, 3):
        dance.CreateTranslationsAttr().Set([Gf.Vec3f(0, 0, 0.1 * (code - 1))], code)
    UsdSkel.BindingAPI.Apply(bones.GetPrim()).CreateAnimationSourceRel().SetTargets(["/World/Body/Dance"])
    skin = UsdGeom.Mesh.Define(stage, "/World/Body/Skin")
    corners = np.array([[x, y, z] for x in (0, 0.1) for y in (0, 0.1) for z in (-1, -0.9)], np.float32)
    skin.CreatePointsAttr(Vt.Vec3fArray.FromNumpy(corners))
    skin.CreateFaceVertexCountsAttr([4] * 6)
    skin.CreateFaceVertexIndicesAttr([0, 1, 3, 2, 4, 6, 7, 5, 0, 4, 5, 1, 2, 3, 7, 6, 0, 2, 6, 4, 1, 5, 7, 3])
    bound = UsdSkel.BindingAPI.Apply(skin.GetPrim())
    bound.CreateSkeletonRel().SetTargets(["/World/Body/Bones"])
    bound.CreateJointIndicesPrimvar(True, 1).Set([0])
    bound.CreateJointWeightsPrimvar(True, 1).Set([1.0])
    scene, made = read(stage, ["/World/Leaf"], colliders=["/World/Body"])
    assert scene["colliders"] == [{"kind": "mesh", "motion": {"mesh": "Skin.####.ply"}}], scene
    for code in (1, 2, 3):
        points = read_ply(made.parent / f"Skin.{code:04d}.ply")[0]
        assert np.abs(points - corners - [0, 0, 0.1 * (code - 1)]).max() < 1e-6


def packed():
    """A USDZ with its picture inside."""
    stage = new("inside.usda", "Y", 0.01)
    mesh = leaf(stage, "/World/Leaf", of_stage(POINTS, "Y", 0.01))
    paint(stage, mesh, "./page.png")
    stage.Save()
    target = FOLDER / "packed.usdz"
    assert UsdUtils.CreateNewUsdzPackage(Sdf.AssetPath(str(FOLDER / "inside.usda")), str(target))
    scene, made = read(target, ["/World/Leaf"])
    same_leaf(made, scene["sheets"][0])
    assert (made.parent / scene["sheets"][0]["picture"]).read_bytes() == (FOLDER / "page.png").read_bytes()


def varied():
    """A variant, a payload and a sublayer: what is composed is what is read; a guide is left out."""
    below = new("below.usda")
    leaf(below, "/World/Leaf", POINTS)
    below.Save()
    stage = new("varied.usda")
    stage.GetRootLayer().subLayerPaths.append("./below.usda")
    prim = stage.GetPrimAtPath("/World/Leaf")
    choices = prim.GetVariantSets().AddVariantSet("place")
    for name, z in (("low", 0), ("high", 0.5)):
        choices.AddVariant(name)
        choices.SetVariantSelection(name)
        with choices.GetVariantEditContext():
            UsdGeom.XformCommonAPI(prim).SetTranslate((0, 0, z))
    UsdGeom.Imageable(leaf(stage, "/World/Guide", POINTS)).CreatePurposeAttr("guide")
    scene, made = read(stage, ["/World"])
    assert len(scene["sheets"]) == 1
    same_leaf(made, scene["sheets"][0], POINTS + [0, 0, 0.5])


def burnt():
    """A stage burns by the package's command, and what the burn leaves as USD is a stage again."""
    also = FOLDER / "also.yaml"
    also.write_text("steps: 2\npace: 4\noutput: {formats: [ply, usd]}\n")
    stage = new("burn.usda", "Y", 0.01)
    leaf(stage, "/World/Leaf", of_stage(POINTS, "Y", 0.01))
    stage.SetStartTimeCode(1)
    stage.SetEndTimeCode(2)
    match = UsdGeom.Sphere.Define(stage, "/World/Match")
    match.CreateRadiusAttr(1)
    UsdGeom.Xformable(match).AddTranslateOp().Set(tuple(of_stage([POINTS[3]], "Y", 0.01)[0]))
    stage.Save()
    code = "import sys; sys.path.insert(0, %r); from singe.command import main; main()" % str(
        HERE.parent.parent / "bindings/python")
    done = subprocess.run([sys.executable, "-c", code, "run", "burn.usda", "--sheets", "/World/Leaf", "--fire",
                           "/World/Match", "--also", "also.yaml", "--no-preview", "--quiet"],
                          cwd=FOLDER, capture_output=True, text=True, env={**os.environ, "SINGE_PROGRAM": SINGE})
    assert done.returncode == 0, done.stdout + done.stderr
    cache = singe.read_cache(FOLDER / "out/burn")
    assert cache[2].temperature.max() > 320, cache[2].temperature.max()
    scene, made = read(FOLDER / "out/burn/burn.usda", ["/burn/sheets/Leaf"])
    points = read_ply(made.parent / scene["sheets"][0]["mesh"])[0]
    assert np.array_equal(points, cache[1].position), "the first frame"
    # the command without Python says what to do
    done = subprocess.run([SINGE, "run", "burn.usda"], cwd=FOLDER, capture_output=True, text=True)
    assert done.returncode == 2 and "python3 -m singe.usd STAGE --sheets" in done.stderr, done.stderr


# ---- stages that are wrong: each is refused by the path of the prim

def broken(change, message, sheets=("/World/Leaf",), **options):
    name = f"broken-{broken.count}.usda"
    broken.count += 1
    stage = new(name)
    mesh = leaf(stage, "/World/Leaf", POINTS)
    change(stage, mesh)
    try:
        read(stage, list(sheets), **options)
    except errors.FormatError as error:
        assert message in str(error), (message, str(error))
    else:
        raise AssertionError(f"not refused: {message}")


broken.count = 0


def set_value(name, value):
    return lambda stage, mesh: mesh.GetPrim().GetAttribute(name).Set(value)


def refused():
    broken(lambda stage, mesh: None, "/World/Lef: ", ["/World/Lef"])
    broken(lambda stage, mesh: None, "its meshes are /World/Leaf", ["World/Leaf"])
    broken(lambda stage, mesh: None, "no sheets", [])
    broken(lambda stage, mesh: UsdGeom.Xform.Define(stage, "/World/Empty"), "/World/Empty: a Xform, and nothing at or "
           "below it is a mesh", ["/World/Empty"])
    broken(lambda stage, mesh: UsdGeom.BasisCurves.Define(stage, "/World/Hair"), "/World/Hair: a BasisCurves",
           ["/World/Hair"])
    broken(set_value("faceVertexIndices", [0, 1, 2, 99]), "/World/Leaf: faceVertexCounts add up to")
    wrong = [v for face in FACES for v in face]
    broken(set_value("faceVertexIndices", [*wrong[:-1], 99]), f"/World/Leaf: faceVertexIndices[{len(wrong) - 1}] is 99")
    broken(set_value("faceVertexCounts", [2, *map(len, FACES)]), "/World/Leaf: face 0 has 2 corners")
    broken(set_value("points", [(0, 0, float("nan"))] * len(POINTS)), "/World/Leaf: point 0 is not finite")
    broken(set_value("points", []), "/World/Leaf: 0 points")

    def endless(stage, mesh):
        wet = UsdGeom.PrimvarsAPI(mesh).CreatePrimvar("wet", Sdf.ValueTypeNames.FloatArray, UsdGeom.Tokens.vertex)
        wet.Set([float("inf")] * len(POINTS))
    broken(endless, "/World/Leaf: primvars:wet has a value that is not finite")

    def unfitting(stage, mesh):
        paint(stage, mesh, "./page.png")
        mesh.GetPrim().GetAttribute("primvars:st").Set([(0, 0)])
    broken(unfitting, "/World/Leaf: primvars:st has 1 values, expected 35 (vertex)")
    broken(lambda stage, mesh: paint(stage, mesh, "./none.png"), "/World/Look/Picture: its picture ./none.png cannot be")
    broken(lambda stage, mesh: paint(stage, mesh, "./also.yaml"), "/World/Look/Picture: its picture ./also.yaml is neither")
    broken(lambda stage, mesh: UsdGeom.Xformable(mesh).AddScaleOp().Set((float("inf"), 1, 1)),
           "/World/Leaf: its transform is not finite")

    def stretched(stage, mesh):
        UsdGeom.Xformable(UsdGeom.Sphere.Define(stage, "/World/Ball")).AddScaleOp().Set((1, 1, 2))
    broken(stretched, "/World/Ball: is stretched", colliders=["/World/Ball"])
    broken(lambda stage, mesh: None, "/World/Match: ", fire=["/World/Match"])
    broken(lambda stage, mesh: stage.SetMetadata("metersPerUnit", 0.0), "metersPerUnit is 0")
    broken(lambda stage, mesh: stage.GetRootLayer().pseudoRoot.SetInfo("upAxis", "X"), "upAxis is X")

    def scatter(indices, positions):
        def change(stage, mesh):
            many = UsdGeom.PointInstancer.Define(stage, "/World/Many")
            many.CreatePrototypesRel().SetTargets(["/World/Leaf"])
            many.CreateProtoIndicesAttr(indices)
            many.CreatePositionsAttr(positions)
        return change
    broken(scatter([0, 7], [(0, 0, 0)] * 2), "/World/Many: protoIndices has 7, but there are 1", ["/World/Many"])
    broken(scatter([0, 0], [(0, 0, 0)]), "/World/Many: has", ["/World/Many"])
    broken(scatter([0] * 1001, [(0, 0, 0)] * 1001), "/World/Many: 1001 copies, expected at most 1000", ["/World/Many"])

    def backwards(stage, mesh):
        stage.SetStartTimeCode(5)
        stage.SetEndTimeCode(1)
    broken(backwards, "endTimeCode 1 comes before startTimeCode 5")
    head = '#usda 1.0\n(\nmetersPerUnit = 1\nupAxis = "Z"\n)\ndef Mesh "World" {\n'
    for name, text, named in (("garbage.usda", "#usda 1.0\ndef Mesh {", ""), ("garbage.usdc", "PXR-USDC", ""),
                              ("none.usda", None, ""),
                              ("word.usda", head + 'string points = "x"\n}', "/World.points: its values are no points"),
                              ("words.usda", head + 'string[] faceVertexCounts = ["x"]\n}', "its values are no numbers")):
        if text:
            (FOLDER / name).write_text(text)
        try:
            usd.scene(FOLDER / name, FOLDER / "none", ["/World"])
        except errors.FormatError as error:
            assert (named or name) in str(error), error
        else:
            raise AssertionError(name)


def main():
    shutil.rmtree(FOLDER, ignore_errors=True)
    FOLDER.mkdir(parents=True)
    (FOLDER / "page.png").write_bytes(png(np.full((4, 4, 3), 200, np.uint8)))
    stages = [plain, turned_and_scaled, mirrored, painted, holes, instances, scattered, scattered_in_instances, moving,
              skinned, packed, varied, deformable, burnt, taken_on]
    for stage in stages:
        stage()
        print(f"{stage.__name__}: as in the stage")
    refused()
    print(f"{len(stages)} stages; {broken.count + 5} broken ones refused")


if __name__ == "__main__":
    main()
