/*
 * test_scale.c - a scene's unit and place: times a power of two it is the same picture bit for bit, times a power of ten the eye
 * rays' hits are the same to a thousandth, and moved away from the origin they err more and more, until the space is refused.
 *
 * ASET_LONG=1: every power and larger pictures. ASET_TABLES=FILE: appends the table of errors away from the origin, in Markdown.
 */
#include "support/rays.h"

#include "aset/procedural.h"

#include <math.h>

/* --- a source in other lengths, elsewhere: a sink before another one --- */

typedef struct moved {
    const aset_sink *to;
    double scale;
    dvec by;
} moved;

static aset_vec3 there(const moved *m, const aset_vec3 *p) {
    return dvec_real(dvec_along(m->by, m->scale, dvec_of(*p)));
}

static aset_status moved_background(void *context, const aset_colour *colour) {
    const moved *m = context;
    return m->to->background(m->to->context, colour);
}

static aset_status moved_view(void *context, const aset_view *view) {
    const moved *m = context;
    aset_view v = *view;
    v.from = there(m, &view->from);
    v.at = there(m, &view->at);
    v.height = (aset_real)(m->scale * (double)view->height);
    return m->to->view(m->to->context, &v);
}

static aset_status moved_light(void *context, const aset_light *light) {
    const moved *m = context;
    aset_light l = *light;
    l.position = light->directional ? light->position : there(m, &light->position);
    return m->to->light(m->to->context, &l);
}

static aset_status moved_material(void *context, const aset_material *material) {
    const moved *m = context;
    return m->to->material(m->to->context, material);
}

#if ASET_WITH_POLYGONS
static aset_status moved_begin(void *context, uint32_t n_points, bool with_normals) {
    const moved *m = context;
    return m->to->polygon_begin(m->to->context, n_points, with_normals);
}

static aset_status moved_point(void *context, const aset_vec3 *point, const aset_vec3 *normal) {
    const moved *m = context;
    aset_vec3 p = there(m, point);
    return m->to->polygon_point(m->to->context, &p, normal);
}

static aset_status moved_end(void *context) {
    const moved *m = context;
    return m->to->polygon_end(m->to->context);
}
#endif

#if ASET_WITH_SPHERES
static aset_status moved_sphere(void *context, const aset_vec3 *centre, aset_real radius) {
    const moved *m = context;
    aset_vec3 c = there(m, centre);
    return m->to->sphere(m->to->context, &c, (aset_real)(m->scale * (double)radius));
}
#endif

#if ASET_WITH_CONES
static aset_status moved_cone(void *context, const aset_vec3 *base, aset_real base_radius, const aset_vec3 *apex,
                              aset_real apex_radius) {
    const moved *m = context;
    aset_vec3 b = there(m, base), a = there(m, apex);
    return m->to->cone(m->to->context, &b, (aset_real)(m->scale * (double)base_radius), &a,
                       (aset_real)(m->scale * (double)apex_radius));
}
#endif

typedef struct place {
    const char *name;
    uint32_t size;
    double scale;
    dvec by;
} place;

static aset_status emit_moved(const aset_sink *to, const void *context) {
    const place *p = context;
    moved m = {to, p->scale, p->by};
    aset_sink sink;
    sink.context = &m;
    sink.background = moved_background;
    sink.view = moved_view;
    sink.light = moved_light;
    sink.material = moved_material;
#if ASET_WITH_POLYGONS
    sink.polygon_begin = moved_begin;
    sink.polygon_point = moved_point;
    sink.polygon_end = moved_end;
#endif
#if ASET_WITH_SPHERES
    sink.sphere = moved_sphere;
#endif
#if ASET_WITH_CONES
    sink.cone = moved_cone;
#endif
    return aset_procedural_find(p->name)->emit(&sink, p->size);
}

/* --- pictures and hits of such a scene --- */

enum { ROOM = 3 << 20, PICTURE_MAX = 64 };

typedef struct subject {
    stage s;
    aset_space space;
#if ASET_WITH_APPROXIMATION
    aset_summary summary;
#endif
    aset_tracer tracer;
    aset_scratch scratch;
} subject;

/* False: the library was compiled without what the scene needs. status: of the scene, or of the space: then the stage is open. */
static bool subject_open(subject *x, const place *p, const aset_method *method, aset_status *status) {
    aset_counter counter;
    aset_sink sink = aset_counter_sink(&counter);
    if (aset_procedural_find(p->name)->emit(&sink, p->size) == ASET_ERR_UNSUPPORTED) {
        return false;
    }
    sink = aset_counter_sink(&counter);
    *status = emit_moved(&sink, p);
    if (*status != ASET_OK) {
        return true;
    }
    stage_open(&x->s, emit_moved, p, ROOM);
    *status = aset_space_build(&x->space, &x->s.scene, method, NULL, &x->s.arena);
    if (*status == ASET_OK) {
        x->tracer = stage_tracer(&x->s, &x->space);
#if ASET_WITH_APPROXIMATION
        assert_int_equal(aset_summary_build(&x->summary, &x->space, 0, &x->s.arena), ASET_OK);
        x->tracer.summary = &x->summary;
#endif
        assert_int_equal(aset_scratch_init(&x->scratch, 0, &x->s.arena), ASET_OK);
    } else {
        stage_close(&x->s);
    }
    return true;
}

static void draw(subject *x, uint32_t side, unsigned char *pixels, aset_statistics *statistics) {
    aset_picture picture = {.width = side, .height = side, .pixels = pixels, .stride = 3 * (size_t)side};
    memset(statistics, 0, sizeof *statistics);
    assert_int_equal(aset_render_rows(&x->tracer, &x->s.scene.view, &picture, 0, side, &x->scratch, statistics), ASET_OK);
}

/* The same scene, drawn exactly and with approximate rays from the second on. */
typedef struct pictures {
    unsigned char exact[3 * PICTURE_MAX * PICTURE_MAX], draft[3 * PICTURE_MAX * PICTURE_MAX];
    aset_statistics exact_counts, draft_counts;
} pictures;

static bool take_pictures(pictures *shot, const place *p, const aset_method *method, uint32_t side) {
    subject x;
    aset_status status;
    memset(shot, 0, sizeof *shot);
    if (!subject_open(&x, p, method, &status)) {
        return false;
    }
    check(status == ASET_OK, "%s times %g: %s", p->name, p->scale, aset_status_text(status));
    draw(&x, side, shot->exact, &shot->exact_counts);
#if ASET_WITH_APPROXIMATION
    x.tracer.approx_kinds = ASET_ALL_KINDS;
    x.tracer.approx_depth = 1;
    x.tracer.curtail = R(0.5);
    draw(&x, side, shot->draft, &shot->draft_counts);
#endif
    stage_close(&x.s);
    return true;
}

static const aset_method *const methods[] = {&aset_mset, &aset_grid, &aset_set, &aset_octree, &aset_arts, &aset_excell};

static const dvec nowhere = {0, 0, 0};

static void test_scale__powers_of_two_are_the_same_picture(void **state) {
    (void)state;
    static pictures one, other;
    int step = long_run() ? 1 : 12;
    for (size_t i = 0; i < SPD_SCENES; i++) {
        for (size_t k = 0; k < COUNT_OF(methods); k++) {
            place p = {small_scenes[i].name, small_scenes[i].size, 1, nowhere};
            uint32_t side = long_run() || (i == 0 && methods[k] == &aset_octree) ? 64 : 16; /* that one shows lost bits first */
            if (!take_pictures(&one, &p, methods[k], side)) {
                break;
            }
            /* all powers with MSET, the largest and smallest, which are all that is far from 1 in another way, with the others */
            for (int e = -60; e <= 60; e += k == 0 ? step : 120) {
                p.scale = ldexp(1, e);
                (void)take_pictures(&other, &p, methods[k], side);
                check(memcmp(&one, &other, sizeof one) == 0, "%s, %s, times 2^%d: another picture or other counts", p.name,
                      aset_method_name(methods[k]), e);
            }
        }
    }
}

/* --- eye rays --- */

typedef struct looks {
    uint32_t n;
    struct {
        bool found;
        uint32_t object;
        dvec point;
        double t;
    } list[PICTURE_MAX * PICTURE_MAX];
} looks;

/* The eye rays of a picture, t and point brought back to the scene as it was. The rays are made in double, then rounded. */
static void look(looks *l, const subject *x, const place *p, const aset_view *view, uint32_t side) {
    dvec from = dvec_of(view->from), forward = dvec_unit(dvec_sub(dvec_of(view->at), from));
    dvec right = dvec_unit(dvec_cross(forward, dvec_of(view->up))), down = dvec_cross(forward, right);
    double half = tan((double)view->angle_deg * 3.14159265358979323846 / 360);
    l->n = 0;
    for (uint32_t i = 0; i < side * side; i++) {
        double u = half * ((2 * (i % side) + 1.0) / side - 1), v = half * ((2 * (double)(i / side) + 1.0) / side - 1);
        aset_ray ray = {dvec_real(dvec_along(p->by, p->scale, from)),
                        dvec_real(dvec_unit(dvec_along(dvec_along(forward, u, right), v, down))), REAL_INFINITY};
        aset_hit hit;
        bool found;
        memset(&hit, 0, sizeof hit);
        assert_int_equal(aset_closest_hit(&found, &hit, &x->tracer, &ray, false, NULL), ASET_OK);
        l->list[l->n].found = found;
        l->list[l->n].object = found ? hit.object : 0;
        l->list[l->n].t = (double)hit.t / p->scale;
        dvec back = dvec_sub(dvec_of(hit.point), p->by);
        l->list[l->n++].point = dvec_make(back.x / p->scale, back.y / p->scale, back.z / p->scale);
    }
}

static bool look_at(looks *l, const place *p, const aset_method *method, const aset_view *view, uint32_t side,
                    aset_status *status) {
    subject x;
    if (!subject_open(&x, p, method, status)) {
        return false;
    }
    if (*status == ASET_OK) {
        look(l, &x, p, view, side);
        stage_close(&x.s);
    }
    return true;
}

/* The scene's view and size as it is by rule; false if it cannot be made here. */
static bool at_home(const place *p, aset_view *view, double *size) {
    subject x;
    aset_status status;
    if (!subject_open(&x, p, &aset_mset, &status)) {
        return false;
    }
    *view = x.s.scene.view;
    *size = size_of(&x.s.scene);
    stage_close(&x.s);
    return true;
}

static uint32_t count_others(const looks *a, const looks *b) {
    uint32_t n = 0;
    for (uint32_t i = 0; i < a->n; i++) {
        n += a->list[i].found != b->list[i].found || a->list[i].object != b->list[i].object;
    }
    return n;
}

/* Coordinates round otherwise, so at silhouettes and edges a ray may meet another object: one in a thousand. */
static void test_scale__powers_of_ten_hit_the_same(void **state) {
    (void)state;
    static looks one, other;
    uint32_t side = long_run() ? 64 : 32;
    for (size_t i = 0; i < SPD_SCENES; i++) {
        place p = {small_scenes[i].name, small_scenes[i].size, 1, nowhere};
        aset_view view;
        aset_status status;
        double size;
        uint32_t hits = 0, others = 0;
        if (!at_home(&p, &view, &size) || !look_at(&one, &p, &aset_mset, &view, side, &status)) {
            continue;
        }
        for (int k = -15; k <= 15; k += long_run() ? 1 : 5) {
            p.scale = pow(10, k);
            (void)look_at(&other, &p, &aset_mset, &view, side, &status);
            check(status == ASET_OK, "%s times 10^%d: %s", p.name, k, aset_status_text(status));
            others += count_others(&one, &other);
            for (uint32_t n = 0; n < one.n; n++) {
                bool same = one.list[n].found && other.list[n].found && one.list[n].object == other.list[n].object;
                check(!same || fabs(other.list[n].t - one.list[n].t) <= 1e-3 * one.list[n].t,
                      "%s times 10^%d, ray %" PRIu32 ": t %.9g, not %.9g", p.name, k, n, other.list[n].t, one.list[n].t);
                hits++;
            }
        }
        check(others * 1000 <= hits, "%s: %" PRIu32 " of %" PRIu32 " eye rays hit something else", p.name, others, hits);
        if (long_run()) {
            print_message("%s times 10^-15 to 10^15: %" PRIu32 " of %" PRIu32 " eye rays hit something else\n", p.name, others, hits);
        }
    }
}

/* --- away from the origin --- */

static int ascending(const void *a, const void *b) {
    const double *x = a, *y = b;
    return (*x > *y) - (*x < *y);
}

typedef struct drift {
    double others, median, most; /* share of rays; errors of the point in parts of the scene's size, most: 99 % below it */
} drift;

static drift drift_of(const looks *one, const looks *other, double size) {
    static double errors[PICTURE_MAX * PICTURE_MAX];
    drift d = {(double)count_others(one, other) / one->n, 0, 0};
    uint32_t n = 0;
    for (uint32_t i = 0; i < one->n; i++) {
        if (one->list[i].found && other->list[i].found && one->list[i].object == other->list[i].object) {
            errors[n++] = dvec_length(dvec_sub(one->list[i].point, other->list[i].point)) / size;
        }
    }
    if (n > 0) {
        qsort(errors, n, sizeof *errors, ascending);
        d.median = errors[n / 2];
        d.most = errors[n - 1 - n / 100];
    }
    return d;
}

/* Steps between neighbouring coordinates so far out, in parts of the scene's size: what everything there is rounded to. */
static double step_at(double sizes) {
    return 2 * (double)REAL_UNIT * sizes;
}

static void test_scale__moved_scenes_err_until_they_are_refused(void **state) {
    (void)state;
    static looks one, other;
    const char *path = getenv("ASET_TABLES");
    FILE *table = path != NULL ? fopen(path, "a") : NULL;
    for (size_t i = 0; i < SPD_SCENES; i++) {
        place p = {small_scenes[i].name, small_scenes[i].size, 1, nowhere};
        aset_view view;
        aset_status status;
        double size;
        if (!at_home(&p, &view, &size) || !look_at(&one, &p, &aset_mset, &view, PICTURE_MAX, &status)) {
            continue;
        }
        for (int k = 3; k <= 6; k++) {
            double sizes = pow(10, k);
            p.by = dvec_make(sizes * size, -0.7 * sizes * size, 0.4 * sizes * size);
            (void)look_at(&other, &p, &aset_mset, &view, PICTURE_MAX, &status);
            bool refused = status == ASET_ERR_PRECISION || status == ASET_ERR_GEOMETRY; /* that: a twig of tree has no length left */
            check(status == ASET_OK || (refused && ASET_REAL_BITS == 32 && k >= 5), "%s 10^%d sizes away: %s", p.name, k,
                  aset_status_text(status));
            check(refused || ASET_REAL_BITS == 64 || k < 6, "%s 10^6 sizes away is taken", p.name);
            if (refused) {
                (void)(table != NULL && fprintf(table, "| %s | 10^%d | %.1e | refused: %s | | |\n", p.name, k, step_at(sizes),
                                                aset_status_text(status)));
                continue;
            }
            drift d = drift_of(&one, &other, size);
            check(d.median <= 4 * step_at(sizes), "%s 10^%d sizes away: median error %g of its size", p.name, k, d.median);
            (void)(table != NULL && fprintf(table, "| %s | 10^%d | %.1e | %.2f %% | %.1e | %.1e |\n", p.name, k, step_at(sizes),
                                            100 * d.others, d.median, d.most));
        }
    }
    assert_true(table == NULL || fclose(table) == 0);
}

/* A point is a scene of no size at all, which is no loss of precision; two spheres that are hardly apart are one. */
static void test_scale__precision_is_asked_of_the_whole_scene(void **state) {
    (void)state;
#if ASET_WITH_POLYGONS
    const double step = 1000 * 2 * (double)REAL_UNIT; /* at least a step at 1000 */
    const struct {
        double size;
        aset_status status;
    } cases[] = {{0, ASET_OK}, {4 * step, ASET_ERR_PRECISION}, {50 * step, ASET_ERR_PRECISION}, {70 * step, ASET_OK}};
    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        for (size_t k = 0; k < COUNT_OF(methods); k++) {
            model m;
            stage s;
            aset_space space;
            aset_space_size size;
            double high = 1000, low = high - cases[i].size;
            const aset_vec3 points[3] = {real3(low, 1, 1), real3(high, 1, 1), real3(high, 1, 1)};
            model_start(&m);
            model_polygon(&m, points, NULL, 3);
            stage_open_model(&s, &m, 1 << 16);
            aset_arena before = s.arena;
            assert_int_equal(aset_space_measure(&size, &s.scene, methods[k], NULL, &s.arena), cases[i].status);
            assert_int_equal(aset_space_build(&space, &s.scene, methods[k], NULL, &s.arena), cases[i].status);
            assert_true(cases[i].status == ASET_OK || s.arena.used == before.used);
            stage_close(&s);
            model_free(&m);
        }
    }
#endif
}

/* A surface nearer to the origin than the least number there is: t has none, but is above 0, as a hit's is. */
static void test_scale__a_t_that_has_no_number(void **state) {
    (void)state;
#if ASET_WITH_POLYGONS
    const aset_real d = REAL_DENORMAL, n = R(0x1p20);
    const aset_vec3 ramp[4] = {{0, 0, 0}, {n * d, 0, d}, {n * d, n * d, d}, {0, n * d, 0}};
    for (size_t k = 0; k < COUNT_OF(methods); k++) {
        model m;
        stage s;
        aset_space space;
        aset_hit hit;
        bool found;
        aset_ray ray = {{n / 8 * d, n / 2 * d, 0}, {0, 0, 1}, REAL_INFINITY};
        model_start(&m);
        model_polygon(&m, ramp, NULL, 4);
        stage_open_model(&s, &m, 1 << 16);
        assert_int_equal(aset_space_build(&space, &s.scene, methods[k], NULL, &s.arena), ASET_OK);
        const aset_tracer tracer = stage_tracer(&s, &space);
        assert_int_equal(aset_closest_hit(&found, &hit, &tracer, &ray, false, NULL), ASET_OK);
        assert_true(found && hit.t > 0 && hit.t <= d);
        stage_close(&s);
        model_free(&m);
    }
#endif
}

/* --- scenes whose objects are of different sizes: the scale changes as they come --- */

static void add_around(model *m, random_state *r, double size) {
    for (int k = 0; k < 6; k++) {
        thing *t = model_random_thing(m, r, size, size);
        (void)t;
    }
}

/* In either order of sizes, so that the scale goes up first or not at all: the same hits, the same boxes. */
static void test_scale__order_of_sizes_does_not_matter(void **state) {
    (void)state;
    const double sizes[][2] = {{1e-12, 1}, {1e-12, 1e20}, {1, 1e20}, {1e-3, 1e-12}};
    for (size_t i = 0; i < COUNT_OF(sizes); i++) {
        random_state r = random_start(seed_of(900 + i));
        model m;
        stage up, down;
        model_start(&m);
        add_around(&m, &r, sizes[i][0]);
        add_around(&m, &r, sizes[i][1]);
        stage_open_model(&up, &m, 0);
        m.backwards = true;
        stage_open_model(&down, &m, 0);
        for (uint32_t k = 0; k < m.n_things; k++) {
            aset_vec3 low[2], high[2];
            aset_object_bounds(&up.scene, k, low, high);
            aset_object_bounds(&down.scene, m.n_things - 1 - k, low + 1, high + 1);
            double size = k < 6 ? sizes[i][0] : sizes[i][1];
            check(dvec_length(dvec_sub(dvec_of(low[0]), dvec_of(low[1]))) <= 1e-6 * size &&
                      dvec_length(dvec_sub(dvec_of(high[0]), dvec_of(high[1]))) <= 1e-6 * size,
                  SEED ", object %" PRIu32 " of %g", r.seed, k, size);
        }
        assert_true(up.scene.scale == down.scene.scale && up.scene.margin == down.scene.margin);
        stage_close(&up);
        stage_close(&down);
        model_free(&m);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_scale__powers_of_two_are_the_same_picture),
        cmocka_unit_test(test_scale__powers_of_ten_hit_the_same),
        cmocka_unit_test(test_scale__moved_scenes_err_until_they_are_refused),
        cmocka_unit_test(test_scale__precision_is_asked_of_the_whole_scene),
        cmocka_unit_test(test_scale__a_t_that_has_no_number),
        cmocka_unit_test(test_scale__order_of_sizes_does_not_matter),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
