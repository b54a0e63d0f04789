// Makes the quads of a sheet from the polygons of a file: the steps in their order, and the resulting mesh.
#include "mesh/to_quads.h"

#include "common/real.h"
#include "common/store.h"
#include "mesh/work.h"

#include <math.h>
#include <string.h>

#define BRACED(...) \
    { __VA_ARGS__ }
#define SINGE_ROWS_STAY
#define SINGE_FIELD(type, name, length, dimension, standard, range, kinds, text) .name = standard,
#define SINGE_OTHER(declaration, name, standard, text) .name = standard,
#define SINGE_NEEDED SINGE_FIELD
#define SINGE_HIDDEN SINGE_FIELD

SingeGridDef mesh_grid_default(void) {
    return (SingeGridDef){
        .struct_size = sizeof(SingeGridDef),
#include "singe/grid.def"
    };
}

SingeMeshDef mesh_default(void) {
    return (SingeMeshDef){
        .struct_size = sizeof(SingeMeshDef),
#include "singe/mesh.def"
    };
}

MeshOptions mesh_default_options(void) {
    const SingeMeshDef def = mesh_default();
    return (MeshOptions){def.quads, def.weld, def.smallest};
}

void polygons_free(Polygons *polygons) {
    size_t vertices = polygons->vertex_count, faces = polygons->face_count, corners = polygons->corner_count;
    attributes_free(polygons->allocator, polygons->attributes, polygons->attribute_count, vertices);
    store_free(polygons->allocator, polygons->positions, vertices, 3 * sizeof *polygons->positions);
    store_free(polygons->allocator, polygons->first, faces + 1, sizeof *polygons->first);
    store_free(polygons->allocator, polygons->corners, corners, sizeof *polygons->corners);
    store_free(polygons->allocator, polygons->uv, corners, 2 * sizeof *polygons->uv);
    store_free(polygons->allocator, polygons->lines, faces, sizeof *polygons->lines);
    memset(polygons, 0, sizeof *polygons);
}

void mesh_free(Mesh *mesh) {
    size_t vertices = mesh->vertex_count, cells = mesh->cell_count;
    attributes_free(mesh->allocator, mesh->attributes, mesh->attribute_count, vertices);
    store_free(mesh->allocator, mesh->positions, vertices, 3 * sizeof *mesh->positions);
    store_free(mesh->allocator, mesh->uv, vertices, 2 * sizeof *mesh->uv);
    store_free(mesh->allocator, mesh->corner_uv, cells, 8 * sizeof *mesh->corner_uv);
    store_free(mesh->allocator, mesh->cells, cells, 4 * sizeof *mesh->cells);
    store_free(mesh->allocator, mesh->cell_lines, cells, sizeof *mesh->cell_lines);
    store_free(mesh->allocator, mesh->cell_faces, cells, sizeof *mesh->cell_faces);
    store_free(mesh->allocator, mesh->source, vertices, sizeof *mesh->source);
    store_free(mesh->allocator, mesh->corner_source, cells, 4 * sizeof *mesh->corner_source);
    store_free(mesh->allocator, mesh->became, mesh->source_count, sizeof *mesh->became);
    memset(mesh, 0, sizeof *mesh);
}

// ---- in

enum { FACE_CORNERS_MAX = 4096 };

static SingeResult check_values(const Work *work) {
    const Polygons *file = work->file;
    if (file->face_count == 0)
        return refuse(work->error, SINGE_ERROR_MESH, "mesh", -1, "%s: has no faces", short_name(work->name));

    for (size_t i = 0; i < 3 * (size_t)file->vertex_count; i++)
        if (!isfinite(file->positions[i]))
            return refuse(work->error, SINGE_ERROR_MESH, "mesh", (int64_t)(i / 3),
                          "%s: vertex %llu (from 0) has a position that is not finite", short_name(work->name),
                          (unsigned long long)(i / 3));
    for (uint32_t f = 0; f < file->face_count; f++)
        if (file->first[f + 1] - file->first[f] > FACE_CORNERS_MAX)
            return work_refuse(work, f, "has more than 4096 corners");
    for (uint32_t i = 0; i < file->corner_count; i++)
        if (file->corners[i] >= file->vertex_count)
            return refuse(work->error, SINGE_ERROR_MESH, "mesh", i, "%s: a face uses vertex %u of %u",
                          short_name(work->name), file->corners[i], file->vertex_count);

    return SINGE_OK;
}

/// Copies the file's vertices and faces.
static void take(Work *work) {
    const Polygons *file = work->file;
    const uint32_t count = file->vertex_count;
    const size_t attributes = work->attribute_count = file->attribute_count;

    work->vertex_capacity = work->vertex_count = count;
    work->position = work_new(work, count, sizeof *work->position);
    work->source = work_new(work, count, sizeof *work->source);
    work->became = work_sets(work, count);
    work->attributes = work_new(work, count * attributes, sizeof *work->attributes);
    Faces faces = work_faces(work, file->face_count, file->corner_count);
    uint8_t *used = work_new(work, count, 1);
    if (work->no_memory) return;

    for (uint32_t v = 0; v < count; v++) {
        for (size_t k = 0; k < 3; k++) work->position[v][k] = (double)file->positions[3 * (size_t)v + k];
        for (size_t k = 0; k < attributes; k++) work->attributes[v * attributes + k] = file->attributes[k].values[v];
        work->source[v] = (int32_t)v;
    }

    faces.count = file->face_count;
    faces.corner_count = file->corner_count;
    memcpy(faces.first, file->first, ((size_t)file->face_count + 1) * sizeof *faces.first);
    memcpy(faces.corner, file->corners, file->corner_count * sizeof *faces.corner);
    for (uint32_t h = 0; h < file->corner_count; h++) faces.id[h] = (int32_t)file->corners[h];
    if (faces.uv) memcpy(faces.uv, file->uv, file->corner_count * sizeof *faces.uv);

    for (uint32_t f = 0; f < faces.count; f++) {
        uint32_t corners = faces.first[f + 1] - faces.first[f];
        faces.origin[f] = f;
        work->report->triangles += corners == 3;
        work->report->quads += corners == 4;
        work->report->polygons += corners > 4;
    }

    work->faces = faces;

    for (uint32_t h = 0; h < file->corner_count; h++) used[file->corners[h]] = 1;
    for (uint32_t v = 0; v < count; v++)
        if (!used[v]) work_did(work, MESH_UNUSED, 1, v);
}

// ---- out

static bool hand_over_attributes(const Work *work, const uint32_t *number, Mesh *mesh) {
    const Polygons *file = work->file;
    if (!work->attribute_count) return true;
    mesh->attributes = store_new(mesh->allocator, work->attribute_count, sizeof *mesh->attributes);
    if (!mesh->attributes) return false;

    memset(mesh->attributes, 0, work->attribute_count * sizeof *mesh->attributes);
    mesh->attribute_count = work->attribute_count;

    for (size_t k = 0; k < work->attribute_count; k++) {
        size_t length = strlen(file->attributes[k].name) + 1;
        char *name = store_new(mesh->allocator, length, 1);
        if (!name) return false;
        memcpy(name, file->attributes[k].name, length);
        mesh->attributes[k].name = name;

        float *values = store_new(mesh->allocator, mesh->vertex_count, sizeof *values);
        if (!values) return false;
        mesh->attributes[k].values = values;
        for (uint32_t v = 0; v < work->vertex_count; v++)
            if (number[v] != MESH_NONE) values[number[v]] = work->attributes[v * (size_t)work->attribute_count + k];
    }

    return true;
}

static bool hand_over(Work *work, Mesh *mesh) {
    const Faces *faces = &work->faces;
    uint32_t *number = work_new(work, work->vertex_count, sizeof *number);
    uint8_t *has = work_new(work, work->vertex_count, 1);
    if (work->no_memory) return false;

    // the remaining vertices are numbered in their order
    for (uint32_t h = 0; h < faces->corner_count; h++) number[faces->corner[h]] = 1;
    for (uint32_t v = 0; v < work->vertex_count; v++) number[v] = number[v] ? mesh->vertex_count++ : MESH_NONE;
    mesh->cell_count = faces->count;
    mesh->source_count = work->file->vertex_count;

    const SingeAllocator a = mesh->allocator;
    const size_t vertices = mesh->vertex_count, cells = mesh->cell_count;
    mesh->positions = store_new(a, vertices, 3 * sizeof *mesh->positions);
    mesh->source = store_new(a, vertices, sizeof *mesh->source);
    mesh->became = store_new(a, mesh->source_count, sizeof *mesh->became);
    mesh->cells = store_new(a, cells, 4 * sizeof *mesh->cells);
    mesh->cell_faces = store_new(a, cells, sizeof *mesh->cell_faces);
    if (!mesh->positions || !mesh->source || !mesh->became || !mesh->cells || !mesh->cell_faces) return false;
    if (work->file->lines && !(mesh->cell_lines = store_new(a, cells, sizeof *mesh->cell_lines))) return false;
    if (work->file->uv) {
        mesh->uv = store_new(a, vertices, 2 * sizeof *mesh->uv);
        mesh->corner_uv = store_new(a, cells, 8 * sizeof *mesh->corner_uv);
        mesh->corner_source = store_new(a, cells, 4 * sizeof *mesh->corner_source);
        if (!mesh->uv || !mesh->corner_uv || !mesh->corner_source) return false;
    }

    if (!hand_over_attributes(work, number, mesh)) return false;

    for (uint32_t v = 0; v < work->vertex_count; v++) {
        if (number[v] == MESH_NONE) continue;
        for (size_t k = 0; k < 3; k++) mesh->positions[3 * (size_t)number[v] + k] = (float)work->position[v][k];
        mesh->source[number[v]] = work->source[v];
    }

    for (uint32_t v = 0; v < mesh->source_count; v++) mesh->became[v] = number[work->became[v]];
    for (uint32_t h = 0; h < faces->corner_count; h++) mesh->cells[h] = number[faces->corner[h]];
    memcpy(mesh->cell_faces, faces->origin, faces->count * sizeof *mesh->cell_faces);
    for (uint32_t c = 0; c < faces->count && mesh->cell_lines; c++)
        mesh->cell_lines[c] = work->file->lines[faces->origin[c]];
    if (!mesh->uv) return true;

    // a vertex gets the uv of its first corner; those of corners stay only if some vertex has several (simplify)
    for (uint32_t h = 0; h < faces->corner_count; h++) {
        uint32_t v = number[faces->corner[h]];
        float *uv = mesh->uv + 2 * (size_t)v;
        if (!has[v]) {
            memcpy(uv, faces->uv[h], 2 * sizeof *uv);
            has[v] = 1;
        } else if (has[v] == 1 && (uv[0] != faces->uv[h][0] || uv[1] != faces->uv[h][1])) {
            has[v] = 2;
            work->report->seam_vertices++;
        }
    }

    memcpy(mesh->corner_uv, faces->uv, faces->corner_count * sizeof *faces->uv);
    memcpy(mesh->corner_source, faces->id, faces->corner_count * sizeof *faces->id);
    return true;
}

// ---- the steps

/// A quad with a repeated corner or without area; MESH_NONE if there is none.
static uint32_t unsound_quad(const Work *work) {
    const Faces *faces = &work->faces;
    for (uint32_t f = 0; f < faces->count; f++) {
        const uint32_t *at = faces->corner + 4 * (size_t)f;
        double normal[3], longest = 0, shortest = INFINITY;
        for (int i = 0; i < 4; i++) {
            for (int k = 0; k < i; k++)
                if (at[i] == at[k]) return f;
            double length = distance3(work->position[at[i]], work->position[at[(i + 1) & 3]]);
            longest = double_max(longest, length);
            shortest = double_min(shortest, length);
        }

        face_area(work, f, normal);
        if (!(sqrt(dot3(normal, normal)) > FACE_THIN * longest * longest && shortest > FACE_THIN * longest)) return f;
    }

    return MESH_NONE;
}

/// Every face of n corners becomes n quads: from a corner to the midpoint of its side, the face's centroid and the
/// midpoint of the side before (Catmull and Clark, 1978, without their smoothing). Strands still run straight through
/// what was a quad.
static void split_faces(Work *work) {
    work_edges(work);
    const Faces *old = &work->faces;
    uint32_t *midpoint = work_new(work, old->corner_count, sizeof *midpoint);
    for (uint32_t h = 0; h < old->corner_count && !work->no_memory; h++) {
        if (work->twin[h] != MESH_NONE && work->twin[h] < h) {
            midpoint[h] = midpoint[work->twin[h]];
            continue;
        }
        const uint32_t ends[2] = {old->corner[h], old->corner[faces_next(old, work->face, h)]};
        midpoint[h] = work_vertex(work, ends, 2);
    }

    Faces out = work_faces(work, old->corner_count, 4 * old->corner_count);
    for (uint32_t f = 0; f < old->count && !work->no_memory; f++) {
        const uint32_t first = old->first[f], end = old->first[f + 1];
        const uint32_t centre = work_vertex(work, old->corner + first, end - first);
        for (uint32_t h = first; h < end; h++) {
            uint32_t before = faces_previous(old, work->face, h), next = faces_next(old, work->face, h);
            faces_push(&out, old->corner[h], old, h);
            faces_push_between(&out, midpoint[h], old, h, next);

            if (out.uv)
                for (uint32_t i = first; i < end; i++)
                    for (int k = 0; k < 2; k++) out.uv[out.corner_count][k] += old->uv[i][k] / (float)(end - first);
            out.id[out.corner_count] = -1;
            out.corner[out.corner_count++] = centre;

            faces_push_between(&out, midpoint[before], old, before, h);
            faces_end(&out, old->origin[f]);
        }
    }

    work_did(work, MESH_SPLIT, old->count, work_face_name(work, 0));
    work->faces = out;
}

static SingeResult run_steps(Work *work, const MeshOptions *options) {
    *work->report = (MeshReport){
        .faces = work->file->face_count, .vertices = work->file->vertex_count, .lines = work->file->lines != NULL};
    SingeResult result = check_values(work);
    if (result) return result;
    take(work);
    if (work->no_memory) return SINGE_OK;

    // distances are shares of the diagonal of the box around the faces
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (uint32_t h = 0; h < work->faces.corner_count; h++)
        for (int k = 0; k < 3; k++) {
            double x = work->position[work->faces.corner[h]][k];
            low[k] = double_min(low[k], x);
            high[k] = double_max(high[k], x);
        }

    work->weld = options->weld > 0 ? (double)options->weld : (double)MESH_WELD * distance3(low, high);
    work->smallest = (double)options->smallest;

    // repairs
    mesh_weld(work);
    if (!work->no_memory) result = mesh_clean(work);
    if (!work->no_memory && !result) result = mesh_shrink(work);
    if (!work->no_memory && !result) result = mesh_junctions(work);
    if (!work->no_memory && !result && work->faces.count == 0)
        return refuse(work->error, SINGE_ERROR_MESH, "mesh", -1, "%s: no face has an area", short_name(work->name));
    if (!work->no_memory && !result) mesh_manifold(work);
    if (result || work->no_memory) return result;

    // quads
    bool all_quads = true, pair = options->quads == SINGE_MESH_PAIR;
    for (uint32_t f = 0; f < work->faces.count; f++)
        all_quads = all_quads && work->faces.first[f + 1] - work->faces.first[f] == 4;

    if (pair && !all_quads) {
        const Faces before = work->faces;
        uint32_t most = mesh_pair(work) && !work->no_memory ? 0 : UINT32_MAX;

        // pairing across polygons may leave a side with more than two quads
        uint32_t *order = most ? NULL : work_sorted_edges(work);
        for (uint32_t k = 0, size; order && k < work->faces.corner_count && most <= 2; k += size)
            most = size = work_edge_size(work, order, k);

        if (most > 2 || unsound_quad(work) != MESH_NONE) { // splits the old faces instead
            work->faces = before;
            work->report->count[MESH_PAIRED] = work->report->count[MESH_HALVED] = 0;
            pair = work->no_memory;
        }
    }

    if (!pair && !work->no_memory) split_faces(work);
    if (!work->no_memory) mesh_leave_out_copies(work); // two triangles on top of a quad become a copy of it
    if (work->no_memory) return SINGE_OK;

    uint32_t unsound = unsound_quad(work);
    if (unsound != MESH_NONE)
        return work_refuse(work, work->faces.origin[unsound],
                           "crosses itself, or is bent so that it cannot be cut into quads");
    mesh_order(work);
    return SINGE_OK;
}

SingeResult mesh_make(const char *name, const Polygons *polygons, const MeshOptions *options, SingeAllocator allocator,
                      Mesh *mesh, MeshReport *report, SingeError *error) {
    MeshReport ignored;
    Work work = {.name = name, .file = polygons, .report = report ? report : &ignored, .error = error};
    memset(mesh, 0, sizeof *mesh);
    mesh->allocator = allocator;

    SingeResult result = run_steps(&work, options);
    if (result == SINGE_ERROR_MESH && work.report->count[MESH_SHRUNK]) { // shrinking may be the cause
        MeshOptions kept = *options;
        kept.smallest = 0;
        work_free(&work);
        work = (Work){.name = name, .file = polygons, .report = work.report, .error = error};
        result = run_steps(&work, &kept);
    }

    if (!result && (work.no_memory || !hand_over(&work, mesh))) result = refuse_memory(error, "mesh", name);

    if (!result) { // leaves out redundant arrays: uv of corners without a seam, numbers that equal those of the file
        bool same = mesh->vertex_count == mesh->source_count, faces = true;
        for (uint32_t v = 0; v < mesh->vertex_count && same; v++) same = mesh->source[v] == (int32_t)v;
        for (uint32_t c = 0; c < mesh->cell_count && faces; c++) faces = mesh->cell_faces[c] == c;

        bool several = false; // some vertex of the sheet was several in the file
        for (size_t i = 0; mesh->corner_source && i < 4 * (size_t)mesh->cell_count; i++)
            several = several || mesh->corner_source[i] != mesh->source[mesh->cells[i]];
        if (mesh->corner_source && !(several && work.report->seam_vertices)) {
            store_free(mesh->allocator, mesh->corner_source, mesh->cell_count, 4 * sizeof *mesh->corner_source);
            mesh->corner_source = NULL;
        }

        if (same && !mesh->corner_source) {
            store_free(mesh->allocator, mesh->source, mesh->vertex_count, sizeof *mesh->source);
            mesh->source = NULL;
            store_free(mesh->allocator, mesh->became, mesh->source_count, sizeof *mesh->became);
            mesh->became = NULL;
        }

        if (faces) {
            store_free(mesh->allocator, mesh->cell_faces, mesh->cell_count, sizeof *mesh->cell_faces);
            mesh->cell_faces = NULL;
        }

        if (mesh->corner_uv && !work.report->seam_vertices) {
            store_free(mesh->allocator, mesh->corner_uv, mesh->cell_count, 8 * sizeof *mesh->corner_uv);
            mesh->corner_uv = NULL;
        }
    }

    work_free(&work);
    if (result) mesh_free(mesh);
    return result;
}
