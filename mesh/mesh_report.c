// What a mesh is and what was done to it, in sentences.
#include "mesh/mesh.h"

#include <stdio.h>

typedef struct RepairText {
    const char *one, *many, *at; ///< `at`: "line" or "face", "vertex", or NULL where it is no matter where
} RepairText;

static const RepairText texts[MESH_REPAIRS] = {
    [MESH_UNUSED] = {"vertex of no face left out", "vertices of no face left out", "vertex"},
    [MESH_WELDED] = {"vertex welded to another at its place", "vertices welded to others at their places", "vertex"},
    [MESH_SHRUNK] = {"very short side shrunk to a point", "very short sides shrunk to points", "face"},
    [MESH_REPEATED] = {"face parted that names a vertex twice", "faces parted that name a vertex twice", "face"},
    [MESH_SPIKE] = {"face whose spikes were cut off", "faces whose spikes were cut off", "face"},
    [MESH_CONCAVE] = {"face with a hole or a bay cut into triangles", "faces with holes or bays cut into triangles",
                      "face"},
    [MESH_DEGENERATE] = {"face without area left out", "faces without area left out", "face"},
    [MESH_DUPLICATE] = {"face left out that is there twice", "faces left out that are there twice", "face"},
    [MESH_JUNCTION] = {"vertex put into a side that it lies on", "vertices put into sides that they lie on", "face"},
    [MESH_TURNED] = {"face turned over, as its neighbours are", "faces turned over, as their neighbours are", "face"},
    [MESH_INSIDE_OUT] = {"closed surface turned inside out", "closed surfaces turned inside out", "face"},
    [MESH_CUT] = {"side of more than two faces cut apart", "sides of more than two faces cut apart", "face"},
    [MESH_ONE_SIDED] = {"side cut apart at which the surface had one side only",
                        "sides cut apart at which the surface had one side only", "face"},
    [MESH_BOW_TIE] = {"vertex doubled whose faces met only there", "vertices doubled whose faces met only there",
                      "face"},
    [MESH_PAIRED] = {"pair of triangles made a quad", "pairs of triangles made quads", NULL},
    [MESH_HALVED] = {"side halved for triangles without a partner", "sides halved for triangles without a partner",
                     NULL},
    [MESH_SPLIT] = {"face split into quads", "faces split into quads", NULL},
};

static void mesh_report_describe(const MeshReport *report, char *text, size_t size) {
    int length = snprintf(text, size, "%u vertices, %u triangles, %u quads, %u polygons, %u component%s",
                          report->vertices, report->triangles, report->quads, report->polygons, report->components,
                          report->components == 1 ? "" : "s");
    if (report->seam_vertices && length > 0 && (size_t)length < size)
        snprintf(text + length, size - (size_t)length, ", %u vertices on seams", report->seam_vertices);
}

static void describe_repair(const MeshReport *report, MeshRepair repair, char *text, size_t size) {
    const RepairText *words = &texts[repair];
    uint32_t count = report->count[repair];
    int length = snprintf(text, size, "%u %s", count, count == 1 ? words->one : words->many);
    if (!words->at || length < 0 || (size_t)length >= size) return;
    bool face = words->at[0] == 'f';
    snprintf(text + length, size - (size_t)length, face && report->lines ? " (%s %u)" : " (%s %u, from 0)",
             face && report->lines ? "line" : words->at, report->first[repair]);
}

bool mesh_report_line(const MeshReport *report, int index, char *text, size_t size) {
    if (index == 0) {
        mesh_report_describe(report, text, size);
        return report->faces > 0;
    }
    for (int i = 0; i < MESH_REPAIRS; i++) {
        if (!report->count[i] || --index) continue;
        describe_repair(report, (MeshRepair)i, text, size);
        return true;
    }
    return false;
}
