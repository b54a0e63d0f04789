// OFF: counts, a line of text for each vertex, then one for each face. Further values of a line (colours, normals or
// texture coordinates) are ignored.
#include "formats/mesh_reader.h"
#include "formats/scan.h"
#include "common/store.h"

/// The header word may state what vertices have besides their positions: "OFF", "COFF", "STCNOFF".
static SingeResult off_header(Scan *scan) {
    if (!scan_to_word(scan, '#')) return scan_refuse(scan, SINGE_ERROR_FORMAT, "the file has nothing but comments");
    const uint8_t *at = scan->text.at, *end = text_word_end(&scan->text);
    if (end - at > 2 && at[0] == 'S' && at[1] == 'T') at += 2;
    if (at < end && *at == 'C') at++;
    if (at < end && *at == 'N') at++;
    if (!text_word_is(at, end, "OFF"))
        return scan_refuse(scan, SINGE_ERROR_FORMAT, "not an OFF file: its header is unknown");
    scan->text.at = end;
    if (!scan_to_word(scan, '#')) return scan_refuse(scan, SINGE_ERROR_FORMAT, "the file ends too soon");
    if (text_word_is(scan->text.at, text_word_end(&scan->text), "BINARY"))
        return scan_refuse(scan, SINGE_ERROR_FORMAT, "binary OFF is not supported");
    return SINGE_OK;
}

// Counts are checked against the size of the file before memory is allocated.
static SingeResult off_counts(Scan *scan, Polygons *mesh) {
    int64_t vertices, faces, sides;
    TRY(scan_count(scan, &vertices));
    TRY(scan_count(scan, &faces));
    text_skip_blanks(&scan->text);
    if (!text_at_line_end(&scan->text) && *scan->text.at != '#') TRY(scan_count(scan, &sides)); // never needed
    if (vertices == 0) return scan_refuse(scan, SINGE_ERROR_FORMAT, "the file has no vertices");
    if (faces == 0) return scan_refuse(scan, SINGE_ERROR_FORMAT, "the file has no faces");
    int64_t left = scan->text.end - scan->text.at; // below 2^31: at least "0 0 0" and "3 0 0 0", and line ends
    if (vertices > left / 6 || faces > left / 8 || 6 * vertices + 8 * faces > left)
        return scan_refuse(scan, SINGE_ERROR_FORMAT, "the file is too short for its %lld vertices and %lld faces",
                           (long long)vertices, (long long)faces);
    mesh->vertex_count = (uint32_t)vertices;
    mesh->face_count = (uint32_t)faces;
    mesh->positions = store_new(scan->allocator, mesh->vertex_count, 3 * sizeof *mesh->positions);
    mesh->first = store_new(scan->allocator, (size_t)mesh->face_count + 1, sizeof *mesh->first);
    mesh->lines = store_new(scan->allocator, mesh->face_count, sizeof *mesh->lines);
    if (!mesh->positions || !mesh->first || !mesh->lines) return refuse_memory(scan->error, "off", scan->name);
    return SINGE_OK;
}

/// Moves to the next line that is not empty.
static SingeResult off_next_line(Scan *scan) {
    text_next_line(&scan->text);
    return scan_to_word(scan, '#') ? SINGE_OK : scan_refuse(scan, SINGE_ERROR_FORMAT, "the file ends too soon");
}

static SingeResult off_face(Scan *scan, Polygons *mesh, size_t *capacity) {
    int64_t count, vertex;
    TRY(scan_count(scan, &count));
    if (count < 3)
        return scan_refuse(scan, SINGE_ERROR_MESH, "face has %lld corner%s; it needs three", (long long)count,
                           count == 1 ? "" : "s");
    for (; count; count--) {
        TRY(scan_count(scan, &vertex));
        if (vertex >= mesh->vertex_count)
            return scan_refuse(scan, SINGE_ERROR_MESH, "vertex index %lld is out of range: the file has %u vertices",
                               (long long)vertex, mesh->vertex_count);
        if (!store_grow(scan->allocator, &mesh->corners, capacity, (size_t)mesh->corner_count + 1,
                        sizeof *mesh->corners))
            return refuse_memory(scan->error, "off", scan->name);
        mesh->corners[mesh->corner_count++] = (uint32_t)vertex;
    }
    return SINGE_OK;
}

static SingeResult off_body(Scan *scan, Polygons *mesh, size_t *capacity) {
    for (size_t v = 0; v < mesh->vertex_count; v++) {
        TRY(off_next_line(scan));
        for (size_t i = 0; i < 3; i++) TRY(scan_float(scan, &mesh->positions[3 * v + i]));
    }
    for (size_t f = 0; f < mesh->face_count; f++) {
        TRY(off_next_line(scan));
        mesh->first[f] = mesh->corner_count;
        mesh->lines[f] = (uint32_t)scan->text.line;
        TRY(off_face(scan, mesh, capacity));
    }
    mesh->first[mesh->face_count] = mesh->corner_count;
    text_next_line(&scan->text);
    if (scan_to_word(scan, '#'))
        return scan_refuse(scan, SINGE_ERROR_FORMAT, "there is data after the %u vertices and %u faces of the header",
                           mesh->vertex_count, mesh->face_count);
    return SINGE_OK;
}

SingeResult off_read(const char *name, const uint8_t *bytes, size_t size, SingeAllocator allocator, Polygons *mesh,
                     SingeError *error) {
    memset(mesh, 0, sizeof *mesh);
    mesh->allocator = allocator;
    Scan scan = {name, "off", bytes, {bytes, bytes + size, 1}, allocator, error};
    size_t capacity = 0;
    if (size == 0) return scan_refuse(&scan, SINGE_ERROR_FORMAT, "the file is empty");
    if (size > MESH_COUNT_LIMIT) return scan_refuse(&scan, SINGE_ERROR_LIMIT, "the file is too large");
    SingeResult result = off_header(&scan);
    if (!result) result = off_counts(&scan, mesh);
    if (!result) result = off_body(&scan, mesh, &capacity);
    if (!result && !store_trim(allocator, &mesh->corners, &capacity, mesh->corner_count, sizeof *mesh->corners))
        result = refuse_memory(error, "off", name);
    if (result) {
        store_free(allocator, mesh->corners, capacity, sizeof *mesh->corners);
        mesh->corners = NULL;
        polygons_free(mesh);
    }
    return result;
}
