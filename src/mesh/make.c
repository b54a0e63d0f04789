// The steps from polygons to quads, in their order, and the resulting mesh.
#include "mesh/work.h"

#include "common/store.h"

#include <math.h>
#include <string.h>

MeshOptions mesh_default_options(void) { return (MeshOptions){.quads = MESH_QUADS_PAIR, .smallest = MESH_SMALLEST}; }

enum { FACE_CORNERS_MAX = 4096 };

// ---- in

static void take_faces(Work *work) {
    const Polygons *file = work->file;
    Faces faces = work_faces(work, file->face_count, file->corner_count);
    if (work->no_memory) return;
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
}

static void take_vertices(Work *work) {
    const Polygons *file = work->file;
    const uint32_t count = file->vertex_count;
    const size_t attributes = work->attribute_count = file->attribute_count;
    work->vertex_capacity = work->vertex_count = count;
    work->position = work_new(work, count, sizeof *work->position);
    work->source = work_new(work, count, sizeof *work->source);
    work->became = work_sets(work, count);
    work->attributes = work_new(work, count * attributes, sizeof *work->attributes);
    for (uint32_t v = 0; v < count && !work->no_memory; v++) {
        for (size_t k = 0; k < 3; k++) work->position[v][k] = (double)file->positions[3 * (size_t)v + k];
        for (size_t k = 0; k < attributes; k++) work->attributes[v * attributes + k] = file->attributes[k].values[v];
        work->source[v] = (int32_t)v;
    }
}

/// The diagonal of the box around the vertices of faces.
static double size_of(const Work *work) {
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (uint32_t h = 0; h < work->faces.corner_count; h++)
        for (int k = 0; k < 3; k++) {
            double x = work->position[work->faces.corner[h]][k];
            low[k] = fmin(low[k], x), high[k] = fmax(high[k], x);
        }
    return distance3(low, high);
}

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

// ---- out

/// Numbers the remaining vertices in their order.
static uint32_t *number_vertices(Work *work, uint32_t *count) {
    uint32_t *number = work_new(work, work->vertex_count, sizeof *number);
    *count = 0;
    if (!number) return NULL;
    for (uint32_t h = 0; h < work->faces.corner_count; h++) number[work->faces.corner[h]] = 1;
    for (uint32_t v = 0; v < work->vertex_count; v++) number[v] = number[v] ? (*count)++ : MESH_NONE;
    return number;
}

static void count_unused(Work *work) {
    uint8_t *used = work_new(work, work->file->vertex_count, 1);
    if (!used) return;
    for (uint32_t i = 0; i < work->file->corner_count; i++) used[work->file->corners[i]] = 1;
    for (uint32_t v = 0; v < work->file->vertex_count; v++)
        if (!used[v]) work_did(work, MESH_UNUSED, 1, v);
}

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

/// A vertex gets the uv of its first corner. The uv of corners stay only if some vertex has several (simplify).
static void hand_over_uv(Work *work, const uint32_t *number, Mesh *mesh, uint8_t *has) {
    const Faces *faces = &work->faces;
    for (uint32_t h = 0; h < faces->corner_count; h++) {
        uint32_t v = number[faces->corner[h]];
        float *uv = mesh->uv + 2 * (size_t)v;
        if (!has[v]) memcpy(uv, faces->uv[h], 2 * sizeof *uv);
        else if (has[v] == 1 && (uv[0] != faces->uv[h][0] || uv[1] != faces->uv[h][1]))
            has[v] = 2, work->report->seam_vertices++;
        if (!has[v]) has[v] = 1;
    }
    memcpy(mesh->corner_uv, faces->uv, faces->corner_count * sizeof *faces->uv);
    memcpy(mesh->corner_source, faces->id, faces->corner_count * sizeof *faces->id);
}

static bool hand_over_arrays(Work *work, Mesh *mesh) {
    SingeAllocator a = mesh->allocator;
    const size_t vertices = mesh->vertex_count, cells = mesh->cell_count;
    mesh->positions = store_new(a, vertices, 3 * sizeof *mesh->positions);
    mesh->source = store_new(a, vertices, sizeof *mesh->source);
    mesh->became = store_new(a, mesh->source_count, sizeof *mesh->became);
    mesh->cells = store_new(a, cells, 4 * sizeof *mesh->cells);
    mesh->cell_faces = store_new(a, cells, sizeof *mesh->cell_faces);
    bool good = mesh->positions && mesh->source && mesh->became && mesh->cells && mesh->cell_faces;
    if (work->file->lines) good = (mesh->cell_lines = store_new(a, cells, sizeof *mesh->cell_lines)) && good;
    if (!work->file->uv) return good;
    mesh->uv = store_new(a, vertices, 2 * sizeof *mesh->uv);
    mesh->corner_uv = store_new(a, cells, 8 * sizeof *mesh->corner_uv);
    mesh->corner_source = store_new(a, cells, 4 * sizeof *mesh->corner_source);
    return good && mesh->uv && mesh->corner_uv && mesh->corner_source;
}

static bool hand_over(Work *work, Mesh *mesh) {
    const Faces *faces = &work->faces;
    uint32_t *number = number_vertices(work, &mesh->vertex_count);
    mesh->cell_count = faces->count;
    mesh->source_count = work->file->vertex_count;
    uint8_t *has = work_new(work, mesh->vertex_count, 1);
    if (work->no_memory || !hand_over_arrays(work, mesh) || !hand_over_attributes(work, number, mesh)) return false;
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
    if (mesh->uv) hand_over_uv(work, number, mesh, has);
    return true;
}

/// Leaves out redundant arrays: the uv of corners if there is no seam, and numbers that equal those of the file.
static void simplify(const Work *work, Mesh *mesh) {
    bool same = mesh->vertex_count == mesh->source_count, faces = true;
    for (uint32_t v = 0; v < mesh->vertex_count && same; v++) same = mesh->source[v] == (int32_t)v;
    for (uint32_t c = 0; c < mesh->cell_count && faces; c++) faces = mesh->cell_faces[c] == c;
    bool several = false; // some vertex of the sheet was several in the file
    for (size_t i = 0; mesh->corner_source && i < 4 * (size_t)mesh->cell_count; i++)
        several = several || mesh->corner_source[i] != mesh->source[mesh->cells[i]];
    if (mesh->corner_source && !(several && work->report->seam_vertices)) {
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
    if (mesh->corner_uv && !work->report->seam_vertices) {
        store_free(mesh->allocator, mesh->corner_uv, mesh->cell_count, 8 * sizeof *mesh->corner_uv);
        mesh->corner_uv = NULL;
    }
}

// ---- the steps

static bool all_quads(const Faces *faces) {
    for (uint32_t f = 0; f < faces->count; f++)
        if (faces->first[f + 1] - faces->first[f] != 4) return false;
    return true;
}

/// Whether no side has more than two quads. Pairing across polygons may cause this.
static bool sides_are_simple(Work *work) {
    uint32_t *order = work_sorted_edges(work);
    for (uint32_t k = 0, size; order && k < work->faces.corner_count; k += size)
        if ((size = work_edge_size(work, order, k)) > 2) return false;
    return true;
}

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
            longest = fmax(longest, length);
            shortest = fmin(shortest, length);
        }
        face_area(work, f, normal);
        if (!(sqrt(dot3(normal, normal)) > FACE_THIN * longest * longest && shortest > FACE_THIN * longest)) return f;
    }
    return MESH_NONE;
}

/// Joins triangles to quads. False, with the old faces restored, if that gives no valid sheet.
static bool pair_faces(Work *work) {
    const Faces faces = work->faces;
    if (mesh_pair(work) && !work->no_memory && sides_are_simple(work) && unsound_quad(work) == MESH_NONE) return true;
    work->faces = faces;
    work->report->count[MESH_PAIRED] = work->report->count[MESH_HALVED] = 0;
    return work->no_memory;
}

static SingeResult run_steps(Work *work, const MeshOptions *options) {
    *work->report = (MeshReport){
        .faces = work->file->face_count, .vertices = work->file->vertex_count, .lines = work->file->lines != NULL};
    SingeResult result = check_values(work);
    if (result) return result;
    take_vertices(work);
    take_faces(work);
    if (work->no_memory) return SINGE_OK;
    count_unused(work);
    work->weld = options->weld > 0 ? (double)options->weld : (double)MESH_WELD * size_of(work);
    work->smallest = (double)options->smallest;
    if (!work->no_memory) mesh_weld(work);
    if (!work->no_memory) result = mesh_clean(work);
    if (!work->no_memory && !result) result = mesh_shrink(work);
    if (!work->no_memory && !result) result = mesh_junctions(work);
    if (!work->no_memory && !result && work->faces.count == 0)
        return refuse(work->error, SINGE_ERROR_MESH, "mesh", -1, "%s: no face has an area", short_name(work->name));
    if (!work->no_memory && !result) mesh_manifold(work);
    if (result || work->no_memory) return result;
    bool pair = options->quads == MESH_QUADS_PAIR;
    if (pair && !all_quads(&work->faces)) pair = pair_faces(work);
    if (!pair && !work->no_memory) mesh_split(work);
    if (!work->no_memory) mesh_leave_out_copies(work); // two triangles on top of a quad become a copy of it
    if (work->no_memory) return SINGE_OK;
    uint32_t unsound = unsound_quad(work);
    if (unsound != MESH_NONE)
        return work_refuse(work, work->faces.origin[unsound],
                           "crosses itself, or is bent so that it cannot be cut into quads");
    if (!work->no_memory) mesh_order(work);
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
    if (!result) simplify(&work, mesh);
    work_free(&work);
    if (result) mesh_free(mesh);
    return result;
}
