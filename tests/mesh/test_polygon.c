// Polygons of every shape become quads that cover exactly their area, or are refused with their line.
#include "sample_meshes.h"

static Text text;

/// A ring in the plane: positions and the corners that name them, from 0.
typedef struct Shape {
    double at[400][2];
    int corner[800], positions, corners;
} Shape;

static int shape_position(Shape *shape, double x, double y) {
    shape->at[shape->positions][0] = x, shape->at[shape->positions][1] = y;
    return shape->positions++;
}
static void shape_corner(Shape *shape, int position) { shape->corner[shape->corners++] = position; }

static void corner_at(Shape *shape, double radius, double angle) {
    shape_corner(shape, shape_position(shape, radius * cos(angle), radius * sin(angle)));
}

static Shape shape_of(const double (*at)[2], int positions, const int *corner, int corners) {
    Shape shape = {0};
    for (int i = 0; i < positions; i++) shape_position(&shape, at[i][0], at[i][1]);
    for (int i = 0; i < corners; i++) shape_corner(&shape, corner ? corner[i] : i);
    return shape;
}

#define SHAPE(positions, ...)                                                                    \
    shape_of(positions, (int)(sizeof positions / sizeof *positions), (const int[]){__VA_ARGS__}, \
             (int)(sizeof(int[]){__VA_ARGS__} / sizeof(int)))

/// The plane that shapes lie in, inclined so that no axis of the file is its normal.
static const double plane[2][3] = {{0.8, 0, 0.6}, {0.36, 0.8, -0.48}};

static Made make_shape(const Shape *shape, SingeMeshQuads quads) {
    MeshOptions options = mesh_default_options();
    options.quads = quads;
    text.size = 0;
    for (int i = 0; i < shape->positions; i++) {
        const double *p = shape->at[i];
        text_add(&text, "v %.9g %.9g %.9g\n", p[0] * plane[0][0] + p[1] * plane[1][0],
                 p[0] * plane[0][1] + p[1] * plane[1][1], p[0] * plane[0][2] + p[1] * plane[1][2]);
    }

    text_add(&text, "f");
    for (int i = 0; i < shape->corners; i++) text_add(&text, " %d", shape->corner[i] + 1);
    text_add(&text, "\n");
    return make_with(&text, options);
}

static double cross2(const double *a, const double *b, const double *c) {
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/// How often the ring winds around a point.
static int winding(const Shape *shape, const double *p) {
    int rounds = 0;
    for (int i = 0; i < shape->corners; i++) {
        const double *a = shape->at[shape->corner[i]], *b = shape->at[shape->corner[(i + 1) % shape->corners]];
        if (a[1] <= p[1] && b[1] > p[1] && cross2(a, b, p) > 0) rounds++;
        if (a[1] > p[1] && b[1] <= p[1] && cross2(a, b, p) < 0) rounds--;
    }

    return rounds;
}

static double area_of(const Shape *shape) {
    double area = 0;
    for (int i = 0; i < shape->corners; i++) {
        const double *a = shape->at[shape->corner[i]], *b = shape->at[shape->corner[(i + 1) % shape->corners]];
        area += 0.5 * (a[0] * b[1] - a[1] * b[0]);
    }
    return area;
}

/// The four triangles that a cell is drawn as, in the plane.
static void cell_triangle(const Mesh *mesh, uint32_t cell, uint32_t side, double at[3][2]) {
    memset(at, 0, 3 * sizeof *at);
    for (uint32_t k = 0; k < 4; k++) {
        const float *p = mesh->positions + 3 * mesh->cells[4 * cell + k];
        double flat[2] = {0, 0};
        for (int i = 0; i < 3; i++) flat[0] += p[i] * plane[0][i], flat[1] += p[i] * plane[1][i];
        for (int i = 0; i < 2; i++) {
            at[2][i] += 0.25 * flat[i];
            if (k == side) at[0][i] = flat[i];
            if (k == (side + 1) % 4) at[1][i] = flat[i];
        }
    }
}

static int covers(const Mesh *mesh, const double *p) {
    int count = 0;
    for (uint32_t i = 0; i < 4 * mesh->cell_count; i++) {
        double at[3][2];
        cell_triangle(mesh, i / 4, i % 4, at);
        double turn = cross2(at[0], at[1], at[2]);
        count += turn * cross2(at[0], at[1], p) > 0 && turn * cross2(at[1], at[2], p) > 0 &&
                 turn * cross2(at[2], at[0], p) > 0;
    }

    return count;
}

/// `area` in the plane; points of a raster are covered once where the shape winds around them, and else never.
/// Corners that meet are drawn apart, which takes some of it.
static void assert_covers_but(const Shape *shape, double area, double less, const char *name) {
    for (SingeMeshQuads quads = SINGE_MESH_PAIR; quads <= SINGE_MESH_SPLIT; quads++) {
        Made made = make_shape(shape, quads);
        if (made.result) fail_msg("%s: %s", name, made.error.message);

        double sum = 0, low[2] = {1e9, 1e9}, high[2] = {-1e9, -1e9};
        for (uint32_t i = 0; i < 4 * made.mesh.cell_count; i++) {
            double at[3][2];
            cell_triangle(&made.mesh, i / 4, i % 4, at);
            sum += 0.5 * fabs(cross2(at[0], at[1], at[2]));
        }

        if (fabs(sum - area) > (1e-5 + less) * area) fail_msg("%s: area %g instead of %g", name, sum, area);
        for (int i = 0; i < shape->positions; i++)
            for (int k = 0; k < 2; k++) {
                low[k] = fmin(low[k], shape->at[i][k]), high[k] = fmax(high[k], shape->at[i][k]);
            }

        for (int i = 0; i < 15 * 15; i++) {
            const double p[2] = {low[0] + (high[0] - low[0]) * (i % 15 + 0.4137) / 15,
                                 low[1] + (high[1] - low[1]) * (i / 15 + 0.5871) / 15};
            if (less == 0 ? covers(&made.mesh, p) != (winding(shape, p) != 0) : covers(&made.mesh, p) > 1)
                fail_msg("%s: (%g, %g) is covered %d times", name, p[0], p[1], covers(&made.mesh, p));
        }

        mesh_free(&made.mesh);
    }
}

static void assert_covers(const Shape *shape, double area, const char *name) {
    assert_covers_but(shape, area, 0, name);
}

static void assert_refused(const Shape *shape, const char *name) {
    for (SingeMeshQuads quads = SINGE_MESH_PAIR; quads <= SINGE_MESH_SPLIT; quads++) {
        Made made = make_shape(shape, quads);
        if (made.result != SINGE_ERROR_MESH) fail_msg("%s is not refused", name);
        char line[40];
        snprintf(line, sizeof line, "a.obj:%d: ", shape->positions + 1);
        if (!strstr(made.error.message, line)) fail_msg("%s: %s", name, made.error.message);
    }
}

// ---- holes

static const double holes[][2] = {{0, 0}, {8, 0}, {8, 8}, {0, 8}, {1, 1}, {3, 1},  {3, 3},
                                  {1, 3}, {5, 5}, {7, 5}, {7, 7}, {5, 7}, {10, 2}, {4, 2}};

TEST(holes_stay_open) {
    Shape shape = SHAPE(holes, 0, 1, 2, 3, 0, 4, 7, 6, 5, 4);
    assert_covers(&shape, 60, "a keyhole");
    shape = SHAPE(holes, 5, 4, 0, 1, 2, 3, 0, 4, 7, 6);
    assert_covers(&shape, 60, "a keyhole, from within");
    shape = SHAPE(holes, 4, 5, 6, 7, 4, 0, 3, 2, 1, 0);
    assert_covers(&shape, 60, "a keyhole, turned over");
    shape = SHAPE(holes, 0, 1, 2, 10, 9, 8, 11, 10, 2, 3, 0, 4, 7, 6, 5, 4);
    assert_covers(&shape, 56, "two keyholes");
    shape = SHAPE(holes, 0, 1, 2, 3, 0, 4, 7, 6, 8, 11, 10, 9, 8, 6, 5, 4);
    assert_covers(&shape, 56, "a keyhole that leads to another");
    shape = SHAPE(holes, 0, 1, 2, 3, 0, 7, 6, 5);
    assert_covers_but(&shape, 58, 0.02, "a hole that hangs at a corner");
    shape = SHAPE(holes, 0, 1, 2, 3, 0, 4, 7, 12, 4);
    assert_refused(&shape, "a hole that goes beyond a side");
    shape = SHAPE(holes, 0, 1, 2, 3, 0, 4, 7, 13, 4, 5, 7, 6, 4);
    assert_refused(&shape, "holes that lie on each other");
}

/// A hole's vertices may be others at the same positions, as where each loop is drawn for itself.
TEST(bridges_of_two_vertices_are_one) {
    Shape shape = SHAPE(holes, 0, 1, 2, 3);
    shape_corner(&shape, shape_position(&shape, 0, 0));
    shape_corner(&shape, 4), shape_corner(&shape, 7), shape_corner(&shape, 6), shape_corner(&shape, 5);
    shape_corner(&shape, shape_position(&shape, 1, 1));
    assert_covers(&shape, 60, "a bridge of two sides");
}

static void ring_around(Shape *shape, int n, double radius, int way) {
    int first = shape->positions;
    for (int i = 0; i < n; i++)
        shape_position(shape, radius * cos(6.283185307179586 * i / n), radius * sin(6.283185307179586 * i / n));
    for (int i = 0; i <= n; i++) shape_corner(shape, first + (way * i + n) % n);
}

TEST(large_rings_keep_their_hole) {
    for (int n = 6; n <= 150; n += 36) {
        Shape shape = {0};
        ring_around(&shape, n, 3, 1);
        ring_around(&shape, n / 2, 1, -1);
        double outer = 4.5 * n * sin(6.283185307179586 / n), inner = 0.25 * n * sin(12.566370614359172 / n);
        assert_covers(&shape, outer - inner, "a ring");
    }
}

// ---- bays

TEST(bays_stay_open) {
    static const double arrow[][2] = {{0, 0}, {4, -3}, {1, 0}, {4, 3}};
    static const double letter_u[][2] = {{0, 0}, {5, 0}, {5, 6}, {4, 6}, {4, 1}, {1, 1}, {1, 6}, {0, 6}};
    Shape shape = SHAPE(arrow, 0, 1, 2, 3);

    assert_covers(&shape, 3, "an arrow head");
    shape = SHAPE(arrow, 2, 3, 0, 1);
    assert_covers(&shape, 3, "an arrow head, from its bay");
    shape = SHAPE(letter_u, 0, 1, 2, 3, 4, 5, 6, 7);
    assert_covers(&shape, 15, "a U");
    for (int teeth = 3; teeth <= 90; teeth += 29) { // a comb
        shape = (Shape){0};
        for (int i = 0; i < teeth; i++) {
            shape_corner(&shape, shape_position(&shape, i, 1));
            shape_corner(&shape, shape_position(&shape, i + 0.5, 9));
        }
        shape_corner(&shape, shape_position(&shape, teeth, 1));
        shape_corner(&shape, shape_position(&shape, teeth, 0));
        shape_corner(&shape, shape_position(&shape, 0, 0));
        assert_covers(&shape, fabs(area_of(&shape)), "a comb");
    }

    shape = (Shape){0}; // a spiral of two and a half rounds
    for (int i = 0; i <= 50; i++) corner_at(&shape, 2 + 0.1 * i, 0.3 * i);
    for (int i = 50; i >= 0; i--) corner_at(&shape, 1 + 0.1 * i, 0.3 * i);
    assert_covers(&shape, fabs(area_of(&shape)), "a spiral");
}

TEST(random_stars_are_covered) {
    uint32_t random = 7;
    for (int turn = 0; turn < 60; turn += 2) {
        Shape shape = {0};
        const int n = 5 + turn;
        for (int i = 0; i < n; i++) {
            random = random * 1664525u + 1013904223u;
            double radius = 0.2 + (random >> 8) / (double)(1 << 24);
            corner_at(&shape, radius, 6.2831853 * i / n);
        }

        assert_covers(&shape, area_of(&shape), "a random star");
    }
}

// ---- corners that say nothing, or twice

static const double few[][2] = {{0, 0},  {4, 0}, {4, 4},   {0, 4},  {2, 0}, {6, 6},
                                {-2, 2}, {2, 2}, {-2, -2}, {4, -2}, {6, 0}, {2, 5}};

TEST(faces_in_contact_with_themselves_are_split) {
    Shape shape = SHAPE(few, 0, 9, 1, 0, 3, 6);
    assert_covers_but(&shape, 8, 0.02, "two triangles that meet in a corner");
    shape = SHAPE(few, 0, 9, 1, 0, 6, 3);
    assert_covers_but(&shape, 8, 0.02, "two triangles that meet in a corner, one turned over");
    shape = SHAPE(few, 0, 1, 1, 2, 3, 3);
    assert_covers(&shape, 16, "corners one after the other");
    shape = SHAPE(few, 0, 1, 10, 1, 2, 3);
    assert_covers(&shape, 16, "a spike");
    shape = SHAPE(few, 10, 1, 2, 3, 0, 1);
    assert_covers(&shape, 16, "a spike at its beginning");
    shape = SHAPE(few, 0, 10, 1, 2, 3);
    assert_covers(&shape, 16, "a spike on a line");
    shape = SHAPE(few, 0, 4, 1, 2, 11, 2, 3);
    assert_covers(&shape, 16, "a spike and a corner without an angle");
    shape = SHAPE(few, 0, 1, 2, 7, 2, 3);
    assert_covers(&shape, 16, "a spike inwards");
    shape = SHAPE(few, 0, 1, 2, 3, 0, 1, 2, 3);
    assert_covers(&shape, 16, "a square wound twice");

    static const double tooth[][2] = {{0, 0}, {8, 0}, {8, 8}, {0, 8}, {0, 5}, {4, 0}, {6, 4}, {2, 4}};
    shape = SHAPE(tooth, 0, 1, 2, 3, 4, 7, 6, 5, 7, 4);
    assert_covers_but(&shape, 56, 0.02, "a hole that touches a side");
}

TEST(self_crossing_polygons_are_refused) {
    static const double star[][2] = {{1, 0}, {0.309, 0.951}, {-0.809, 0.588}, {-0.809, -0.588}, {0.309, -0.951}};
    Shape shape = SHAPE(few, 0, 2, 1, 3);
    assert_refused(&shape, "a bow tie");
    shape = SHAPE(few, 0, 5, 1, 3);
    assert_refused(&shape, "a bow tie of different wings");
    shape = SHAPE(star, 0, 2, 4, 1, 3);
    assert_refused(&shape, "a star drawn in one line");
    shape = (Shape){0};
    for (int i = 0; i < 20; i++) corner_at(&shape, 3 + i % 2 + 0.001 * i, 0.6283185307 * i);

    assert_refused(&shape, "a ring wound twice");
    shape = (Shape){0};
    for (int i = 0; i < 120; i++) corner_at(&shape, 3 - 0.002 * i, 0.15 * i);
    assert_refused(&shape, "a large ring wound three times");
}

/// Bent polygons keep the area of a surface between their corners, and a folded quad is cut along its fold.
TEST(bent_polygons_are_covered) {
    text.size = 0;
    text_add(&text, "v 0 0 0\nv 5 0 .3\nv 5 6 0\nv 4 6 .2\nv 4 1 0\nv 1 1 .4\nv 1 6 0\nv 0 6 .3\nf 1 2 3 4 5 6 7 8\n");

    Made made = make(&text);
    double area = 0;
    for (uint32_t i = 0; i < 4 * made.mesh.cell_count; i++) {
        const float *p[4];
        double a[2], b[2], c[2] = {0, 0};
        for (uint32_t k = 0; k < 4; k++) p[k] = made.mesh.positions + 3 * made.mesh.cells[i / 4 * 4 + k];
        for (int k = 0; k < 2; k++) {
            a[k] = p[i % 4][k], b[k] = p[(i + 1) % 4][k];
            for (int v = 0; v < 4; v++) c[k] += 0.25 * p[v][k];
        }
        area += 0.5 * fabs(cross2(a, b, c));
    }

    assert_float_equal(area, 15, 1e-4);
    mesh_free(&made.mesh);
    text.size = 0; // folded by 120 degrees
    text_add(&text, "v 0 0 0\nv 1 1 0\nv 0 2 0\nv -.5 1 1.5\nf 1 2 3 4\nf 1 3 2\n");
    made = make(&text);
    assert_int_not_equal(made.mesh.cell_count, 0);
    mesh_free(&made.mesh);
}
