// Figure 6: the cases of marching triangles in the drawn surface.
#include <math.h>
#include <stdio.h>

#include "paper/paper.h"

enum { MARCH_CELLS = 6 };
static const double march_loss = 0.5;

typedef struct March {
    int cases[4];    ///< triangles by how many of their corners are left
    double expected; ///< m2 that eq 7 leaves
    int count;
    double centroids[4 * MARCH_CELLS * MARCH_CELLS][3]; ///< of the triangles: x, y, case
} March;

/// A cell's four triangles around its centre.
static void march_cell(March *march, const SingeView *view, const float *mass, uint32_t cell, double side) {
    const uint32_t *corner = view->cells[cell], m = view->vertex_count + cell;
    for (int k = 0; k < 4; k++) {
        uint32_t a = corner[k], b = corner[(k + 1) % 4];
        double level[3] = {(double)mass[a] - march_loss, (double)mass[b] - march_loss, 0};
        for (int i = 0; i < 4; i++) level[2] += (double)mass[corner[i]] / 4;
        level[2] -= march_loss;

        // the remaining share of the triangle, by eq 7, from the corner with a different sign
        const int inside = (level[0] >= 0) + (level[1] >= 0) + (level[2] >= 0);
        double share = inside == 3;
        for (int i = 0; i < 3; i++) {
            double p = level[i], q = level[(i + 1) % 3], r = level[(i + 2) % 3];
            if ((p >= 0) == (q >= 0) || (p >= 0) == (r >= 0)) continue;
            double cut = p / (p - q) * (p / (p - r));
            share = inside == 1 ? cut : 1 - cut;
        }

        march->expected += share * side * side / 4;
        march->cases[inside]++;

        double *centroid = march->centroids[march->count++];
        for (int d = 0; d < 2; d++)
            centroid[d] = ((double)view->rest_position[a][d] + (double)view->rest_position[b][d] +
                           (double)view->rest_position[m][d]) /
                          3;
        centroid[2] = inside;
    }
}

/// m2 in the rest plane.
static double drawn_area(const SingeSurface *surface) {
    double area = 0;
    for (uint32_t t = 0; t < surface->triangle_count; t++) {
        const float *p = surface->rest_position[surface->triangles[t][0]];
        const float *q = surface->rest_position[surface->triangles[t][1]];
        const float *r = surface->rest_position[surface->triangles[t][2]];
        area += fabs(((double)q[0] - (double)p[0]) * ((double)r[1] - (double)p[1]) -
                     ((double)q[1] - (double)p[1]) * ((double)r[0] - (double)p[0])) /
                2;
    }

    return area;
}

static int march_fewest(const March *march) {
    int fewest = march->cases[0];
    for (int k = 1; k <= 3; k++)
        if (march->cases[k] < fewest) fewest = march->cases[k];
    return fewest;
}

SingeResult paper_fig6(Lab *lab, SingeError *error) {
    enum { ROW = MARCH_CELLS + 1 };
    const double cell = 0.01;
    float mass[ROW * ROW];
    LabGrid grid = lab_grid(MARCH_CELLS, MARCH_CELLS, (float)cell);

    for (int v = 0; v < ROW * ROW; v++)
        mass[v] = (float)(0.5 + 0.3 * sin(1.3 * (v % ROW) + 0.4) * cos(0.9 * (v / ROW) + 0.2 * (v % ROW)) + 0.03);
    lab_sets_mass(&grid.material);
    grid.material.shrink_front = grid.material.shrink_back = singe_param(0);

    SingeSim *sim;
    SingeSurface surface = {0};
    SingeResult result = paper_burn_to(lab, &grid, mass, march_loss, &sim, &surface, error);
    if (!result) {
        SingeView view = singe_sim_view(sim);
        March march = {.count = 0}, fresh = {.count = 0};
        float ones[ROW * ROW];
        for (int v = 0; v < ROW * ROW; v++) ones[v] = 1;

        for (uint32_t c = 0; c < view.cell_count; c++) {
            march_cell(&march, &view, mass, c, cell);
            march_cell(&fresh, &view, ones, c, cell);
        }

        // `fresh`: of the same sheet before it burns
        static const char *const shapes[] = {"nothing", "a triangle", "a quadrilateral", "the whole"};

        FILE *file = report_drawing(lab->report);
        const int count = march.count;
        static const char *const fills[] = {"#fff", "#fdd0a2", "#fdae6b", "#c9dcf0"};
        const double scale = 56 / cell;

        fprintf(file, "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"360\" height=\"360\">\n");
        for (int i = 0; i < count; i++) // which case each triangle is
            fprintf(file,
                    "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"7\" fill=\"%s\" "
                    "stroke=\"#bbb\"/>\n",
                    12 + scale * march.centroids[i][0], 348 - scale * march.centroids[i][1],
                    fills[(int)march.centroids[i][2]]);

        for (uint32_t t = 0; t < surface.triangle_count; t++) {
            fprintf(file, "<polygon fill=\"#9ab\" fill-opacity=\".35\" stroke=\"#234\" stroke-width=\".8\" points=\"");
            for (int k = 0; k < 3; k++) {
                const float *p = surface.rest_position[surface.triangles[t][k]];
                fprintf(file, "%.1f,%.1f ", 12 + scale * (double)p[0], 348 - scale * (double)p[1]);
            }

            fprintf(file, "\"/>\n");
        }

        fprintf(file, "</svg>\n");

        report_text(
            lab->report,
            "%d x %d cells whose masses are given, each cell four triangles around its virtual centre; the dots "
            "tell the case of each triangle.",
            MARCH_CELLS, MARCH_CELLS);
        report_heads(lab->report, "corners left|drawn as|triangles");
        for (int k = 3; k >= 0; k--) report_row(lab->report, "%d|%s|%d", k, shapes[k], march.cases[k]);
        report_bar(lab->report, "cases", "triangles of the rarest case", march_fewest(&march), 1, INFINITY,
                   march_fewest(&fresh), "the sheet before it burns");

        double whole = 0; // what the bar must not pass: cells drawn whole where any of their triangles is
        for (int i = 0; i < march.count; i++) whole += march.centroids[i][2] > 0 ? cell * cell / 4 : 0;
        report_bar(lab->report, "area", "drawn area over that of eq 7", drawn_area(&surface) / march.expected, 0.999,
                   1.001, whole / march.expected, "whole triangles wherever a corner is left");
    }

    singe_surface_free(&surface);
    singe_sim_destroy(sim);
    return result;
}
