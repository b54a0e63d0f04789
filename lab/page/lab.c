#include "page/lab.h"

#include <math.h>
#include <stdlib.h>

#include "bench/geometry.h"
#include "bench/hung_sheet.h"
#include "common/float3.h"
#include "common/order.h"

// ---- scenes

SingeResult play_open(Play *play, Lab *lab, const char *scene, const char *const *sets, SingeError *error) {
    SetList list = {0};
    *play = (Play){.lab = lab};
    if (lab->quick) set_add(&list, "preview.size=[320, 240]"), set_add(&list, "preview.samples=4");
    for (; sets && *sets; sets++)
        if (**sets) set_add(&list, *sets);

    char *path = text_format("%s/%s", lab->scenes, scene);
    lab->console.quiet = true; // suppress the scene's own messages
    ExitCode code = job_open(&play->job, &lab->console, path, &list, lab->threads);
    if (!code) code = job_build(&play->job, &lab->console, &play->sim);
    lab->console.quiet = false;
    set_free(&list);

    if (code) {
        *error = (SingeError){.code = SINGE_ERROR_FORMAT, .element = -1};
        snprintf(error->message, sizeof error->message, "%s cannot be used", path);
    }
    free(path);
    return code ? SINGE_ERROR_FORMAT : SINGE_OK;
}

void lab_usual_compliance(char *set, size_t size) {
    const SingeMaterialDef usual = singe_default_material();
    const SingeParam *c = usual.compliance;
    snprintf(set, size, "sheets.0.material.compliance={red: %.9g, green: %.9g, blue: %.9g, yellow: %.9g}",
             (double)c[SINGE_RED].value, (double)c[SINGE_GREEN].value, (double)c[SINGE_BLUE].value,
             (double)c[SINGE_YELLOW].value);
}

SingeResult play_until(Play *play, double time, SingeError *error) {
    while (singe_sim_view(play->sim).time < time - 1e-9) {
        SingeResult result = singe_sim_step(play->sim);
        if (!result) continue;
        *error = *singe_sim_error(play->sim);
        return result;
    }

    return SINGE_OK;
}

SingeResult play_surface(Play *play, SingeError *error) {
    SingeResult result = singe_sim_surface(play->sim, &play->surface);
    if (result) *error = *singe_sim_error(play->sim);
    return result;
}

static const uint8_t *draw(Play *play, int size[2], SingeError *error) {
    if (!play->pictures && pictures_open(&play->job, &play->pictures, error)) return NULL;
    if (play_surface(play, error)) return NULL;
    SingeGas gas = singe_sim_gas(play->sim);
    pictures_size(play->pictures, &size[0], &size[1]);
    double time = singe_sim_view(play->sim).time;
    return pictures_draw(play->pictures, &play->surface, gas.size[0] ? &gas : NULL, time, error);
}

SingeResult play_draw(Play *play, uint8_t **rgb, int size[2], SingeError *error) {
    *rgb = NULL;
    const uint8_t *drawn = draw(play, size, error);
    if (!drawn) return error->code ? error->code : SINGE_ERROR_STATE;
    size_t bytes = (size_t)size[0] * (size_t)size[1] * 3;
    if ((*rgb = malloc(bytes))) memcpy(*rgb, drawn, bytes);
    return *rgb ? SINGE_OK : SINGE_ERROR_MEMORY;
}

SingeResult play_shoot(Play *play, const char *caption, SingeError *error) {
    int size[2];
    const uint8_t *drawn = draw(play, size, error);
    if (!drawn) return error->code ? error->code : SINGE_ERROR_STATE;
    report_picture(play->lab->report, caption, size[0], size[1], drawn);
    return SINGE_OK;
}

SingeResult play_shoot_at(Play *play, double time, SingeError *error) {
    char caption[40];
    snprintf(caption, sizeof caption, "%.1f s", time);
    SingeResult result = play_until(play, time, error);
    return result ? result : play_shoot(play, caption, error);
}

void play_close(Play *play) {
    singe_surface_free(&play->surface);
    pictures_close(play->pictures);
    singe_sim_destroy(play->sim);
    job_close(&play->job);
    *play = (Play){0};
}

// ---- grids

LabGrid lab_grid(int across, int along, float cell) {
    LabGrid grid = {.cells = {across, along},
                    .sides = {(float)across * cell, (float)along * cell},
                    .material = singe_default_material(),
                    .solver = singe_default_solver(),
                    .time_step = singe_default_sim().time_step,
                    .pace = 1};
    sheet_inert(&grid.material);
    return grid;
}

/// Adds the grid's mesh with its attributes.
static SingeResult add_grid(const LabGrid *grid, SingeSim *sim, SingeError *error) {
    SingeSheetDef sheet = singe_default_sheet();
    SingeSheetId id;
    Mesh mesh = {0};
    const uint32_t nx = (uint32_t)grid->cells[0], ny = (uint32_t)grid->cells[1];
    SingeResult result = mesh_grid(grid->sides[0], grid->sides[1], nx, ny, (SingeAllocator){0}, &mesh, error);

    if (result) return result;
    mesh_grid_wear(&mesh, nx, ny, &(GridWear){.jitter = grid->jitter});
    float *field = malloc(mesh.vertex_count * sizeof *field);
    for (uint32_t v = 0; v < mesh.vertex_count && field; v++) {
        float *p = mesh.positions + 3 * (size_t)v;
        for (int k = 0; k < 2; k++) p[k] += grid->sides[k] / 2;
        field[v] = grid->field ? (float)grid->field(grid->context, (double)p[0], (double)p[1]) : 0;
    }

    // drops cells, and vertices without cells
    if (grid->inside) {
        uint32_t cells = 0, vertices = 0, *number = calloc(mesh.vertex_count, sizeof *number);
        for (uint32_t c = 0; c < mesh.cell_count && number; c++) {
            uint32_t *corner = mesh.cells + 4 * (size_t)c;
            const float *p = mesh.positions + 3 * (size_t)corner[0], *q = mesh.positions + 3 * (size_t)corner[2];
            if (!grid->inside((double)(p[0] + q[0]) / 2, (double)(p[1] + q[1]) / 2)) continue;
            for (int k = 0; k < 4; k++) number[mesh.cells[4 * (size_t)cells + (size_t)k] = corner[k]] = 1;
            cells++;
        }

        for (uint32_t v = 0; v < mesh.vertex_count && number; v++) {
            if (!number[v]) continue;
            memmove(mesh.positions + 3 * (size_t)vertices, mesh.positions + 3 * (size_t)v, 3 * sizeof(float));
            memmove(mesh.uv + 2 * (size_t)vertices, mesh.uv + 2 * (size_t)v, 2 * sizeof(float));
            number[v] = vertices++;
        }

        for (size_t i = 0; i < 4 * (size_t)cells; i++) mesh.cells[i] = number[mesh.cells[i]];
        if (number) {
            mesh.cell_count = cells;
            mesh.vertex_count = vertices;
        }
        free(number);
    }

    const SingeAttribute attributes[] = {{"field", field}, {"mass", grid->mass ? grid->mass : field}};

    sheet.material = grid->material;
    sheet.vertex_count = mesh.vertex_count;
    sheet.positions = mesh.positions;
    sheet.uv = mesh.uv;
    sheet.cell_count = mesh.cell_count;
    sheet.cells = mesh.cells;
    sheet.attribute_count = 2;
    sheet.attributes = attributes;
    result = field ? singe_sim_add_sheet(sim, &sheet, &id) : SINGE_ERROR_MEMORY;
    if (!result) result = singe_sim_commit(sim);
    if (result) *error = *singe_sim_error(sim);
    free(field);
    mesh_free(&mesh);

    return result;
}

SingeResult lab_build(const Lab *lab, const LabGrid *grid, SingeSim **sim, SingeError *error) {
    SingeSimDef def = singe_default_sim();
    def.thread_count = lab->threads;
    def.time_step = grid->time_step;
    def.solver = grid->solver;
    def.gravity[2] = -grid->gravity;
    def.air_density = 0;
    def.pace = grid->pace;
    TRY(singe_sim_create(&def, sim, error));

    SingeResult result = add_grid(grid, *sim, error);
    if (result) singe_sim_destroy(*sim), *sim = NULL;
    return result;
}

SingeResult lab_steps(SingeSim *sim, int count, SingeError *error) {
    SingeResult result = SINGE_OK;
    for (int step = 0; step < count && !result; step++) result = singe_sim_step(sim);
    if (result) *error = *singe_sim_error(sim);
    return result;
}

void lab_sets_mass(SingeMaterialDef *material) {
    material->temperature = singe_param(600);
    material->ignition_temperature = singe_param(500);
    material->rate_ceiling = singe_param(1e6f);
    material->air_supply = singe_param(INFINITY);
    material->mass_rate = singe_param(0.1f);
    material->ash_exponent = singe_param(0);
    material->ash_density = singe_param(1);
    material->shrink_front = material->shrink_back = material->fibre_shrink = singe_param(1);

    static const SingeField mass = {.kind = SINGE_FIELD_ATTRIBUTE, .attribute = "mass"};
    material->mass_min = singe_param_field(0, 1, &mass);
    material->mass_loss = material->char_yield = singe_param(0);
}

// ---- shapes

double shape_angle(const SingeView *view, uint32_t a, uint32_t b) {
    double n[3], m[3];
    geometry_normal(view, a, n);
    geometry_normal(view, b, m);
    unit3(n);
    unit3(m);
    return acos(fmin(1, fmax(-1, dot3(n, m))));
}

double shape_bend(const SingeView *view) {
    double sum = 0, count = 0;
    for (uint32_t s = 0; s < view->spring_count[SINGE_GREEN]; s++) {
        if (!(view->spring_flags[SINGE_GREEN][s] & SINGE_ALIVE)) continue;
        const uint32_t *end = view->springs[SINGE_GREEN][s];
        double angle = shape_angle(view, end[0] - view->vertex_count, end[1] - view->vertex_count);
        sum += angle * angle, count++;
    }

    return count > 0 ? sqrt(sum / count) * 180 / acos(-1) : 0;
}

void shape_bounds(const SingeView *view, double low[3], double high[3]) {
    for (int k = 0; k < 3; k++) low[k] = INFINITY, high[k] = -INFINITY;
    for (uint32_t v = 0; v < view->vertex_count; v++) {
        if (!(view->particle_flags[v] & SINGE_ALIVE)) continue;
        for (int k = 0; k < 3; k++) {
            low[k] = fmin(low[k], (double)view->position[v][k]);
            high[k] = fmax(high[k], (double)view->position[v][k]);
        }
    }
}

double shape_left(const SingeView *view) {
    double left = 0;
    for (uint32_t c = 0; c < view->cell_count; c++) left += view->cell_flags[c] & SINGE_ALIVE ? 1 : 0;
    return left / view->cell_count;
}

int shape_pieces(const SingeView *view, double share) {
    enum { MAX = 4096 };
    static const double none = 0;
    double *area = calloc(MAX, sizeof *area), all = none;
    int count = 0;

    for (uint32_t i = view->vertex_count; area && i < view->particle_count; i++) {
        all += (double)view->area[i];
        if (view->particle_flags[i] & SINGE_ALIVE && view->piece[i] >= 0)
            area[view->piece[i] % MAX] += (double)view->area[i];
    }

    for (int p = 0; area && p < MAX; p++) count += area[p] >= share * all && area[p] > 0;
    free(area);
    return count;
}

typedef struct Edge {
    uint32_t low, high;
} Edge;

double shape_border(const SingeSurface *surface) {
    const size_t count = 3 * (size_t)surface->triangle_count;
    float(*rest)[3] = surface->rest_position;
    Edge *edges = malloc((count + 1) * sizeof *edges);
    double length = 0, area = 0;

    for (uint32_t t = 0; edges && t < surface->triangle_count; t++) {
        const uint32_t *c = surface->triangles[t];
        for (int k = 0; k < 3; k++) {
            uint32_t a = c[k], b = c[(k + 1) % 3];
            edges[3 * (size_t)t + (size_t)k] = a < b ? (Edge){a, b} : (Edge){b, a};
        }
        double twice[3];
        area3(rest[c[0]], rest[c[1]], rest[c[2]], twice);
        area += 0.5 * sqrt(dot3(twice, twice));
    }

    if (edges) qsort(edges, count, sizeof *edges, order_by_two);
    for (size_t i = 0, j; edges && i < count; i = j) {
        for (j = i + 1; j < count && order_by_two(&edges[i], &edges[j]) == 0;) j++;
        if (j == i + 1) length += distance_of(rest[edges[i].low], rest[edges[i].high]);
    }
    free(edges);
    return area > 0 ? length / sqrt(area) : NAN;
}

// ---- spectrum

/// Adds the power of a line of heights: the angle to the rest plane, without its mean and slope, under a Hann window;
/// the power of the height follows from that of its slope by (wavelength/2 pi)^2.
static void add_line(const SingeView *view, uint32_t first, uint32_t stride, int count, double cell, double *line,
                     ShapeSpectrum *spectrum) {
    const double pi = acos(-1);
    for (int i = 0; i < count; i++) {
        const float *p = view->position[first + (uint32_t)i * stride];
        const float *q = view->position[first + (uint32_t)(i + 1) * stride];
        double x = (double)q[0] - (double)p[0], y = (double)q[1] - (double)p[1], z = (double)q[2] - (double)p[2];
        line[i] = atan2(z, sqrt(x * x + y * y));
    }

    geometry_window(line, count);
    for (int k = 1; k <= count / 2; k++) {
        const double wave = count * cell / k;
        const int band = (int)floor(2 * log2(wave / (2 * cell)) + 1e-9);
        if (band < 0 || band >= SHAPE_BANDS) continue;

        // a wave's mean square is 2 |c_k|^2/n^2, and the window keeps 3/8 of it
        const double power = 2 * geometry_power(line, count, k) / ((double)count * count) / 0.375;
        spectrum->height[band] += power * wave * wave / (4 * pi * pi);
    }
}

SingeResult shape_spectrum(const SingeView *view, int across, int along, double cell, ShapeSpectrum *spectrum) {
    *spectrum = (ShapeSpectrum){0};
    double *line = malloc((size_t)(across > along ? across : along) * sizeof *line);
    if (!line) return SINGE_ERROR_MEMORY;

    const uint32_t row = (uint32_t)across + 1;
    for (int j = 0; j <= along; j++) add_line(view, (uint32_t)j * row, 1, across, cell, line, spectrum);
    for (int i = 0; i <= across; i++) add_line(view, (uint32_t)i, row, along, cell, line, spectrum);

    for (int b = 0; b < SHAPE_BANDS; b++) {
        spectrum->wave[b] = 2 * cell * pow(2, (b + 0.5) / 2);
        int waves = 0; // integer numbers of waves on a line that lie in the band
        for (int k = 1; k <= across / 2; k++) waves += (int)floor(2 * log2(across / (2.0 * k)) + 1e-9) == b;
        spectrum->height[b] = waves ? sqrt(spectrum->height[b] / (across + along + 2)) : (double)NAN;
    }

    free(line);
    return SINGE_OK;
}

// ---- heat on a still sheet: the grid on which it is measured, and how fast a hot spot spreads.

LabGrid warm_grid(int across, int along, float cell, SingeHeatOperator operator) {
    LabGrid grid = lab_grid(across, along, cell);
    grid.material.heat_operator = operator;
    grid.material.diffusivity = singe_param((float)WARM_DIFFUSIVITY);
    grid.material.ignition_temperature = singe_param(5000);
    static const SingeField field = {.kind = SINGE_FIELD_ATTRIBUTE, .attribute = "field"};
    grid.material.temperature = singe_param_field((float)WARM_MEAN, (float)(WARM_MEAN + WARM_AMPLITUDE), &field);
    grid.solver.substeps = 1; // nothing moves
    return grid;
}

// ---- a hot spot: its variance grows by 2 alpha t

static double spot(const void *context, double x, double y) {
    const double *centre = context;
    return 2 * exp(-(pow(x - centre[0], 2) + pow(y - centre[1], 2)) / (2 * centre[2] * centre[2]));
}

/// Variances along x and y of both layers' temperature rise, weighted by area.
static void variances(const SingeView *view, double out[2]) {
    double sum = 0, mean[2] = {0}, square[2] = {0};
    for (uint32_t i = 0; i < view->particle_count; i++) {
        double w = (double)view->area[i] * ((double)view->temperature[i] - WARM_MEAN);
        sum += w;
        for (int k = 0; k < 2; k++) {
            double x = (double)view->rest_position[i][k];
            mean[k] += w * x;
            square[k] += w * x * x;
        }
    }

    for (int k = 0; k < 2; k++) out[k] = square[k] / sum - pow(mean[k] / sum, 2);
}

SingeResult spot_spread(Lab *lab, const SpotMesh *mesh, SingeHeatOperator operator, double ratio[2],
                        SingeError *error) {
    const double centre[3] = {(double)mesh->sides[0] / 2, (double)mesh->sides[1] / 2, 0.008}, seconds = 0.4;
    LabGrid grid = warm_grid(mesh->cells[0], mesh->cells[1], 1, operator);
    grid.sides[0] = mesh->sides[0];
    grid.sides[1] = mesh->sides[1];
    grid.jitter = mesh->jitter;
    grid.field = spot;
    grid.context = centre;
    grid.time_step = 0.004f;
    grid.material.thickness = singe_param(1e-4f);

    SingeSim *sim;
    TRY(lab_build(lab, &grid, &sim, error));

    SingeView view = singe_sim_view(sim);
    double before[2], after[2];
    variances(&view, before);
    SingeResult result = lab_steps(sim, (int)lround(seconds / 0.004), error);
    variances(&view, after);
    for (int k = 0; k < 2; k++) ratio[k] = (after[k] - before[k]) / (2 * WARM_DIFFUSIVITY * seconds);
    singe_sim_destroy(sim);
    return result;
}

// ---- textures

void texture_show(Lab *lab, const SingeTexture *picture) {
    uint8_t *rgb = malloc((size_t)picture->width * (size_t)picture->height * 3);
    for (int i = 0; rgb && i < picture->width * picture->height; i++)
        for (int k = 0; k < 3; k++) rgb[3 * i + k] = (uint8_t)lrintf(255 * fminf(1, fmaxf(0, picture->values[i])));
    if (rgb) report_picture(lab->report, "the texture", picture->width, picture->height, rgb);
    free(rgb);
}

double texture_mean(const SingeTexture *picture) {
    const int count = picture->width * picture->height;
    double sum = 0;
    for (int i = 0; i < count; i++) sum += (double)picture->values[i];
    return sum / count;
}

double texture_correlation(const SingeView *view, const SingeTexture *picture, bool mirrored, const float *field) {
    double n = 0, x = 0, y = 0, xx = 0, yy = 0, xy = 0;
    for (uint32_t v = 0; v < view->vertex_count; v++) {
        if (view->source_vertex[v] < 0) continue; // in reserve for tears
        const float uv[2] = {mirrored ? 1 - view->uv[v][0] : view->uv[v][0], view->uv[v][1]};

        int column = (int)(uv[0] * (float)picture->width), row = (int)((1 - uv[1]) * (float)picture->height);
        column = column < 0 ? 0 : column >= picture->width ? picture->width - 1 : column;
        row = row < 0 ? 0 : row >= picture->height ? picture->height - 1 : row;
        double a = (double)picture->values[row * picture->width + column], b = (double)field[v];

        n++;
        x += a;
        y += b;
        xx += a * a;
        yy += b * b;
        xy += a * b;
    }

    return (n * xy - x * y) / sqrt((n * xx - x * x) * (n * yy - y * y));
}
