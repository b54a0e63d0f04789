// Reports of a simulation to its host's log. Errors are results, not lines: the log has what no result contains.
#include "sim/sim_internal.h"

#include "common/format.h"

static void sim_log(const SingeSim *sim, SingeLogLevel level, const char *format, ...) {
    const SingeLog *log = &sim->def.log;
    if (!log->write) return;
    char line[256];
    va_list list;
    va_start(list, format);
    text_print(line, sizeof line, format, list);
    va_end(list);
    log->write(log->context, level, line);
}

/// A sheet that falls farther than this within a substep, over its cells' size, stretches visibly where it is held.
static const float fall_max = 0.02f;

/// The stopping rules of the methods that iterate (docs/equations/paper-solver.md).
static void sim_log_solver(const SingeSim *sim) {
    const SingeSolverDef *solver = &sim->def.solver;
    double tolerance = (double)solver->tolerance;
    const char *each = solver->method == SINGE_SOLVER_ALL_AT_ONCE ? "system" : "colour";

    if (solver->method == SINGE_SOLVER_STRAND) {
        if (solver->substeps == 0)
            sim_log(sim, SINGE_LOG_INFO, "solver: %d substeps for the sheets' stiffness and load",
                    dynamics_plan_substeps(sim->dynamics));
        else if (dynamics_plan_substeps(sim->dynamics) != solver->substeps)
            sim_log(sim, SINGE_LOG_WARNING,
                    "solver: %d substeps instead of %d: with fewer, light sheets stretch in their plume and may tear",
                    dynamics_plan_substeps(sim->dynamics), solver->substeps);
        return;
    }

    if (solver->method == SINGE_SOLVER_MASS_SPRING) {
        sim_log(sim, SINGE_LOG_INFO, "solver: mass-spring, %g N/m, %d substeps", (double)solver->stiffness,
                dynamics_plan_substeps(sim->dynamics));
    } else if (solver->early_exit) {
        sim_log(sim, SINGE_LOG_INFO,
                "solver: up to %d projections a substep, ending when no %s has an error above %g of its lengths; "
                "conjugate gradients to a residual of %g, or to that error",
                solver->projections, each, tolerance, tolerance);
    } else {
        sim_log(sim, SINGE_LOG_INFO, "solver: %d projections a substep; conjugate gradients to a residual of %g",
                solver->projections, tolerance);
    }
}

void sim_log_commit(const SingeSim *sim) {
    SingeCounts counts = singe_sim_counts(sim);
    uint32_t springs = 0, strands = 0;
    for (int c = 0; c < SINGE_COLOUR_COUNT; c++) springs += counts.springs[c], strands += counts.strands[c];
    sim_log(sim, SINGE_LOG_INFO, "%u particles, %u springs in %u strands, %.3g MB", counts.particles, springs, strands,
            1e-6 * (double)counts.memory);

    // each sheet
    float h = sim->def.time_step / (float)dynamics_plan_substeps(sim->dynamics);
    float gravity = float3_length(float3_load(sim->def.gravity));
    for (uint32_t s = 0; s < sim->shell.sheet_count; s++) {
        const Sheet *sheet = &sim->shell.sheets[s];
        sim_log(sim, SINGE_LOG_INFO, "sheet %u: cells of %.3g mm; its fire front is widened %.3g times", s,
                1e3 * (double)sheet->cell_size, (double)sim->thickening[s]);

        if (sim->tear)
            sim_log(sim, SINGE_LOG_INFO,
                    "sheet %u: tears at line forces up to %.3g N/m; substeps of %.3g ms carry no more", s,
                    (double)shell_carried(&sim->shell, s, h), 1e3 * (double)h);
        if (gravity * h * h > fall_max * sheet->cell_size)
            sim_log(sim, SINGE_LOG_WARNING,
                    "sheet %u: a substep of %.3g ms is long for cells of %.3g mm: the sheet will stretch; "
                    "use more substeps or a smaller time step",
                    s, 1e3 * (double)h, 1e3 * (double)sheet->cell_size);
    }

    sim_log_solver(sim);
    if (sim->def.solver.tearing && !sim->tear)
        sim_log(sim, SINGE_LOG_WARNING, "tearing needs the solver's method `strand`: these sheets stay whole");
}

void sim_log_short_of_spares(SingeSim *sim) {
    if (sim->tear_warned) return;
    sim->tear_warned = true;
    sim_log(sim, SINGE_LOG_WARNING,
            "tearing: a sheet has used its reserve of vertices and tears no further (reported once)");
}

void sim_log_unconverged(SingeSim *sim) {
    if (sim->heat_warned) return;
    sim->heat_warned = true;
    sim_log(
        sim, SINGE_LOG_WARNING,
        "heat: conduction does not converge to heat_tolerance in 200 iterations; use a smaller time_step or pace, or "
        "a larger tolerance (reported once)");
}

void sim_log_contacts(SingeSim *sim, const CollisionCounters *contacts) {
    if (contacts->intersecting && !sim->intersecting_warned && sim->timers.steps == 0) {
        sim->intersecting_warned = true;
        const float *at = sim->shell.rest_position[sim->shell.cells[contacts->intersecting_first][0]];
        sim_log(sim, SINGE_LOG_WARNING,
                "contact: %u cells intersect or coincide with others as the simulation starts, one near (%.4g, %.4g, "
                "%.4g) m; contact between them is off until they separate",
                contacts->intersecting, (double)at[0], (double)at[1], (double)at[2]);
    }

    if (contacts->unresolved && !sim->crossing_warned) {
        sim->crossing_warned = true;
        sim_log(sim, SINGE_LOG_WARNING,
                "contact: at %.4g s cells could not be kept apart: pins pull them through each other, or they "
                "intersected initially (reported once)",
                sim->state.time);
    }

    if (contacts->dropped && !sim->crowd_warned) {
        sim->crowd_warned = true;
        sim_log(sim, SINGE_LOG_WARNING,
                "contact: at %.4g s there are more pairs than the lists can hold; sheets may cross (reported once)",
                sim->state.time);
    }
}

void sim_log_buried(const SingeSim *sim, uint32_t collider, double share, float depth, Float3 position) {
    sim_log(sim, SINGE_LOG_WARNING,
            "collider %u: %.3g %% of the sheets begin inside it, up to %.3g m deep, at (%.4g, %.4g, %.4g) m: the "
            "first step pushes them out, which stretches them",
            collider, 100 * share, (double)depth, (double)position.x, (double)position.y, (double)position.z);
}

void sim_log_missed(const SingeSim *sim, uint32_t pin, uint32_t sheet, const float *point, float distance) {
    sim_log(
        sim, SINGE_LOG_WARNING,
        "pin %u: its point [%.6g, %.6g, %.6g] m misses sheet \"%s\": it holds only the nearest vertex, which is %.3g m "
        "away",
        pin, (double)point[0], (double)point[1], (double)point[2], sim->sheets[sheet].sheet.name, (double)distance);
}

void sim_log_render_mesh(const SingeSim *sim, uint32_t sheet, uint32_t left_out, uint32_t odd_edges) {
    const char *name = sim->sheets[sheet].sheet.name;
    if (left_out)
        sim_log(sim, SINGE_LOG_WARNING,
                "render mesh of sheet \"%s\": triangles left out, as they have no area or the corners of another: %u",
                name, left_out);
    if (odd_edges)
        sim_log(
            sim, SINGE_LOG_WARNING,
            "render mesh of sheet \"%s\": edges of more than two triangles, or of two wound against each other, which are "
            "faults for `singe verify`: %u",
            name, odd_edges);
}

void sim_log_turned(const SingeSim *sim, uint32_t collider) {
    sim_log(sim, SINGE_LOG_INFO, "collider %u: its mesh was inside out and has been flipped", collider);
}
