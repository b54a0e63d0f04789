// A landscape: cotton falls onto a height field, a grid of heights.
//
// Prints:
//   it lies on the hills, at most 3 mm above them
#include "sample.h"

enum { NODES = 41 };
static const float SIDE = 0.2f;

static float hill(float x, float y) { return 0.012f * (sinf(50 * x) * cosf(50 * y) + 1); }

int main(void) {
    static float heights[NODES * NODES];
    for (int i = 0; i < NODES * NODES; i++)
        heights[i] =
            hill(SIDE * ((float)(i % NODES) / (NODES - 1) - 0.5f), SIDE * ((float)(i / NODES) / (NODES - 1) - 0.5f));
    SingeSheetDef cloth = singe_default_sheet();
    SingeError error;
    must(singe_material_preset("cotton", &cloth.material, &error), &error);
    cloth.material.damping = singe_param(4);
    SingeSim *sim = sample_sim(singe_default_sim());
    sample_sheet(sim, cloth, 0.15f, 22, 0.04f);
    SingeColliderDef land = singe_default_collider();
    land.kind = SINGE_COLLIDER_HEIGHTFIELD, land.columns = land.rows = NODES, land.heights = heights;
    land.size[0] = land.size[1] = SIDE;
    TRY(sim, singe_sim_add_collider(sim, &land, NULL));
    TRY(sim, singe_sim_commit(sim));
    TRY(sim, singe_sim_advance(sim, 0.5, 0, NULL));
    const SingeView view = singe_sim_view(sim);
    uint32_t near = 0;
    for (uint32_t i = 0; i < view.vertex_count; i++)
        near += view.position[i][2] - hill(view.position[i][0], view.position[i][1]) < 0.003f;
    printf("it lies on the hills, %s\n", 2 * near > view.vertex_count ? "at most 3 mm above them" : "and hovers");
    singe_sim_destroy(sim);
}
