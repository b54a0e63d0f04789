"""Mesh files that crash readers or exhaust memory or time: {name: (bytes, part of the message)}."""

import base64
import json
import struct

SQUARE = struct.pack("<12f", 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0)
TWO = (0, 1, 2, 0, 2, 3)


def gltf(indices=TWO, **changes):
    """A square of two triangles; what is in `changes` replaces the file's own."""
    data = SQUARE + struct.pack(f"<{len(indices)}I", *indices)
    uri = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
    file = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "buffers": [{"byteLength": len(data), "uri": uri}],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": 48},
            {"buffer": 0, "byteOffset": 48, "byteLength": 4 * len(indices)},
        ],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0] * 3, "max": [1] * 3},
            {"bufferView": 1, "componentType": 5125, "count": len(indices), "type": "SCALAR"},
        ],
    }
    file.update(changes)
    return json.dumps(file).encode()


def accessors(**changes):
    """The square's accessors, the first with these changes."""
    both = json.loads(gltf())["accessors"]
    both[0].update(changes)
    return both


def nested_gltf(depth):
    nodes = [{"children": [i + 1]} for i in range(depth)] + [{"mesh": 0}]
    return gltf(nodes=nodes)


def glb(indices=TWO, claimed=None, length=None):
    """The same with its numbers in the second chunk, which may claim another length, as may the buffer."""
    data = SQUARE + struct.pack(f"<{len(indices)}I", *indices)
    text = gltf(indices, buffers=[{"byteLength": len(data) if length is None else length}])
    text += b" " * (-len(text) % 4)
    body = struct.pack("<II", len(text), 0x4E4F534A) + text
    body += struct.pack("<II", len(data) if claimed is None else claimed, 0x004E4942) + data
    return struct.pack("<4sII", b"glTF", 2, 12 + len(body)) + body


def dae(nodes, library="", indices="0 1 2 0 2 3", count=2, floats=12):
    return f"""<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="a" count="{floats}">0 0 0 1 0 0 1 1 0 0 1 0</float_array>
<technique_common><accessor source="#a" count="{floats // 3}" stride="3"><param name="X" type="float"/><param name="Y"
type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="{count}"><input semantic="VERTEX" source="#v" offset="0"/><p>{indices}</p></triangles>
</mesh></geometry></library_geometries>
{library}
<library_visual_scenes><visual_scene id="s">{nodes}</visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>""".encode()


USE = '<instance_geometry url="#g"/>'


def doubling_dae(depth):
    """2 to the power of `depth` copies."""
    library = "".join(
        f'<node id="n{i}"><instance_node url="#n{i + 1}"/><instance_node url="#n{i + 1}"/></node>' for i in range(depth)
    )
    library = f'<library_nodes>{library}<node id="n{depth}">{USE}</node></library_nodes>'
    return dae('<node id="root"><instance_node url="#n0"/></node>', library)


def x3d(body):
    return f'<?xml version="1.0"?>\n<X3D version="3.0" profile="Interchange"><Scene>{body}</Scene></X3D>'.encode()


def x3d_shape(indices="0 1 2 3 -1"):
    return (
        f'<Shape><IndexedFaceSet coordIndex="{indices}"><Coordinate point="0 0 0 1 0 0 1 1 0 0 1 0"/>'
        "</IndexedFaceSet></Shape>"
    )


def chunk(kind, body):
    return struct.pack("<HI", kind, 6 + len(body)) + body


def three_ds(indices=TWO, vertices=4, faces=2):
    points = chunk(0x4110, struct.pack("<H", vertices) + SQUARE)
    corners = b"".join(struct.pack("<4H", *indices[3 * i : 3 * i + 3], 0) for i in range(len(indices) // 3))
    sides = chunk(0x4120, struct.pack("<H", faces) + corners)
    return chunk(0x4D4D, chunk(0x3D3D, chunk(0x4000, b"a\0" + chunk(0x4100, points + sides))))


def fbx_node(name, values, children=b"", at=0):
    body = b"".join(values)
    size = 13 + len(name) + len(body) + len(children)
    return struct.pack("<IIIB", at + size, len(values), len(body), len(name)) + name + body + children


def fbx_bomb():
    """An array that says it holds 4 billion doubles."""
    array = b"d" + struct.pack("<III", 0xFFFFFFF0, 1, 8) + b"\x78\x9c\x03\0\0\0\0\x01"
    head = b"Kaydara FBX Binary  \0\x1a\0" + struct.pack("<I", 7400)
    return head + fbx_node(b"Objects", [array], at=len(head)) + b"\0" * 13


def off(vertices=4, faces=1, face="4 0 1 2 3"):
    return f"OFF\n{vertices} {faces} 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n{face}\n".encode()


def stl(count):
    return b"\0" * 80 + struct.pack("<I", count) + b"\0" * 50


def ply(index=3, head="", vertices=4, kind="uchar int", count="4"):
    return (
        f"ply\nformat ascii 1.0\n{head}element vertex {vertices}\nproperty float x\nproperty float y\n"
        f"property float z\nelement face 1\nproperty list {kind} vertex_indices\nend_header\n"
        f"0 0 0\n1 0 0\n1 1 0\n0 1 0\n{count} 0 1 2 {index}\n"
    ).encode()


def obj(index):
    return f"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 {index}\n".encode()


GOOD = {
    "a.gltf": gltf(),
    "a.glb": glb(),
    "a.dae": dae(f"<node>{USE}</node>"),
    "a.x3d": x3d(x3d_shape()),
    "a.3ds": three_ds(),
    "a.off": off(),
    "a.stl": b"\0" * 80
    + struct.pack("<I", 2)
    + b"".join(struct.pack("<12fH", 0, 0, 1, *t, 0) for t in ((0, 0, 0, 1, 0, 0, 1, 1, 0), (0, 0, 0, 1, 1, 0, 0, 1, 0))),
    "a.ply": ply(),
    "a.obj": obj(4),
}

# the second is a part of the message; "" if assimp words it
HOSTILE = {
    # nodes in nodes, and nodes in themselves
    "self.gltf": (gltf(nodes=[{"children": [0], "mesh": 0}]), ""),
    "ring.gltf": (gltf(nodes=[{"children": [1]}, {"children": [0], "mesh": 0}]), ""),
    "deep.gltf": (nested_gltf(100000), ""),
    "copies.gltf": (
        gltf(
            scenes=[{"nodes": list(range(3000))}],
            nodes=[{"mesh": 0}] * 3000,
            meshes=[{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}] * 100}],
        ),
        "repeat meshes",
    ),
    "deeper.gltf": (gltf(extras="x").replace(b'"x"', b"[" * 500000 + b"]" * 500000), ""),
    "self.dae": (dae(f'<node id="n">{USE}<instance_node url="#n"/></node>'), ""),
    "deep.dae": (dae("<node>" * 100000 + USE + "</node>" * 100000), ""),
    "doubled.dae": (doubling_dae(40), ""),
    "deep.x3d": (x3d("<Group>" * 200000 + x3d_shape() + "</Group>" * 200000), ""),
    "self.x3d": (x3d(f'<Group DEF="a">{x3d_shape()}<Group USE="a"/></Group>'), ""),
    # counts, sizes and offsets past the end
    "view.gltf": (gltf(bufferViews=[{"buffer": 0, "byteOffset": 1 << 30, "byteLength": 48}] * 2), ""),
    "past.gltf": (gltf(accessors=accessors(byteOffset=1 << 30)), ""),
    "count.gltf": (gltf(accessors=accessors(count=0x7FFFFFFF)), ""),
    "bare.gltf": (gltf(accessors=[{"componentType": 5126, "count": 800000000, "type": "VEC3"}] * 2), ""),
    "buffer.gltf": (gltf(buffers=[{"byteLength": 10**10}]), ""),
    "negative.gltf": (gltf(accessors=accessors(bufferView=-1)), ""),
    "view0.gltf": (gltf(accessors=accessors(bufferView=77)), ""),
    "mesh.gltf": (gltf(nodes=[{"mesh": 9}]), ""),
    "sparse.gltf": (
        gltf(
            accessors=accessors(
                sparse={
                    "count": 4,
                    "indices": {"bufferView": 1, "componentType": 5125, "byteOffset": 1 << 28},
                    "values": {"bufferView": 0},
                }
            )
        ),
        "",
    ),
    "chunk.glb": (glb(claimed=1 << 31), ""),
    "cut.glb": (glb()[:200], ""),
    "28bytes.off": (b"OFF\n2147483647 2147483647 0\n"[:28], ""),
    "negative.off": (off(vertices=-1), ""),
    "faces.off": (off(faces=1 << 40), ""),
    "corners.off": (off(face="4000000000 0 1 2 3"), ""),
    "count.stl": (stl(0xFFFFFFFF), "byte 80"),
    "cut.3ds": (three_ds()[:60], ""),
    "vertices.3ds": (three_ds(vertices=0xFFFF), ""),
    "bomb.fbx": (fbx_bomb(), ""),
    "nothing.fbx": (b"Kaydara FBX Binary  \0\x1a\0" + struct.pack("<I", 7400), ""),
    "elements.ply": (ply(head="".join(f"element e{i} 0\n" for i in range(200000))), "more than 100 kinds of elements"),
    "bare.ply": (
        b"ply\nformat binary_little_endian 1.0\nelement vertex 2147483647\nelement face 1\n"
        b"property list uchar int vertex_indices\nend_header\n\3",
        'no property "x"',
    ),
    # indices out of range, in every format
    "buffer.glb": (glb(length=1 << 40), ""),
    "index.gltf": (gltf(indices=(0, 1, 2, 0, 2, 999999)), "index 5 (from 0): vertex 999999 is out of range"),
    "index.glb": (glb((0, 1, 999999, 0, 2, 3)), "index 2 (from 0): vertex 999999 is out of range"),
    "index.dae": (dae(f"<node>{USE}</node>", indices="0 1 2 0 2 999999"), "999999"),
    "index.x3d": (x3d(x3d_shape("0 1 2 999999 -1")), ""),
    "index.3ds": (three_ds(indices=(0, 1, 2, 0, 2, 60000)), "index"),
    "index.off": (off(face="4 0 1 2 999999"), "index"),
    "index.ply": (ply(index=999999), "index.ply:14: vertex index 999999 is out of range"),
    "index.obj": (obj(999999), "index.obj:5:"),
    # what is no file of its kind
    "blend.dae": (b"BLENDER-v279" + b"\0" * 100, "do not match the extension"),
    "text.glb": (b"hello", "not glTF"),
}
