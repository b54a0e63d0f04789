// What the samples share, so that each of them shows one thing: errors end the program, and paper and matches are a call.
#pragma once

#include <singe/mesh.h>
#include <singe/singe.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/// Ends the program with the sentence of an error, if there was one.
static inline void must(SingeResult result, const SingeError *error) {
    if (result == SINGE_OK) return;
    fprintf(stderr, "%s: %s\n", error->stage, error->message);
    exit(1);
}

/// The same for a call on a simulation, which keeps its last error.
#define TRY(sim, call) must(call, singe_sim_error(sim))

/// A simulation whose fire runs eight times as fast as a real one, and whose drawn surface is fine.
static inline SingeSim *sample_sim(SingeSimDef def) {
    SingeSim *sim;
    SingeError error;
    def.pace = 8, def.surface_detail = 1e-3f;
    must(singe_sim_create(&def, &sim, &error), &error);
    return sim;
}

/// A square of `cells` x `cells` cells and `side` m about the origin of the x-y plane, `height` m above it; material and
/// all else are those of `sheet`.
static inline SingeSheetId sample_sheet(SingeSim *sim, SingeSheetDef sheet, float side, uint32_t cells, float height) {
    SingeGridDef grid = singe_default_grid();
    grid.size[0] = grid.size[1] = side, grid.cells[0] = grid.cells[1] = cells;
    SingeMesh *mesh;
    SingeError error;
    must(singe_mesh_create_grid(&grid, &mesh, &error), &error);
    singe_mesh_fill_sheet(mesh, &sheet);
    float *lifted = malloc(3 * sizeof *lifted * sheet.vertex_count);
    if (!lifted) exit(1);
    for (uint32_t i = 0; i < 3 * sheet.vertex_count; i++) lifted[i] = sheet.positions[i] + (i % 3 == 2 ? height : 0);
    sheet.positions = lifted;
    SingeSheetId id;
    TRY(sim, singe_sim_add_sheet(sim, &sheet, &id));
    free(lifted);
    singe_mesh_destroy(mesh);
    return id;
}

/// Holds what lies within `radius` m of a point.
static inline SingePinId sample_pin(SingeSim *sim, SingeSheetId sheet, float x, float y, float z, float radius) {
    SingePinDef pin = singe_default_pin();
    pin.sheet = sheet, pin.point_count = 1, pin.points = (const float[]){x, y, z}, pin.radius = radius;
    SingePinId id;
    TRY(sim, singe_sim_add_pin(sim, &pin, &id));
    return id;
}

/// A table at z = 0.
static inline void sample_table(SingeSim *sim) {
    SingeColliderDef table = singe_default_collider();
    TRY(sim, singe_sim_add_collider(sim, &table, NULL));
}

/// A match that burns at a point for half a second.
static inline void sample_match(SingeSim *sim, float x, float y, float z) {
    SingeSourceDef match = singe_default_source();
    match.position[0] = x, match.position[1] = y, match.position[2] = z;
    match.radius = match.falloff = 0.01f, match.temperature = 1123, match.end = 0.5f;
    TRY(sim, singe_sim_add_source(sim, &match, NULL));
}
