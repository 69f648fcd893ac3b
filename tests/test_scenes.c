/*
 * test_scenes.c - the three scenes that stand for unpublished ones of Dauenhauer and Semwal (1990): their counts, and the
 * densities that the paper prints, marked anew by brute force: a counter for each of the 6 n^3 sides of all voxels.
 */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#include "aset/procedural.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* What each scene shows. */
#define WITH_SNOW (ASET_WITH_POLYGONS && ASET_WITH_SPHERES)
#define WITH_MOON (WITH_SNOW && ASET_WITH_REFRACTION)
#define WITH_SKULL (WITH_SNOW && ASET_WITH_CONES)

enum { max_objects = 5000, max_materials = 8, max_points = 32 };

/* --- A sink that keeps each object's box and material. --- */

typedef struct box {
    double low[3], high[3];
    uint32_t material;
} box;

typedef struct taken {
    box *boxes, all;
    uint32_t n, n_polygons, n_spheres, n_cones, n_lights, n_views, n_coordinates;
    aset_material materials[max_materials];
    uint32_t n_materials;
    double points[max_points][3];
    uint32_t n_points, n_announced;
    uint64_t hash; /* of every number, in order (FNV-1a) */
} taken;

static void take_number(taken *to, aset_real number) {
    unsigned char bytes[sizeof number];
    memcpy(bytes, &number, sizeof number);
    assert_true(isfinite(number));
    for (size_t i = 0; i < sizeof number; i++) {
        to->hash = (to->hash ^ bytes[i]) * 1099511628211u;
    }
}

static void take_vec3(taken *to, const aset_vec3 *v) {
    take_number(to, v->x);
    take_number(to, v->y);
    take_number(to, v->z);
}

static void take_colour(taken *to, const aset_colour *colour) {
    take_number(to, colour->r);
    take_number(to, colour->g);
    take_number(to, colour->b);
}

static void widen(box *b, const double low[3], const double high[3]) {
    for (int a = 0; a < 3; a++) {
        b->low[a] = fmin(b->low[a], low[a]);
        b->high[a] = fmax(b->high[a], high[a]);
    }
}

static box empty_box(void) {
    box b = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}, 0};
    return b;
}

static box *next_box(taken *to) {
    box *b;
    assert_true(to->n < max_objects);
    assert_true(to->n_materials > 0);
    b = &to->boxes[to->n++];
    *b = empty_box();
    b->material = to->n_materials - 1;
    return b;
}

static aset_status on_background(void *context, const aset_colour *colour) {
    take_colour(context, colour);
    return ASET_OK;
}

static aset_status on_view(void *context, const aset_view *view) {
    taken *to = context;
    to->n_views++;
    take_vec3(to, &view->from);
    take_vec3(to, &view->at);
    take_vec3(to, &view->up);
    take_number(to, view->angle_deg);
    return ASET_OK;
}

static aset_status on_light(void *context, const aset_light *light) {
    taken *to = context;
    to->n_lights++;
    take_vec3(to, &light->position);
    return ASET_OK;
}

static aset_status on_material(void *context, const aset_material *material) {
    taken *to = context;
    assert_true(to->n_materials < max_materials);
    take_colour(to, &material->fill);
    take_number(to, material->diffuse);
    take_number(to, material->specular);
    take_number(to, material->shine);
    assert_true(material->diffuse >= 0 && material->specular >= 0 && material->shine >= 0);
#if ASET_WITH_REFRACTION
    take_number(to, material->transmittance);
    take_number(to, material->refraction_index);
    assert_true(material->transmittance >= 0 && material->refraction_index >= 0);
#endif
    to->materials[to->n_materials++] = *material;
    return ASET_OK;
}

#if ASET_WITH_POLYGONS
static aset_status on_polygon_begin(void *context, uint32_t n_points, bool with_normals) {
    taken *to = context;
    assert_false(with_normals);
    assert_in_range(n_points, 3, max_points);
    to->n_announced = n_points;
    to->n_points = 0;
    return ASET_OK;
}

static aset_status on_polygon_point(void *context, const aset_vec3 *point, const aset_vec3 *normal) {
    taken *to = context;
    assert_null(normal);
    assert_true(to->n_points < to->n_announced);
    take_vec3(to, point);
    to->points[to->n_points][0] = (double)point->x;
    to->points[to->n_points][1] = (double)point->y;
    to->points[to->n_points][2] = (double)point->z;
    to->n_points++;
    return ASET_OK;
}

/* The first three points give a normal, and all the others lie in their plane but for the rounding to float. */
static void assert_flat(const taken *to) {
    double normal[3], length = 0.0, u[3], v[3];
    for (int a = 0; a < 3; a++) {
        u[a] = to->points[1][a] - to->points[0][a];
        v[a] = to->points[2][a] - to->points[1][a];
    }
    for (int a = 0; a < 3; a++) {
        normal[a] = u[(a + 1) % 3] * v[(a + 2) % 3] - u[(a + 2) % 3] * v[(a + 1) % 3];
        length += normal[a] * normal[a];
    }
    length = sqrt(length);
    assert_true(length > 1e-6);
    for (uint32_t i = 3; i < to->n_points; i++) {
        double distance = 0.0;
        for (int a = 0; a < 3; a++) {
            distance += normal[a] * (to->points[i][a] - to->points[0][a]);
        }
        assert_true(fabs(distance) <= 1e-5 * length);
    }
}

static aset_status on_polygon_end(void *context) {
    taken *to = context;
    box *b = next_box(to);
    assert_int_equal(to->n_points, to->n_announced);
    assert_flat(to);
    for (uint32_t i = 0; i < to->n_points; i++) {
        widen(b, to->points[i], to->points[i]);
    }
    widen(&to->all, b->low, b->high);
    to->n_polygons++;
    to->n_coordinates += ASET_COORDINATES_POLYGON(to->n_points);
    return ASET_OK;
}
#endif

#if ASET_WITH_SPHERES || ASET_WITH_CONES
static void widen_round(box *b, const aset_vec3 *centre, const double reach[3]) {
    const double c[3] = {(double)centre->x, (double)centre->y, (double)centre->z};
    double low[3], high[3];
    for (int a = 0; a < 3; a++) {
        low[a] = c[a] - reach[a];
        high[a] = c[a] + reach[a];
    }
    widen(b, low, high);
}
#endif

#if ASET_WITH_SPHERES
static aset_status on_sphere(void *context, const aset_vec3 *centre, aset_real radius) {
    taken *to = context;
    const double reach[3] = {(double)radius, (double)radius, (double)radius};
    box *b = next_box(to);
    assert_true(radius > 0);
    take_vec3(to, centre);
    take_number(to, radius);
    widen_round(b, centre, reach);
    widen(&to->all, b->low, b->high);
    to->n_spheres++;
    to->n_coordinates += ASET_COORDINATES_SPHERE;
    return ASET_OK;
}
#endif

#if ASET_WITH_CONES
/* A disc's box reaches radius * sqrt(1 - axis_a^2) along coordinate a. */
static aset_status on_cone(void *context, const aset_vec3 *base, aset_real base_radius, const aset_vec3 *apex,
                           aset_real apex_radius) {
    taken *to = context;
    const double axis[3] = {(double)(apex->x - base->x), (double)(apex->y - base->y), (double)(apex->z - base->z)};
    double square = axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2], at_base[3], at_apex[3];
    box *b = next_box(to);
    assert_true(square > 0 && base_radius > 0 && apex_radius > 0);
    take_vec3(to, base);
    take_number(to, base_radius);
    take_vec3(to, apex);
    take_number(to, apex_radius);
    for (int a = 0; a < 3; a++) {
        double share = sqrt(fmax(0.0, 1.0 - axis[a] * axis[a] / square));
        at_base[a] = share * (double)base_radius;
        at_apex[a] = share * (double)apex_radius;
    }
    widen_round(b, base, at_base);
    widen_round(b, apex, at_apex);
    widen(&to->all, b->low, b->high);
    to->n_cones++;
    to->n_coordinates += ASET_COORDINATES_CONE;
    return ASET_OK;
}
#endif

static taken taken_start(void) {
    taken to;
    memset(&to, 0, sizeof to);
    to.boxes = malloc(max_objects * sizeof *to.boxes);
    assert_non_null(to.boxes);
    to.all = empty_box();
    to.hash = 14695981039346656037u;
    return to;
}

static aset_status take(taken *to, const char *name, uint32_t size) {
    const aset_procedural *scene = aset_procedural_find(name);
    aset_sink sink;
    memset(&sink, 0, sizeof sink);
    sink.context = to;
    sink.background = on_background;
    sink.view = on_view;
    sink.light = on_light;
    sink.material = on_material;
#if ASET_WITH_POLYGONS
    sink.polygon_begin = on_polygon_begin;
    sink.polygon_point = on_polygon_point;
    sink.polygon_end = on_polygon_end;
#endif
#if ASET_WITH_SPHERES
    sink.sphere = on_sphere;
#endif
#if ASET_WITH_CONES
    sink.cone = on_cone;
#endif
    assert_non_null(scene);
    return scene->emit(&sink, size);
}

#if WITH_SNOW
/* --- The marking. --- */

typedef struct marking {
    uint32_t n, references, nonempty, averages;
    uint16_t *counts; /* of each side, one per material */
} marking;

/* The voxels of a box along axis a. The volume grows by 2^-17 of its longest edge, a box by half of that. */
static void range(const taken *to, const box *b, uint32_t n, int a, uint32_t *first, uint32_t *last) {
    double longest = 0.0, low, width;
    for (int k = 0; k < 3; k++) {
        longest = fmax(longest, to->all.high[k] - to->all.low[k]);
    }
    low = to->all.low[a] - ldexp(longest, -17);
    width = (to->all.high[a] + ldexp(longest, -17) - low) / n;
    *first = (uint32_t)((b->low[a] - ldexp(longest, -18) - low) / width);
    *last = (uint32_t)((b->high[a] + ldexp(longest, -18) - low) / width);
    assert_true(*first <= *last && *last < n);
}

/* Writes one box into the sides of face 2 a + high: of every voxel of that layer of its range. */
static void mark_face(marking *m, const uint32_t first[3], const uint32_t last[3], uint32_t a, uint32_t high,
                      uint32_t material) {
    const uint32_t b = (a + 1) % 3, c = (a + 2) % 3;
    uint32_t voxel[3];
    voxel[a] = high ? last[a] : first[a];
    for (voxel[b] = first[b]; voxel[b] <= last[b]; voxel[b]++) {
        for (voxel[c] = first[c]; voxel[c] <= last[c]; voxel[c]++) {
            size_t side = 6 * (((size_t)voxel[0] * m->n + voxel[1]) * m->n + voxel[2]) + 2 * a + high;
            m->counts[side * max_materials + material]++;
            m->references++;
        }
    }
}

static uint32_t common_divisor(uint32_t a, uint32_t b) {
    while (b != 0) {
        uint32_t rest = a % b;
        a = b;
        b = rest;
    }
    return a;
}

/* Counts the sides that hold something, and the different mixtures of materials in them up to 64. */
static void count_sides(marking *m) {
    uint32_t known[64][max_materials];
    size_t n_sides = 6 * (size_t)m->n * m->n * m->n;
    for (size_t side = 0; side < n_sides; side++) {
        const uint16_t *counts = &m->counts[side * max_materials];
        uint32_t mixture[max_materials], divisor = 0, i = 0;
        for (uint32_t k = 0; k < max_materials; k++) {
            divisor = common_divisor(counts[k], divisor);
        }
        if (divisor == 0) {
            continue;
        }
        m->nonempty++;
        for (uint32_t k = 0; k < max_materials; k++) {
            mixture[k] = counts[k] / divisor;
        }
        while (i < m->averages && memcmp(known[i], mixture, sizeof mixture) != 0) {
            i++;
        }
        if (i == m->averages && i < 64) {
            memcpy(known[m->averages++], mixture, sizeof mixture);
        }
    }
}

static marking mark(const taken *to, uint32_t n) {
    marking m = {n, 0, 0, 0, NULL};
    m.counts = calloc(6 * (size_t)n * n * n * max_materials, sizeof *m.counts);
    assert_non_null(m.counts);
    for (uint32_t i = 0; i < to->n; i++) {
        uint32_t first[3], last[3];
        for (int a = 0; a < 3; a++) {
            range(to, &to->boxes[i], n, a, &first[a], &last[a]);
        }
        for (uint32_t face = 0; face < 6; face++) {
            mark_face(&m, first, last, face / 2, face % 2, to->boxes[i].material);
        }
    }
    count_sides(&m);
    return m;
}

static void assert_density(const marking *m, double published) {
    double density = (double)m->references / m->nonempty;
    if (!(fabs(density - published) <= 0.1 * published)) {
        fail_msg("%lu divisions: %lu references on %lu sides are %.3f a side, published %.1f", (unsigned long)m->n,
                 (unsigned long)m->references, (unsigned long)m->nonempty, density, published);
    }
}
#endif

/* --- The tests. --- */

static const struct {
    const char *name;
    bool available;
} scenes[] = {{"snow", WITH_SNOW}, {"tetra-moon", WITH_MOON}, {"skull", WITH_SKULL}};
enum { n_scenes = sizeof scenes / sizeof scenes[0] };

static void test_scenes__need_what_they_show(void **state) {
    (void)state;
    for (int i = 0; i < n_scenes; i++) {
        taken to = taken_start();
        assert_int_equal(take(&to, scenes[i].name, 0), scenes[i].available ? ASET_OK : ASET_ERR_UNSUPPORTED);
        assert_true(scenes[i].available || to.n == 0);
        free(to.boxes);
    }
}

static void test_scenes__size(void **state) {
    (void)state;
    for (int i = 0; i < n_scenes; i++) {
        const aset_procedural *scene = aset_procedural_find(scenes[i].name);
        taken by_default = taken_start(), again = taken_start(), refused = taken_start();
        if (scenes[i].available) {
            assert_int_equal(take(&by_default, scenes[i].name, 0), ASET_OK);
            assert_int_equal(take(&again, scenes[i].name, scene->default_size), ASET_OK);
            assert_true(by_default.hash == again.hash && by_default.n == again.n);
            assert_int_equal(take(&refused, scenes[i].name, scene->largest_size + 1), ASET_ERR_ARGUMENT);
            assert_true(refused.n == 0 && refused.n_views == 0 && refused.n_lights == 0);
        }
        free(by_default.boxes);
        free(again.boxes);
        free(refused.boxes);
    }
}

static void test_scenes__setting(void **state) {
    (void)state;
    for (int i = 0; i < n_scenes; i++) {
        taken to = taken_start();
        bool reflects = false;
        if (scenes[i].available) {
            assert_int_equal(take(&to, scenes[i].name, 0), ASET_OK);
            assert_int_equal(to.n_views, 1);
            assert_in_range(to.n_lights, 1, 2);
            for (uint32_t k = 0; k < to.n_materials; k++) {
                reflects = reflects || to.materials[k].specular >= (aset_real)0.3;
            }
            assert_true(reflects);
        }
        free(to.boxes);
    }
}

#if WITH_SNOW
static void test_snow__counts(void **state) {
    taken to = taken_start();
    (void)state;
    assert_int_equal(take(&to, "snow", 0), ASET_OK);
    assert_int_equal(to.n, 813);
    assert_int_equal(to.n_polygons, 571);
    assert_int_equal(to.n_spheres, 242);
    assert_int_equal(to.n_cones, 0);
    assert_int_equal(to.n_materials, 3);
    assert_in_range(to.n_coordinates, 1, 7000);
    free(to.boxes);
}

/* Table 2 of the paper; and few enough sides, references and averages for a small memory. */
static void test_snow__density(void **state) {
    static const struct {
        uint32_t n, most_references, most_sides;
        double published;
    } rows[] = {{100, 40000, 30000, 1.3}, {50, 20000, 10000, 2.1}, {30, 16000, 4000, 3.9}};
    taken to = taken_start();
    (void)state;
    assert_int_equal(take(&to, "snow", 0), ASET_OK);
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        marking m = mark(&to, rows[i].n);
        assert_density(&m, rows[i].published);
        assert_in_range(m.references, 1, rows[i].most_references);
        assert_in_range(m.nonempty, 1, rows[i].most_sides);
        assert_in_range(m.averages, 3, 15);
        free(m.counts);
    }
    free(to.boxes);
}

/* Ice is the first material; the slice at 3/10 of the height parts it from the others. */
static void test_snow__ice_keeps_to_itself(void **state) {
    static const uint32_t divisions[] = {100, 50, 30};
    taken to = taken_start();
    (void)state;
    assert_int_equal(take(&to, "snow", 0), ASET_OK);
    for (size_t i = 0; i < sizeof divisions / sizeof divisions[0]; i++) {
        const uint32_t n = divisions[i];
        marking m = mark(&to, n);
        for (size_t side = 0; side < 6 * (size_t)n * n * n; side++) {
            const uint16_t *counts = &m.counts[side * max_materials];
            assert_true(counts[0] == 0 || (counts[1] == 0 && counts[2] == 0));
        }
        free(m.counts);
    }
    free(to.boxes);
}
#endif

#if WITH_MOON
static void test_tetra_moon__counts(void **state) {
    (void)state;
    for (uint32_t size = 1, triangles = 4; size <= 6; size++, triangles *= 4) {
        taken to = taken_start();
        assert_int_equal(take(&to, "tetra-moon", size), ASET_OK);
        assert_int_equal(to.n_polygons, triangles);
        assert_int_equal(to.n_spheres, 1);
        assert_int_equal(to.n, triangles + 1);
        assert_int_equal(to.n_materials, 2);
        free(to.boxes);
    }
}

static void test_tetra_moon__density(void **state) {
    taken to = taken_start();
    marking m;
    (void)state;
    assert_int_equal(take(&to, "tetra-moon", 0), ASET_OK);
    assert_int_equal(to.n, 1025);
    m = mark(&to, 10);
    assert_density(&m, 11.4);
    free(m.counts);
    free(to.boxes);
}
#endif

#if WITH_SKULL
static void test_skull__counts(void **state) {
    taken to = taken_start();
    (void)state;
    assert_int_equal(take(&to, "skull", 0), ASET_OK);
    assert_int_equal(to.n_polygons, 2);
    assert_int_equal(to.n_spheres, 117);
    assert_int_equal(to.n_cones, 84);
    assert_int_equal(to.n, 203);
    assert_int_equal(to.n_materials, 5);
    free(to.boxes);
}
#endif

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_scenes__need_what_they_show),
        cmocka_unit_test(test_scenes__size),
        cmocka_unit_test(test_scenes__setting),
#if WITH_SNOW
        cmocka_unit_test(test_snow__counts),
        cmocka_unit_test(test_snow__density),
        cmocka_unit_test(test_snow__ice_keeps_to_itself),
#endif
#if WITH_MOON
        cmocka_unit_test(test_tetra_moon__counts),
        cmocka_unit_test(test_tetra_moon__density),
#endif
#if WITH_SKULL
        cmocka_unit_test(test_skull__counts),
#endif
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
