// A bad mesh is repaired, and each repair is said: here two squares are not joined, and a face has no area.
//
// Prints:
//   8 vertices, 1 triangles, 2 quads, 0 polygons, 1 component
//   2 vertices welded to others at their positions (vertex 4, from 0)
//   1 face without area left out (face 2, from 0)
//   6 vertices, 2 cells
#include "sample.h"

static void heard(void *context, SingeLogLevel level, const char *line) {
    (void)context, (void)level;
    printf("%s\n", line);
}

int main(void) {
    // two squares side by side, each with corners of its own: 1 and 4, 2 and 7 are the same point
    const float positions[] = {0,    0, 0, 0.1f, 0, 0, 0.1f, 0.1f, 0, 0,    0.1f, 0,
                               0.1f, 0, 0, 0.2f, 0, 0, 0.2f, 0.1f, 0, 0.1f, 0.1f, 0};
    const uint32_t sizes[] = {4, 4, 3}, corners[] = {0, 1, 2, 3, 4, 5, 6, 7, 0, 1, 0};
    SingeMeshDef def = singe_default_mesh();
    def.name = "squares", def.vertex_count = 8, def.positions = positions;
    def.face_count = 3, def.face_sizes = sizes, def.corners = corners;
    def.log.write = heard;
    SingeMesh *mesh;
    SingeError error;
    must(singe_mesh_create(&def, &mesh, &error), &error);
    const SingeMeshView view = singe_mesh_view(mesh);
    printf("%u vertices, %u cells\n", view.vertex_count, view.cell_count);
    singe_mesh_destroy(mesh);
}
