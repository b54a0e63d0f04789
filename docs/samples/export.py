# Meshes for other programs: the drawn surface as an OBJ, with colours of the vertices, which Blender and MeshLab read.
#
# Prints:
#   export.obj: as many faces as triangles are drawn
import os

import sample

sim = sample.fire()
sheet = sim.sheet(*sample.square(0.1, 16))
for x in (-0.05, 0.05):
    sample.pin(sim, sheet, x, 0.05, 0)
sample.match(sim, 0, -0.05, 0)
sim.commit()
sim.advance(0.7)

surface = sim.surface()
with open("export.obj", "w") as file:
    for (x, y, z), burn in zip(surface.position, surface.burn):
        fresh = 1 - burn
        file.write(f"v {x:g} {y:g} {z:g} {fresh:g} {fresh * 0.9:g} {fresh * 0.8:g}\n")
    for a, b, c in surface.triangles + 1:
        file.write(f"f {a} {b} {c}\n")
with open("export.obj") as file:
    faces = sum(line.startswith("f") for line in file)
os.remove("export.obj")
print(f"export.obj: {'as many' if faces == len(surface.triangles) else 'not as many'} faces as triangles are drawn")
