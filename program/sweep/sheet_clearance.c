// Whether sheets of different rows stayed apart (method `sheets`), from the rows' caches.
//
// A row has two boxes in a frame. The sheets' box contains each vertex with the distance that it travels in half a
// frame, so the boxes of two frames contain everything in between. The gas's box contains the cells that are `hot`
// above the air or have flame. Rows are independent if no two boxes of sheets meet and no gas meets the sheets of
// another row.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "cli/folder.h"
#include "cli/text.h"
#include "formats/formats.h"
#include "sweep/box.h"
#include "sweep/sweep.h"

static const float hot = 20; ///< K

/// A row in a frame.
typedef struct RowBoxes {
    Box sheets, sheets_before, gas;
} RowBoxes;

/// The min distances of two rows.
typedef struct RowPair {
    double gap, gas_gap; ///< m
    int frame, gas_frame;
} RowPair;

typedef struct Apart {
    Sweep *sweep;
    uint32_t count; ///< of rows
    Folder *folders;
    RowBoxes *boxes;
    RowPair *pairs; ///< [count * (count - 1)/2]
    float fps, thickness, ambient;
} Apart;

// ---- boxes

static SingeResult read_sheets(const Apart *apart, const char *path, Box *box, SingeError *error) {
    Bytes bytes = {0};
    SingeSurface surface = {0};
    SingeResult result = file_read(path, (SingeAllocator){0}, &bytes, error);
    if (!result) result = ply_read_surface(path, bytes.data, bytes.size, (SingeAllocator){0}, &surface, NULL, error);
    bytes_free(&bytes);
    *box = box_empty();
    for (uint32_t v = 0; !result && v < surface.vertex_count; v++) {
        double around[3];
        for (int k = 0; k < 3; k++) around[k] = 0.5 * fabs((double)surface.velocity[v][k]) / (double)apart->fps;
        box_add(box, surface.position[v], around);
    }
    singe_surface_free(&surface);
    return result;
}

static SingeResult read_gas(const Apart *apart, const char *path, Box *box, SingeError *error) {
    Bytes bytes = {0};
    Gas gas = {0};
    *box = box_empty();
    if (!folder_has(path)) return SINGE_OK;
    SingeResult result = file_read(path, (SingeAllocator){0}, &bytes, error);
    if (!result) result = vdb_read_gas(path, bytes.data, bytes.size, (SingeAllocator){0}, &gas, NULL, error);
    bytes_free(&bytes);
    const SingeGas *view = &gas.view;
    const uint32_t *size = view->size;
    const double half = 0.5 * (double)view->cell;
    for (uint32_t z = 0, i = 0; !result && z < size[2]; z++)
        for (uint32_t y = 0; y < size[1]; y++)
            for (uint32_t x = 0; x < size[0]; x++, i++) {
                if (!(view->temperature[i] > apart->ambient + hot) && !(view->flame[i] > 0)) continue;
                const uint32_t cell[3] = {x, y, z};
                float centre[3];
                for (int k = 0; k < 3; k++) centre[k] = view->origin[k] + ((float)cell[k] + 0.5f) * view->cell;
                box_add(box, centre, (double[3]){half, half, half});
            }
    gas_free(&gas);
    return result;
}

static SingeResult read_row(Apart *apart, uint32_t row, int frame, SingeError *error) {
    RowBoxes *boxes = &apart->boxes[row];
    char *ply = folder_ply(&apart->folders[row], frame), *vdb = folder_vdb(&apart->folders[row], frame);
    boxes->sheets_before = boxes->sheets;
    SingeResult result = read_sheets(apart, ply, &boxes->sheets, error);
    if (!result) result = read_gas(apart, vdb, &boxes->gas, error);
    free(ply), free(vdb);
    return result;
}

// ---- pairs

static void compare(RowPair *pair, const RowBoxes *a, const RowBoxes *b, int frame) {
    const Box one = box_union(&a->sheets, &a->sheets_before), other = box_union(&b->sheets, &b->sheets_before);
    const double gap = box_gap(&one, &other), gas = fmin(box_gap(&a->gas, &other), box_gap(&b->gas, &one));
    if (gap < pair->gap) {
        pair->gap = gap;
        pair->frame = frame;
    }
    if (gas < pair->gas_gap) {
        pair->gas_gap = gas;
        pair->gas_frame = frame;
    }
}

static SingeResult compare_frames(Apart *apart, SingeError *error) {
    SingeResult result = SINGE_OK;
    const int frames = (int)apart->sweep->frames[0];
    for (int frame = 1; frame <= frames && !result; frame++) {
        for (uint32_t row = 0; row < apart->count && !result; row++) result = read_row(apart, row, frame, error);
        RowPair *pair = apart->pairs;
        for (uint32_t i = 0; i < apart->count && !result; i++)
            for (uint32_t j = 0; j < i; j++) compare(pair++, &apart->boxes[i], &apart->boxes[j], frame);
    }
    return result;
}

// ---- report

static void write_gap(FILE *file, double gap, int frame) {
    if (isfinite(gap)) fprintf(file, ",%.6g,%d", gap, frame);
    else fputs(",,", file);
}

/// Writes apart.csv; returns the number of pairs that met.
static uint32_t report_pairs(const Apart *apart, FILE *file) {
    const RowPair *pair = apart->pairs;
    uint32_t met = 0;
    fputs("row,other_row,sheets_gap_m,sheets_frame,gas_gap_m,gas_frame\n", file);
    for (uint32_t i = 0; i < apart->count; i++)
        for (uint32_t j = 0; j < i; j++, pair++) {
            fprintf(file, "%u,%u", j + 1, i + 1);
            write_gap(file, pair->gap, pair->frame), write_gap(file, pair->gas_gap, pair->gas_frame);
            fputc('\n', file);
            const bool sheets = pair->gap <= (double)apart->thickness, gas = pair->gas_gap <= 0;
            if (!sheets && !gas) continue;
            console_error(apart->sweep->console,
                          "rows %u and %u do not stay apart: %s in frame %d; a larger margin joins them", j + 1, i + 1,
                          sheets ? "boxes of their sheets meet" : "hot gas of one meets the other's sheets",
                          sheets ? pair->frame : pair->gas_frame);
            met++;
        }
    return met;
}

static bool write_pairs(const Apart *apart, uint32_t *met) {
    char *path = text_format("%s/apart.csv", apart->sweep->folder), *text = NULL;
    size_t size = 0;
    SingeError error = {.code = SINGE_ERROR_MEMORY, .stage = "report", .element = -1};
    FILE *file = open_memstream(&text, &size);
    if (file) *met = report_pairs(apart, file);
    const bool good = text_stream_end(file, &text) && !file_write(path, text, size, &error);
    if (!good) console_result(apart->sweep->console, &error);
    free(text), free(path);
    return good;
}

// ---- all

static bool open_apart(Apart *apart) {
    const Sweep *sweep = apart->sweep;
    const size_t pairs = (size_t)apart->count * (apart->count - 1) / 2;
    apart->folders = calloc(apart->count, sizeof *apart->folders);
    apart->boxes = calloc(apart->count, sizeof *apart->boxes);
    apart->pairs = calloc(pairs + 1, sizeof *apart->pairs);
    if (!apart->folders || !apart->boxes || !apart->pairs) return false;
    for (uint32_t row = 0; row < apart->count; row++) {
        char *path = sweep_row_folder(sweep, row, true);
        apart->folders[row] = folder_name(path, sweep->name);
        apart->boxes[row].sheets = box_empty();
        free(path);
    }
    for (size_t i = 0; i < pairs; i++)
        apart->pairs[i] = (RowPair){.gap = (double)INFINITY, .gas_gap = (double)INFINITY};
    return true;
}

static void close_apart(Apart *apart) {
    for (uint32_t row = 0; row < apart->count && apart->folders; row++) folder_free(&apart->folders[row]);
    free(apart->folders), free(apart->boxes), free(apart->pairs);
}

bool sweep_sheet_clearance(Sweep *sweep) {
    Apart apart = {.sweep = sweep, .count = sweep->plan.row_count};
    Job job;
    SetList none = {0};
    char *first = sweep_row_folder(sweep, 0, true);
    const ExitCode code = job_reopen(&job, sweep->console, first, &none, 1);
    free(first);
    if (code) return false;
    apart.fps = job.scene->fps;
    apart.ambient = job.scene->sim.ambient_temperature;
    apart.thickness = job.scene->sim.contact.enabled ? job.scene->sim.contact.thickness : 0;
    job_close(&job);

    SingeError error = {.code = SINGE_ERROR_MEMORY, .element = -1, .message = "out of memory"};
    uint32_t met = 0;
    bool good = open_apart(&apart) && !compare_frames(&apart, &error);
    if (good) good = write_pairs(&apart, &met);
    else console_result(sweep->console, &error);
    close_apart(&apart);
    return good && !met;
}
