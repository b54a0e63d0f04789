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

enum {
    SCRAP_SIDES = 5, ///< of an outline
    ASH_KINDS = 4,   ///< leaves, scraps, crumbs and grains
    ASH_KEPT = 4,    ///< squares of a kind, two by two
};

/// A scrap of burnt paper; lengths are in units of its size (half its length).
typedef struct Scrap {
    uint32_t key;
    float sides[SCRAP_SIDES][3]; ///< unit and outward, and how far it lies from the middle
    float bent, aside, twist;
} Scrap;

Scrap scrap_make(uint32_t key);

/// How far inside it a point of its plane lies; negative outside. The outline has torn sides, bites and frays.
float scrap_depth(const Scrap *scrap, float x, float y);

/// Its height at the point: it is bent about its long axis, and creased.
float scrap_height(const Scrap *scrap, float x, float y);

/// What lies in the square of a lattice, or nothing.
typedef struct LeafSquare {
    int i, j;
    bool known, taken;
    float size;           ///< m
    float turn[2], at[2]; ///< as of a Leaf; its middle within the square
    Scrap scrap;
} LeafSquare;

/// Squares that were looked up: points that are looked up in turn mostly lie in the same ones.
typedef struct AshSquares {
    LeafSquare kept[ASH_KINDS][ASH_KEPT];
} AshSquares;

/// The ash at a point of the ground, of which a pixel covers `footprint` m. `squares` begin as zeros.
void ash_look(const Preview *preview, Float3 position, float footprint, AshSquares *squares, Ash *ash);

/// Lays it on a point of the ground if its leaf has already landed.
void ash_lay(const Preview *preview, const Ash *ash, Point *point);

// shade_ground.c
/// `squares` begin as zeros, and may be kept from point to point.
void ground_look(const Preview *preview, Float3 position, float cosine, float distance, AshSquares *squares,
                 Table *table);
void ground_shade(const Preview *preview, float distance, const Table *table, Point *point);
Float3 background_colour(const Preview *preview, Float3 direction);

// shade_wall.c
/// Distance to the wall along a ray; infinite if the ray misses it.
float wall_hit(const Preview *preview, Float3 origin, Float3 direction);

/// The share of the sun's disc that the wall, which is endless, does not hide from the scene in front of it.
float wall_clears(const Preview *preview);
void wall_look(const Preview *preview, Float3 position, float footprint, Table *table);
void wall_shade(const Preview *preview, const Table *table, Point *point);
