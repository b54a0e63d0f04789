// Small meshes for the tests of the shell, and what every shell must satisfy.
#pragma once

#include "shell/shell.h"
#include "support/support.h"

typedef struct QuadMesh {
    uint32_t vertex_count, cell_count, vertex_capacity, cell_capacity;
    float (*position)[3];
    uint32_t (*cells)[4];
} QuadMesh;

void mesh_add_vertex(QuadMesh *mesh, float x, float y, float z);
void mesh_add_cell(QuadMesh *mesh, uint32_t a, uint32_t b, uint32_t c, uint32_t d);
void mesh_release(QuadMesh *mesh);
#define OwnQuadMesh OWNED(mesh_release) QuadMesh

/// n x m cells of dx x dy in the plane z = 0, numbered row by row; its origin at (x, y).
QuadMesh mesh_grid(uint32_t n, uint32_t m, float dx, float dy);
void mesh_append_grid(QuadMesh *mesh, uint32_t n, uint32_t m, float x, float y);
/// n x m cells closed around both ways.
QuadMesh mesh_torus(uint32_t n, uint32_t m);
/// n cells around, m along.
QuadMesh mesh_cylinder(uint32_t n, uint32_t m, float radius, float height);
/// A strip of n cells with half a twist.
QuadMesh mesh_moebius(uint32_t n);
/// `sides` patches of n x n cells around one vertex.
QuadMesh mesh_polygon(uint32_t sides, uint32_t n);
/// Three squares of n x n cells.
QuadMesh mesh_ell(uint32_t n);
/// A cube of 6 n x n cells, pushed out to the unit sphere.
QuadMesh mesh_sphere(uint32_t n);
/// n x n squares cut in two by a random diagonal, each triangle split into three quads.
QuadMesh mesh_random(uint32_t n, uint32_t seed);
/// Renumbers vertices and cells and turns the cells' starts.
void mesh_shuffle(QuadMesh *mesh, uint32_t seed);

/// A default sheet on the mesh.
SingeSheetDef mesh_sheet(const QuadMesh *mesh);
/// The shell of one default sheet; fails the test when it cannot be made.
Shell mesh_shell(Memory *memory, const QuadMesh *mesh);

/// A mesh, and the shell of one sheet on it.
typedef struct Sample {
    Memory memory;
    QuadMesh mesh;
    Shell shell;
} Sample;

/// Takes the mesh. `thickness` is m, 0 the default.
Sample sample_open(QuadMesh mesh, float thickness);
/// Frees everything and fails when something was leaked.
void sample_close(Sample *sample);
#define OwnSample OWNED(sample_close) Sample

/// Checks strands, families, cell springs and cell families from their definitions.
void check_shell(const Shell *shell);
uint32_t count_rings(const SpringSet *set);
