// A sheet of paper that burns under the mouse, in a window and in real time: drag over it to hold a match there.
//
//   cc live.c $(pkg-config --cflags --libs singe-input sdl2) -lm -o live && ./live
//
// `live FRAMES` draws so many frames with a match that moves by itself, as fast as it can, and says what they cost.
#include <singe/singe.h>

#include <SDL.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { WIDTH = 800, HEIGHT = 800, CELLS = 50, FRAMES_PER_SECOND = 60, STEPS_MAX = 8 };
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

static int fail(const char *stage, const char *message) {
    fprintf(stderr, "%s: %s\n", stage, message);
    return 1;
}

/// 2,500 cells of paper that hang from their upper corners in the plane y = 0, and a match that is not lit.
static int make(Live *live) {
    SingeSimDef def = singe_default_sim();
    def.time_step = 1.0f / 480, def.pace = 6, def.contact.enabled = true;
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

/// A match that goes up along the sheet's edge and into its centre, for runs without a hand.
static int hold_by_itself(Live *live, int frame) {
    const float along = (float)frame / 60;
    return hold(live, frame < 90, WIDTH * (0.14f + 0.25f * along), HEIGHT * (0.85f - 0.25f * along));
}

static int play(Live *live, int frames) {
    double frame_time = 1.0 / FRAMES_PER_SECOND, begun = (double)SDL_GetTicks64(), steps = 0;
    Uint64 last = SDL_GetTicks64();
    for (int frame = 0; frames == 0 || frame < frames; frame++) {
        SDL_Event event;
        while (SDL_PollEvent(&event))
            if (event.type == SDL_QUIT && frames == 0) return 0;
        int x, y;
        const bool down = SDL_GetMouseState(&x, &y) & SDL_BUTTON_LMASK;
        if (frames ? hold_by_itself(live, frame) : hold(live, down, (float)x, (float)y))
            return fail("match", singe_sim_error(live->sim)->message);
        if (frames == 0) frame_time = 1e-3 * (double)(SDL_GetTicks64() - last), last = SDL_GetTicks64();
        uint32_t made;
        if (singe_sim_advance(live->sim, frame_time, STEPS_MAX, &made)) // what is slower slows down
            return fail("step", singe_sim_error(live->sim)->message);
        steps += made;
        if (draw(live)) return 1;
    }
    const SingeStats stats = singe_sim_stats(live->sim);
    printf("%d frames, %.0f steps, %.1f ms a frame, %u triangles, %.0f %% burnt\n", frames, steps,
           ((double)SDL_GetTicks64() - begun) / frames, live->surface.triangle_count, 100 * stats.burnt_fraction);
    return 0;
}

static void save_picture(Live *live, const char *path) {
    SDL_Surface *picture = SDL_CreateRGBSurfaceWithFormat(0, WIDTH, HEIGHT, 32, SDL_PIXELFORMAT_ARGB8888);
    if (picture &&
        !SDL_RenderReadPixels(live->renderer, NULL, picture->format->format, picture->pixels, picture->pitch))
        SDL_SaveBMP(picture, path);
    SDL_FreeSurface(picture);
}

int main(int argc, char **argv) {
    Live live = {0};
    const int frames = argc > 1 ? atoi(argv[1]) : 0;
    int status = 1;
    if (SDL_Init(SDL_INIT_VIDEO)) return fail("SDL", SDL_GetError());
    live.window = SDL_CreateWindow("Singe", SDL_WINDOWPOS_CENTERED, SDL_WINDOWPOS_CENTERED, WIDTH, HEIGHT, 0);
    if (live.window)
        live.renderer = SDL_CreateRenderer(live.window, -1, frames ? SDL_RENDERER_SOFTWARE : SDL_RENDERER_PRESENTVSYNC);
    if (!live.renderer) fail("SDL", SDL_GetError());
    else if (!make(&live)) status = play(&live, frames);
    if (!status && argc > 2) save_picture(&live, argv[2]);
    singe_surface_free(&live.surface);
    singe_sim_destroy(live.sim);
    free(live.corners);
    SDL_DestroyRenderer(live.renderer);
    SDL_DestroyWindow(live.window);
    SDL_Quit();
    return status;
}
