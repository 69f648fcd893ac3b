/* rays.c - rays of all sorts, scenes that are hard to divide, a space against brute force. */
#include "support/rays.h"

#include "space/slices.h"

/* --- small helpers --- */

aset_vec3 real3(double x, double y, double z) {
    return dvec_real(dvec_make(x, y, z));
}

void set_axis(aset_vec3 *v, int a, aset_real x) {
    *(a == 0 ? &v->x : a == 1 ? &v->y : &v->z) = x;
}

aset_real axis_of(aset_vec3 v, int a) {
    return a == 0 ? v.x : a == 1 ? v.y : v.z;
}

static void bounds_of(const aset_scene *scene, dvec *low, dvec *high) {
    aset_vec3 l = {0, 0, 0}, h = {1, 1, 1};
    aset_scene_bounds(scene, &l, &h);
    *low = dvec_of(l);
    *high = dvec_of(h);
}

double size_of(const aset_scene *scene) {
    dvec low, high;
    bounds_of(scene, &low, &high);
    double size = fmax(high.x - low.x, fmax(high.y - low.y, high.z - low.z));
    return size > 0 ? size : 1;
}

dvec random_in_scene(random_state *r, const aset_scene *scene, double grown) {
    dvec low, high;
    double g = grown * size_of(scene);
    bounds_of(scene, &low, &high);
    double x = random_between(r, low.x - g, high.x + g), y = random_between(r, low.y - g, high.y + g);
    return dvec_make(x, y, random_between(r, low.z - g, high.z + g));
}

bool voxel_next(int32_t v[3], const uint32_t n[3]) {
    for (int a = 0; a < 3; a++) {
        if (++v[a] < (int32_t)n[a]) {
            return true;
        }
        v[a] = 0;
    }
    return false;
}

/* --- scenes --- */

const small_scene small_scenes[SMALL_SCENES] = {{"balls", 2}, {"gears", 1}, {"mount", 3}, {"rings", 2},
                                                {"teapot", 2}, {"tetra", 3}, {"tree", 5}, {"snow", 0}};

const far_place far_places[FAR_PLACES] = {
    {1, {1000, -2000, 500}}, {1e-3, {10, 0, -7}}, {1e-6, {0, 0, 0}}, {1e5, {1e6, 0, 1e5}}, {1e12, {0, 1e13, 0}}};

void model_move(model *m, const far_place *to) {
    for (uint32_t i = 0; i < m->n_things; i++) {
        thing *t = m->things + i;
        for (int k = 0; k < THING_POINTS_MAX; k++) {
            t->points[k] = dvec_real(dvec_along(to->offset, to->scale, dvec_of(t->points[k])));
        }
        t->radii[0] = (aset_real)(to->scale * (double)t->radii[0]);
        t->radii[1] = (aset_real)(to->scale * (double)t->radii[1]);
    }
}

void model_in_one_plane(model *m, random_state *r, int axis, uint32_t n) {
    for (uint32_t i = 0; i < n; i++) {
        aset_vec3 corner = random_in_cube(r, 4), u = {0, 0, 0}, v = {0, 0, 0};
        set_axis(&corner, axis, axis == 1 ? R(2.5) : 0);
        set_axis(&u, (axis + 1) % 3, (aset_real)random_between(r, 0.2, 3));
        set_axis(&v, (axis + 2) % 3, (aset_real)random_between(r, 0.2, 3));
        model_rectangle(m, corner, u, v);
    }
}

void model_in_one_point(model *m, aset_vec3 place, uint32_t n) {
    const aset_vec3 points[3] = {place, place, place};
    for (uint32_t i = 0; i < n; i++) {
        model_polygon(m, points, NULL, 3);
    }
}

void model_in_slices(model *m, random_state *r) {
    for (int axis = 0; axis < 3; axis++) {
        for (int k = 0; k <= 4; k++) {
            aset_vec3 corner = {0, 0, 0}, u = {0, 0, 0}, v = {0, 0, 0};
            set_axis(&corner, axis, (aset_real)k);
            set_axis(&corner, (axis + 1) % 3, (aset_real)random_below(r, 3));
            set_axis(&corner, (axis + 2) % 3, (aset_real)random_below(r, 3));
            set_axis(&u, (axis + 1) % 3, (aset_real)(1 + random_below(r, 2)));
            set_axis(&v, (axis + 2) % 3, (aset_real)(1 + random_below(r, 2)));
            model_rectangle(m, corner, u, v);
        }
    }
}

/* --- rays of all sorts --- */

const char *const ray_sort_names[RAY_SORTS] = {
    "from outside",    "from inside", "along an axis",            "nearly along an axis", "in a slice",   "from a slice",
    "through corners", "along a box", "from inside of an object", "from a surface",       "in a surface", "from far"};

aset_real random_slice(random_state *r, const aset_space *space, int a, bool halving) {
    uint32_t n = space->slices.n[a], k = random_below(r, n + 1);
    if (halving && random_chance(r, 0.4)) {
        k = n * (1 + random_below(r, 3)) / 4;
    }
    return slices_plane(&space->slices, a, (int32_t)k);
}

void aim_at(aset_ray *ray, dvec target) {
    dvec to = dvec_sub(target, dvec_of(ray->origin));
    ray->direction = dvec_length(to) > 0 ? dvec_real(dvec_unit(to)) : real3(0, 0, 1);
}

bool move_to_hit(aset_ray *ray, const aset_scene *scene, uint32_t object) {
    aset_real t = object_hit(scene, object, ray->origin, ray->direction);
    if (!(t < REAL_INFINITY)) {
        return false;
    }
    ray->origin = dvec_real(dvec_along(dvec_of(ray->origin), (double)t, dvec_of(ray->direction)));
    return true;
}

/* Zeros of either sign. */
static aset_real some_zero(random_state *r) {
    return random_chance(r, 0.5) ? R(0.0) : -R(0.0);
}

static void turn_along_axis(aset_ray *ray, random_state *r) {
    int axis = (int)random_below(r, 3);
    for (int a = 0; a < 3; a++) {
        set_axis(&ray->direction, a, a == axis ? (random_chance(r, 0.5) ? R(1) : R(-1)) : some_zero(r));
    }
}

/* Components down to the smallest that there are. */
static void turn_nearly_along_axis(aset_ray *ray, random_state *r) {
    int axis = (int)random_below(r, 3);
    for (int a = 0; a < 3; a++) {
        double x = pow(10, random_between(r, -44, -3)) * (random_chance(r, 0.5) ? 1 : -1);
        set_axis(&ray->direction, a, a == axis ? (random_chance(r, 0.5) ? R(1) : R(-1)) : (aset_real)x);
    }
}

/* The origin on one, two or three slices; stays: the ray stays in one of them. */
static void put_on_slices(aset_ray *ray, random_state *r, const aset_space *space, bool stays, bool halving) {
    int axis = (int)random_below(r, 3);
    ray->origin = dvec_real(random_in_scene(r, space->scene, stays ? 0.3 : 0));
    for (int a = 0; a < 3; a++) {
        if (a == axis || random_chance(r, 0.3)) {
            set_axis(&ray->origin, a, random_slice(r, space, a, halving));
        }
    }
    ray->direction = random_direction(r);
    if (random_chance(r, 0.3)) {
        turn_along_axis(ray, r);
    }
    if (stays) {
        set_axis(&ray->direction, axis, some_zero(r));
        if (ray->direction.x == 0 && ray->direction.y == 0 && ray->direction.z == 0) {
            set_axis(&ray->direction, (axis + 1) % 3, !halving || random_chance(r, 0.5) ? R(1) : R(-1));
        }
    }
}

/* Along a face or an edge of an object's own box. */
static void put_along_box(aset_ray *ray, random_state *r, const aset_scene *scene) {
    aset_vec3 low, high;
    aset_object_bounds(scene, random_below(r, scene->counts.objects), &low, &high);
    ray->origin = dvec_real(random_in_scene(r, scene, 0.2));
    turn_along_axis(ray, r);
    for (int a = 0; a < 3; a++) {
        aset_real side = axis_of(random_chance(r, 0.5) ? low : high, a);
        if (random_chance(r, 0.7)) {
            set_axis(&ray->origin, a, side);
        }
    }
}

aset_ray random_ray_common(random_state *r, const aset_space *space, ray_sort sort, bool halving) {
    const aset_scene *scene = space->scene;
    aset_ray ray;
    ray.t_max = random_chance(r, 0.2) ? (aset_real)random_between(r, 0, 3 * size_of(scene)) : REAL_INFINITY;
    ray.origin = dvec_real(random_in_scene(r, scene, sort == FROM_OUTSIDE ? 1.5 : sort == ALONG_AXIS ? 0.4 : 0));
    aim_at(&ray, random_in_scene(r, scene, 0));
    switch (sort) {
    case FROM_INSIDE: ray.direction = random_direction(r); break;
    case ALONG_AXIS: turn_along_axis(&ray, r); break;
    case NEARLY_ALONG_AXIS: turn_nearly_along_axis(&ray, r); break;
    case IN_SLICE: put_on_slices(&ray, r, space, true, halving); break;
    case FROM_SLICE: put_on_slices(&ray, r, space, false, halving); break;
    case ALONG_BOX:
        if (scene->counts.objects > 0) {
            put_along_box(&ray, r, scene);
        }
        break;
    default: break;
    }
    return ray;
}

aset_ray random_whole_ray(random_state *r) {
    aset_ray ray = {{0, 0, 0}, {0, 0, 0}, REAL_INFINITY};
    for (int a = 0; a < 3; a++) {
        set_axis(&ray.origin, a, (aset_real)random_below(r, 9) - 2);
        set_axis(&ray.direction, a, (aset_real)random_below(r, 5) - 2);
    }
    ray.direction.x = ray.direction.x == 0 && ray.direction.y == 0 && ray.direction.z == 0 ? 1 : ray.direction.x;
    return ray;
}

aset_ray brought_near(const aset_scene *scene, const aset_ray *ray) {
    aset_ray near = *ray;
    aset_vec3 low, high;
    aset_real t_in, t_out;
    near.direction = dvec_real(dvec_unit(dvec_of(ray->direction)));
    probe p = aset_probe_make(near.origin, near.direction);
    if (aset_scene_bounds(scene, &low, &high) && aset_probe_box(&p, low, high, &t_in, &t_out)) {
        double moved = (double)t_in - size_of(scene) / 16;
        if (moved > 0) {
            near.origin = dvec_real(dvec_along(dvec_of(near.origin), moved, dvec_of(near.direction)));
        }
    }
    return near;
}

/* --- a space against brute force --- */

bool same_hit(const aset_hit *a, const aset_hit *b) {
    return memcmp(&a->t, &b->t, sizeof a->t) == 0 && memcmp(&a->point, &b->point, sizeof a->point) == 0 &&
           memcmp(&a->normal, &b->normal, sizeof a->normal) == 0 &&
           memcmp(&a->geometric, &b->geometric, sizeof a->geometric) == 0 && a->object == b->object &&
           a->material == b->material;
}

bool same_closest(const aset_tracer *a, const aset_tracer *b, const aset_ray *ray, bool *found) {
    aset_hit expected, hit;
    bool expected_found, hit_found;
    aset_closest_hit(&expected_found, &expected, a, ray, false, NULL);
    aset_closest_hit(&hit_found, &hit, b, ray, false, NULL);
    if (found != NULL) {
        *found = hit_found;
    }
    return hit_found == expected_found && (!hit_found || same_hit(&hit, &expected));
}

void duel_open(duel *d, const stage *s, const aset_space *brute, const aset_space *space) {
    d->stage = s;
    d->brute = stage_tracer(s, brute);
    d->other = stage_tracer(s, space);
    d->seen = malloc(s->scene.counts.objects + 1);
}

void duel_close(duel *d) {
    free(d->seen);
    d->seen = NULL;
}

bool duel_closest(duel *d, const aset_ray *ray, ray_sort sort, aset_statistics *brute, aset_statistics *other) {
    aset_hit expected, hit;
    bool expected_found, found;
    assert_int_equal(aset_closest_hit(&expected_found, &expected, &d->brute, ray, false, brute), ASET_OK);
    assert_int_equal(aset_closest_hit(&found, &hit, &d->other, ray, false, other), ASET_OK);
    check(found == expected_found, DUEL_TEXT, DUEL_ARGS(d, sort));
    check(!found || same_hit(&hit, &expected), DUEL_TEXT ": object %" PRIu32 " at %.9g, not %" PRIu32 " at %.9g",
          DUEL_ARGS(d, sort), hit.object, (double)hit.t, expected.object, (double)expected.t);
    check(other->tests <= d->stage->scene.counts.objects && other->test_hits <= other->tests, DUEL_TEXT, DUEL_ARGS(d, sort));
    d->hits += found;
    if (found && d->rays % 8 == 0) { /* t_max itself is no hit any more */
        aset_ray shorter = *ray;
        shorter.t_max = hit.t;
        check(same_closest(&d->brute, &d->other, &shorter, NULL), DUEL_TEXT ": t_max", DUEL_ARGS(d, sort));
    }
    return found;
}

/* --- what a walk goes through --- */

aset_real inspect(walk_request *walk, const walk_cell *cell) {
    inspection *in = (inspection *)walk;
    const aset_scene *scene = &in->duel->stage->scene;
    if (cell->face != FACE_NONE) {
        in->backwards = in->backwards || cell->t < in->last_t;
        in->last_t = cell->t;
    }
    for (uint32_t i = 0; i < cell->n; i++) {
        uint32_t object = cell->objects[i];
        in->twice = in->twice || in->duel->seen[object] > 0;
        in->duel->seen[object] = 1;
        if (cell->face != FACE_NONE) {
            in->late = in->late || cell->t > object_hit(scene, object, in->ray->origin, in->ray->direction);
        }
    }
    return REAL_INFINITY;
}

void inspect_walk(inspection *in, duel *d, const aset_ray *ray, ray_sort sort) {
    memset(d->seen, 0, d->stage->scene.counts.objects);
    in->walk.limit = REAL_INFINITY;
    in->walk.wants_references = true;
    in->duel = d;
    in->ray = ray;
    in->last_t = -REAL_INFINITY;
    probe p = aset_probe_make(ray->origin, ray->direction);
    d->other.space->method->go(d->other.space, &p, &in->walk);
    check(!in->twice, DUEL_TEXT ": an object twice", DUEL_ARGS(d, sort));
    check(!in->backwards, DUEL_TEXT ": cells out of order", DUEL_ARGS(d, sort));
    check(!in->late, DUEL_TEXT ": met behind its hit", DUEL_ARGS(d, sort));
}

void inspect_seen(const duel *d, const aset_ray *ray, ray_sort sort) {
    const aset_scene *scene = &d->stage->scene;
    for (uint32_t i = 0; i < scene->counts.objects; i++) {
        check(d->seen[i] > 0 || !(object_hit(scene, i, ray->origin, ray->direction) < REAL_INFINITY),
              DUEL_TEXT ": object %" PRIu32 " missed", DUEL_ARGS(d, sort), i);
    }
}
