// Whether anything can light the sheets. A source is said to miss only if the sheets cannot come to it either: a box
// around each sheet is moved as far as it could fall, fly or be blown, and made larger by its diagonal, for what hangs,
// swings or curls.
#include "scene/messages.h"
#include "scene/space.h"
#include "scene/warnings.h"

#include <math.h>
#include <stdlib.h>

/// Where a sheet can be, and what it takes to light it.
typedef struct Place {
    Box box;                ///< at the start
    double fall[3];         ///< m, how far it may go from there, at most
    double slack;           ///< m, in any direction
    double diagonal;        ///< m, of the box at the start
    double cell;            ///< m, longest side of a cell
    double start, ignition; ///< K, the hottest that it begins with, the lowest at which it burns
    double capacity;        ///< J/(m2 K) of a layer, the least
    bool burns;
} Place;

static double param_least(SingeParam p) { return (double)fminf(p.value, p.to); }
static double param_most(SingeParam p) { return (double)fmaxf(p.value, p.to); }
static bool burns(const SingeMaterialDef *material) {
    return param_most(material->mass_rate) > 0 || param_most(material->pre_exponential) > 0;
}

/// The length of a path, m: a pin carries a sheet so far, or a collider pushes it.
static double carried(const SceneKey *keys, uint32_t count) {
    double length = 0;
    for (uint32_t i = 1; i < count; i++) {
        double sum = 0;
        for (int c = 0; c < 3; c++) {
            const double d = (double)keys[i].position[c] - (double)keys[i - 1].position[c];
            sum += d * d;
        }
        length += sqrt(sum);
    }

    return length;
}

/// How far a sheet may come, and fall: by pins and colliders that carry it, wind, its velocity and gravity.
static void add_motion(const Scene *scene, uint32_t index, Place *place) {
    const double time = fmax((scene->frames - 1) / (double)scene->fps, 1); // a trial of few frames is no miss
    bool held = false;

    place->slack = place->diagonal;
    for (uint32_t i = 0; i < scene->pin_count; i++) {
        const ScenePin *pin = &scene->pins[i];
        if (pin->sheet_index != index) continue;
        held = held || (double)pin->end > time;
        place->slack += carried(pin->keys, pin->key_count);
        if (pin->motion.given) place->slack = INFINITY;
    }

    for (uint32_t i = 0; i < scene->collider_count; i++) {
        place->slack += carried(scene->colliders[i].keys, scene->colliders[i].key_count);
        if (scene->colliders[i].motion.given) place->slack = INFINITY;
    }

    if (!held) {
        const float *gravity = scene->sim.gravity, *wind = scene->sim.wind.velocity;
        double g = 0, blown = 0, flown = 0;
        for (int c = 0; c < 3; c++) {
            g += (double)gravity[c] * (double)gravity[c];
            blown += (double)wind[c] * (double)wind[c];
            flown += (double)scene->sheets[index].velocity[c] * (double)scene->sheets[index].velocity[c];
        }

        g = sqrt(g);
        place->slack += (sqrt(blown) + sqrt(flown)) * time;

        // until a plane that stands still below it stops it
        double length = 0.5 * g * time * time;
        for (uint32_t i = 0; i < scene->collider_count; i++) {
            const SceneCollider *collider = &scene->colliders[i];
            const bool level = collider->key_count == 1 && collider->keys[0].rotation[0] == 0 &&
                               collider->keys[0].rotation[1] == 0 && gravity[0] == 0 && gravity[1] == 0 &&
                               gravity[2] < 0;
            if (collider->def.kind != SINGE_COLLIDER_PLANE || !level) continue;
            const double gap = place->box.high[2] - (double)collider->keys[0].position[2];
            if (gap >= 0) length = fmin(length, gap);
        }

        for (int c = 0; c < 3 && g > 0; c++) place->fall[c] = (double)gravity[c] / g * length;
    }
}

static Place place_of(const Scene *scene, const SceneAssets *assets, uint32_t index) {
    const Mesh *mesh = &assets->meshes[index];
    const SceneSheet *sheet = &scene->sheets[index];
    const SingeMaterialDef *material = &sheet->material.def;
    Place place = {.box = BOX_EMPTY,
                   .start = param_most(material->temperature),
                   .ignition = param_least(material->ignition_temperature),
                   .capacity = 0.5 * param_least(material->grammage) * param_least(material->specific_heat),
                   .burns = burns(material)};
    box_add_points(&place.box, mesh->positions, mesh->vertex_count);
    place.diagonal = box_diagonal(&place.box);

    // the largest cell
    for (size_t k = 0; k < 4 * (size_t)mesh->cell_count; k++) {
        const float *a = mesh->positions + 3 * (size_t)mesh->cells[k];
        const float *b = mesh->positions + 3 * (size_t)mesh->cells[k % 4 == 3 ? k - 3 : k + 1];
        double side = 0;
        for (int c = 0; c < 3; c++) side += ((double)a[c] - (double)b[c]) * ((double)a[c] - (double)b[c]);
        place.cell = fmax(place.cell, sqrt(side));
    }

    add_motion(scene, index, &place);
    return place;
}

/// The least distance of a source from the box that a sheet sweeps as it falls, while the source burns. The distance from a box is convex along each part of the
/// path, so that dividing the part finds it.
static double path_distance(const SceneSource *source, const Place *place) {
    const double from = fmax((double)source->def.start, 0), to = (double)source->def.end;
    double least = INFINITY;
    for (uint32_t i = 0; i < source->key_count; i++) {
        const SceneKey *a = &source->keys[i], *b = i + 1 < source->key_count ? a + 1 : a;
        // before its first key and after its last the source stands still
        const double begin = i == 0 ? -INFINITY : (double)a->time, end = b == a ? INFINITY : (double)b->time;
        if (end < from || begin > to) continue;

        const double length = b == a ? 1 : fmax((double)b->time - (double)a->time, 1e-9);
        double low = fmin(fmax((from - (double)a->time) / length, 0), 1);
        double high = fmin(fmax((to - (double)a->time) / length, 0), 1);
        for (int k = 0; k < 40; k++) {
            double at[2], distance[2];
            for (int side = 0; side < 2; side++) {
                double sum = 0;
                at[side] = low + (high - low) * (1 + side) / 3;
                for (int c = 0; c < 3; c++) {
                    const double p =
                        (double)a->position[c] + at[side] * ((double)b->position[c] - (double)a->position[c]);
                    const double below = place->box.low[c] + fmin(place->fall[c], 0) - p;
                    const double above = p - place->box.high[c] - fmax(place->fall[c], 0);
                    const double out = fmax(fmax(below, above), 0);
                    sum += out * out;
                }

                distance[side] = sqrt(sum);
            }

            least = fmin(least, fmin(distance[0], distance[1]));
            if (distance[0] < distance[1]) high = at[1];
            else low = at[0];
            if (a == b || least == 0) break;
        }
    }

    return least;
}

/// The temperature to which a source can bring a layer of the sheet, K, if it heats all of it for as long as it burns,
/// nothing cools it, and all balls and spots are there. Without the rise by the sheet's own fire.
static double heat_of(const Scene *scene, const SceneSource *source, const Place *place) {
    const SingeSourceDef *def = &source->def;
    double pace = (double)scene->sim.pace; // the highest
    for (uint32_t i = 0; i < scene->pace_count; i++) pace = fmax(pace, (double)scene->paces[i].value);

    const double time = fmax((double)def->end - fmax((double)def->start, 0), 0) * pace;
    if (def->kind == SINGE_SOURCE_TEXTURE) {
        double strength = source->strength_count ? 0 : 1;
        for (uint32_t i = 0; i < source->strength_count; i++)
            strength = fmax(strength, (double)source->strength[i].value);
        return place->start + fmax((double)def->flux, 0) * strength * time / place->capacity;
    }

    double conductance = 0;
    for (uint32_t i = 0; i < scene->source_count; i++)
        if ((scene->sources[i].def.kind == SINGE_SOURCE_BALL || scene->sources[i].def.kind == SINGE_SOURCE_SPOT))
            conductance += (double)scene->sources[i].def.conductance;
    const double rest = exp(-conductance * time / place->capacity);
    return fmax(place->start, (double)def->temperature - ((double)def->temperature - place->start) * rest);
}

/// m, from a point to the nearest particle of a sheet: its vertices and the centres of its cells.
static double particle_distance(const Mesh *mesh, const float *point) {
    double nearest = INFINITY;
    for (uint32_t k = 0; k < mesh->vertex_count + mesh->cell_count; k++) {
        const uint32_t *cell = k < mesh->vertex_count ? NULL : mesh->cells + 4 * (size_t)(k - mesh->vertex_count);
        double sum = 0;
        for (size_t c = 0; c < 3; c++) {
            double x = cell ? 0 : (double)mesh->positions[3 * (size_t)k + c];
            for (size_t corner = 0; cell && corner < 4; corner++)
                x += 0.25 * (double)mesh->positions[3 * (size_t)cell[corner] + c];
            x -= (double)point[c];
            sum += x * x;
        }

        nearest = fmin(nearest, sqrt(sum));
    }

    return nearest;
}

/// Whether a source may light a sheet. Otherwise there is a warning, unless it touches one and `lit` says that something
/// else lights the scene: a weaker source may warm it.
static bool source_lights(const Scene *scene, const SceneAssets *assets, const SceneSource *source, const Place *places,
                          bool lit, const SingeLog *log) {
    if (source_wets_or_blows(&source->def)) return false; // it puts fires out, or fans them

    const bool everywhere = !source_is_round(&source->def);
    const bool mapped = everywhere && source->def.kind != SINGE_SOURCE_TEXTURE; // it lights whatever burns
    // a flame of its own is some 0.24 m high at 1 kW, and its hot gas rises farther
    const bool flame = !everywhere && scene->sim.gas.enabled && source->def.power > 0;
    const double plume = flame ? 0.5 * pow(1e-3 * (double)source->def.power, 0.4) : 0;
    const double reach = everywhere ? INFINITY : (double)source->def.radius + (double)source->def.falloff + plume;
    double nearest = INFINITY, hottest = 0, ignition = INFINITY;
    uint32_t near = 0, between = UINT32_MAX;
    bool touches = false;

    for (uint32_t i = 0; i < scene->sheet_count; i++) {
        const double gap = everywhere ? 0 : path_distance(source, &places[i]) - reach;
        if (gap < nearest) {
            nearest = gap;
            near = i;
        }
        if (!(gap <= places[i].slack)) continue;

        // a source that is smaller than the cells may lie between the particles of a sheet that has not moved yet
        const bool small = gap <= 0 && source->key_count == 1 && reach < 0.5 * places[i].cell;
        if (small && particle_distance(&assets->meshes[i], source->keys[0].position) > reach) {
            between = i;
            continue;
        }

        touches = true;
        const double heat = heat_of(scene, source, &places[i]);
        if (places[i].burns && (flame || mapped || heat >= places[i].ignition)) return true;
        hottest = fmax(hottest, heat);
        ignition = fmin(ignition, places[i].ignition);
    }

    if (!touches && between != UINT32_MAX) {
        message_warn(
            log, scene->text, source->location,
            "the source lights nothing: it reaches %.3g m, and the cells of sheet '%s' are %.3g m large, so it falls between their particles",
            reach, scene->sheets[between].name, places[between].cell);
    } else if (!touches) {
        message_warn(log, scene->text, source->location,
                     "the source misses the sheets: its heat ends %.3g m short of the nearest, '%s'", nearest,
                     scene->sheets[near].name);
    } else if (!lit) {
        message_warn(log, scene->text, source->location,
                     "the source lights nothing: it brings a sheet to %.0f C at most, which ignites at %.0f C",
                     hottest - 273.15, ignition - 273.15);
    }

    return false;
}

double scene_ignition(const Scene *scene) {
    double least = INFINITY;
    for (uint32_t i = 0; i < scene->sheet_count; i++) {
        const SingeMaterialDef *material = &scene->sheets[i].material.def;
        if (burns(material)) least = fmin(least, param_least(material->ignition_temperature));
    }
    return least;
}

void scene_warn_of_fires(const Scene *scene, const SceneAssets *assets, const SingeLog *log) {
    Place *places = calloc(scene->sheet_count + 1, sizeof *places);
    if (!places) return; // it is only a warning

    bool any = false, lit = false;
    double largest = 0;

    // hot from the start or from the air, or lit by a hot collider: that one is taken to touch
    for (uint32_t i = 0; i < scene->sheet_count; i++) {
        places[i] = place_of(scene, assets, i);
        any = any || places[i].burns;
        largest = fmax(largest, places[i].diagonal);

        const double hot = fmax(places[i].start, (double)scene->sim.ambient_temperature);
        lit = lit || (places[i].burns && hot >= places[i].ignition);
        for (uint32_t k = 0; k < scene->collider_count; k++) {
            const SingeColliderDef *def = &scene->colliders[k].def;
            lit = lit || (def->conductance > 0 && (double)def->temperature >= places[i].ignition);
        }
    }

    uint32_t heaters = 0;
    for (uint32_t i = 0; i < scene->source_count; i++) {
        const SingeSourceDef *def = &scene->sources[i].def;
        const double reach = (double)def->radius + (double)def->falloff;
        heaters += !source_wets_or_blows(def);
        // most likely a unit is missing
        if ((def->kind == SINGE_SOURCE_BALL || def->kind == SINGE_SOURCE_SPOT) && reach > 4 * largest)
            message_warn(log, scene->text, scene->sources[i].location,
                         "the source heats all at once: it reaches %.3g m, and the largest sheet is %.3g m large",
                         reach, largest);
    }

    if (any && heaters == 0 && !lit)
        message_warn(
            log, scene->text, (SceneLocation){0},
            "nothing lights the sheets: there is no source of heat, no collider that is hot enough, and no sheet "
            "that begins hot");

    // sources that miss, and those that are too weak if nothing else is strong enough
    for (int pass = 0; pass < 2 && any; pass++) {
        const SingeLog silent = {0};
        for (uint32_t i = 0; i < scene->source_count; i++)
            if (!source_heats_nothing(scene, &scene->sources[i]) &&
                source_lights(scene, assets, &scene->sources[i], places, lit, pass ? log : &silent))
                lit = true;
    }

    free(places);
}
