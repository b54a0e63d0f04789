#include "bench/geometry.h"

#include <math.h>
#include <string.h>

#include "analysis/crossings.h"
#include "common/float3.h"

static double square(const float *v) {
    return (double)v[0] * (double)v[0] + (double)v[1] * (double)v[1] + (double)v[2] * (double)v[2];
}

void geometry_grid(uint32_t across, uint32_t along, uint32_t *cells) {
    for (uint32_t c = 0; c < across * along; c++) {
        const uint32_t row = across + 1, v = c / across * row + c % across;
        uint32_t *cell = cells + (size_t)4 * c;
        cell[0] = v;
        cell[1] = v + 1;
        cell[2] = v + row + 1;
        cell[3] = v + row;
    }
}

double geometry_energy(const SingeView *view, double gravity) {
    double energy = 0, mass = 0;
    for (uint32_t i = 0; i < view->particle_count; i++) {
        double m = (double)view->area[i] * (double)view->mass[i];
        energy += m * (0.5 * square(view->velocity[i]) + gravity * (double)view->position[i][2]);
        mass += m;
    }

    return energy / mass;
}

double geometry_height(const SingeView *view) {
    double moment = 0, mass = 0;
    for (uint32_t i = 0; i < view->particle_count; i++) {
        double m = (double)view->area[i] * (double)view->mass[i];
        moment += m * (double)view->position[i][2];
        mass += m;
    }

    return moment / mass;
}

double geometry_speed(const SingeView *view) {
    double max = 0;
    for (uint32_t i = 0; i < view->particle_count; i++) {
        double v = square(view->velocity[i]);
        if (!(v <= max)) max = v; // keeps NaN
    }
    return sqrt(max);
}

double geometry_gyration(const SingeView *view) {
    double centre[3] = {0}, sum = 0;
    const double count = view->particle_count;
    for (uint32_t i = 0; i < view->particle_count; i++)
        for (int axis = 0; axis < 3; axis++) centre[axis] += (double)view->position[i][axis] / count;
    for (uint32_t i = 0; i < view->particle_count; i++)
        for (int axis = 0; axis < 3; axis++) sum += pow((double)view->position[i][axis] - centre[axis], 2);
    return sqrt(sum / count);
}

void geometry_normal(const SingeView *view, uint32_t cell, double *normal) {
    const uint32_t *corner = view->cells[cell];
    double a[3], b[3];
    for (int axis = 0; axis < 3; axis++) {
        a[axis] = (double)view->position[corner[2]][axis] - (double)view->position[corner[0]][axis];
        b[axis] = (double)view->position[corner[3]][axis] - (double)view->position[corner[1]][axis];
    }
    cross3(a, b, normal);
}

double geometry_folded(const SingeView *view, int cells) {
    uint32_t n = (uint32_t)cells, folded = 0, edges = 0;
    for (uint32_t cell = 0; cell < n * n; cell++) {
        double own[3], other[3];
        geometry_normal(view, cell, own);
        for (int side = 0; side < 2; side++) {
            if (side ? cell / n + 1 == n : cell % n + 1 == n) continue;
            geometry_normal(view, side ? cell + n : cell + 1, other);
            folded += dot3(own, other) < 0;
            edges++;
        }
    }

    return edges ? (double)folded / edges : 0;
}

double geometry_inverted(const SingeView *view) {
    double count = 0;
    for (uint32_t cell = 0; cell < view->cell_count; cell++) {
        double normal[3], above = 0, square = 0;
        if (!(view->cell_flags[cell] & SINGE_ALIVE)) continue;
        geometry_normal(view, cell, normal);

        const float *centre = view->position[view->vertex_count + cell];
        for (int axis = 0; axis < 3; axis++) {
            double mean = 0;
            for (int i = 0; i < 4; i++) mean += (double)view->position[view->cells[cell][i]][axis] / 4;
            above += normal[axis] * ((double)centre[axis] - mean);
            square += normal[axis] * normal[axis];
        }

        count += square > 0 && !(above > 0);
    }

    return count;
}

SingeResult geometry_crossings(SingeSim *sim, uint64_t *count, SingeError *error) {
    SingeSurface surface = {0};
    float at[3];
    SingeResult result = singe_sim_surface(sim, &surface);
    if (result) *error = *singe_sim_error(sim);
    else if (!crossings_count(&surface, count, at)) result = SINGE_ERROR_MEMORY;
    singe_surface_free(&surface);
    return result;
}

double geometry_reach(const SingeView *view, const float *position) {
    double max = 0;
    for (uint32_t i = 0; i < view->vertex_count; i++) {
        double rest = distance_of(view->rest_position[i], position);
        if (rest < 0.2) continue;
        double ratio = distance_of(view->position[i], position) / rest;
        if (!(ratio <= max)) max = ratio; // keeps NaN
    }

    return max;
}

double geometry_curvatures(const SingeView *view, double x, double y, double radius, double principal[2]) {
    double c[6], m[6][7] = {{0}};
    for (uint32_t v = 0; v < view->vertex_count; v++) {
        const float *at = view->position[v], *rest = view->rest_position[v];
        if (hypot((double)rest[0] - x, (double)rest[1] - y) > radius) continue;
        const double u = (double)at[0], w = (double)at[1], f[7] = {1, u, w, u * u, u * w, w * w, (double)at[2]};
        for (int i = 0; i < 6; i++)
            for (int j = 0; j < 7; j++) m[i][j] += f[i] * f[j];
    }

    for (int i = 0; i < 6; i++)
        for (int k = 0; k < 6; k++) {
            if (k == i) continue;
            const double factor = m[k][i] / m[i][i];
            for (int j = i; j < 7; j++) m[k][j] -= factor * m[i][j];
        }
    for (int i = 0; i < 6; i++) c[i] = m[i][6] / m[i][i];

    const double mean = c[3] + c[5], half = hypot(c[3] - c[5], c[4]), sign = mean < 0 ? -1 : 1;
    principal[0] = fabs(mean) + half;
    principal[1] = fabs(mean) - half;
    return fmod(0.5 * atan2(sign * c[4], sign * (c[3] - c[5])) + acos(-1), acos(-1));
}

double geometry_window(double *line, int count) {
    const double centre = 0.5 * (count - 1), pi = acos(-1);
    double mean = 0, slope = 0, squares = 0, power = 0;
    for (int i = 0; i < count; i++) {
        mean += line[i] / count;
        slope += line[i] * (i - centre);
        squares += (i - centre) * (i - centre);
    }

    for (int i = 0; i < count; i++) {
        line[i] -= mean + slope / squares * (i - centre);
        power += line[i] * line[i] / count;
        line[i] *= 0.5 - 0.5 * cos(2 * pi * (i + 0.5) / count);
    }

    return power;
}

double geometry_power(const double *line, int count, int k) {
    const double pi = acos(-1);
    double re = 0, im = 0;
    for (int i = 0; i < count; i++) {
        re += line[i] * cos(2 * pi * k * i / count);
        im += line[i] * sin(2 * pi * k * i / count);
    }

    return re * re + im * im;
}

void strain_clear(Strain *strain) {
    memset(strain, 0, sizeof *strain);
    strain->finite = true;
}

void strain_add(Strain *strain, const SingeView *view, SingeColour colour) {
    for (uint32_t s = 0; s < view->spring_count[colour]; s++) {
        const uint32_t *ends = view->springs[colour][s];
        if (!(view->spring_flags[colour][s] & SINGE_ALIVE)) continue;
        if (view->particle_flags[ends[0]] & view->particle_flags[ends[1]] & SINGE_PINNED) continue;

        double x = (double)view->position[ends[1]][0] - (double)view->position[ends[0]][0],
               y = (double)view->position[ends[1]][1] - (double)view->position[ends[0]][1],
               z = (double)view->position[ends[1]][2] - (double)view->position[ends[0]][2];
        double length = sqrt(x * x + y * y + z * z);

        double value = fabs(length / (double)view->spring_length[colour][s] - 1);
        strain->count++;
        if (!isfinite(value)) {
            strain->finite = false;
            continue;
        }

        float rounded = (float)value;
        uint32_t bits;
        memcpy(&bits, &rounded, sizeof bits);
        strain->bins[bits >> 16]++;
        strain->sum += value;
        if (value > strain->max) strain->max = value;
    }
}

void strain_merge(Strain *strain, const Strain *other) {
    for (uint32_t bin = 0; bin < STRAIN_BINS; bin++) strain->bins[bin] += other->bins[bin];
    strain->count += other->count;
    strain->sum += other->sum;
    strain->max = fmax(strain->max, other->max);
    strain->finite = strain->finite && other->finite;
}

BenchValue strain_percent(const Strain *strain) {
    if (!strain->finite || strain->count == 0) return (BenchValue){.number = {NAN, NAN, NAN}};

    // the centre of the bin up to which 99 of 100 samples lie
    uint64_t below = 0, wanted = strain->count - strain->count / 100;
    double p99 = NAN;
    for (uint32_t bin = 0; bin < STRAIN_BINS; bin++) {
        below += strain->bins[bin];
        if (below < wanted) continue;
        uint32_t bits = bin << 16 | 0x8000;
        float value;
        memcpy(&value, &bits, sizeof value);
        p99 = fmin((double)value, strain->max);
        break;
    }

    return (BenchValue){.number = {100 * strain->max, 100 * p99, 100 * strain->sum / (double)strain->count}};
}

BenchValue strain_of(const SingeStats *stats) {
    return (BenchValue){.number = {100 * stats->strain_max, 100 * stats->strain_p99, 100 * stats->strain_mean}};
}
