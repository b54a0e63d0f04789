"""The swinging sheet of `singe bench swing` as cloth of Blender's module bpy, for scripts/bench_peers.py.

Usage: blender_sheet.py CELLS FRAMES STEPS STIFFNESS OUT: prints the milliseconds of processor time of each frame, and
writes the positions of its (CELLS + 1)^2 points, row by row, to OUT. Its solver is implicit, so that a stiffness of
tension stands in place of iterations."""
import struct
import sys
import time

import bpy


def sheet(cells, steps, stiffness):
    """1 m x 1 m, held at two corners beside each other, without drag and damping.

    Only stiffness over mass counts; with masses of grams its solver stops too early. Its gravity is 0.001 of a unit of time
    of which 25 are a second, so 0.625 of what it should be."""
    side = cells + 1
    mesh = bpy.data.meshes.new("sheet")
    mesh.from_pydata([(i / cells, j / cells, 0) for j in range(side) for i in range(side)], [],
                     [(j * side + i, j * side + i + 1, (j + 1) * side + i + 1, (j + 1) * side + i)
                      for j in range(cells) for i in range(cells)])
    made = bpy.data.objects.new("sheet", mesh)
    bpy.context.scene.collection.objects.link(made)
    made.vertex_groups.new(name="held").add([0, cells], 1, "REPLACE")
    cloth = made.modifiers.new("cloth", "CLOTH")
    cloth.point_cache.frame_end = 250
    cloth.collision_settings.use_collision = False
    of = cloth.settings
    of.vertex_group_mass, of.pin_stiffness = "held", 50
    of.quality, of.mass, of.time_scale = steps, 1, (1 / 0.625) ** 0.5
    of.tension_stiffness = of.compression_stiffness = stiffness
    of.shear_stiffness = of.bending_stiffness = 0
    of.tension_damping = of.compression_damping = of.shear_damping = of.bending_damping = of.air_damping = 0
    return made


def main():
    cells, frames, steps, stiffness = map(int, sys.argv[1:5])
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.fps, scene.gravity = 24, (0, 0, -9.81)
    made = sheet(cells, steps, stiffness)
    scene.frame_set(1)
    with open(sys.argv[5], "wb") as out:
        for frame in range(2, frames + 2):
            began = time.process_time()
            scene.frame_set(frame)
            print(f"{1e3 * (time.process_time() - began):.4f}", flush=True)
            found = made.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
            for vertex in found.vertices:
                out.write(struct.pack("=3f", *vertex.co))


if __name__ == "__main__":
    main()
