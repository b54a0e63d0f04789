// Any bytes as a simulation: a few sheets of any polygons, close together or not, of any material, with anything that
// the library accepts about them. Up to three steps: nothing crashes, what is left stays finite and above 0 K, a step that
// fails changes nothing, and two threads give the bytes of one. Most have so few cells and substeps that a second has
// many runs.
#include <string.h>

#include "mesh/to_quads.h"
#include "sim_state.h"

enum { SHEETS = 16, FEW_SHEETS = 3, SIDE = 4, VERTICES = 32, FACES = 8, STEPS = 3 };

/// Most of a mesh's polygons lie in a square of this side, m.
static const float size = 0.06f;

static const float extreme[] = {0,    1e-30f, 1e-9f, 1e-4f, 0.01f, 0.1f, 0.25f, 0.5f,  0.75f,
                                0.9f, 1,      2,     10,    500,   1e4f, 1e9f,  1e30f, INFINITY};

static float input_extreme(Input *input) { return extreme[input_pick(input, sizeof extreme / sizeof *extreme)]; }

// ---- meshes

typedef struct Sketch {
    float positions[3 * VERTICES];
    uint32_t first[FACES + 1 + SIDE * SIDE], corners[4 * SIDE * SIDE + 6 * FACES];
    Polygons polygons;
} Sketch;

static void sketch_face(Sketch *sketch, uint32_t count, const uint32_t *corners) {
    Polygons *p = &sketch->polygons;
    memcpy(sketch->corners + p->corner_count, corners, count * sizeof *corners);
    p->corner_count += count;
    sketch->first[++p->face_count] = p->corner_count;
}

static void sketch_grid(Input *input, Sketch *sketch) {
    uint32_t nx = 1 + input_pick(input, SIDE), ny = 1 + input_pick(input, SIDE), v = 0;
    float jitter = input_rarely(input, 4) ? 0.6f : input_rarely(input, 2) ? 0.1f : 0;
    for (uint32_t j = 0; j <= ny; j++)
        for (uint32_t i = 0; i <= nx; i++, v++) {
            float *p = sketch->positions + 3 * v;
            p[0] = size * ((float)i + jitter * (jitter > 0 ? input_share(input) : 0)) / (float)nx;
            p[1] = size * ((float)j + jitter * (jitter > 0 ? input_share(input) : 0)) / (float)ny;
            p[2] = jitter > 0 ? 0.1f * size * input_share(input) * jitter : 0;
        }

    sketch->polygons.vertex_count = v;
    for (uint32_t j = 0; j < ny; j++)
        for (uint32_t i = 0; i < nx; i++) {
            uint32_t c = j * (nx + 1) + i;
            sketch_face(sketch, 4, (uint32_t[]){c, c + 1, c + nx + 2, c + nx + 1});
        }
}

/// Triangles to hexagons over vertices that lie anywhere.
static void sketch_soup(Input *input, Sketch *sketch) {
    uint32_t vertices = 4 + input_pick(input, VERTICES - 4), faces = 1 + input_pick(input, FACES);
    for (uint32_t i = 0; i < 3 * vertices; i++) sketch->positions[i] = size * input_share(input);
    sketch->polygons.vertex_count = vertices;
    for (uint32_t f = 0; f < faces; f++) {
        uint32_t corners[6], count = 3 + input_pick(input, 4), base = input_byte(input);
        for (uint32_t i = 0; i < count; i++) corners[i] = (base + input_pick(input, 8)) % vertices;
        sketch_face(sketch, count, corners);
    }
}

static bool sketch_mesh(Input *input, Mesh *mesh) {
    Sketch sketch = {0};
    if (input_rarely(input, 3)) sketch_soup(input, &sketch);
    else sketch_grid(input, &sketch);
    sketch.polygons.positions = sketch.positions;
    sketch.polygons.first = sketch.first, sketch.polygons.corners = sketch.corners;

    MeshOptions options = mesh_default_options();
    if (input_rarely(input, 4)) options.quads = SINGE_MESH_SPLIT;
    MeshReport report;
    SingeError error;
    return mesh_make("fuzz", &sketch.polygons, &options, (SingeAllocator){0}, mesh, &report, &error) == SINGE_OK;
}

// ---- what a sheet is made of

static void vary_material(Input *input, SingeMaterialDef *material) {
    static const size_t params[] = {
#define SINGE_PARAM(number, NAME, name, ...) offsetof(SingeMaterialDef, name),
#define SINGE_PARAM_BACK SINGE_PARAM
#define SINGE_PARAM_COLOURS(number, NAME, name, range, text)                                                       \
    offsetof(SingeMaterialDef, name[0]), offsetof(SingeMaterialDef, name[1]), offsetof(SingeMaterialDef, name[2]), \
        offsetof(SingeMaterialDef, name[3]),
#include "singe/material.def"
    };
    enum { CHANGES = 8 };
    static SingeField fields[CHANGES]; // the material points to them
    for (unsigned k = input_pick(input, CHANGES); k > 0; k--) {
        size_t at = params[input_pick(input, sizeof params / sizeof *params)];
        SingeParam param = singe_param(input_extreme(input));
        if (input_rarely(input, 3)) {
            param.to = input_extreme(input), param.field = &fields[k];
            fields[k].kind = SINGE_FIELD_NOISE;
            fields[k].noise = (SingeNoise){0.01f, 1 + (int)input_pick(input, 8), input_byte(input)};
        }
        memcpy((char *)material + at, &param, sizeof param);
    }
    if (input_rarely(input, 4)) material->heat_operator = SINGE_HEAT_UMBRELLA_LIVE;
    if (input_rarely(input, 4)) material->thickening = input_extreme(input);
    if (input_rarely(input, 8)) material->ablate = false;
}

/// A material that burns from the first step on.
static void make_quick(SingeMaterialDef *material) {
    material->temperature = singe_param(700);
    material->mass_rate = singe_param(2);
    material->thickening = 1;
}

static SingeSheetDef sheet_def(const Mesh *mesh) {
    SingeSheetDef def = singe_default_sheet();
    def.vertex_count = mesh->vertex_count, def.positions = mesh->positions;
    def.cell_count = mesh->cell_count, def.cells = mesh->cells;
    def.uv = mesh->uv, def.corner_uv = mesh->corner_uv;
    return def;
}

/// `near`: where there is gas, whose cells fill all that lies between sheets, and would take all the time.
static void move_mesh(Input *input, Mesh *mesh, unsigned sheet, bool near) {
    static const float far[] = {0, 0, 0, 0.01f, 9e3f, 1e6f, 1e14f};
    static const float scales[] = {1, 1, 1, 1, 1e-3f, 100, 1e6f, 1e-9f};
    float gap = (float[]){0.5e-3f, 0.1e-3f, 0.02e-3f, 5e-3f, 0.05f}[input_pick(input, 5)];
    float x = far[input_pick(input, 7) * (input_rarely(input, 4) ? 1 : 0)];
    float scale = scales[input_pick(input, 8) * (input_rarely(input, 8) ? 1 : 0)];

    if (near) x = 0, scale = 1;
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        float *p = mesh->positions + 3 * (size_t)v;
        for (int k = 0; k < 3; k++) p[k] *= scale;
        p[0] += x, p[2] += gap * (float)sheet;
    }
}

/// Sheets one over the other: most often copies of the first, half a millimetre apart; rarely a whole stack.
static unsigned add_sheets(Input *input, SingeSim *sim, bool near) {
    const unsigned byte = input_byte(input), count = 1 + byte % (byte / SHEETS == 12 ? SHEETS : FEW_SHEETS);
    unsigned added = 0;
    Mesh mesh = {0};
    SingeMaterialDef material = singe_default_material();

    for (unsigned s = 0; s < count; s++) {
        if (s == 0 || input_rarely(input, 4)) {
            mesh_free(&mesh);
            if (!sketch_mesh(input, &mesh)) return added;
            material = singe_default_material();
            if (input_rarely(input, 2)) make_quick(&material);
            if (input_rarely(input, 2)) vary_material(input, &material);
        }

        move_mesh(input, &mesh, s == 0 ? 0 : 1, near);
        SingeSheetDef def = sheet_def(&mesh);
        def.material = material;
        if (input_rarely(input, 8)) def.velocity[input_pick(input, 3)] = input_share(input) * input_extreme(input);
        if (input_rarely(input, 8)) def.drop_pieces_below = input_extreme(input);

        SingeSheetId id;
        added += singe_sim_add_sheet(sim, &def, &id) == SINGE_OK;
    }

    mesh_free(&mesh);
    return added;
}

// ---- what is around them

static SingePoseKey input_pose(Input *input, float time) {
    return (SingePoseKey){time,
                          {size * input_share(input), size * input_share(input), size * input_share(input)},
                          {input_share(input), 0, 0, 1}};
}

static void add_sources(Input *input, SingeSim *sim) {
    for (unsigned k = input_pick(input, 3); k > 0; k--) {
        SingeSourceDef def = singe_default_source();
        SingePoseKey path[2] = {input_pose(input, 0), input_pose(input, 0.01f)};

        def.kind = input_pick(input, 2) ? SINGE_SOURCE_BALL : SINGE_SOURCE_SPOT;
        def.path = path, def.path_count = def.kind == SINGE_SOURCE_BALL ? 2 : 1;
        if (input_rarely(input, 2)) def.radius = size;
        if (input_rarely(input, 4)) def.temperature = input_extreme(input);
        if (input_rarely(input, 4)) def.conductance = input_extreme(input);

        SingeSourceId id;
        if (singe_sim_add_source(sim, &def, &id)) continue;
    }
}

static void add_colliders(Input *input, SingeSim *sim) {
    static const float vertices[] = {0.01f, 0, 0, -0.01f, 0, 0, 0, 0.01f, 0, 0, -0.01f, 0, 0, 0, 0.01f, 0, 0, -0.01f};
    static const uint32_t triangles[] = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
    float heights[9];

    for (unsigned k = input_pick(input, 3); k > 0; k--) {
        SingeColliderDef def = singe_default_collider();
        SingePoseKey path[2] = {input_pose(input, 0), input_pose(input, 0.02f)};

        for (int i = 0; i < 9; i++) heights[i] = 0.02f * input_share(input);
        def.kind = (SingeColliderKind)input_pick(input, SINGE_COLLIDER_MESH);
        if (input_rarely(input, 16)) def.kind = SINGE_COLLIDER_MESH; // takes long to build
        def.path = path, def.path_count = 1 + input_pick(input, 2);
        def.vertex_count = 6, def.vertices = vertices, def.triangle_count = 8, def.triangles = triangles;
        def.columns = def.rows = 3, def.heights = heights;
        if (input_rarely(input, 4)) def.conductance = input_extreme(input), def.temperature = input_extreme(input);
        if (input_rarely(input, 4)) def.friction = input_extreme(input);
        if (input_rarely(input, 8)) def.radius = def.half_size[1] = input_extreme(input);

        SingeColliderId id;
        if (singe_sim_add_collider(sim, &def, &id)) continue;
    }
}

static void add_pins(Input *input, SingeSim *sim) {
    for (uint32_t k = input_pick(input, 4); k > 0; k--) {
        SingePinDef def = singe_default_pin();
        const float points[3] = {size * input_share(input), size * input_share(input), 0};
        SingePoseKey path[2] = {input_pose(input, 0), input_pose(input, 0.02f)};

        def.sheet = (SingeSheetId){k - 1, 1};
        def.points = points, def.point_count = 1;
        def.path = path, def.path_count = 2 * input_pick(input, 2);
        if (input_rarely(input, 4)) def.radius = size;

        SingePinId id;
        if (singe_sim_add_pin(sim, &def, &id)) continue;
    }
}

static SingeSimDef input_sim(Input *input) {
    SingeSimDef def = singe_default_sim();
    unsigned choices = input_byte(input), more = input_byte(input);
    def.contact.enabled = !(choices & 1);
    def.solver.creases = choices & 2, def.solver.tearing = choices & 4, def.solver.substeps = 2;
    def.gas.enabled = (choices & 24) == 24, def.gas.cell_size = 0.02f, def.gas.height = 0.05f;
    if ((choices & 96) == 96) {
        singe_init_solver_method(&def.solver, sizeof def.solver, (SingeSolverMethod)input_pick(input, 5));
        if (def.solver.substeps > 20) def.solver.substeps = 20;
        if (def.solver.method != SINGE_SOLVER_STRAND) // conjugate gradients take thousands of iterations each
            def.solver.substeps = def.solver.projections = 1;
    }

    if (choices & 128) def.time_step = (float[]){1.0f / 24, 1e-9f, 1e-3f, 10}[input_pick(input, 4)];
    if ((more & 7) == 7) def.contact.thickness = input_extreme(input);
    if ((more & 56) == 56) def.pace = input_extreme(input);
    if ((more & 64) && input_rarely(input, 2)) def.gravity[input_pick(input, 3)] = 1e4f * input_share(input);
    if ((more & 128) && input_rarely(input, 2)) def.wind.velocity[input_pick(input, 3)] = 1000 * input_share(input);
    if ((more & 128) && input_rarely(input, 2)) def.wind.gust = 1000;
    if ((more & 128) && input_rarely(input, 2)) def.surface_detail = 0.002f, def.surface_raggedness = 0.002f;
    return def;
}

// ---- what must hold

typedef struct Saved {
    uint8_t *bytes;
    size_t size;
} Saved;

static Saved save(SingeSim *sim) {
    Saved saved;
    if (singe_sim_save(sim, &saved.bytes, &saved.size)) abort();
    return saved;
}

static void demand_same(SingeSim *sim, const Saved *before) {
    Saved now = save(sim);
    demand(now.size == before->size && memcmp(now.bytes, before->bytes, now.size) == 0);
    singe_sim_free_bytes(sim, now.bytes, now.size);
}

/// NULL where the library refuses it.
static SingeSim *make(Input input, int threads) {
    SingeSim *sim = NULL;
    SingeError error;
    SingeSimDef def = input_sim(&input);
    def.thread_count = threads;
    if (singe_sim_create(&def, &sim, &error)) return NULL;
    if (add_sheets(&input, sim, def.gas.enabled) == 0 || singe_sim_commit(sim)) {
        singe_sim_destroy(sim);
        return NULL;
    }

    add_colliders(&input, sim);
    add_sources(&input, sim);
    add_pins(&input, sim);
    return sim;
}

/// STEPS steps; one of a stack, in which contact may do all that a step may take.
static bool run(SingeSim *sim, bool thorough) {
    const int steps = singe_sim_sheets(sim, NULL, 0) > FEW_SHEETS ? 1 : STEPS;
    for (int step = 0; step < steps; step++) {
        uint64_t before = thorough ? digest_view(sim) : 0;
        bool failed = singe_sim_step(sim) != SINGE_OK;
        if (failed && thorough) demand(digest_view(sim) == before);
        if (failed) return false;
        demand_state(sim);
    }

    return true;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t length) {
    Input input = {data, data + length};
    unsigned thorough = input_byte(&input);
    SingeSim *sim = make(input, 1);

    if (!sim) return 0;
    bool good = run(sim, thorough & 1);
    demand_surface(sim);

    if ((thorough & 14) == 14) {
        SingeSim *other = make(input, 2);
        demand(other && run(other, false) == good);
        Saved saved = save(other);
        demand_same(sim, &saved);
        singe_sim_free_bytes(other, saved.bytes, saved.size);
        singe_sim_destroy(other);
    }

    singe_sim_destroy(sim);
    return 0;
}
