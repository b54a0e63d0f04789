// A prototype: one sheet on several nodes, its strands cut into pieces by a Schur complement at the cuts.
//
//   mpirun -n P strands_mpi ROWS COLUMNS SUBSTEPS [FILE [NUDGE]]
//
// A sheet of ROWS x COLUMNS particles hangs by two corners and swings. It is projected as Singe's solver does: family
// by family (rows, columns, two diagonals), each strand of a family by one Newton step, whose system is tridiagonal:
//
//   (w_i + w_{i+1} + s) y_i - w_i n_{i-1}.n_i y_{i-1} - w_{i+1} n_i.n_{i+1} y_{i+1} = |d_i| - l_i.
//
// Each rank has a slab of columns. Rows and diagonals are cut at each border: there the spring between two ranks is the
// border's unknown. Inside its slab a rank solves every piece of strand for three right sides, y = z - a y_left - b
// y_right. What is left is a tridiagonal system along the ranks, of one unknown a strand and border, which goes through
// the ranks forth and back. The result is that of the uncut strand but for rounding.
//
// Prints the times and the messages of a substep, and writes the particles to FILE. NUDGE moves one particle at the
// start, m: what rounding does to the motion is held against that (tests/farm/check_mpi.py).
#include <math.h>
#include <mpi.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { FAMILIES = 4, HALO = 3, DRAG = 4 }; // drag: 1/s
// rows, columns, diagonals: the step to the next particle of a strand
static const int step_row[FAMILIES] = {0, 1, 1, -1}, step_column[FAMILIES] = {1, 0, 1, 1};

typedef struct Sheet {
    int rank, ranks, rows, columns;         ///< columns of the whole sheet
    int first, width;                       ///< of this rank's slab
    double cell, softness;                  ///< rest length of rows and columns, regularisation
    double (*x)[3], (*old)[3], (*v)[3], *w; ///< [rows][width + 2]: a column of each neighbour at the sides
    double *buffer[4];
    double solve, wait, bytes; ///< s, s, sent
    long messages;
} Sheet;

/// Of a strand's piece on this rank, at the left and the right border; all by the row of the particle there.
typedef struct Border {
    double *pivot, *left, *right, *value; ///< of the right border's unknown: its row of the system along the ranks
    double *below, *unknown;              ///< the row of the strand's left border, -1: none; the solution
} Border;

static size_t at(const Sheet *s, int row, int column) {
    return (size_t)row * (size_t)(s->width + 2) + (size_t)(column + 1);
}

static void exchange(Sheet *s, int to, int from, const double *out, double *in, int count) {
    const double begun = MPI_Wtime();
    MPI_Sendrecv(out, count, MPI_DOUBLE, to, 0, in, count, MPI_DOUBLE, from, 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    s->wait += MPI_Wtime() - begun;
    if (to != MPI_PROC_NULL) s->bytes += 8.0 * count, s->messages++;
}

static int before(const Sheet *s) { return s->rank ? s->rank - 1 : MPI_PROC_NULL; }
static int after(const Sheet *s) { return s->rank + 1 < s->ranks ? s->rank + 1 : MPI_PROC_NULL; }

/// The outer columns of the neighbours.
static void exchange_halo(Sheet *s) {
    for (int side = 0; side < 2; side++) {
        const int mine = side ? 0 : s->width - 1, theirs = side ? s->width : -1;
        for (int r = 0; r < s->rows; r++) memcpy(s->buffer[0] + HALO * r, s->x[at(s, r, mine)], sizeof *s->x);
        exchange(s, side ? before(s) : after(s), side ? after(s) : before(s), s->buffer[0], s->buffer[1],
                 HALO * s->rows);
        if ((side ? after(s) : before(s)) == MPI_PROC_NULL) continue;
        for (int r = 0; r < s->rows; r++) memcpy(s->x[at(s, r, theirs)], s->buffer[1] + HALO * r, sizeof *s->x);
    }
}

// ---- a piece of a strand

typedef struct Spring {
    double n[3], stretch, wa, wb; ///< unit vector from a to b, |b - a| - rest, inverse masses
} Spring;

static Spring spring_between(const Sheet *s, size_t a, size_t b, double rest) {
    Spring spring = {.wa = s->w[a], .wb = s->w[b]};
    double length = 0;
    for (int k = 0; k < 3; k++) spring.n[k] = s->x[b][k] - s->x[a][k], length += spring.n[k] * spring.n[k];
    length = sqrt(length);
    for (int k = 0; k < 3; k++) spring.n[k] /= length;
    spring.stretch = length - rest;
    return spring;
}

static double coupling(const Spring *p, const Spring *q) { // of the particle between them
    return -p->wb * (p->n[0] * q->n[0] + p->n[1] * q->n[1] + p->n[2] * q->n[2]);
}

static double diagonal(const Sheet *s, const Spring *p) { return p->wa + p->wb + s->softness; }

typedef struct Piece {
    int count, row, column; ///< springs inside; the first particle
    bool cut_left, cut_right;
    Spring *springs;           ///< [count + 2]: those of the borders first and last
    double *z, *a, *b, *upper; ///< [count]
} Piece;

static bool inside(const Sheet *s, int row, int column) {
    const int whole = s->first + column;
    return row >= 0 && row < s->rows && whole >= 0 && whole < s->columns;
}

/// Whether a strand's piece on this rank begins here.
static bool begins(const Sheet *s, int family, int row, int column) {
    const int r = row - step_row[family], c = column - step_column[family];
    return !inside(s, r, c) || c < 0;
}

static void measure_piece(const Sheet *s, int family, int row, int column, Piece *p) {
    const int dr = step_row[family], dc = step_column[family];
    const double rest = s->cell * sqrt(dr * dr + dc * dc);
    p->row = row, p->column = column, p->count = 0;
    p->cut_left = inside(s, row - dr, column - dc);
    if (p->cut_left) p->springs[0] = spring_between(s, at(s, row - dr, column - dc), at(s, row, column), rest);
    for (;; row += dr, column += dc) {
        p->cut_right = false;
        if (!inside(s, row + dr, column + dc)) break;
        p->springs[p->count + 1] = spring_between(s, at(s, row, column), at(s, row + dr, column + dc), rest);
        if ((p->cut_right = column + dc == s->width)) break;
        p->count++;
    }
}

/// y = z - a y_left - b y_right inside.
static void solve_piece(const Sheet *s, Piece *p) {
    const int m = p->count;
    for (int i = 0; i < m; i++) {
        const Spring *spring = &p->springs[i + 1];
        double pivot = diagonal(s, spring), lower = i ? coupling(spring - 1, spring) : 0;
        p->z[i] = spring->stretch;
        p->a[i] = i == 0 && p->cut_left ? coupling(spring - 1, spring) : 0;
        p->b[i] = i == m - 1 && p->cut_right ? coupling(spring, spring + 1) : 0;
        if (i) {
            pivot -= lower * p->upper[i - 1];
            p->z[i] -= lower * p->z[i - 1], p->a[i] -= lower * p->a[i - 1], p->b[i] -= lower * p->b[i - 1];
        }
        p->upper[i] = i < m - 1 ? coupling(spring, spring + 1) / pivot : 0;
        p->z[i] /= pivot, p->a[i] /= pivot, p->b[i] /= pivot;
    }
    for (int i = m - 2; i >= 0; i--) {
        p->z[i] -= p->upper[i] * p->z[i + 1];
        p->a[i] -= p->upper[i] * p->a[i + 1], p->b[i] -= p->upper[i] * p->b[i + 1];
    }
}

static void move_piece(Sheet *s, int family, const Piece *p, double left, double right) {
    for (int i = 0; i <= p->count; i++) {
        const size_t here = at(s, p->row + i * step_row[family], p->column + i * step_column[family]);
        const double y0 = i ? p->z[i - 1] - p->a[i - 1] * left - p->b[i - 1] * right : p->cut_left ? left : 0;
        const double y1 = i < p->count ? p->z[i] - p->a[i] * left - p->b[i] * right : p->cut_right ? right : 0;
        const double *n0 = p->springs[i].n, *n1 = p->springs[i + 1].n;
        for (int k = 0; k < 3; k++) {
            if (i || p->cut_left) s->x[here][k] -= s->w[here] * y0 * n0[k];
            if (i < p->count || p->cut_right) s->x[here][k] += s->w[here] * y1 * n1[k];
        }
    }
}

// ---- the system along the ranks

typedef struct Work {
    Piece *pieces; ///< of the family, by their begin
    int piece_count;
    Spring *springs; ///< that the pieces' arrays are parts of
    double *numbers;
    Border border;
    double *for_left, *from_before, *mine, *theirs;
} Work;

/// What the piece says about the borders: three numbers for the rank before (by the row beyond the border), and the row
/// of its own right border.
static void note_borders(const Sheet *s, int family, const Piece *p, double *for_left, Border *border) {
    const int m = p->count;
    const Spring *left = &p->springs[0], *right = &p->springs[m + 1];
    if (p->cut_left) {
        double *out = for_left + 3 * (p->row - step_row[family]);
        const double c = m ? coupling(left, left + 1) : 0;
        out[0] = m ? c * p->z[0] : 0, out[1] = m ? c * p->a[0] : 0;
        out[2] = m ? c * p->b[0] : p->cut_right ? -coupling(left, right) : 0;
    }
    if (p->cut_right) {
        const int row = p->row + m * step_row[family];
        const double c = m ? coupling(right - 1, right) : 0;
        border->pivot[row] = diagonal(s, right) - (m ? c * p->b[m - 1] : 0);
        border->left[row] = m ? -c * p->a[m - 1] : p->cut_left ? coupling(left, right) : 0;
        border->value[row] = right->stretch - (m ? c * p->z[m - 1] : 0);
        border->right[row] = 0;
        border->below[row] = p->cut_left ? p->row - step_row[family] : -1; // where its left border's unknown is
    }
}

/// Thomas' algorithm over the ranks: forth, then back. An unknown has the row of the particle left of its border.
static void solve_borders(Sheet *s, Work *work) {
    Border *border = &work->border;
    const int rows = s->rows;
    const bool last = after(s) == MPI_PROC_NULL;
    double *in = s->buffer[0], *out = s->buffer[1];
    exchange(s, before(s), after(s), work->for_left, in, 3 * rows);
    exchange(s, MPI_PROC_NULL, before(s), s->buffer[2], work->from_before, 2 * rows);
    for (int r = 0; r < rows && !last; r++) {
        const int l = (int)border->below[r];
        if (border->pivot[r] == 0) continue; // no strand crosses here
        border->value[r] -= in[3 * r], border->pivot[r] -= in[3 * r + 1], border->right[r] = -in[3 * r + 2];
        if (l >= 0) {
            border->pivot[r] -= border->left[r] * work->from_before[2 * l];
            border->value[r] -= border->left[r] * work->from_before[2 * l + 1];
        }
        out[2 * r] = border->right[r] / border->pivot[r], out[2 * r + 1] = border->value[r] / border->pivot[r];
    }
    exchange(s, after(s), MPI_PROC_NULL, out, s->buffer[2], 2 * rows);
    memset(in, 0, (size_t)rows * sizeof *in);
    exchange(s, MPI_PROC_NULL, after(s), s->buffer[2], in,
             rows); // the unknowns of the next border, by the rows of this one
    memset(work->mine, 0, (size_t)rows * sizeof *work->mine);
    for (int r = 0; r < rows && !last; r++) {
        const int l = (int)border->below[r];
        border->unknown[r] = border->pivot[r] != 0 ? out[2 * r + 1] - out[2 * r] * in[r] : 0;
        if (border->pivot[r] != 0 && l >= 0) work->mine[l] = border->unknown[r];
    }
    exchange(s, before(s), MPI_PROC_NULL, work->mine, s->buffer[2], rows);
    exchange(s, after(s), before(s), border->unknown, work->theirs, rows);
}

// ---- a family

/// Measures and solves all pieces of a family; their springs and numbers follow each other.
static void solve_pieces(Sheet *s, int family, Work *work) {
    Spring *springs = work->springs;
    double *numbers = work->numbers;
    work->piece_count = 0;
    for (int column = 0; column < s->width; column++)
        for (int row = 0; row < s->rows; row++) {
            if (!begins(s, family, row, column)) continue;
            Piece *p = &work->pieces[work->piece_count++];
            p->springs = springs;
            measure_piece(s, family, row, column, p);
            const size_t m = (size_t)p->count;
            p->z = numbers, p->a = numbers + m, p->b = numbers + 2 * m, p->upper = numbers + 3 * m;
            springs += m + 2, numbers += 4 * m;
            solve_piece(s, p);
        }
}

static void move_pieces(Sheet *s, int family, const Work *work) {
    for (int i = 0; i < work->piece_count; i++) {
        const Piece *p = &work->pieces[i];
        const int last = p->row + p->count * step_row[family];
        move_piece(s, family, p, p->cut_left ? work->theirs[p->row - step_row[family]] : 0,
                   p->cut_right ? work->border.unknown[last] : 0);
    }
}

static void project_family(Sheet *s, int family, Work *work) {
    const double begun = MPI_Wtime(), waited = s->wait;
    const bool cut = s->ranks > 1 && step_column[family];
    if (cut) exchange_halo(s);
    solve_pieces(s, family, work);
    if (cut) {
        memset(work->border.pivot, 0, (size_t)s->rows * sizeof(double));
        memset(work->for_left, 0, 3 * (size_t)s->rows * sizeof(double));
        for (int i = 0; i < work->piece_count; i++)
            note_borders(s, family, &work->pieces[i], work->for_left, &work->border);
        solve_borders(s, work);
    }
    move_pieces(s, family, work);
    s->solve += MPI_Wtime() - begun - (s->wait - waited);
}

// ---- the motion

static void substep(Sheet *s, double h, Work *work) {
    for (int r = 0; r < s->rows; r++)
        for (int c = 0; c < s->width; c++) {
            const size_t i = at(s, r, c);
            memcpy(s->old[i], s->x[i], sizeof *s->x);
            for (int k = 0; k < 3; k++) s->v[i][k] *= 1 - DRAG * h;
            if (s->w[i] > 0) s->v[i][2] -= 9.81 * h;
            for (int k = 0; k < 3; k++) s->x[i][k] += h * s->v[i][k];
        }
    for (int family = 0; family < FAMILIES; family++) project_family(s, family, work);
    for (int r = 0; r < s->rows; r++)
        for (int c = 0; c < s->width; c++) {
            const size_t i = at(s, r, c);
            for (int k = 0; k < 3; k++) s->v[i][k] = (s->x[i][k] - s->old[i][k]) / h;
        }
}

static void *need(size_t count, size_t size) {
    void *block = calloc(count, size);
    if (!block) MPI_Abort(MPI_COMM_WORLD, 1);
    return block;
}

static Sheet make_sheet(int rank, int ranks, int rows, int columns) {
    const int first = (int)((long)columns * rank / ranks), next = (int)((long)columns * (rank + 1) / ranks);
    Sheet s = {.rank = rank, .ranks = ranks, .rows = rows, .columns = columns, .first = first, .width = next - first};
    const size_t count = (size_t)rows * (size_t)(s.width + 2);
    s.cell = 1.0 / (columns - 1), s.softness = 0.01;
    s.x = need(count, sizeof *s.x), s.old = need(count, sizeof *s.old), s.v = need(count, sizeof *s.v);
    s.w = need(count, sizeof *s.w);
    for (int i = 0; i < 4; i++) s.buffer[i] = need(3 * (size_t)rows, sizeof(double));
    for (int r = 0; r < rows; r++)
        for (int c = -1; c <= s.width; c++) {
            const size_t i = at(&s, r, c);
            const int whole = first + c;
            s.x[i][0] = whole * s.cell, s.x[i][1] = r * s.cell;
            s.w[i] = r == 0 && (whole == 0 || whole == columns - 1) ? 0 : 1;
        }
    return s;
}

static Work make_work(const Sheet *s) {
    Work w = {0};
    const size_t rows = (size_t)s->rows, columns = (size_t)s->width, pieces = rows + columns;
    w.pieces = need(pieces, sizeof *w.pieces);
    w.springs = need(rows * columns + 2 * pieces, sizeof *w.springs), w.numbers = need(4 * rows * columns, 8);
    w.border = (Border){need(rows, 8), need(rows, 8), need(rows, 8), need(rows, 8), need(rows, 8), need(rows, 8)};
    w.for_left = need(3 * rows, 8), w.from_before = need(3 * rows, 8), w.mine = need(rows, 8), w.theirs = need(rows, 8);
    return w;
}

/// All particles on rank 0, row by row; NULL elsewhere.
static double *gather(const Sheet *s) {
    const int count = 3 * s->rows * s->width;
    double *mine = need((size_t)count, 8), *all = s->rank ? NULL : need(3 * (size_t)s->rows * (size_t)s->columns, 8);
    int *counts = need((size_t)s->ranks, sizeof *counts),
        *displacements = need((size_t)s->ranks, sizeof *displacements);
    for (int c = 0; c < s->width; c++) // column by column, as the slabs are
        for (int r = 0; r < s->rows; r++)
            memcpy(mine + 3 * ((size_t)c * (size_t)s->rows + (size_t)r), s->x[at(s, r, c)], 24);
    MPI_Gather(&count, 1, MPI_INT, counts, 1, MPI_INT, 0, MPI_COMM_WORLD);
    for (int i = 1; i < s->ranks; i++) displacements[i] = displacements[i - 1] + counts[i - 1];
    MPI_Gatherv(mine, count, MPI_DOUBLE, all, counts, displacements, MPI_DOUBLE, 0, MPI_COMM_WORLD);
    free(mine), free(counts), free(displacements);
    return all;
}

int main(int argc, char **argv) {
    int rank, ranks;
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    const int rows = argc > 1 ? atoi(argv[1]) : 200, columns = argc > 2 ? atoi(argv[2]) : 200;
    const int substeps = argc > 3 ? atoi(argv[3]) : 240;
    if (rows < 2 || columns < 2 * ranks || substeps < 1) {
        if (!rank) fprintf(stderr, "strands_mpi ROWS COLUMNS SUBSTEPS [FILE [NUDGE]], two columns a rank at least\n");
        MPI_Finalize();
        return 2;
    }
    Sheet s = make_sheet(rank, ranks, rows, columns);
    Work work = make_work(&s);
    const int middle = columns / 2 - s.first;
    if (argc > 5 && middle >= 0 && middle < s.width) s.x[at(&s, rows / 2, middle)][2] += atof(argv[5]);
    MPI_Barrier(MPI_COMM_WORLD);
    const double begun = MPI_Wtime();
    for (int i = 0; i < substeps; i++) substep(&s, 1.0 / 480, &work);
    const double mine[2] = {s.solve / substeps, s.wait / substeps}, seconds = (MPI_Wtime() - begun) / substeps;
    double max[2];
    MPI_Reduce(mine, max, 2, MPI_DOUBLE, MPI_MAX, 0, MPI_COMM_WORLD);
    double *all = gather(&s);
    if (!rank) {
        printf(
            "%d ranks: %.3f ms a substep, of it %.3f projecting and %.3f in messages; %ld messages, %.1f kB a rank\n",
            ranks, 1e3 * seconds, 1e3 * max[0], 1e3 * max[1], s.messages / substeps, 1e-3 * s.bytes / substeps);
        FILE *file = argc > 4 ? fopen(argv[4], "wb") : NULL;
        if (file) fwrite(all, 24, (size_t)rows * (size_t)columns, file), fclose(file);
    }
    MPI_Finalize();
    return 0;
}
