// What sheets burn on and before: the ground, its wood and its ash, and the wall.
#pragma once

#include "preview/point.h"

/// Ash that lies on the table at a pixel if it is stained.
typedef struct Ash {
    float cover;   ///< share of the table that it and its shadow hide
    float albedo;  ///< times the share that it hides
    float tilt[2]; ///< what it adds to the slope
    float from[2]; ///< m: to the middle of the leaf, times cover: all of a leaf lies there or none
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
    float along, across, deep; ///< m, from its own corner, from its middle, and above its face
    float width, edge;         ///< m, its own, and to the nearest joint
    float tone, hue, shift;    ///< its own, 0 to 1, 0 to 1, and m
} Plank;

// shade_wood.c
/// (x, y): where its wear and its fibres are counted from.
void wood_look(const Plank *plank, float x, float y, uint32_t seed, float footprint, Table *table);

// shade_ash.c
#define SCRAP_FLAT 0.5f ///< of its size: no part of a scrap is as high

/// How far a point of the plane is inside a scrap of burnt paper, in units of its size, half of its length: below 0 outside.
/// It is torn off along lines, bitten and frayed. `key`: which scrap.
float scrap_depth(float x, float y, uint32_t key);

/// Its height at the point, in units of its size: it is bent across, and creased.
float scrap_height(float x, float y, uint32_t key);

/// What lies on the ground at a point of it, where a pixel sees `footprint` m.
void ash_look(const Preview *preview, Float3 position, float footprint, Ash *ash);

/// Lays it on a point of the ground if its leaf has come down.
void ash_lay(const Preview *preview, const Ash *ash, Point *point);

// shade_ground.c
void ground_look(const Preview *preview, Float3 position, float cosine, float distance, Table *table);
void ground_shade(const Preview *preview, float distance, const Table *table, Point *point);
Float3 background_colour(const Preview *preview, Float3 direction);

// shade_wall.c
/// Distance to the wall along a ray; infinite: it is not met.
float wall_hit(const Preview *preview, Float3 origin, Float3 direction);

/// The share of the sun's disc that the wall, which has no end, leaves to the scene before it.
float wall_clears(const Preview *preview);
void wall_look(const Preview *preview, Float3 position, float footprint, Table *table);
void wall_shade(const Preview *preview, const Table *table, Point *point);
