/* support.c - random numbers, models, guarded blocks, stages, inputs. */
#include "support/support.h"

#include "aset/procedural.h"
#include "space/cells.h"
#include "space/slices.h"

#define PI 3.14159265358979323846

bool long_run(void) {
    const char *text = getenv("ASET_LONG");
    return text != NULL && text[0] != 0 && strcmp(text, "0") != 0;
}

/* --- random numbers --- */

uint64_t seed_of(uint64_t number) {
    const char *text = getenv("ASET_TEST_SEED");
    return number + (text != NULL ? strtoull(text, NULL, 10) * UINT64_C(1000003) : 0);
}

random_state random_start(uint64_t seed) {
    random_state r = {seed, seed * UINT64_C(0x9e3779b97f4a7c15) + 1};
    return r;
}

uint64_t random_next(random_state *r) {
    r->state += UINT64_C(0x9e3779b97f4a7c15);
    uint64_t x = r->state;
    x = (x ^ (x >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    x = (x ^ (x >> 27)) * UINT64_C(0x94d049bb133111eb);
    return x ^ (x >> 31);
}

uint32_t random_below(random_state *r, uint32_t n) {
    return (uint32_t)((random_next(r) >> 32) * n >> 32);
}

double random_between(random_state *r, double low, double high) {
    return low + (high - low) * (double)(random_next(r) >> 11) * (1.0 / 9007199254740992.0);
}

bool random_chance(random_state *r, double share) {
    return random_between(r, 0, 1) < share;
}

aset_vec3 random_in_cube(random_state *r, double half_edge) {
    double x = random_between(r, -half_edge, half_edge), y = random_between(r, -half_edge, half_edge);
    return dvec_real(dvec_make(x, y, random_between(r, -half_edge, half_edge)));
}

static dvec random_unit(random_state *r) {
    double z = random_between(r, -1, 1), angle = random_between(r, 0, 2 * PI), across = sqrt(1 - z * z);
    return dvec_make(across * cos(angle), across * sin(angle), z);
}

aset_vec3 random_direction(random_state *r) {
    return dvec_real(random_unit(r));
}

aset_ray random_ray_from(random_state *r, double half_edge) {
    aset_ray ray;
    ray.origin = random_in_cube(r, half_edge);
    ray.direction = random_direction(r);
    ray.t_max = REAL_INFINITY;
    return ray;
}

/* --- double precision --- */

dvec dvec_make(double x, double y, double z) {
    dvec v = {x, y, z};
    return v;
}

dvec dvec_of(aset_vec3 v) {
    return dvec_make((double)v.x, (double)v.y, (double)v.z);
}

aset_vec3 dvec_real(dvec v) {
    aset_vec3 real = {(aset_real)v.x, (aset_real)v.y, (aset_real)v.z};
    return real;
}

dvec dvec_sub(dvec a, dvec b) {
    return dvec_make(a.x - b.x, a.y - b.y, a.z - b.z);
}

dvec dvec_along(dvec a, double s, dvec b) {
    return dvec_make(a.x + s * b.x, a.y + s * b.y, a.z + s * b.z);
}

double dvec_dot(dvec a, dvec b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

dvec dvec_cross(dvec a, dvec b) {
    return dvec_make(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}

double dvec_length(dvec a) {
    return sqrt(dvec_dot(a, a));
}

dvec dvec_unit(dvec a) {
    double length = dvec_length(a);
    return dvec_make(a.x / length, a.y / length, a.z / length);
}

/* --- models --- */

bool thing_available(unsigned kind) {
    static const bool available[THING_KINDS] = {ASET_WITH_POLYGONS, ASET_WITH_PATCHES, ASET_WITH_SPHERES, ASET_WITH_CONES};
    return available[kind];
}

aset_material plain_material(void) {
    aset_material m;
    memset(&m, 0, sizeof m);
    m.fill.r = m.fill.g = m.fill.b = 1;
    m.diffuse = R(0.5);
    return m;
}

void model_start(model *m) {
    aset_material plain = plain_material();
    memset(m, 0, sizeof *m);
    model_material(m, &plain);
}

void model_free(model *m) {
    free(m->things);
    m->things = NULL;
}

uint32_t model_material(model *m, const aset_material *material) {
    assert_true(m->n_materials < MODEL_MATERIALS_MAX);
    m->materials[m->n_materials] = *material;
    return m->n_materials++;
}

void model_light(model *m, aset_vec3 position) {
    assert_true(m->n_lights < MODEL_LIGHTS_MAX);
    memset(m->lights + m->n_lights, 0, sizeof m->lights[0]);
    m->lights[m->n_lights++].position = position;
}

static thing *model_thing(model *m, unsigned kind) {
    if (m->n_things == m->capacity) {
        m->capacity = m->capacity > 0 ? 2 * m->capacity : 64;
        m->things = realloc(m->things, m->capacity * sizeof *m->things);
        assert_non_null(m->things);
    }
    thing *t = m->things + m->n_things++;
    memset(t, 0, sizeof *t);
    t->kind = kind;
    t->material = m->n_materials - 1;
    return t;
}

thing *model_sphere(model *m, aset_vec3 centre, double radius) {
    thing *t = model_thing(m, THING_SPHERE);
    t->points[0] = centre;
    t->radii[0] = (aset_real)radius;
    return t;
}

thing *model_cone(model *m, aset_vec3 base, double base_radius, aset_vec3 apex, double apex_radius) {
    thing *t = model_thing(m, THING_CONE);
    t->points[0] = base;
    t->points[1] = apex;
    t->radii[0] = (aset_real)base_radius;
    t->radii[1] = (aset_real)apex_radius;
    return t;
}

thing *model_polygon(model *m, const aset_vec3 *points, const aset_vec3 *normals, uint32_t n_points) {
    assert_true(n_points <= THING_POINTS_MAX);
    thing *t = model_thing(m, normals != NULL ? THING_PATCH : THING_POLYGON);
    t->n_points = n_points;
    memcpy(t->points, points, n_points * sizeof *points);
    if (normals != NULL) {
        memcpy(t->normals, normals, n_points * sizeof *normals);
    }
    return t;
}

thing *model_rectangle(model *m, aset_vec3 corner, aset_vec3 u, aset_vec3 v) {
    dvec c = dvec_of(corner), a = dvec_along(c, 1, dvec_of(u)), b = dvec_along(c, 1, dvec_of(v));
    const aset_vec3 points[4] = {corner, dvec_real(a), dvec_real(dvec_along(a, 1, dvec_of(v))), dvec_real(b)};
    return model_polygon(m, points, NULL, 4);
}

/* Two unit vectors across n and across each other. */
static void frame_of(dvec n, dvec *u, dvec *v) {
    dvec other = fabs(n.x) < 0.6 ? dvec_make(1, 0, 0) : dvec_make(0, 1, 0);
    *u = dvec_unit(dvec_cross(n, other));
    *v = dvec_cross(n, *u);
}

/* A polygon that a star of corners at growing angles makes: simple, and concave more often than not. */
static thing *random_polygon(model *m, random_state *r, dvec middle, double size, bool with_normals) {
    aset_vec3 points[THING_POINTS_MAX], normals[THING_POINTS_MAX];
    dvec n = random_unit(r), u, v;
    uint32_t n_points = random_chance(r, 0.4) ? 3 : 3 + random_below(r, THING_POINTS_MAX - 2);
    frame_of(n, &u, &v);
    for (uint32_t i = 0; i < n_points; i++) {
        double angle = 2 * PI * (i + random_between(r, 0, 0.7)) / n_points;
        double radius = 0.5 * size * (n_points == 3 ? 1 : random_between(r, 0.25, 1));
        dvec point = dvec_along(dvec_along(middle, radius * cos(angle), u), radius * sin(angle), v);
        points[i] = dvec_real(point);
        double lean = random_between(r, 0, 0.8);
        normals[i] = dvec_real(dvec_along(n, lean, random_unit(r)));
    }
    return model_polygon(m, points, with_normals ? normals : NULL, n_points);
}

static thing *random_cone(model *m, random_state *r, dvec middle, double size) {
    dvec axis = random_unit(r);
    double a = random_between(r, 0.05, 0.4) * size, b = random_between(r, 0.05, 0.4) * size;
    if (random_chance(r, 0.3)) {
        b = random_chance(r, 0.5) ? 0 : a; /* a pointed cone, a cylinder */
    }
    double sign = random_chance(r, 0.2) ? -1 : 1;
    return model_cone(m, dvec_real(dvec_along(middle, -size / 2, axis)), sign * a,
                      dvec_real(dvec_along(middle, size / 2, axis)), sign * b);
}

thing *model_random_thing(model *m, random_state *r, double half_edge, double size) {
    unsigned kind = random_below(r, THING_KINDS);
    while (!thing_available(kind)) {
        kind = random_below(r, THING_KINDS);
    }
    dvec middle = dvec_of(random_in_cube(r, half_edge));
    switch (kind) {
    case THING_SPHERE: return model_sphere(m, dvec_real(middle), (random_chance(r, 0.2) ? -0.5 : 0.5) * size);
    case THING_CONE: return random_cone(m, r, middle, size);
    default: return random_polygon(m, r, middle, size, kind == THING_PATCH);
    }
}

static aset_real random_part(random_state *r, double high) {
    return (aset_real)random_between(r, 0, high);
}

static aset_material random_material(random_state *r) {
    aset_material m = plain_material();
    m.fill.r = random_part(r, 1);
    m.fill.g = random_part(r, 1);
    m.fill.b = random_part(r, 1);
    m.diffuse = random_part(r, 1);
    m.specular = random_chance(r, 0.5) ? random_part(r, 0.7) : 0;
    m.shine = random_part(r, 60);
#if ASET_WITH_REFRACTION
    m.transmittance = random_chance(r, 0.3) ? random_part(r, 0.9) : 0;
    m.refraction_index = m.transmittance > 0 ? R(1.4) : 0;
#endif
    m.one_sided = random_chance(r, 0.3);
    return m;
}

void model_random(model *m, random_state *r, uint32_t n_things, double half_edge, double smallest, double largest) {
    model_start(m);
    while (m->n_materials < 6) {
        aset_material material = random_material(r);
        model_material(m, &material);
    }
    for (uint32_t i = 0; i < n_things; i++) {
        double size = smallest * pow(largest / smallest, random_between(r, 0, 1));
        thing *t = model_random_thing(m, r, half_edge, size);
        t->material = random_below(r, m->n_materials);
    }
    model_light(m, random_in_cube(r, 3 * half_edge));
    model_light(m, random_in_cube(r, 3 * half_edge));
    m->background.b = R(0.5);
}

static aset_status thing_emit(const aset_sink *sink, const thing *t) {
    switch (t->kind) {
#if ASET_WITH_POLYGONS
    case THING_POLYGON: return aset_sink_polygon(sink, t->points, NULL, t->n_points);
    case THING_PATCH: return aset_sink_polygon(sink, t->points, t->normals, t->n_points);
#endif
#if ASET_WITH_SPHERES
    case THING_SPHERE: return sink->sphere(sink->context, t->points, t->radii[0]);
#endif
#if ASET_WITH_CONES
    case THING_CONE: return sink->cone(sink->context, t->points, t->radii[0], t->points + 1, t->radii[1]);
#endif
    default: return ASET_ERR_UNSUPPORTED;
    }
}

aset_status model_emit(const aset_sink *sink, const void *context) {
    const model *m = context;
    aset_status status = sink->background(sink->context, &m->background);
    for (uint32_t i = 0; i < m->n_lights && status == ASET_OK; i++) {
        status = sink->light(sink->context, m->lights + i);
    }
    for (uint32_t i = 0; i < m->n_things && status == ASET_OK; i++) {
        const thing *t = m->things + (m->backwards ? m->n_things - 1 - i : i);
        status = sink->material(sink->context, m->materials + t->material);
        if (status == ASET_OK) {
            status = thing_emit(sink, t);
        }
    }
    return status;
}

/* --- guarded blocks --- */

static unsigned char guard_byte(size_t i) {
    return (unsigned char)(0xa5 ^ (i * 37));
}

guarded guarded_open(size_t size) {
    guarded g;
    g.size = size;
    g.whole = malloc(size + 2 * GUARD_BYTES);
    assert_non_null(g.whole);
    g.block = g.whole + GUARD_BYTES;
    memset(g.block, 0xcd, size); /* nobody may count on zeros */
    for (size_t i = 0; i < GUARD_BYTES; i++) {
        g.whole[i] = g.whole[GUARD_BYTES + size + i] = guard_byte(i);
    }
    return g;
}

bool guarded_intact(const guarded *g) {
    for (size_t i = 0; i < GUARD_BYTES; i++) {
        if (g->whole[i] != guard_byte(i) || g->whole[GUARD_BYTES + g->size + i] != guard_byte(i)) {
            return false;
        }
    }
    return true;
}

void guarded_close(guarded *g) {
    bool intact = guarded_intact(g);
    free(g->whole);
    g->whole = NULL;
    assert_true(intact);
}

/* --- stages --- */

void stage_open(stage *s, stage_source source, const void *context, size_t room) {
    memset(s, 0, sizeof *s);
    aset_sink sink = aset_counter_sink(&s->counter);
    assert_int_equal(source(&sink, context), ASET_OK);
    const aset_counts *c = &s->counter.counts;
    s->memory = guarded_open(ASET_BYTES_SCENE(c->objects, c->coordinates, c->materials, c->lights) + room);
    assert_int_equal(aset_arena_init(&s->arena, s->memory.block, s->memory.size), ASET_OK);
    assert_int_equal(aset_scene_init(&s->scene, &s->arena, c), ASET_OK);
    sink = aset_scene_sink(&s->scene);
    assert_int_equal(source(&sink, context), ASET_OK);
}

void stage_open_model(stage *s, const model *m, size_t room) {
    stage_open(s, model_emit, m, room);
}

typedef struct procedural_choice {
    const aset_procedural *procedural;
    uint32_t size;
} procedural_choice;

static aset_status procedural_source(const aset_sink *sink, const void *context) {
    const procedural_choice *choice = context;
    return choice->procedural->emit(sink, choice->size);
}

bool stage_open_procedural(stage *s, const char *name, uint32_t size, size_t room) {
    procedural_choice choice = {aset_procedural_find(name), size};
    aset_counter counter;
    aset_sink sink = aset_counter_sink(&counter);
    assert_non_null(choice.procedural);
    if (procedural_source(&sink, &choice) == ASET_ERR_UNSUPPORTED) {
        return false;
    }
    stage_open(s, procedural_source, &choice, room);
    return true;
}

void stage_space(stage *s, aset_space *space, const aset_method *method, uint32_t nx, uint32_t ny, uint32_t nz) {
    aset_space_options options;
    memset(&options, 0, sizeof options);
    options.divisions[0] = nx;
    options.divisions[1] = ny;
    options.divisions[2] = nz;
    assert_int_equal(aset_space_build(space, &s->scene, method, &options, &s->arena), ASET_OK);
}

void stage_close(stage *s) {
    guarded_close(&s->memory);
}

aset_tracer stage_tracer(const stage *s, const aset_space *space) {
    aset_tracer tracer;
    memset(&tracer, 0, sizeof tracer);
    tracer.scene = &s->scene;
    tracer.space = space;
    return tracer;
}

aset_real object_hit(const aset_scene *scene, uint32_t object, aset_vec3 origin, aset_vec3 direction) {
    probe ray = aset_probe_make(origin, direction);
    return aset_object_nearest(scene, object, &ray, REAL_INFINITY);
}

/* --- marking --- */

void expected_box(const aset_space *space, uint32_t object, int32_t low[3], int32_t high[3]) {
    aset_vec3 lower, upper;
    aset_object_bounds(space->scene, object, &lower, &upper);
    const aset_real margin = 2 * space->scene->margin; /* the rule of spaces, see aset_object_margin */
    const aset_real from[3] = {lower.x - margin, lower.y - margin, lower.z - margin};
    const aset_real to[3] = {upper.x + margin, upper.y + margin, upper.z + margin};
    for (int a = 0; a < 3; a++) {
        low[a] = 0;
        high[a] = (int32_t)space->slices.n[a] - 1;
        while (slices_plane(&space->slices, a, low[a] + 1) <= from[a]) {
            low[a]++;
        }
        while (slices_plane(&space->slices, a, high[a]) > to[a]) {
            high[a]--;
        }
    }
}

bool expected_marked(const int32_t low[3], const int32_t high[3], const int32_t voxel[3], uint32_t face) {
    for (int a = 0; a < 3; a++) {
        if (voxel[a] < low[a] || voxel[a] > high[a]) {
            return false;
        }
    }
    uint32_t axis = face / 2;
    return voxel[axis] == (face % 2 == 0 ? low[axis] : high[axis]);
}

uint32_t cell_number(const aset_space *space, const int32_t voxel[3], uint32_t face) {
    const aset_cells *cells = &space->cells;
    uint32_t rank = cells_rank(cells, cells_block(cells, voxel, face));
    unsigned place = cells_place(voxel);
    if (rank == NO_CELL || (cells->marks[rank] >> place & 1) == 0) {
        return UINT32_MAX;
    }
    return cells->first[rank] + bits_count(cells->marks[rank] & ((UINT64_C(1) << place) - 1));
}

/* --- inputs for readers --- */

const size_t chunks[4] = {1, 2, 7, SIZE_MAX};

byte_source source_of(const char *bytes, size_t size, size_t chunk) {
    const byte_source from = {bytes, size, 0, chunk, SIZE_MAX, false};
    return from;
}

ptrdiff_t give(void *context, void *buffer, size_t size) {
    byte_source *from = context;
    assert_true(size > 0);
    assert_false(from->ended);
    if (from->at >= from->fail_at) {
        return -1;
    }
    size_t n = from->size - from->at;
    n = n < size ? n : size;
    n = n < from->chunk ? n : from->chunk;
    n = n < from->fail_at - from->at ? n : from->fail_at - from->at;
    memcpy(buffer, from->bytes + from->at, n);
    from->at += n;
    from->ended = n == 0;
    return (ptrdiff_t)n;
}

char *bad_input(const bad_case *bad, size_t *size, size_t *offset) {
    const size_t length = strlen(bad->text), mark = strcspn(bad->text, "@");
    assert_true(mark < length);
    char *text = malloc(length);
    assert_non_null(text);
    memcpy(text, bad->text, mark);
    memcpy(text + mark, bad->text + mark + 1, length - mark - 1);
    *size = length - 1;
    *offset = mark;
    return text;
}

char *text_append(char *old, size_t *length, size_t *capacity, const char *more) {
    const size_t n = strlen(more);
    while (*length + n + 1 > *capacity) {
        *capacity = *capacity * 2 + 256;
        old = realloc(old, *capacity);
        assert_non_null(old);
    }
    memcpy(old + *length, more, n + 1);
    *length += n;
    return old;
}

void test_support__not_compiled(void **state) {
    (void)state;
    skip();
}
