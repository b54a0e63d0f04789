// The tables of Defs (singe/*.def) say which fields are stored, and in which order.
#include "sim/snapshot_def.h"

#include "common/def_table.h"

#include <string.h>

static void def_whole(Stream *stream, const DefTable *table, void *def, size_t size) {
    memcpy(def, &size, sizeof size);
    def_stream(stream, table, def, 0, size);
}

void snapshot_sim_def(Stream *stream, SingeSimDef *def) {
    const size_t surface = offsetof(SingeSimDef, surface_detail);
    def_stream(stream, &sim_table, def, 0, surface);
    def_whole(stream, &wind_table, &def->wind, sizeof def->wind);
    def_whole(stream, &solver_table, &def->solver, sizeof def->solver);
    def_stream(stream, &sim_table, def, surface, sizeof *def);
    def_whole(stream, &gas_table, &def->gas, sizeof def->gas);
    def_whole(stream, &contact_table, &def->contact, sizeof def->contact);
}

void snapshot_sheet_def(Stream *stream, Sheet *sheet) {
    STREAM(stream, sheet->name);
    sheet->name[sizeof sheet->name - 1] = 0;
    STREAM(stream, sheet->vertex_count);
    STREAM(stream, sheet->cell_count);
    STREAM(stream, sheet->velocity);
    STREAM(stream, sheet->drop_pieces_below);
    STREAM(stream, sheet->source_count);

    // its material
    SheetMaterial *material = &sheet->material;
    STREAM(stream, material->heat_operator);
    STREAM(stream, material->thickening);
    STREAM(stream, material->reference_grammage);

    uint8_t ablate = material->ablate;
    STREAM(stream, ablate);
    if (stream->mode == STREAM_READ) material->ablate = ablate != 0;
}

void snapshot_source_def(Stream *stream, SingeSourceDef *def) { def_whole(stream, &source_table, def, sizeof *def); }

void snapshot_collider_def(Stream *stream, SingeColliderDef *def) {
    def_whole(stream, &collider_table, def, sizeof *def);
}
