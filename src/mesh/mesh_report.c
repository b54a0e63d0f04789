// Describes a mesh and its changes in sentences.
#include "mesh/to_quads.h"

#include <stdio.h>

typedef struct RepairText {
    const char *one, *many, *at; ///< `at`: "line" or "face", "vertex", or NULL if the location does not matter
} RepairText;

static const RepairText texts[MESH_REPAIRS] = {
    [MESH_UNUSED] = {"unused vertex left out", "unused vertices left out", "vertex"},
    [MESH_WELDED] = {"vertex welded to another at its position", "vertices welded to others at their positions",
                     "vertex"},
    [MESH_SHRUNK] = {"very short edge collapsed", "very short edges collapsed", "face"},
    [MESH_REPEATED] = {"face that names a vertex twice split", "faces that name a vertex twice split", "face"},
    [MESH_SPIKE] = {"face whose spikes were cut off", "faces whose spikes were cut off", "face"},
    [MESH_CONCAVE] = {"face with a hole or a bay cut into triangles", "faces with holes or bays cut into triangles",
                      "face"},
    [MESH_DEGENERATE] = {"face without area left out", "faces without area left out", "face"},
    [MESH_DUPLICATE] = {"duplicate face left out", "duplicate faces left out", "face"},
    [MESH_JUNCTION] = {"vertex inserted into an edge that it lies on", "vertices inserted into edges that they lie on",
                       "face"},
    [MESH_TURNED] = {"face flipped to match its neighbours", "faces flipped to match their neighbours", "face"},
    [MESH_INSIDE_OUT] = {"inside-out closed surface flipped", "inside-out closed surfaces flipped", "face"},
    [MESH_CUT] = {"edge of more than two faces split", "edges of more than two faces split", "face"},
    [MESH_ONE_SIDED] = {"edge split where the surface is one-sided", "edges split where the surface is one-sided",
                        "face"},
    [MESH_BOW_TIE] = {"vertex duplicated whose faces met only there", "vertices duplicated whose faces met only there",
                      "face"},
    [MESH_PAIRED] = {"pair of triangles joined to a quad", "pairs of triangles joined to quads", NULL},
    [MESH_HALVED] = {"edge halved for triangles without a partner", "edges halved for triangles without a partner",
                     NULL},
    [MESH_SPLIT] = {"face split into quads", "faces split into quads", NULL},
};

bool mesh_report_line(const MeshReport *report, int index, char *text, size_t size) {
    if (index == 0) {
        int length = snprintf(text, size, "%u vertices, %u triangles, %u quads, %u polygons, %u component%s",
                              report->vertices, report->triangles, report->quads, report->polygons, report->components,
                              report->components == 1 ? "" : "s");
        if (report->seam_vertices && length > 0 && (size_t)length < size)
            snprintf(text + length, size - (size_t)length, ", %u vertices on seams", report->seam_vertices);
        return report->faces > 0;
    }

    for (int i = 0; i < MESH_REPAIRS; i++) {
        const uint32_t count = report->count[i];
        const RepairText *words = &texts[i];
        if (!count || --index) continue;

        int length = snprintf(text, size, "%u %s", count, count == 1 ? words->one : words->many);
        if (!words->at || length < 0 || (size_t)length >= size) return true;

        const bool line = words->at[0] == 'f' && report->lines;
        snprintf(text + length, size - (size_t)length, line ? " (%s %u)" : " (%s %u, from 0)",
                 line ? "line" : words->at, report->first[i]);
        return true;
    }

    return false;
}
