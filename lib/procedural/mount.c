/*
 * mount.c - a fractal mountain: a square of heights, halved again and again, under four glass spheres.
 *
 *    left upper   upper mid   right upper      A square of w cells gets five new heights: each the mean of its neighbours
 *         +-----------+-----------+            plus a pseudo-normal number that depends on the place alone, so that both
 *         |           |           |            squares at an edge give its middle the same height: no cracks.
 *  left mid +       middle        + right mid
 *         |           |           |
 *         +-----------+-----------+
 *    left lower   lower mid   right lower
 *
 * Source: A. Fournier, D. Fussell and L. Carpenter, CACM 25(6), 1982, for the method; E. Haines, "A Proposal for Standard
 * Graphics Environments", IEEE CG&A 7(11), 1987, and the Standard Procedural Databases 3 for this mountain. Its hash is
 * the original one, which repeats itself from size 8 on; it is kept because the published figures belong to it.
 */
#include "elementary.h"
#include "emit.h"

#include <math.h>

#if ASET_WITH_POLYGONS && ASET_WITH_SPHERES && ASET_WITH_REFRACTION

typedef struct mountain {
    const aset_sink *sink;
    uint32_t size, n_cells; /* n_cells = 2^size along each edge, 2^15 at most for the hash */
    double roughness;
} mountain;

/* The heights at the corners of a square. */
typedef struct corners {
    double left_lower, right_lower, right_upper, left_upper;
} corners;

/* Below 2^16. Up to size 7 it tells all vertices of the grid apart and depends on a / n_cells and b / n_cells alone. */
static uint32_t hashed(const mountain *all, uint32_t a, uint32_t b) {
    uint32_t shift_a = all->size <= 7 ? 7 - all->size : 23 - all->size;
    return ((a << shift_a) + (b << (15 - all->size))) & 0xffffu;
}

/* A linear congruential generator; seed below 134456, so the product stays below 1.1e9. */
static uint32_t stepped(uint32_t seed) {
    return (8121u * seed + 28411u) % 134456u;
}

/*
 * A number of mean 0 and variance 1 for the vertex (a, b): the polar method (G. Marsaglia and T. A. Bray, 1964) on pairs
 * from the generator. The generator's period is the whole 134456, so the loop ends, for any seed here after 9 pairs
 * at most; and r > 0, as no number follows itself at the centre.
 */
static double pseudo_normal(const mountain *all, uint32_t a, uint32_t b) {
    uint32_t seed = hashed(all, a, b) + 21u;
    double v1, v2, r;
    do {
        seed = stepped(seed);
        v1 = 2.0 * seed / 134456.0 - 1.0;
        seed = stepped(seed);
        v2 = 2.0 * seed / 134456.0 - 1.0;
        r = v1 * v1 + v2 * v2;
    } while (r >= 1.0);
    return v1 * sqrt(-2.0 * aset_emit_logarithm(r) / r);
}

static emit_point vertex(const mountain *all, uint32_t i, uint32_t j, double height) {
    emit_point result;
    result.x = -1.0 + 2.0 * i / all->n_cells;
    result.y = -1.0 + 2.0 * j / all->n_cells;
    result.z = height;
    return result;
}

/* The two triangles of one cell. */
static aset_status cell(const mountain *all, uint32_t i, uint32_t j, const corners *z) {
    emit_point lower[3], upper[3];
    aset_status status;
    lower[0] = upper[2] = vertex(all, i, j, z->left_lower);
    lower[1] = vertex(all, i + 1, j, z->right_lower);
    lower[2] = upper[0] = vertex(all, i + 1, j + 1, z->right_upper);
    upper[1] = vertex(all, i, j + 1, z->left_upper);
    status = aset_emit_polygon(all->sink, lower, NULL, 3);
    return status == ASET_OK ? aset_emit_polygon(all->sink, upper, NULL, 3) : status;
}

/* The square of width cells whose lower left vertex is (i, j). Depth of recursion: size. */
static aset_status grow(const mountain *all, uint32_t width, uint32_t i, uint32_t j, const corners *z) {
    uint32_t half = width / 2;
    double d = all->roughness * width / all->n_cells;
    double lower, right, upper, left, middle;
    aset_status status;
    if (width == 1) {
        return cell(all, i, j, z);
    }
    lower = (z->left_lower + z->right_lower) / 2.0 + d * pseudo_normal(all, i + half, j);
    right = (z->right_lower + z->right_upper) / 2.0 + d * pseudo_normal(all, i + width, j + half);
    upper = (z->right_upper + z->left_upper) / 2.0 + d * pseudo_normal(all, i + half, j + width);
    left = (z->left_upper + z->left_lower) / 2.0 + d * pseudo_normal(all, i, j + half);
    middle = (z->left_lower + z->right_lower + z->right_upper + z->left_upper) / 4.0 +
             1.4142136 * d * pseudo_normal(all, i + half, j + half);
    status = grow(all, half, i, j, &(corners){z->left_lower, lower, middle, left});
    if (status == ASET_OK) {
        status = grow(all, half, i + half, j, &(corners){lower, z->right_lower, right, middle});
    }
    if (status == ASET_OK) {
        status = grow(all, half, i + half, j + half, &(corners){middle, right, z->right_upper, upper});
    }
    if (status == ASET_OK) {
        status = grow(all, half, i, j + half, &(corners){left, middle, upper, z->left_upper});
    }
    return status;
}

/* Four spheres that touch each other, one above the other three. */
static aset_status spheres(const aset_sink *sink) {
    static const emit_surface glass = {1, 1, 1, 0.1, 0.1, EMIT_SHINE_6_7, 0.9, 1.5};
    const emit_point middle = {-0.8, 0.8, 1.0};
    const double radius = 0.17, height = radius * sqrt(1.5), across = height * sqrt(8.0) / 3.0;
    emit_point centre = middle;
    aset_status status = aset_emit_material(sink, &glass);
    centre.z += height;
    if (status == ASET_OK) {
        status = aset_emit_sphere(sink, &centre, radius);
    }
    for (int i = 0; i < 3 && status == ASET_OK; i++) {
        double azimuth = EMIT_RAD(-45.0 + 120.0 * i);
        centre.x = middle.x + across * aset_emit_cosine(azimuth);
        centre.y = middle.y + across * aset_emit_sine(azimuth);
        centre.z = middle.z - height / 3.0;
        status = aset_emit_sphere(sink, &centre, radius);
    }
    return status;
}

aset_status aset_procedural_mount(const aset_sink *sink, uint32_t size) {
    static const emit_point lights[] = {{-100, -100, 100}};
    static const emit_setting setting = {{-1.6, 1.6, 1.7}, {0, 0, 0}, {0, 0, 1}, lights, 1};
    static const emit_surface rock = {0.5, 0.45, 0.35, 1, 0, EMIT_DULL, 0, 0};
    static const corners flat = {0, 0, 0, 0};
    mountain all;
    aset_status status = EMIT_SIZE(mount, &size);
    if (status != ASET_OK) {
        return status;
    }
    all.sink = sink;
    all.size = size;
    all.n_cells = (uint32_t)1 << size;
    all.roughness = sqrt(1.2599210498948732 - 1.0);
    status = aset_emit_setting(sink, &setting);
    if (status == ASET_OK) {
        status = spheres(sink);
    }
    if (status == ASET_OK) {
        status = aset_emit_material(sink, &rock);
    }
    return status == ASET_OK ? grow(&all, all.n_cells, 0, 0, &flat) : status;
}

#else
EMIT_UNSUPPORTED(mount)
#endif
