// What a scene without `preview` looks like.
#include "parsing.h"
#include "preview/fixture.h"

/// White paper under a flame: the share of it that is so white that creases are lost, and the colour that is left of the
/// flame before it, the mean of 1 - blue/red.
static void see(const PreviewDef *light, float *white, float *colour) {
    static uint8_t rgb[BYTES];
    static float fire[W * H][4];
    static Ball ball;
    Float4 q;
    PreviewDef def = *light;
    def.width = W, def.height = H;
    def.camera = (PreviewCamera){.eye = {0, -0.35f, 0.35f}, .target = {0, 0, 0.03f}, .up = {0, 0, 1}, .fov = 0.5f};
    quad_make(&q, 0.6f, 0.001f);
    ball_make(&ball, 0, 0, 0.05f, 0.03f, 4e6f, 0);

    Preview *preview = NULL;
    PreviewLayers layers = {.fire = fire};
    assert_int_equal(preview_create(&def, (SingeAllocator){0}, &preview, NULL), SINGE_OK);
    assert_int_equal(preview_set_gas(preview, &ball.gas, NULL), SINGE_OK);
    assert_int_equal(preview_draw_layers(preview, &q.surface, 0.3, rgb, &layers, NULL), SINGE_OK);
    preview_destroy(preview);

    int paper = 0, pale = 0, flame = 0;
    *colour = 0;
    for (int i = 0; i < W * H; i++) {
        const uint8_t *p = rgb + 3 * i;
        const float light_of_fire = 0.21f * fire[i][0] + 0.72f * fire[i][1] + 0.07f * fire[i][2];
        paper += light_of_fire < 0.01f;
        pale += light_of_fire < 0.01f && p[1] > 225;
        if (light_of_fire < 0.3f) continue;
        flame++;
        *colour += 1 - (float)p[2] / (float)p[0];
    }

    assert_true(paper > W * H / 4 && flame > 100);
    *white = (float)pale / (float)paper;
    *colour /= (float)flame;
}

/// Paper that fire lights is not white, and flames before it keep their colour. Under the light of day, which was the
/// default before, both were lost. The bar of the colour was .44, then .50, while flames were paler; by day it was .36, then .45.
TEST(the_default_light_leaves_room_for_fire) {
    OwnScene *scene = good_scene("sheets: [{grid: {size: [1.2, 1.2], cells: [2, 2]}}]", NULL, 0);
    SceneAssets assets = {0};
    OwnMessages messages = {0};
    assert_int_equal(scene_load(scene, &assets, &messages), SINGE_OK);

    for (int day = 0; day < 2; day++) {
        PreviewDef def;
        scene_preview(scene, &assets, &def);
        static const float sun[3] = {2.05f, 1.70f, 1.32f}, sky[3] = {0.18f, 0.21f, 0.27f};
        for (int c = 0; day && c < 3; c++) def.sun_colour[c] = sun[c], def.sky_colour[c] = sky[c];

        float white, colour;
        see(&def, &white, &colour);
        print_message("%s: %.3f of the paper is white, colour of the flame %.2f\n", day ? "by day" : "by default",
                      (double)white, (double)colour);
        assert_true((white < 0.05f) == !day && (colour > 0.56f) == !day); // .51 by day
    }

    scene_assets_free(&assets);
}
