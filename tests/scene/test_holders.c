// What holds sheets, in pictures.
#include "parsing.h"
#include "preview/fixture.h"

#include "common/float3.h"
#include "scene/assets.h"

typedef struct Hung {
    Scene *scene;
    SceneAssets assets;
    PreviewShape shapes[16];
    uint32_t count;
} Hung;

static Hung hang_text(const char *text) {
    Hung hung = {.scene = good_scene(text, NULL, 0)};
    OwnMessages messages = {0};
    assert_int_equal(scene_load(hung.scene, &hung.assets, &messages), SINGE_OK);
    return hung;
}

/// A sheet of 0.2 x 0.3 m that stands upright, its upper edge at z = 0.15, and pins.
static Hung hang(const char *more) {
    char text[2000];
    snprintf(text, sizeof text,
             "sheets: [{grid: {size: [0.2, 0.3], cells: [40, 60], jitter: 0}, rotate: [90, 0, 0]}]\n%s\n", more);
    return hang_text(text);
}

static void gather(Hung *hung, double time) {
    hung->count = scene_shapes(hung->scene, &hung->assets, time, hung->shapes, 16);
    assert_true(hung->count <= 16);
}

static void let_go(Hung *hung) {
    scene_assets_free(&hung->assets);
    scene_free(hung->scene);
}

/// The lowest and the highest corner of a shape in the world; checks that its surface is closed and faces out.
static void measure(const PreviewShape *shape, Float3 *low, Float3 *high) {
    const PreviewSolid *s = shape->solid;
    double volume = 0, open[3] = {0, 0, 0};
    *low = float3(INFINITY, INFINITY, INFINITY);
    *high = float3(-INFINITY, -INFINITY, -INFINITY);

    for (uint32_t t = 0; t < s->triangle_count; t++) {
        double area[3];
        const float *p[3];
        for (int k = 0; k < 3; k++) p[k] = s->vertices + 3 * (size_t)s->triangles[3 * t + (uint32_t)k];
        area3(p[0], p[1], p[2], area);
        for (int k = 0; k < 3; k++) volume += area[k] * (double)p[0][k] / 6, open[k] += area[k];
    }

    for (uint32_t v = 0; v < s->vertex_count; v++) {
        const Float3 p = float3_add(float3_load(shape->position),
                                    quat_rotate(shape->rotation, float3_load(s->vertices + 3 * (size_t)v)));
        *low = float3(fminf(low->x, p.x), fminf(low->y, p.y), fminf(low->z, p.z));
        *high = float3(fmaxf(high->x, p.x), fmaxf(high->y, p.y), fmaxf(high->z, p.z));
    }

    assert_true(s->triangle_count > 0 && volume > 0);
    for (int k = 0; k < 3; k++) assert_true(fabs(open[k]) < 1e-6);
}

#define PIN "pins: [{points: [[-0.05, 0, 0.15], [0.05, 0, 0.15]], radius: 8 mm"

/// Without the key nothing is drawn, and where a pin holds the inside of a sheet there is no edge.
TEST(nothing_holds_what_has_no_holder) {
    const char *const scenes[] = {PIN "}]", PIN ", holder: none}]",
                                  "pins: [{points: [[0, 0, 0]], radius: 8 mm, holder: peg}]"};
    for (int i = 0; i < 3; i++) {
        Hung hung = hang(scenes[i]);
        gather(&hung, 0);
        assert_int_equal(hung.count, 0);
        assert_int_equal(scene_slots(hung.scene, &hung.assets), 0);
        let_go(&hung);
    }
}

/// Two pegs stand on the edge, on both sides of the sheet, and a cord goes on beyond them. All of it follows the pin.
TEST(pegs_stand_on_the_edge_and_follow_their_pin) {
    Hung hung = hang(PIN ", holder: peg, path: [{time: 0, position: [0, 0, 1]}, {time: 1, position: [0.3, 0, 1]}]}]");
    gather(&hung, 0);
    assert_int_equal(hung.count, 5); // of each peg the wood and the spring
    assert_int_equal(hung.shapes[0].surface, PREVIEW_SURFACE_WOOD);
    assert_int_equal(hung.shapes[2].surface, PREVIEW_SURFACE_WOOD);
    assert_int_equal(hung.shapes[4].surface, PREVIEW_SURFACE_CORD);

    Float3 low, high, first;
    measure(&hung.shapes[2], &low, &high);
    assert_true(high.x < 0.06f && high.x > 0.05f);
    measure(&hung.shapes[0], &first, &high);
    assert_true(first.x > -0.06f && first.x < -0.05f);
    assert_true(first.y < -0.005f && high.y > 0.005f);
    assert_true(fabsf(first.z - 0.138f) < 0.002f && fabsf(high.z - 0.21f) < 0.002f);
    measure(&hung.shapes[1], &low, &high);
    assert_true(low.z > 0.15f && high.z < 0.18f);
    measure(&hung.shapes[4], &low, &high);
    assert_true(low.x < -0.7f && high.x > 0.7f && low.z > 0.15f);

    gather(&hung, 0.5);
    for (int i = 0; i < 5; i++) assert_true(fabsf(hung.shapes[i].velocity[0] - 0.3f) < 1e-3f);
    measure(&hung.shapes[0], &low, &high);
    assert_true(fabsf(low.x - first.x - 0.15f) < 1e-5f && fabsf(low.z - first.z) < 1e-5f);
    let_go(&hung);
}

/// A clip turns with its pin; its rod goes away from the sheet.
TEST(clips_turn_with_their_pin) {
    Hung hung = hang("pins: [{points: [[0.1, 0, -0.01], [0.1, 0, 0.01]], radius: 12 mm, holder: clip,\n"
                     "  path: [{time: 0}, {time: 1, rotation: [0, 90, 0]}]}]");
    Float3 low, high;

    gather(&hung, 0);
    assert_int_equal(hung.count, 2); // the plate, and its wires
    measure(&hung.shapes[0], &low, &high);
    assert_true(low.x > 0.088f && low.x < 0.095f && high.x < 0.12f && fabsf(high.z) < 0.025f);
    measure(&hung.shapes[1], &low, &high);
    assert_true(high.x > 0.6f && fabsf(high.z) < 0.025f);
    gather(&hung, 1);
    measure(&hung.shapes[1], &low, &high); // about y: x turns down
    assert_true(low.z < -0.6f && high.z < -0.088f && fabsf(high.x) < 0.025f);
    let_go(&hung);
}

/// Sheets that lie one before the other share a clip, whose jaws are around all of them; those farther apart have their own.
TEST(sheets_one_before_the_other_share_a_clip) {
    for (int apart = 0; apart < 2; apart++) {
        char text[2000];
        int used = snprintf(text, sizeof text, "sheets:\n");
        const double step = apart ? 0.05 : 0.012;
        for (int i = 0; i < 3; i++)
            used +=
                snprintf(text + used, sizeof text - (size_t)used,
                         "  - {name: s%d, grid: {size: [0.1, 0.15], cells: [20, 30], jitter: 0}, rotate: [90, %d, 0], "
                         "translate: [0, %g, 0]}\n",
                         i, 5 * i, i * step);
        used += snprintf(text + used, sizeof text - (size_t)used, "pins:\n");
        for (int i = 0; i < 3; i++)
            used += snprintf(text + used, sizeof text - (size_t)used,
                             "  - {sheet: s%d, points: [[0, %g, 0.075]], radius: 14 mm, holder: clip}\n", i, i * step);
        Hung hung = hang_text(text);
        gather(&hung, 0);
        assert_int_equal(hung.count, apart ? 6 : 2);

        Float3 low, high;
        measure(&hung.shapes[0], &low, &high);
        print_message("%u shapes; a clip is %.1f mm deep\n", hung.count, 1e3 * (double)(high.y - low.y));
        if (apart) assert_true(high.y < 0.02f && low.y > -0.02f);
        else assert_true(low.y < -1e-3f && high.y > 0.025f && high.y - low.y < 0.04f);
        let_go(&hung);
    }
}

/// Rings hang from a capsule, and swing about it as their pins move; a rod is drawn where none is seen.
TEST(rings_hang_from_their_rod) {
    for (int way = 0; way < 3; way++) {
        static const char *const rods[] = {
            "colliders: [{kind: capsule, radius: 5 mm, height: 0.3, position: [0, 0, 0.165], rotation: [0, 90, 0]}]",
            "colliders: [{kind: capsule, radius: 5 mm, height: 0.3, position: [0, 0, 0.165], rotation: [0, 90, 0], "
            "visible: no}]",
            ""};
        char text[1000];
        snprintf(text, sizeof text,
                 "pins:\n  - {points: [[-0.05, 0, 0.15]], holder: ring, path: [{time: 0}, {time: 1, position: "
                 "[0.02, 0.014, 0]}]}\n  - {points: [[0.05, 0, 0.15]], holder: ring}\n%s",
                 rods[way]);

        Hung hung = hang(text);
        gather(&hung, 1);
        assert_int_equal(hung.count, 3); // the capsule or a rod of its own

        const PreviewShape *ring = &hung.shapes[way ? 0 : 1];
        Float3 low, high, x = quat_rotate(ring->rotation, float3(1, 0, 0));
        measure(ring, &low, &high);
        assert_true(fabsf(ring->position[0] + 0.03f) < 2e-3f);
        assert_true(fabsf(ring->position[1]) < 1e-6f && fabsf(ring->position[2] - 0.165f) < 1e-3f);
        assert_true(fabsf(x.y + 0.68f) < 0.05f && x.z > 0.68f);           // from the pin's point to the rod
        assert_true(high.z > 0.170f && low.z < 0.152f && low.z > 0.144f); // over the rod, down to the cloth
        let_go(&hung);
    }
}

/// How much of a picture shapes cover, and where their middle is.
static float covered(const Hung *hung, double time, int threads, uint8_t *rgb, float *middle) {
    static float coverage[W * H];
    PreviewDef def;
    Float4 q;
    Preview *preview = NULL;
    PreviewShape shapes[16];

    scene_preview(hung->scene, &hung->assets, &def);
    def.width = W;
    def.height = H;
    def.samples = 4;
    def.thread_count = threads;
    def.camera = (PreviewCamera){.eye = {0, -0.5f, 0.19f}, .target = {0, 0, 0.19f}, .up = {0, 0, 1}, .fov = 0.5f};
    def.shapes = shapes;
    def.shape_count = scene_shapes(hung->scene, &hung->assets, time, shapes, 16);

    quad_make(&q, 0.01f, -0.5f); // below the picture
    assert_int_equal(preview_create(&def, (SingeAllocator){0}, &preview, NULL), SINGE_OK);

    const PreviewLayers layers = {.coverage = coverage};
    assert_int_equal(preview_draw_layers(preview, &q.surface, time, rgb, &layers, NULL), SINGE_OK);
    preview_destroy(preview);

    float sum = 0, across = 0;
    for (int i = 0; i < W * H; i++) {
        sum += coverage[i];
        across += coverage[i] * ((float)(i % W) / W - 0.5f);
    }

    *middle = across / fmaxf(sum, 1);
    return sum / (W * H);
}

/// A picture shows pegs where the pin is, and they move with it; it has the same bytes for any number of threads.
TEST(pictures_show_what_holds_a_sheet) {
    static uint8_t rgb[BYTES], other[BYTES];
    float at, later;
    Hung bare = hang(PIN "}]"),
         hung = hang(PIN ", holder: peg, path: [{time: 0}, {time: 1, position: [0.05, 0, 0]}]}]");
    assert_true(covered(&bare, 0, 1, rgb, &at) == 0);

    const float share = covered(&hung, 0, 1, rgb, &at), now = covered(&hung, 1, 1, other, &later);
    print_message("%.3f and %.3f of the picture, %.3f and %.3f of its width from the middle\n", (double)share,
                  (double)now, (double)at, (double)later);
    assert_true(share > 0.015f && share < 0.1f && fabsf(at) < 0.02f);
    assert_true(now > 0.015f && later > at + 0.05f);
    covered(&hung, 1, 3, rgb, &later);
    assert_memory_equal(rgb, other, BYTES);
    let_go(&bare);
    let_go(&hung);
}

/// Pegs whose sheet has burnt are black where they held it, and wood where it has not.
TEST(pegs_are_singed_where_their_sheet_burns) {
    static uint8_t rgb[BYTES];
    double light[4];
    for (int k = 0; k < 4; k++) { // fresh, burnt, nothing left of it, and fresh, a strip of one coarse cell
        PreviewDef def;
        Preview *preview = NULL;
        PreviewShape shapes[16];
        Hung hung = hang("pins: [{points: [[0, 0, 0.15]], radius: 8 mm, holder: peg}]");
        Float4 q;
        quad_make(&q, 0.004f, k == 2 ? -0.5f : 0.15f);
        for (int i = 0; i < 4; i++) q.burn[i] = k == 1, q.position[i][0] *= k == 3 ? 25 : 1;
        scene_preview(hung.scene, &hung.assets, &def);
        def.width = W;
        def.height = H;
        def.samples = 4;
        def.camera =
            (PreviewCamera){.eye = {0, -0.2f, 0.144f}, .target = {0, 0, 0.144f}, .up = {0, 0, 1}, .fov = 0.05f};
        def.shapes = shapes;
        def.shape_count = scene_shapes(hung.scene, &hung.assets, 0, shapes, 16);
        assert_int_equal(preview_create(&def, (SingeAllocator){0}, &preview, NULL), SINGE_OK);
        assert_int_equal(preview_draw(preview, &q.surface, 0, rgb, NULL), SINGE_OK);
        preview_destroy(preview);
        light[k] = 0;
        for (int y = H / 2; y < H * 3 / 4; y++)
            for (int x = W * 2 / 5; x < W * 3 / 5; x++) light[k] += rgb[3 * (y * W + x)] / (0.25 * H * 0.2 * W);
        let_go(&hung);
    }
    print_message("red of the jaws: %.0f, burnt %.0f, nothing left %.0f, of a coarse strip %.0f\n", light[0], light[1],
                  light[2], light[3]);
    assert_true(light[0] > 60 && light[1] < 0.5 * light[0] && light[2] < 0.5 * light[0]);
    assert_true(light[3] > 0.8 * light[0]); // black where vertices were looked for
}
