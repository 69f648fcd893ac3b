/*
 * test_procedural.c - the SPD scenes against the counts and check sums of the original programs' output, and, where the
 * reference files are at hand, against every number in them.
 */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#include "aset/procedural.h"
#include "procedural/elementary.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* What each scene needs of the library; without it, it must say so. */
#define SPHERES_ON_FLOOR (ASET_WITH_POLYGONS && ASET_WITH_SPHERES)
static const struct {
    const char *name;
    bool available;
} spd_scenes[] = {
    {"balls", SPHERES_ON_FLOOR},
    {"gears", ASET_WITH_POLYGONS && ASET_WITH_REFRACTION},
    {"mount", SPHERES_ON_FLOOR && ASET_WITH_REFRACTION},
    {"rings", SPHERES_ON_FLOOR && ASET_WITH_CONES},
    {"teapot", ASET_WITH_PATCHES},
    {"tetra", ASET_WITH_POLYGONS},
    {"tree", SPHERES_ON_FLOOR && ASET_WITH_CONES},
};
enum { n_spd_scenes = sizeof spd_scenes / sizeof spd_scenes[0] };

static bool available(const char *name) {
    for (size_t i = 0; i < n_spd_scenes; i++) {
        if (strcmp(spd_scenes[i].name, name) == 0) {
            return spd_scenes[i].available;
        }
    }
    return false;
}

/* --- A sink that hands every entity on as a word and numbers, in the order of NFF, to one of the two takers below. --- */

typedef struct taker {
    aset_status (*word)(struct taker *self, const char *word, uint32_t n_points); /* n_points: of p and pp */
    void (*number)(struct taker *self, double number);
} taker;

static aset_status give(void *context, const char *word, uint32_t n_points) {
    taker *to = context;
    return to->word(to, word, n_points);
}

static void give_number(void *context, aset_real number) {
    taker *to = context;
    to->number(to, (double)number);
}

static void give_vec3(void *context, const aset_vec3 *v) {
    give_number(context, v->x);
    give_number(context, v->y);
    give_number(context, v->z);
}

static void give_colour(void *context, const aset_colour *colour) {
    give_number(context, colour->r);
    give_number(context, colour->g);
    give_number(context, colour->b);
}

static aset_status on_background(void *context, const aset_colour *colour) {
    aset_status status = give(context, "b", 0);
    give_colour(context, colour);
    return status;
}

static aset_status on_view(void *context, const aset_view *view) {
    aset_status status = give(context, "v", 0);
    assert_true(view->height == 0);
    give_vec3(context, &view->from);
    give_vec3(context, &view->at);
    give_vec3(context, &view->up);
    give_number(context, view->angle_deg);
    give_number(context, (aset_real)view->width_px);
    give_number(context, (aset_real)view->height_px);
    return status;
}

static aset_status on_light(void *context, const aset_light *light) {
    aset_status status = give(context, "l", 0);
    assert_false(light->has_colour);
    assert_false(light->directional);
    give_vec3(context, &light->position);
    return status;
}

static aset_status on_material(void *context, const aset_material *material) {
    aset_status status = give(context, "f", 0);
    assert_false(material->one_sided);
    give_colour(context, &material->fill);
    give_number(context, material->diffuse);
    give_number(context, material->specular);
    give_number(context, material->shine);
#if ASET_WITH_REFRACTION
    give_number(context, material->transmittance);
    give_number(context, material->refraction_index);
#endif
    return status;
}

#if ASET_WITH_POLYGONS
static aset_status on_polygon_begin(void *context, uint32_t n_points, bool with_normals) {
    return give(context, with_normals ? "pp" : "p", n_points);
}

static aset_status on_polygon_point(void *context, const aset_vec3 *point, const aset_vec3 *normal) {
    give_vec3(context, point);
    if (normal != NULL) {
        give_vec3(context, normal);
    }
    return ASET_OK;
}

static aset_status on_polygon_end(void *context) {
    (void)context;
    return ASET_OK;
}
#endif

#if ASET_WITH_SPHERES
static aset_status on_sphere(void *context, const aset_vec3 *centre, aset_real radius) {
    aset_status status = give(context, "s", 0);
    give_vec3(context, centre);
    give_number(context, radius);
    return status;
}
#endif

#if ASET_WITH_CONES
static aset_status on_cone(void *context, const aset_vec3 *base, aset_real base_radius, const aset_vec3 *apex,
                           aset_real apex_radius) {
    aset_status status = give(context, "c", 0);
    give_vec3(context, base);
    give_number(context, base_radius);
    give_vec3(context, apex);
    give_number(context, apex_radius);
    return status;
}
#endif

static aset_sink sink_to(taker *to) {
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
    return sink;
}

static aset_status emit(taker *to, const char *name, uint32_t size) {
    const aset_procedural *scene = aset_procedural_find(name);
    aset_sink sink = sink_to(to);
    assert_non_null(scene);
    return scene->emit(&sink, size);
}

/* --- The first taker counts, sums, and stops when told to. --- */

typedef struct tally {
    taker taker;
    uint32_t n_words, stop_at;                 /* stop_at: the word that is refused, counted from 1; 0: none */
    uint32_t f, s, c, p3, p4, p144, pp3, rest; /* rest: b, v and l */
    bool in_object;
    uint64_t n, n_settings; /* numbers of objects so far, and of everything else */
    double q, w, w_settings;
} tally;

static aset_status tally_word(taker *self, const char *word, uint32_t n_points) {
    tally *sums = (tally *)self;
    sums->n_words++;
    sums->in_object = strchr("scp", word[0]) != NULL;
    if (sums->stop_at > 0) {
        assert_true(sums->n_words <= sums->stop_at); /* nothing comes after a refusal */
    }
    sums->f += word[0] == 'f';
    sums->s += word[0] == 's';
    sums->c += word[0] == 'c';
    sums->rest += strchr("bvl", word[0]) != NULL;
    sums->p3 += strcmp(word, "p") == 0 && n_points == 3;
    sums->p4 += strcmp(word, "p") == 0 && n_points == 4;
    sums->p144 += strcmp(word, "p") == 0 && n_points == 144;
    sums->pp3 += strcmp(word, "pp") == 0 && n_points == 3;
    return sums->n_words == sums->stop_at ? ASET_ERR_STOPPED : ASET_OK;
}

/* The sums are those of numbers printed with six digits, so the numbers are rounded likewise first. */
static void tally_number(taker *self, double number) {
    tally *sums = (tally *)self;
    char text[32];
    double rounded;
    snprintf(text, sizeof text, "%.6g", number);
    rounded = strtod(text, NULL);
    if (sums->in_object) {
        sums->q += rounded * rounded;
        sums->w += (double)(sums->n % 97 + 1) * rounded;
        sums->n++;
    } else {
        sums->w_settings += (double)(sums->n_settings % 97 + 1) * rounded;
        sums->n_settings++;
    }
}

static tally tally_init(uint32_t stop_at) {
    tally sums;
    memset(&sums, 0, sizeof sums);
    sums.taker.word = tally_word;
    sums.taker.number = tally_number;
    sums.stop_at = stop_at;
    return sums;
}

/* --- The second compares with a file in NFF. --- */

typedef struct comparison {
    taker taker;
    FILE *file;
    const char *path;
    bool after_material;
} comparison;

static void read_token(comparison *to, char token[32]) {
    if (fscanf(to->file, "%31s", token) != 1) {
        fail_msg("%s ends too early", to->path);
    }
}

static void compare_word(comparison *to, const char *emitted) {
    char token[32];
    read_token(to, token);
    if (strcmp(token, emitted) != 0) {
        fail_msg("%s before byte %ld: %s, emitted %s", to->path, ftell(to->file), token, emitted);
    }
}

static aset_status comparison_word(taker *self, const char *word, uint32_t n_points) {
    comparison *to = (comparison *)self;
    char token[32];
    if (!ASET_WITH_REFRACTION && to->after_material) {
        read_token(to, token); /* T */
        read_token(to, token); /* and the refraction index, which then are in no entity */
    }
    to->after_material = word[0] == 'f';
    compare_word(to, word);
    if (n_points > 0) {
        snprintf(token, sizeof token, "%lu", (unsigned long)n_points);
        compare_word(to, token);
    }
    return ASET_OK;
}

/* The next number, past the labels of the view's lines and past hither, which is in no entity. */
static void read_number(comparison *to, char token[32]) {
    static const char *const labels[] = {"from", "at", "up", "angle", "resolution"};
    read_token(to, token);
    if (strcmp(token, "hither") == 0) {
        read_token(to, token);
        read_token(to, token);
    }
    for (size_t i = 0; i < sizeof labels / sizeof labels[0]; i++) {
        if (strcmp(token, labels[i]) == 0) {
            read_token(to, token);
            return;
        }
    }
}

/* Relative: 20 times the rounding to six digits. Absolute: the noise in place of 0, and float's part of it. */
#define TOLERANCE 1e-4
#define TOLERANCE_AT_0 1e-7

static void comparison_number(taker *self, double number) {
    comparison *to = (comparison *)self;
    char token[32], *end;
    double expected;
    read_number(to, token);
    expected = strtod(token, &end);
    if (end == token || *end != '\0' || !(fabs(number - expected) <= TOLERANCE * fabs(expected) + TOLERANCE_AT_0)) {
        fail_msg("%s before byte %ld: %s, emitted %.9g", to->path, ftell(to->file), token, number);
    }
}

/* --- The tests. --- */

static void test_procedural__table(void **state) {
    static const char *const names[] = {"balls", "gears", "mount", "rings",      "teapot",
                                        "tetra", "tree",  "snow",  "tetra-moon", "skull"};
    const size_t n = sizeof names / sizeof names[0];
    (void)state;
    for (size_t i = 0; i < n; i++) {
        const aset_procedural *scene = aset_procedural_at(i);
        assert_non_null(scene);
        assert_string_equal(scene->name, names[i]);
        assert_ptr_equal(aset_procedural_find(names[i]), scene);
        assert_true(strlen(scene->text) > 0);
        assert_non_null(scene->emit);
        assert_in_range(scene->default_size, 1, scene->largest_size);
    }
    assert_null(aset_procedural_at(n));
    assert_null(aset_procedural_at(SIZE_MAX));
    assert_null(aset_procedural_find("ball"));
    assert_null(aset_procedural_find(""));
    assert_null(aset_procedural_find(NULL));
}

static void test_procedural__counts(void **state) {
    static const struct {
        const char *name;
        uint32_t size, f, s, c, p3, p4, p144, pp3, rest;
    } rows[] = {
        {"balls", 1, 2, 10, 0, 0, 1, 0, 0, 5},       {"balls", 2, 2, 91, 0, 0, 1, 0, 0, 5},
        {"balls", 3, 2, 820, 0, 0, 1, 0, 0, 5},      {"balls", 4, 2, 7381, 0, 0, 1, 0, 0, 5},
        {"balls", 0, 2, 7381, 0, 0, 1, 0, 0, 5},     {"balls", 5, 2, 66430, 0, 0, 1, 0, 0, 5},
        {"gears", 1, 2, 0, 0, 0, 145, 2, 0, 7},      {"gears", 2, 9, 0, 0, 0, 1153, 16, 0, 7},
        {"gears", 3, 28, 0, 0, 0, 3889, 54, 0, 7},   {"gears", 4, 65, 0, 0, 0, 9217, 128, 0, 7},
        {"gears", 0, 65, 0, 0, 0, 9217, 128, 0, 7},  {"gears", 5, 126, 0, 0, 0, 18001, 250, 0, 7},
        {"mount", 1, 2, 4, 0, 8, 0, 0, 0, 3},        {"mount", 2, 2, 4, 0, 32, 0, 0, 0, 3},
        {"mount", 4, 2, 4, 0, 512, 0, 0, 0, 3},      {"mount", 6, 2, 4, 0, 8192, 0, 0, 0, 3},
        {"mount", 0, 2, 4, 0, 8192, 0, 0, 0, 3},     {"mount", 8, 2, 4, 0, 131072, 0, 0, 0, 3},
        {"rings", 1, 7, 30, 30, 0, 1, 0, 0, 5},      {"rings", 2, 31, 150, 150, 0, 1, 0, 0, 5},
        {"rings", 3, 85, 420, 420, 0, 1, 0, 0, 5},   {"rings", 5, 331, 1650, 1650, 0, 1, 0, 0, 5},
        {"rings", 7, 841, 4200, 4200, 0, 1, 0, 0, 5}, {"rings", 0, 841, 4200, 4200, 0, 1, 0, 0, 5},
        {"teapot", 1, 3, 0, 0, 0, 1, 0, 56, 4},      {"teapot", 2, 3, 0, 0, 0, 4, 0, 240, 4},
        {"teapot", 3, 3, 0, 0, 0, 9, 0, 552, 4},     {"teapot", 6, 3, 0, 0, 0, 36, 0, 2256, 4},
        {"teapot", 0, 3, 0, 0, 0, 36, 0, 2256, 4},   {"teapot", 8, 3, 0, 0, 0, 64, 0, 4032, 4},
        {"teapot", 12, 3, 0, 0, 0, 144, 0, 9120, 4}, {"tetra", 1, 1, 0, 0, 4, 0, 0, 0, 3},
        {"tetra", 2, 1, 0, 0, 16, 0, 0, 0, 3},       {"tetra", 4, 1, 0, 0, 256, 0, 0, 0, 3},
        {"tetra", 6, 1, 0, 0, 4096, 0, 0, 0, 3},     {"tetra", 0, 1, 0, 0, 4096, 0, 0, 0, 3},
        {"tetra", 8, 1, 0, 0, 65536, 0, 0, 0, 3},    {"tree", 1, 2, 3, 3, 0, 1, 0, 0, 9},
        {"tree", 2, 2, 7, 7, 0, 1, 0, 0, 9},         {"tree", 5, 2, 63, 63, 0, 1, 0, 0, 9},
        {"tree", 8, 2, 511, 511, 0, 1, 0, 0, 9},     {"tree", 11, 2, 4095, 4095, 0, 1, 0, 0, 9},
        {"tree", 0, 2, 4095, 4095, 0, 1, 0, 0, 9},
    };
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        tally sums = tally_init(0);
        if (!available(rows[i].name)) {
            continue;
        }
        assert_int_equal(emit(&sums.taker, rows[i].name, rows[i].size), ASET_OK);
        assert_int_equal(sums.f, rows[i].f);
        assert_int_equal(sums.s, rows[i].s);
        assert_int_equal(sums.c, rows[i].c);
        assert_int_equal(sums.p3, rows[i].p3);
        assert_int_equal(sums.p4, rows[i].p4);
        assert_int_equal(sums.p144, rows[i].p144);
        assert_int_equal(sums.pp3, rows[i].pp3);
        assert_int_equal(sums.rest, rows[i].rest);
        assert_int_equal(sums.n_words, sums.f + sums.s + sums.c + sums.p3 + sums.p4 + sums.p144 + sums.pp3 + sums.rest);
    }
}

/*
 * The sums of the original programs' output: Q = sum of v^2, W = sum of (i mod 97 + 1) v_i over the numbers v_i of all
 * objects, each as printed with six digits. Rounded likewise, a correct scene differs where a number lies on the border of
 * two roundings (noise of the arithmetic, or float: one unit of the sixth digit) and where noise stands for 0: at random,
 * and so few that Q stays within 1e-6 of itself and W within 1e-5 n + 0.01. Observed: at most 2.3e-7 of Q and 16 % of
 * W's tolerance, in float and in double.
 */
static void test_procedural__check_sums(void **state) {
    static const struct {
        const char *name;
        uint32_t size;
        uint64_t n;
        double q, w;
    } rows[] = {
        {"balls", 2, 376, 1204.2820, 1222.014},
        {"balls", 4, 29536, 5571.5326, 74993.936},
        {"gears", 1, 2604, 1591.5308, 40024.858},
        {"gears", 4, 165900, 59798.1837, 1557420.368},
        {"mount", 3, 1168, 329.6260, 4197.123},
        {"mount", 6, 73744, 19401.1490, 238791.180},
        {"mount", 8, 1179664, 288516.0495, -1701037.602},
        {"rings", 2, 1812, 11963.8017, 104516.156},
        {"rings", 7, 50412, 3159355.0279, 9078929.596},
        {"teapot", 2, 4368, 6166.5708, 67511.737},
        {"teapot", 6, 41040, 56778.2308, 613372.479},
        {"teapot", 12, 165888, 228659.5372, 2474029.371},
        {"tetra", 2, 144, 72.0000, -148.000},
        {"tetra", 6, 36864, 12312.0000, 1202.250},
        {"tree", 3, 192, 20170.9140, 4676.954},
        {"tree", 11, 49152, 107405.2512, 1713302.549},
    };
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        tally sums = tally_init(0);
        if (!available(rows[i].name)) {
            continue;
        }
        assert_int_equal(emit(&sums.taker, rows[i].name, rows[i].size), ASET_OK);
        assert_int_equal(sums.n, rows[i].n);
        if (!(fabs(sums.q - rows[i].q) <= 1e-6 * rows[i].q)) {
            fail_msg("%s %u: Q is %.4f, expected %.4f", rows[i].name, (unsigned)rows[i].size, sums.q, rows[i].q);
        }
        if (!(fabs(sums.w - rows[i].w) <= 1e-5 * (double)rows[i].n + 0.01)) {
            fail_msg("%s %u: W is %.3f, expected %.3f", rows[i].name, (unsigned)rows[i].size, sums.w, rows[i].w);
        }
    }
}

/* W likewise of what is no object: background, view (without hither), lights and materials, at the default size. */
static void test_procedural__check_sums_of_settings(void **state) {
#if ASET_WITH_REFRACTION
    static const struct {
        const char *name;
        uint64_t n;
        double w;
    } rows[] = {
        {"balls", 40, 3016113.71160},   {"gears", 550, 313326459.56271}, {"mount", 34, 3216579.66100},
        {"rings", 6752, 3231652.19331}, {"teapot", 45, 17080.77318},     {"tetra", 26, 2415090.95642},
        {"tree", 52, 9220470.90900},
    };
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        tally sums = tally_init(0);
        if (!available(rows[i].name)) {
            continue;
        }
        assert_int_equal(emit(&sums.taker, rows[i].name, 0), ASET_OK);
        assert_int_equal(sums.n_settings, rows[i].n);
        if (!(fabs(sums.w_settings - rows[i].w) <= 1e-5 * (double)rows[i].n + 0.01)) {
            fail_msg("%s: W is %.5f, expected %.5f", rows[i].name, sums.w_settings, rows[i].w);
        }
    }
#else
    (void)state;
    skip(); /* materials have two numbers less */
#endif
}

/* Every entity and number of the original programs' files, in order. */
static void test_procedural__same_as_original_files(void **state) {
    static const struct {
        const char *path, *name;
        uint32_t size;
    } files[] = {
        {"../shared/scenes/balls.nff", "balls", 4},    {"../shared/scenes/balls-2.nff", "balls", 2},
        {"../shared/scenes/gears.nff", "gears", 4},    {"../shared/scenes/gears-2.nff", "gears", 2},
        {"../shared/scenes/mount.nff", "mount", 6},    {"../shared/scenes/mount-4.nff", "mount", 4},
        {"../shared/scenes/rings.nff", "rings", 7},    {"../shared/scenes/rings-3.nff", "rings", 3},
        {"../shared/scenes/teapot.nff", "teapot", 6},  {"../shared/scenes/teapot-3.nff", "teapot", 3},
        {"../shared/scenes/tetra.nff", "tetra", 6},    {"../shared/scenes/tetra-5.nff", "tetra", 5},
        {"../shared/scenes/tree.nff", "tree", 11},     {"../shared/scenes/tree-7.nff", "tree", 7},
    };
    (void)state;
    for (size_t i = 0; i < sizeof files / sizeof files[0]; i++) {
        comparison with = {{comparison_word, comparison_number}, NULL, files[i].path, false};
        char token[32];
        with.file = fopen(with.path, "r");
        if (with.file == NULL && i == 0) {
            skip(); /* the files are not part of the library */
        }
        assert_non_null(with.file);
        if (available(files[i].name)) {
            assert_int_equal(emit(&with.taker, files[i].name, files[i].size), ASET_OK);
            assert_int_equal(fscanf(with.file, "%31s", token), EOF);
        }
        fclose(with.file);
    }
}

static void test_procedural__sizes_out_of_range(void **state) {
    (void)state;
    for (size_t i = 0; i < n_spd_scenes; i++) {
        const aset_procedural *scene = aset_procedural_find(spd_scenes[i].name);
        aset_status refusal = spd_scenes[i].available ? ASET_ERR_ARGUMENT : ASET_ERR_UNSUPPORTED;
        tally sums = tally_init(1);
        assert_int_equal(emit(&sums.taker, scene->name, scene->largest_size + 1), refusal);
        assert_int_equal(emit(&sums.taker, scene->name, UINT32_MAX), refusal);
        assert_int_equal(sums.n_words, 0);
        /* the largest itself begins */
        assert_int_equal(emit(&sums.taker, scene->name, scene->largest_size),
                         spd_scenes[i].available ? ASET_ERR_STOPPED : ASET_ERR_UNSUPPORTED);
    }
}

/* What is switched off is refused before anything is emitted. */
static void test_procedural__unsupported(void **state) {
    (void)state;
    for (size_t i = 0; i < n_spd_scenes; i++) {
        tally sums = tally_init(0);
        if (!spd_scenes[i].available) {
            assert_int_equal(emit(&sums.taker, spd_scenes[i].name, 1), ASET_ERR_UNSUPPORTED);
            assert_int_equal(sums.n_words, 0);
        }
    }
}

/* Wherever the sink refuses, the scene ends at once and returns that error. */
static void test_procedural__sink_errors(void **state) {
    (void)state;
    for (size_t i = 0; i < n_spd_scenes; i++) {
        tally whole = tally_init(0);
        if (!spd_scenes[i].available) {
            continue;
        }
        assert_int_equal(emit(&whole.taker, spd_scenes[i].name, 2), ASET_OK);
        for (uint32_t stop_at = 1; stop_at <= whole.n_words; stop_at++) {
            tally sums = tally_init(stop_at);
            assert_int_equal(emit(&sums.taker, spd_scenes[i].name, 2), ASET_ERR_STOPPED);
            assert_int_equal(sums.n_words, stop_at);
        }
    }
}

static void test_procedural__no_sink(void **state) {
    aset_sink empty;
    memset(&empty, 0, sizeof empty);
    (void)state;
    for (size_t i = 0; i < n_spd_scenes; i++) {
        const aset_procedural *scene = aset_procedural_find(spd_scenes[i].name);
        aset_status refusal = spd_scenes[i].available ? ASET_ERR_ARGUMENT : ASET_ERR_UNSUPPORTED;
        assert_int_equal(scene->emit(NULL, 1), refusal);
        assert_int_equal(scene->emit(&empty, 1), refusal);
    }
}

/* --- the scenes' own sine and logarithm against libm's --- */

static void test_procedural__elementary_functions(void **state) {
    (void)state;
    const double bound = ldexp(1.0, -50); /* 2^-51 of ours, and the same for libm's */
    for (int i = -40000; i <= 40000; i++) {
        double rad = i / 1000.0 + i / 7.0e7;
        assert_true(fabs(aset_emit_sine(rad) - sin(rad)) <= bound);
        assert_true(fabs(aset_emit_cosine(rad) - cos(rad)) <= bound);
        assert_true(fabs(aset_emit_tangent(rad) - tan(rad)) <= bound * (1.0 + tan(rad) * tan(rad)));
    }
    for (int i = -30000; i <= 30000; i++) {
        double x = exp(i / 50.0);
        assert_true(fabs(aset_emit_logarithm(x) - log(x)) <= bound * fmax(1.0, fabs(log(x))));
    }
    assert_true(aset_emit_logarithm(1.0) == 0.0 && aset_emit_sine(0.0) == 0.0 && aset_emit_cosine(0.0) == 1.0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_procedural__table),
        cmocka_unit_test(test_procedural__counts),
        cmocka_unit_test(test_procedural__check_sums),
        cmocka_unit_test(test_procedural__check_sums_of_settings),
        cmocka_unit_test(test_procedural__same_as_original_files),
        cmocka_unit_test(test_procedural__sizes_out_of_range),
        cmocka_unit_test(test_procedural__unsupported),
        cmocka_unit_test(test_procedural__sink_errors),
        cmocka_unit_test(test_procedural__no_sink),
        cmocka_unit_test(test_procedural__elementary_functions),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
