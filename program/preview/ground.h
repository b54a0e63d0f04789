// What sheets burn on and before: the ground, its wood and its ash, and the wall.
#pragma once

#include "preview/point.h"

/// Ash that lies on the table at a pixel if it is stained.
typedef struct Ash {
    float cover;   ///< share of the table hidden by it and its shadow
    float albedo;  ///< times the hidden share
    float tilt[2]; ///< added to the slope
    float from[2]; ///< m to the middle of the leaf, times cover: a leaf lands as a whole
} Ash;

/// The table at a pixel.
typedef struct Table {
    Float3 albedo;
    float tilt[2]; ///< slope of its surface along x and y
    float polish;  ///< its reflectance
    Ash ash;
} Table;

/// A point of a piece of wood.
typedef struct Plank {
    float along, across, deep; ///< m from its corner, from its middle line, and above its face
    float width, edge;         ///< m, its own, and to the nearest joint
    float tone, hue, shift;    ///< its own, 0 to 1, 0 to 1, and m
} Plank;

// shade_wood.c
/// (x, y): the origin of its wear and its fibres.
void wood_look(const Plank *plank, float x, float y, uint32_t seed, float footprint, Table *table);

// shade_ash.c
#define SCRAP_FLAT 0.5f ///< in units of its size, above any part of a scrap

/// How far inside a scrap of burnt paper a point of the plane lies, in units of its size (half its length); negative
/// outside. The outline has torn sides, bites and frays. `key`: which scrap.
float scrap_depth(float x, float y, uint32_t key);

/// Its height at the point, in units of its size: it is bent about its long axis, and creased.
float scrap_height(float x, float y, uint32_t key);

/// The ash at a point of the ground, of which a pixel covers `footprint` m.
void ash_look(const Preview *preview, Float3 position, float footprint, Ash *ash);

/// Lays it on a point of the ground if its leaf has already landed.
void ash_lay(const Preview *preview, const Ash *ash, Point *point);

// shade_ground.c
void ground_look(const Preview *preview, Float3 position, float cosine, float distance, Table *table);
void ground_shade(const Preview *preview, float distance, const Table *table, Point *point);
Float3 background_colour(const Preview *preview, Float3 direction);

// shade_wall.c
/// Distance to the wall along a ray; infinite if the ray misses it.
float wall_hit(const Preview *preview, Float3 origin, Float3 direction);

/// The share of the sun's disc that the wall, which is endless, does not hide from the scene in front of it.
float wall_clears(const Preview *preview);
void wall_look(const Preview *preview, Float3 position, float footprint, Table *table);
void wall_shade(const Preview *preview, const Table *table, Point *point);
