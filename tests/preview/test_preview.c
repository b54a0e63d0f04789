// Pictures of synthetic sheets: what is where, what is refused, and that threads and memory do not matter.

#include "fixture.h"
#include "synthetic.h"
#include "support/support.h"

// what a case works on
static uint8_t rgb[BYTES];
static Float4 q;

TEST(pictures_do_not_depend_on_threads) {
    SingeSurface surface;
    assert_true(synthetic_make(SYNTHETIC_FLAT, 30, 0.05f, &surface));

    // enough tiles that every thread gets some, the last of each row and column cut
    enum { BIG_W = 175, BIG_H = 130, BIG = BIG_W * BIG_H * 3 };
    static uint8_t pictures[3][BIG];
    PreviewShape ball = {.kind = SINGE_COLLIDER_SPHERE,
                         .position = {0, 0, 0.03f},
                         .radius = 0.01f,
                         .temperature = 1200,
                         .velocity = {0.3f, 0.1f, 0}};
    for (uint32_t i = 0; i < surface.vertex_count; i++) surface.velocity[i][2] = 0.2f * surface.rest_position[i][0];
    for (int blurred = 0; blurred < 2; blurred++) {
        for (int threads = 1; threads <= 3; threads++) {
            PreviewDef def = small();
            def.width = BIG_W, def.height = BIG_H;
            def.thread_count = threads, def.shapes = &ball, def.shape_count = 1;
            if (blurred) def.camera.aperture = 0.01f, def.shutter = 0.02f;
            if (blurred) def.sky = PREVIEW_SKY_STUDIO, def.ground = PREVIEW_GROUND_STONE;
            draw(&def, &surface, 0.5, pictures[threads - 1]);
        }
        assert_memory_equal(pictures[0], pictures[1], BIG);
        assert_memory_equal(pictures[0], pictures[2], BIG);
    }
    synthetic_free(&surface);
}

/// Drawing another frame between must leave no trace.
TEST(frames_between_leave_no_trace) {
    SingeSurface burning, cold;
    assert_true(synthetic_make(SYNTHETIC_FLAT, 20, 0.05f, &burning));
    assert_true(synthetic_make(SYNTHETIC_COLD, 30, 0.07f, &cold));
    static uint8_t first[BYTES], between[BYTES], again[BYTES], later[BYTES];
    PreviewDef def = small();
    Preview *preview = preview_open(&def);
    assert_int_equal(preview_draw(preview, &burning, 2, first, NULL), SINGE_OK);
    assert_int_equal(preview_draw(preview, &cold, 2, between, NULL), SINGE_OK);
    assert_int_equal(preview_draw(preview, &burning, 2, again, NULL), SINGE_OK);
    assert_int_equal(preview_draw(preview, &burning, 2.6, later, NULL), SINGE_OK);
    preview_destroy(preview);
    assert_memory_equal(first, again, BYTES);
    assert_memory_not_equal(first, between, BYTES);
    assert_memory_not_equal(first, later, BYTES); // embers flicker
    synthetic_free(&burning), synthetic_free(&cold);
}

/// State that a preview keeps between frames (the table, the mask, the shapes) does not affect the next frame.
TEST(kept_state_does_not_affect_the_picture) {
    SingeSurface burning, hanging;
    assert_true(synthetic_make(SYNTHETIC_FLAT, 20, 0.05f, &burning));
    assert_true(synthetic_make(SYNTHETIC_HANGING, 20, 0.05f, &hanging));
    static uint8_t alone[BYTES], after[BYTES];
    PreviewDef def = small();
    draw(&def, &burning, 2, alone);
    PreviewShape ball = {
        .kind = SINGE_COLLIDER_SPHERE, .position = {0.05f, 0, 0.03f}, .radius = 0.03f, .temperature = 1200};
    OwnPreview *preview = preview_open(&def);
    assert_int_equal(preview_set_shapes(preview, &ball, 1, NULL), SINGE_OK);
    assert_int_equal(preview_draw(preview, &hanging, 1, after, NULL), SINGE_OK);
    assert_memory_not_equal(alone, after, BYTES);
    assert_int_equal(preview_set_shapes(preview, NULL, 0, NULL), SINGE_OK);
    assert_int_equal(preview_draw(preview, &nothing, 7, after, NULL), SINGE_OK);
    assert_int_equal(preview_draw(preview, &burning, 2, after, NULL), SINGE_OK);
    assert_memory_equal(alone, after, BYTES);
    synthetic_free(&burning), synthetic_free(&hanging);
}

TEST(an_empty_surface_is_drawn) {
    PreviewDef def = above();

    draw(&def, &nothing, 0, rgb);
    const uint8_t *p = pixel(rgb, W / 2, H / 2);
    assert_true(p[0] > p[1] && p[1] > p[2]); // a wooden table
    assert_in_range(p[0], 50, 190);
    def.ground_height = -INFINITY;
    draw(&def, &nothing, 0, rgb);
    p = pixel(rgb, W / 2, H / 2);
    assert_in_range(p[0], 60, 130); // the background: 0.16 of grey
    assert_true(abs(p[0] - p[2]) < 12);
}

/// Left half red, right half blue, top row darker: uv and rows must be the right way round.
TEST(uv_and_rows_are_the_right_way_round) {
    uint8_t texels[2 * 2 * 3] = {255, 0, 0, 0, 0, 255, 60, 0, 0, 0, 0, 60};
    Image image = {.width = 2, .height = 2, .rgb = texels};
    const Image *pictures[2] = {&image, NULL};

    quad_make(&q, 0.1f, 0.01f);
    PreviewDef def = above();
    def.pictures = pictures, def.sheet_count = 2;
    draw(&def, &q.surface, 0, rgb);
    const uint8_t *left = pixel(rgb, W / 2 - 14, H / 2 - 14), *right = pixel(rgb, W / 2 + 13, H / 2 - 14);
    const uint8_t *low = pixel(rgb, W / 2 - 14, H / 2 + 13);
    assert_true(left[0] > 180 && left[1] < 90 && left[2] < 90);
    assert_true(right[2] > 180 && right[0] < 90 && right[1] < 90);
    assert_true(low[0] + 60 < left[0]);

    for (int i = 0; i < 4; i++) q.sheet[i] = 1; // no picture
    draw(&def, &q.surface, 0, rgb);
    assert_in_range(pixel(rgb, W / 2 - 14, H / 2 - 14)[1], 210, 252);
    for (int i = 0; i < 4; i++) q.sheet[i] = 7 - 9 * (i & 1); // sheets that do not exist: white
    draw(&def, &q.surface, 0, rgb);
    assert_in_range(pixel(rgb, W / 2 - 14, H / 2 - 14)[1], 210, 252);
}

/// What is printed on the back reads from there, and hardly changes the front: no byte where it is white.
TEST(a_back_reads_from_behind) {
    static uint8_t front[3][W * H * 3];
    uint8_t texels[2 * 1 * 3] = {255, 0, 0, 0, 0, 255}, blank[1 * 1 * 3] = {255, 255, 255};
    Image image = {.width = 2, .height = 1, .rgb = texels}, white = {.width = 1, .height = 1, .rgb = blank};
    const Image *pictures[1] = {&image}, *whites[1] = {&white};
    const Image *const *backs[3] = {NULL, whites, pictures};
    int most = 0;

    quad_make(&q, 0.1f, 0.01f);
    PreviewDef def = above();
    def.pictures = pictures, def.sheet_count = 1;
    for (int k = 0; k < 3; k++) {
        def.backs = backs[k];
        draw(&def, &q.surface, 0, front[k]);
    }
    assert_memory_equal(front[0], front[1], sizeof front[0]);
    for (size_t i = 0; i < sizeof front[0]; i++)
        most = abs(front[2][i] - front[0][i]) > most ? abs(front[2][i] - front[0][i]) : most;

    def.camera.eye[2] = -def.camera.eye[2], def.sun_direction[2] = -1, def.ground_height = -INFINITY;
    draw(&def, &q.surface, 0, rgb);
    const uint8_t *left = pixel(rgb, W / 2 - 14, H / 2), *right = pixel(rgb, W / 2 + 13, H / 2);
    print_message("front within %d of 255; back %d %d %d, %d %d %d\n", most, left[0], left[1], left[2], right[0],
                  right[1], right[2]);
    assert_true(most < 24 && left[0] > 150 && left[2] < 90 && right[2] > 150 && right[0] < 90);
}

TEST(shapes_are_drawn) {
    PreviewDef def = above();
    PreviewShape shape = {.position = {0.1f, 0, 0.05f},
                          .rotation = {0, 0, 0, 1},
                          .radius = 0.03f,
                          .half_size = {0.03f, 0.03f, 0.03f},
                          .height = 0.02f,
                          .colour = {0.1f, 0.1f, 0.8f},
                          .temperature = 293};

    def.shapes = &shape, def.shape_count = 1;
    const SingeColliderKind kinds[3] = {SINGE_COLLIDER_SPHERE, SINGE_COLLIDER_BOX, SINGE_COLLIDER_CAPSULE};
    for (int k = 0; k < 3; k++) {
        shape.kind = kinds[k];
        draw(&def, &nothing, 0, rgb);

        // 0.1 m at distance 0.45 m; half the picture's height is 0.45 tan 0.35 there
        int x = (int)(W / 2 + 0.1f / (0.45f * tanf(0.35f)) * (H / 2));
        const uint8_t *on = pixel(rgb, x, H / 2), *off = pixel(rgb, W - x, H / 2);
        assert_true(on[2] > on[0] + 50 && on[2] > 120);
        assert_true(off[0] > off[2]);
    }

    shape.kind = SINGE_COLLIDER_PLANE; // planes are the ground's business
    draw(&def, &nothing, 0, rgb);
    const uint8_t *p = pixel(rgb, W / 2, H / 2);
    assert_true(p[0] > p[2]);
}

/// A mesh of a box is drawn as the box, turned, hot or blurred; one that is built again as before.
TEST(a_box_of_a_mesh_is_drawn_as_the_box) {
    static uint8_t box[BYTES], mesh[BYTES], again[BYTES];
    PreviewDef def = above();
    float vertices[24];
    uint32_t triangles[] = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                            2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};

    for (int k = 0; k < 24; k++) vertices[k] = (k / 3 >> k % 3 & 1 ? 1 : -1) * (0.02f + 0.01f * (float)(k % 3));
    PreviewSolid solid = {8, 12, vertices, triangles, false};
    PreviewShape shape = {.position = {0.06f, 0.02f, 0.05f},
                          .rotation = {0.2f, 0.1f, 0.3f, 0.9274f},
                          .half_size = {0.02f, 0.03f, 0.04f},
                          .colour = {0.1f, 0.1f, 0.8f},
                          .temperature = 293};
    def.shapes = &shape, def.shape_count = 1;
    for (int moving = 0; moving < 2; moving++) {
        shape.velocity[0] = moving ? 1.5f : 0;
        def.shutter = moving ? 0.02f : 0;
        shape.kind = SINGE_COLLIDER_BOX, shape.solid = NULL;
        draw(&def, &nothing, 0, box);
        shape.kind = SINGE_COLLIDER_MESH, shape.solid = &solid;
        draw(&def, &nothing, 0, mesh);
        draw(&def, &nothing, 0, again);
        assert_memory_equal(mesh, again, BYTES);
        int blue = 0, differ = 0;
        for (int i = 0; i < BYTES; i += 3) {
            blue += box[i + 2] > box[i] + 30;
            differ += abs(box[i] - mesh[i]) + abs(box[i + 1] - mesh[i + 1]) + abs(box[i + 2] - mesh[i + 2]) > 24;
        }

        print_message("solid: %d pixels, %d differ\n", blue, differ);
        assert_true(blue > 100 && differ <= blue / 50);
    }

    SingeError error;
    Preview *preview = NULL;
    shape.solid = NULL;
    assert_int_equal(preview_create(&def, (SingeAllocator){0}, &preview, &error), SINGE_ERROR_ARGUMENT);
    triangles[7] = 8, shape.solid = &solid;
    assert_int_equal(preview_create(&def, (SingeAllocator){0}, &preview, &error), SINGE_ERROR_ARGUMENT);
}

TEST(a_hot_ball_glows) {
    static uint8_t hot[BYTES], cold[BYTES];
    PreviewDef def = above();
    PreviewShape ball = {.kind = SINGE_COLLIDER_SPHERE,
                         .position = {0, 0, 0.03f},
                         .radius = 0.025f,
                         .colour = {0.2f, 0.2f, 0.2f},
                         .temperature = 1350};

    def.shapes = &ball, def.shape_count = 1;
    draw(&def, &nothing, 0, hot);
    ball.temperature = 600;
    draw(&def, &nothing, 0, cold);
    const uint8_t *p = pixel(hot, W / 2, H / 2);
    print_message("a ball of 1350 K: %d %d %d\n", p[0], p[1], p[2]);
    assert_true(p[0] > 230 && p[0] > p[1] + 8 && p[1] > p[2] + 40); // pale yellow in its middle
    // its light reaches the table beside it
    assert_true(pixel(hot, W / 2 + 9, H / 2)[0] > pixel(cold, W / 2 + 9, H / 2)[0] + 8);

    // with no table to light, only the halo is left
    def.ground_height = -INFINITY;
    draw(&def, &nothing, 0, cold);
    ball.temperature = 1350;
    draw(&def, &nothing, 0, hot);
    assert_true(pixel(hot, W / 2 + 7, H / 2)[0] > pixel(cold, W / 2 + 7, H / 2)[0] + 3);
    assert_true(abs(pixel(hot, 3, 3)[0] - pixel(cold, 3, 3)[0]) <= 2);
}

/// In the dark, exposed for what it lights, a hot ball is no white disc: its limb is darker than its middle, and what faces
/// down is darker than what faces up.
TEST(a_hot_ball_is_graded) {
    PreviewDef def = small();
    PreviewShape ball = {.kind = SINGE_COLLIDER_SPHERE, .radius = 0.1f, .temperature = 1300};
    def.shapes = &ball, def.shape_count = 1;
    def.camera = (PreviewCamera){.eye = {0, -0.6f, 0}, .target = {0, 0, 0}, .up = {0, 0, 1}, .fov = 0.5f};
    def.ground_height = -INFINITY;
    def.exposure = 1.6f;
    memset(def.sun_colour, 0, sizeof def.sun_colour);
    draw(&def, &nothing, 0, rgb);

    int white = 0, bright = 0, sum[3] = {0, 0, 0}; // green around the middle, above and below
    for (int i = 0; i < W * H; i++) white += rgb[3 * i + 2] > 200, bright += rgb[3 * i + 1] > 230;
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < 25; i++)
            sum[k] += pixel(rgb, W / 2 - 2 + i % 5, H / 2 + (k == 1 ? -21 : k == 2 ? 17 : -2) + i / 5)[1];
    print_message("%d white, %d bright; green %d in the middle, %d above, %d below\n", white, bright, sum[0] / 25,
                  sum[1] / 25, sum[2] / 25);
    assert_true(white < 10);  // 1285 where all of it was as bright as the film shows
    assert_true(bright > 30); // where scale is off, as bright as a flame's body; if nowhere, the ball looked matt
    assert_true(sum[0] > sum[1] + 25 * 20 && sum[1] > sum[2] + 25 * 10);
}

/// A sheet over the table darkens it, softly.
TEST(a_sheet_darkens_the_table) {
    static uint8_t with[BYTES], without[BYTES];
    PreviewDef def = above();
    def.sun_direction[0] = -1, def.sun_direction[1] = 0, def.sun_direction[2] = 1; // the shadow falls to +x
    quad_make(&q, 0.03f, 0.08f);
    draw(&def, &q.surface, 0, with);
    draw(&def, &nothing, 0, without);
    int x = (int)(W / 2 + 0.08f / (0.5f * tanf(0.35f)) * (H / 2));
    assert_true(pixel(with, x, H / 2)[0] + 25 < pixel(without, x, H / 2)[0]);
    assert_true(abs(pixel(with, 4, 4)[0] - pixel(without, 4, 4)[0]) <= 4);
}

TEST(bad_vertices_are_refused) {
    PreviewDef def = above();
    const float bad[] = {NAN, INFINITY, -INFINITY, 1e30f};

    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        quad_make(&q, 0.1f, 0.01f);
        q.position[3][1] = bad[k]; // the second triangle goes, the first stays
        q.rest[1][0] = bad[k], q.normal[1][2] = bad[k], q.uv[1][0] = bad[k];
        q.burn[1] = bad[k] > 0 ? NAN : bad[k], q.rate[1] = bad[k];
        q.temperature[1] = bad[k] == 1e30f ? NAN : bad[k];
        draw(&def, &q.surface, 0, rgb);
        assert_in_range(pixel(rgb, W / 2 + 5, H / 2 + 8)[1], 200, 252);
        assert_true(pixel(rgb, W / 2 - 8, H / 2 - 5)[1] < 190);
    }

    quad_make(&q, 0.1f, 0.01f);
    q.triangles[1][2] = 0; // degenerate
    memset(q.normal, 0, sizeof q.normal);
    draw(&def, &q.surface, 0, rgb);
    assert_in_range(pixel(rgb, W / 2 + 5, H / 2 + 8)[1], 200, 252); // the good triangle
    assert_true(pixel(rgb, W / 2 - 8, H / 2 - 5)[1] < 190);         // the table where the other was
}

static SingeResult draw_result(const SingeSurface *surface, double time, SingeError *error) {
    PreviewDef def = above();
    Preview *preview = NULL;
    assert_int_equal(preview_create(&def, (SingeAllocator){0}, &preview, error), SINGE_OK);
    SingeResult result = preview_draw(preview, surface, time, rgb, error);
    preview_destroy(preview);
    return result;
}

TEST(bad_surfaces_are_refused) {
    SingeError error = {0};
    quad_make(&q, 0.1f, 0.01f);
    q.triangles[1][1] = 4;
    assert_int_equal(draw_result(&q.surface, 0, &error), SINGE_ERROR_ARGUMENT);
    assert_int_equal(error.element, 1);
    assert_string_equal(error.stage, "preview");
    quad_make(&q, 0.1f, 0.01f);
    q.surface.burn = NULL;
    assert_int_equal(draw_result(&q.surface, 0, &error), SINGE_ERROR_ARGUMENT);
    quad_make(&q, 0.1f, 0.01f);
    q.surface.triangles = NULL;
    assert_int_equal(draw_result(&q.surface, 0, &error), SINGE_ERROR_ARGUMENT);
    quad_make(&q, 0.1f, 0.01f);
    assert_int_equal(draw_result(&q.surface, (double)NAN, &error), SINGE_ERROR_ARGUMENT);
    assert_int_equal(draw_result(&q.surface, 1e30, NULL), SINGE_OK);
}

static void refused(PreviewDef def, const char *word) {
    Preview *preview = (Preview *)&def;
    SingeError error = {0};
    assert_int_equal(preview_create(&def, (SingeAllocator){0}, &preview, &error), SINGE_ERROR_ARGUMENT);
    assert_null(preview);
    assert_non_null(strstr(error.message, word));
    assert_int_equal(preview_create(&def, (SingeAllocator){0}, &preview, NULL), SINGE_ERROR_ARGUMENT);
}

#define REFUSED(change, word)     \
    do {                          \
        PreviewDef def = small(); \
        change;                   \
        refused(def, word);       \
    } while (0)

TEST(bad_defs_are_refused) {
    REFUSED(def.width = 0, "width");
    REFUSED(def.height = -3, "height");
    REFUSED(def.width = 1 << 20, "width");
    REFUSED(def.samples = 0, "samples");
    REFUSED(def.thread_count = 0, "thread_count");
    REFUSED(def.thread_count = 65, "thread_count");
    REFUSED(def.camera.eye[1] = NAN, "camera");
    REFUSED(def.camera.target[2] = INFINITY, "camera");
    REFUSED(def.camera.up[0] = NAN, "camera");
    REFUSED(memset(def.camera.up, 0, sizeof def.camera.up), "up");
    REFUSED(memcpy(def.camera.target, def.camera.eye, sizeof def.camera.eye), "same point");
    REFUSED(def.camera.fov = 0, "fov");
    REFUSED(def.camera.fov = 3.2f, "fov");
    REFUSED(memset(def.sun_direction, 0, sizeof def.sun_direction), "sun_direction");
    REFUSED(def.sun_direction[0] = NAN, "sun_direction");
    REFUSED(def.sun_angle = -1, "sun_angle");
    REFUSED(def.sun_colour[2] = NAN, "colour");
    REFUSED(def.ground_colour[2] = -1, "colour");
    REFUSED(def.exposure = 0, "exposure");
    REFUSED(def.camera.aperture = -1, "aperture");
    REFUSED(def.camera.aperture = NAN, "aperture");
    REFUSED(def.camera.focus = -1, "focus");
    REFUSED(def.camera.focus = INFINITY, "focus");
    REFUSED(def.shutter = -0.1f, "shutter");
    REFUSED(def.shutter = NAN, "shutter");
    REFUSED(def.pace = 0, "pace");
    REFUSED(def.ground = (PreviewGround)9, "ground");
    REFUSED(def.sky = (PreviewSky)9, "sky");
    REFUSED(def.sky = PREVIEW_SKY_PICTURE, "sky_picture");
    REFUSED(def.sky_turn = NAN, "sky_turn");
    REFUSED(def.ground_height = NAN, "ground_height");
    REFUSED(def.ground_height = INFINITY, "ground_height");
    REFUSED(def.wall = (PreviewWall)9, "wall");
    REFUSED(def.wall_distance = NAN, "wall_distance");
    REFUSED(def.wall_distance = INFINITY, "wall_distance");
    REFUSED(def.shape_count = 1, "shapes");
    PreviewShape shape = {.kind = SINGE_COLLIDER_SPHERE, .radius = 0, .temperature = 293};
    REFUSED((def.shapes = &shape, def.shape_count = 1), "shape");
    shape.radius = 1, shape.velocity[1] = NAN;
    REFUSED((def.shapes = &shape, def.shape_count = 1), "shape");
    shape.velocity[1] = 0, shape.temperature = NAN;
    REFUSED((def.shapes = &shape, def.shape_count = 1), "shape");
    shape.temperature = 293, shape.kind = SINGE_COLLIDER_BOX; // rotation is not a unit quaternion
    REFUSED((def.shapes = &shape, def.shape_count = 1), "shape");
    shape.kind = (SingeColliderKind)9;
    REFUSED((def.shapes = &shape, def.shape_count = 1), "shape");
    Image empty = {0};
    const Image *pictures[1] = {&empty};
    REFUSED((def.pictures = pictures, def.sheet_count = 1), "picture");
    REFUSED((def.backs = pictures, def.sheet_count = 1), "back");
    const float colours[1][3] = {{1, NAN, 1}};
    REFUSED((def.colours = colours, def.sheet_count = 1), "colour");
}

/// Sizes that are no multiple of anything, one sample, straight down with `up` along the view.
TEST(odd_sizes_are_drawn) {
    SingeSurface surface;
    assert_true(synthetic_make(SYNTHETIC_HANGING, 12, 0.05f, &surface));
    const int sizes[][3] = {{1, 1, 1}, {3, 5, 2}, {17, 33, 5}, {70, 2, 7}, {33, 9, 12}};
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
        PreviewDef def = small();
        def.width = sizes[k][0], def.height = sizes[k][1], def.samples = sizes[k][2], def.thread_count = 2;
        uint8_t *picture = malloc((size_t)(def.width * def.height * 3));
        assert_non_null(picture);
        draw(&def, &surface, 1, picture);
        def.camera = (PreviewCamera){.eye = {0, 0, 0.9f}, .target = {0, 0, 0}, .up = {0, 0, 1}, .fov = 0.5f};
        draw(&def, &surface, 1, picture);
        free(picture);
    }

    synthetic_free(&surface);
}

/// Every allocation fails once: the right result, nothing left behind, and a failed frame can be drawn again.
TEST(every_allocation_fails_once) {
    uint8_t texels[4 * 4 * 3] = {0};
    Image image = {.width = 4, .height = 4, .rgb = texels};
    const Image *pictures[1] = {&image};
    PreviewShape shapes[2] = {{.kind = SINGE_COLLIDER_SPHERE, .radius = 0.01f, .temperature = 293},
                              {.kind = SINGE_COLLIDER_PLANE, .rotation = {0, 0, 0, 1}, .temperature = 293}};
    PreviewDef def = small();
    def.samples = 1, def.shutter = 0.01f, def.pictures = pictures, def.sheet_count = 1, def.shapes = shapes,
    def.shape_count = 2;
    quad_make(&q, 0.1f, 0.01f);
    bool succeeded = false;
    for (int n = 0; n < 60 && !succeeded; n++) {
        TestAllocator allocator = {.fail_at = n + 1};
        Preview *preview = NULL;
        SingeError error = {0};
        SingeResult result = preview_create(&def, test_allocator(&allocator), &preview, &error);
        if (!result) result = preview_draw(preview, &q.surface, 0, rgb, &error);
        succeeded = !result;
        if (result) assert_int_equal(result, SINGE_ERROR_MEMORY);
        if (result && preview) {
            allocator.fail_at = 0;
            assert_int_equal(preview_draw(preview, &q.surface, 0, rgb, &error), SINGE_OK);
        }

        preview_destroy(preview);
        test_allocator_check(&allocator);
    }

    assert_true(succeeded);
}

TEST(shapes_can_be_set_anew) {
    PreviewDef def = above();
    Preview *preview = NULL;
    SingeError error = {0};

    assert_int_equal(preview_create(&def, (SingeAllocator){0}, &preview, &error), SINGE_OK);
    PreviewShape ball = {.kind = SINGE_COLLIDER_SPHERE,
                         .position = {0, 0, 0.03f},
                         .radius = 0.03f,
                         .colour = {0.1f, 0.1f, 0.8f},
                         .temperature = 293};
    assert_int_equal(preview_set_shapes(preview, &ball, 1, &error), SINGE_OK);
    ball.radius = -1; // copied: this must not matter, but is refused when set
    assert_int_equal(preview_draw(preview, &nothing, 0, rgb, &error), SINGE_OK);
    assert_true(pixel(rgb, W / 2, H / 2)[2] > pixel(rgb, W / 2, H / 2)[0] + 50);
    assert_int_equal(preview_set_shapes(preview, &ball, 1, &error), SINGE_ERROR_ARGUMENT);
    assert_int_equal(error.element, 0);
    assert_int_equal(preview_draw(preview, &nothing, 0, rgb, &error), SINGE_OK);
    assert_true(pixel(rgb, W / 2, H / 2)[2] > pixel(rgb, W / 2, H / 2)[0] + 50);
    assert_int_equal(preview_set_shapes(preview, NULL, 0, &error), SINGE_OK);
    assert_int_equal(preview_draw(preview, &nothing, 0, rgb, &error), SINGE_OK);
    assert_true(pixel(rgb, W / 2, H / 2)[0] > pixel(rgb, W / 2, H / 2)[2]);
    preview_destroy(preview);
}
