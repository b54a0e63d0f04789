// `singe paper`: a function per experiment.
#pragma once

#include "page/page.h"

LabFn paper_fig1, paper_fig2, paper_fig3, paper_fig4, paper_fig5, paper_fig6, paper_fig7ab, paper_fig7cd, paper_fig8,
    paper_fig10, paper_fig11, paper_table1, paper_table2, paper_all_at_once, paper_mass_loss, paper_weights,
    paper_rival, paper_readings, paper_adaptive, paper_whole, paper_heat, paper_alpha, paper_crossing, paper_statements;

/// Builds and burns a grid whose material has lab_sets_mass, and draws the rest. The caller destroys *sim, which may be
/// NULL, and frees the surface in any case.
SingeResult paper_burn_to(Lab *lab, LabGrid *grid, const float *mass, double mass_loss, SingeSim **sim,
                          SingeSurface *surface, SingeError *error);

/// Which springs of a partly burnt cell go: the longest side of such a cell over its length at rest while it hangs, with
/// section 6's rule of triangles or with all springs until the cell is gone.
SingeResult paper_longest_side(Lab *lab, bool by_triangles, double *longest, SingeError *error);
