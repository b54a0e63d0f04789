// A new field of a Def must be added here; a test counts the bytes that are missing.
#include "sim/snapshot_def.h"

#include "shell/sheet.h"

static void def_bool(Stream *stream, bool *value) {
    uint8_t byte = *value;
    STREAM(stream, byte);
    if (stream->mode == STREAM_READ) *value = byte != 0;
}

static void def_wind(Stream *stream, SingeWindDef *wind) {
    wind->struct_size = sizeof *wind;
    STREAM(stream, wind->velocity);
    STREAM(stream, wind->gust);
    STREAM(stream, wind->gust_time);
    STREAM(stream, wind->gust_size);
    STREAM(stream, wind->seed);
}

static void def_solver(Stream *stream, SingeSolverDef *solver) {
    solver->struct_size = sizeof *solver;
    STREAM(stream, solver->method);
    STREAM(stream, solver->substeps);
    STREAM(stream, solver->projections);
    STREAM(stream, solver->order);
    STREAM(stream, solver->regularisation);
    def_bool(stream, &solver->attachments);
    def_bool(stream, &solver->early_exit);
    STREAM(stream, solver->tolerance);
    STREAM(stream, solver->stiffness);
    STREAM(stream, solver->smoothing);
    STREAM(stream, solver->smoothing_length);
    STREAM(stream, solver->height_min);
    STREAM(stream, solver->height_gain);
    def_bool(stream, &solver->creases);
    def_bool(stream, &solver->tearing);
}

static void def_gas(Stream *stream, SingeGasDef *gas) {
    gas->struct_size = sizeof *gas;
    def_bool(stream, &gas->enabled);
    STREAM(stream, gas->cell_size);
    STREAM(stream, gas->height);
    STREAM(stream, gas->conductance);
    STREAM(stream, gas->radiated);
    STREAM(stream, gas->soot);
}

static void def_contact(Stream *stream, SingeContactDef *contact) {
    contact->struct_size = sizeof *contact;
    def_bool(stream, &contact->enabled);
    STREAM(stream, contact->thickness);
    STREAM(stream, contact->friction);
}

void snapshot_sim_def(Stream *stream, SingeSimDef *def) {
    STREAM(stream, def->seed);
    STREAM(stream, def->time_step);
    STREAM(stream, def->pace);
    STREAM(stream, def->gravity);
    STREAM(stream, def->ambient_temperature);
    STREAM(stream, def->air_density);
    STREAM(stream, def->heat_tolerance);
    def_wind(stream, &def->wind);
    def_solver(stream, &def->solver);
    STREAM(stream, def->surface_detail);
    STREAM(stream, def->surface_raggedness);
    def_gas(stream, &def->gas);
    def_contact(stream, &def->contact);
}

static void def_material(Stream *stream, SheetMaterial *material) {
    STREAM(stream, material->heat_operator);
    STREAM(stream, material->thickening);
    STREAM(stream, material->reference_grammage);
    def_bool(stream, &material->ablate);
}

void snapshot_sheet_def(Stream *stream, Sheet *sheet) {
    STREAM(stream, sheet->name);
    sheet->name[sizeof sheet->name - 1] = 0;
    STREAM(stream, sheet->vertex_count);
    STREAM(stream, sheet->cell_count);
    STREAM(stream, sheet->velocity);
    STREAM(stream, sheet->drop_pieces_below);
    STREAM(stream, sheet->source_count);
    def_material(stream, &sheet->material);
}

void snapshot_source_def(Stream *stream, SingeSourceDef *def) {
    def->struct_size = sizeof *def;
    STREAM(stream, def->kind);
    STREAM(stream, def->start);
    STREAM(stream, def->end);
    STREAM(stream, def->temperature);
    STREAM(stream, def->conductance);
    STREAM(stream, def->radius);
    STREAM(stream, def->falloff);
    STREAM(stream, def->path_count);
    STREAM(stream, def->flux);
}

void snapshot_collider_def(Stream *stream, SingeColliderDef *def) {
    def->struct_size = sizeof *def;
    STREAM(stream, def->kind);
    STREAM(stream, def->radius);
    STREAM(stream, def->half_size);
    STREAM(stream, def->height);
    STREAM(stream, def->friction);
    STREAM(stream, def->offset);
    STREAM(stream, def->temperature);
    STREAM(stream, def->conductance);
    STREAM(stream, def->contact_distance);
    STREAM(stream, def->path_count);
    STREAM(stream, def->sides);
    STREAM(stream, def->vertex_count);
    STREAM(stream, def->triangle_count);
    STREAM(stream, def->columns);
    STREAM(stream, def->rows);
    STREAM(stream, def->size);
}
