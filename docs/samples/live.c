// A sheet of paper that burns under the mouse, in a window and in real time: drag over it to hold a match there.
//
//   cc live.c $(pkg-config --cflags --libs singe-input sdl2) -lm -o live && ./live
//
// `live --frames N` draws N frames with a match that moves by itself, as fast as it can, and prints what they cost.
#include <singe/singe.h>

#include <SDL.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 800, HEIGHT = 800, CELLS = 50, FRAMES_PER_SECOND = 60, STEPS_MAX = 8, FRAMES_MAX = 100000 };
static const float SIDE = 0.2f, SHOWN = 0.26f; // m, of the sheet and of the window

typedef struct Live {
    SingeSim *sim;
    SingeSourceId match;
    SingeSurface surface;
    SDL_Window *window;
    SDL_Renderer *renderer;
    SDL_Vertex *corners; ///< [3 * triangle_capacity]
    size_t capacity;
} Live;

typedef struct Options {
    int frames;          ///< 0: until the window is closed
    const char *picture; ///< a BMP file of the last frame, or NULL
} Options;

static const char usage[] =
    "usage: live [--frames N] [--picture FILE.bmp]\n"
    "\n"
    "A sheet of 2,500 cells that burns where the mouse is dragged.\n"
    "\n"
    "  --frames N           draw N frames (1 to 100000) without a hand, print what they cost, and end\n"
    "  --picture FILE.bmp   write the last frame to a file; with --frames\n"
    "  --help               print this\n";

static int fail(const char *stage, const char *message) {
    fprintf(stderr, "%s: %s\n", stage, message);
    return 1;
}

/// 2,500 cells of paper that hang from their upper corners in the plane y = 0, and a match that is not lit.
static int make(Live *live) {
    SingeSimDef def = singe_default_sim();
    def.time_step = 1.0f / 240, def.pace = 6, def.contact.enabled = true;
    def.thread_count = SDL_GetCPUCount() > 1 ? 2 : 1; // results are the same
    SingeGridDef grid = singe_default_grid();
    grid.size[0] = grid.size[1] = SIDE, grid.cells[0] = grid.cells[1] = CELLS;
    SingeSheetDef sheet = singe_default_sheet();
    SingeSourceDef match = singe_default_source();
    match.end = 0; // out till the button is down
    const float corners[6] = {-SIDE / 2, 0, SIDE / 2, SIDE / 2, 0, SIDE / 2};
    SingePinDef pin = singe_default_pin();
    pin.point_count = 2, pin.points = corners, pin.radius = 0.008f;

    SingeMesh *mesh;
    SingeError error;
    SingePinId held;
    if (singe_sim_create(&def, &live->sim, &error)) return fail(error.stage, error.message);
    if (singe_mesh_create_grid(&grid, &mesh, &error)) return fail(error.stage, error.message);
    singe_mesh_fill_sheet(mesh, &sheet);
    float *upright = malloc(3 * sizeof *upright * sheet.vertex_count); // x stays, y becomes z
    for (uint32_t v = 0; upright && v < sheet.vertex_count; v++) {
        upright[3 * v] = sheet.positions[3 * v], upright[3 * v + 1] = 0;
        upright[3 * v + 2] = sheet.positions[3 * v + 1];
    }
    sheet.positions = upright;
    int bad = !upright || singe_sim_add_sheet(live->sim, &sheet, &pin.sheet) ||
              singe_sim_add_source(live->sim, &match, &live->match) || singe_sim_add_pin(live->sim, &pin, &held) ||
              singe_sim_commit(live->sim);
    free(upright);
    singe_mesh_destroy(mesh);
    return bad ? fail("make", singe_sim_error(live->sim)->message) : 0;
}

/// Holds a match at a point of the window, or takes it away.
static int hold(Live *live, bool lit, float x, float y) {
    SingeSourceDef match = singe_default_source();
    match.temperature = 1200, match.conductance = 400, match.radius = match.falloff = 0.006f;
    match.position[0] = (x / WIDTH - 0.5f) * SHOWN, match.position[2] = (0.5f - y / HEIGHT) * SHOWN;
    if (singe_sim_remove_source(live->sim, live->match)) return 1;
    if (!lit) match.end = 0;
    return singe_sim_add_source(live->sim, &match, &live->match) != SINGE_OK;
}

/// Paper, brown where it was hot, black where it is burnt, and glowing by its temperature.
static SDL_Color colour_of(const SingeSurface *surface, uint32_t v) {
    const float brown = fminf(fmaxf((surface->temperature_peak[v] - 420) / 120, 0), 1);
    const float black = fminf(surface->burn[v] * 1.6f, 1),
                glow = fminf(fmaxf((surface->temperature[v] - 750) / 350, 0), 1);
    const float slope = 0.55f + 0.45f * fabsf(surface->normal[v][1]);
    const float paper[3] = {238 - 118 * brown, 232 - 150 * brown, 215 - 165 * brown}, fire[3] = {255, 140, 40};
    float mixed[3];
    for (int i = 0; i < 3; i++) {
        const float leaf = slope * (paper[i] + (22 - paper[i]) * black);
        mixed[i] = leaf + (fire[i] - leaf) * glow;
    }
    return (SDL_Color){(Uint8)mixed[0], (Uint8)mixed[1], (Uint8)mixed[2], 255};
}

static int draw(Live *live) {
    if (singe_sim_surface(live->sim, &live->surface)) return fail("surface", singe_sim_error(live->sim)->message);
    const SingeSurface *surface = &live->surface;
    const size_t count = 3 * (size_t)surface->triangle_count;
    if (count > live->capacity) {
        SDL_Vertex *grown = realloc(live->corners, 2 * count * sizeof *grown);
        if (!grown) return fail("draw", "out of memory");
        live->corners = grown, live->capacity = 2 * count;
    }
    for (size_t k = 0; k < count; k++) {
        const uint32_t v = surface->triangles[k / 3][k % 3];
        const float x = (surface->position[v][0] / SHOWN + 0.5f) * WIDTH,
                    y = (0.5f - surface->position[v][2] / SHOWN) * HEIGHT;
        live->corners[k] = (SDL_Vertex){{x, y}, colour_of(surface, v), {0, 0}};
    }
    SDL_SetRenderDrawColor(live->renderer, 24, 26, 32, 255);
    SDL_RenderClear(live->renderer);
    if (count && SDL_RenderGeometry(live->renderer, NULL, live->corners, (int)count, NULL, 0))
        return fail("draw", SDL_GetError());
    SDL_RenderPresent(live->renderer);
    return 0;
}

/// What frames cost, in ms: [frames] each.
typedef struct Cost {
    double *steps, *whole;
} Cost;

static double now(void) { return 1e3 * (double)SDL_GetPerformanceCounter() / (double)SDL_GetPerformanceFrequency(); }

static int compare(const void *a, const void *b) {
    const double difference = *(const double *)a - *(const double *)b;
    return (difference > 0) - (difference < 0);
}

/// Sorts the times and prints them beside the time that a frame of a screen has.
static void print_cost(const Live *live, Cost cost, int frames, uint32_t steps) {
    const SingeStats stats = singe_sim_stats(live->sim);
    qsort(cost.steps, (size_t)frames, sizeof *cost.steps, compare);
    qsort(cost.whole, (size_t)frames, sizeof *cost.whole, compare);
    printf("%d frames, %u steps, %u triangles, %.0f %% burnt\n", frames, steps, live->surface.triangle_count,
           100 * stats.burnt_fraction);
    printf("median %.1f ms a frame, of which steps %.1f ms; 90 %% under %.1f ms; real time needs %.1f ms\n",
           cost.whole[frames / 2], cost.steps[frames / 2], cost.whole[frames * 9 / 10], 1e3 / FRAMES_PER_SECOND);
}

/// The match where it is held, and the steps of `time` s.
static int burn(Live *live, double time, int x, int y, bool lit, uint32_t *steps) {
    if (hold(live, lit, (float)x, (float)y)) return fail("match", singe_sim_error(live->sim)->message);
    if (singe_sim_advance(live->sim, time, STEPS_MAX, steps)) // what is slower slows down
        return fail("step", singe_sim_error(live->sim)->message);
    return 0;
}

static bool is_closed(void) {
    SDL_Event event;
    while (SDL_PollEvent(&event))
        if (event.type == SDL_QUIT) return true;
    return false;
}

/// Under the mouse, until the window is closed.
static int play(Live *live) {
    for (double last = now(), begun; !is_closed(); last = begun) {
        int x, y;
        const bool lit = SDL_GetMouseState(&x, &y) & SDL_BUTTON_LMASK;
        uint32_t steps;
        begun = now();
        if (burn(live, 1e-3 * (begun - last), x, y, lit, &steps) || draw(live)) return 1;
    }
    return 0;
}

/// With a match that goes up along the sheet's edge and into its centre, as fast as it can.
static int play_alone(Live *live, int frames) {
    double *times = malloc(2 * (size_t)frames * sizeof *times);
    if (!times) return fail("play", "out of memory");
    const Cost cost = {times, times + frames};
    uint32_t steps = 0;
    int status = 0;
    for (int frame = 0; frame < frames && !status; frame++) {
        is_closed(); // a window that answers nobody is taken for one that hangs
        const float along = (float)frame / 60;
        const int x = (int)(WIDTH * (0.14f + 0.25f * along)), y = (int)(HEIGHT * (0.85f - 0.25f * along));
        const double begun = now();
        uint32_t done = 0;
        status = burn(live, 1.0 / FRAMES_PER_SECOND, x, y, frame < 90, &done);
        cost.steps[frame] = now() - begun;
        if (!status) status = draw(live);
        cost.whole[frame] = now() - begun;
        steps += done;
    }
    if (!status) print_cost(live, cost, frames, steps);
    free(times);
    return status;
}

static int save_picture(Live *live, const char *path) {
    SDL_Surface *picture = SDL_CreateRGBSurfaceWithFormat(0, WIDTH, HEIGHT, 32, SDL_PIXELFORMAT_ARGB8888);
    bool bad = !picture ||
               SDL_RenderReadPixels(live->renderer, NULL, picture->format->format, picture->pixels, picture->pitch) ||
               SDL_SaveBMP(picture, path);
    SDL_FreeSurface(picture);
    return bad ? fail(path, SDL_GetError()) : 0;
}

/// Opens the window, plays, and closes it; without a hand the processor alone draws, as no screen need be there.
static int run(Live *live, const Options *options) {
    if (SDL_Init(SDL_INIT_VIDEO)) return fail("SDL", SDL_GetError());
    live->window = SDL_CreateWindow("Singe", SDL_WINDOWPOS_CENTERED, SDL_WINDOWPOS_CENTERED, WIDTH, HEIGHT, 0);
    const Uint32 way = options->frames ? SDL_RENDERER_SOFTWARE : SDL_RENDERER_PRESENTVSYNC;
    if (live->window) live->renderer = SDL_CreateRenderer(live->window, -1, way);
    int status = live->renderer ? make(live) : fail("SDL", SDL_GetError());
    if (!status) status = options->frames ? play_alone(live, options->frames) : play(live);
    if (!status && options->picture) status = save_picture(live, options->picture);
    singe_surface_free(&live->surface);
    singe_sim_destroy(live->sim);
    free(live->corners);
    if (live->renderer) SDL_DestroyRenderer(live->renderer);
    if (live->window) SDL_DestroyWindow(live->window);
    SDL_Quit();
    return status;
}

/// What is wrong with the arguments; NULL: nothing.
static const char *read_options(int count, char **arguments, Options *options) {
    for (int i = 1; i < count; i += 2) {
        const char *name = arguments[i], *value = i + 1 < count ? arguments[i + 1] : NULL;
        if (strcmp(name, "--frames") && strcmp(name, "--picture")) return "no such argument";
        if (!value) return "a value is missing at the end";
        if (strcmp(name, "--picture") == 0) options->picture = value;
        else {
            char *end;
            const long frames = strtol(value, &end, 10);
            if (end == value || *end || frames < 1 || frames > FRAMES_MAX) return "--frames must be from 1 to 100000";
            options->frames = (int)frames;
        }
    }
    return options->picture && !options->frames ? "--picture needs --frames" : NULL;
}

int main(int argc, char **argv) {
    for (int i = 1; i < argc; i++)
        if (strcmp(argv[i], "--help") == 0 || strcmp(argv[i], "-h") == 0) return fputs(usage, stdout), 0;
    Options options = {0};
    const char *bad = read_options(argc, argv, &options);
    if (bad) return fprintf(stderr, "live: %s\n%s", bad, usage), 2;
    Live live = {0};
    return run(&live, &options);
}
