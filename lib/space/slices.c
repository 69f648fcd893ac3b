/* slices.c - where the slices are, how many there are to be, which voxels a box touches, where a ray begins among them. */
#include "space/slices.h"

/*
 * In margins of objects, whose boxes grow by two of them on each side: how far the outermost slices lie outside the scene,
 * and by how much the inner ones lie before the places that equal division gives. Where objects end in such a place (a
 * ground, storeys, symmetric scenes) the slice passes before them by more than they grow: a flat object stays one voxel
 * thick, and a box that begins or ends at the place belongs to the voxel behind it, as floor() of the bare numbers would
 * have it.
 */
#define OUTSIDE 8
#define BEFORE 4

#define AUTO_DENSITY 64
#define AUTO_DIVISIONS_MAX 512
#define AUTO_THIN R(0.001)

void aset_slices_make(aset_slices *slices, const aset_scene *scene, const uint32_t divisions[3]) {
    aset_vec3 low = vec(0, 0, 0), high = vec(1, 1, 1);
    aset_real margin = REAL_UNIT;
    if (scene->margin > 0) {
        low = scene->low;
        high = scene->high;
        margin = scene->margin;
    }
    for (int a = 0; a < 3; a++) {
        aset_real from = vec_at(&low, a), to = vec_at(&high, a);
        slices->n[a] = divisions[a];
        slices->planes[a] = NULL;
        slices->first[a] = from - OUTSIDE * margin;
        slices->last[a] = to + OUTSIDE * margin;
        bool is_flat = to - from < OUTSIDE * margin; /* it is divided as if it were not quite */
        slices->low[a] = is_flat ? slices->first[a] : from - BEFORE * margin;
        slices->width[a] = (is_flat ? slices->last[a] - slices->first[a] : to - from) / (aset_real)divisions[a];
        slices->per_width[a] = 1 / slices->width[a];
    }
}

/* The cube root of x >= 1, by Newton's steps from above: twice the precision each once they are near. */
static aset_real cube_root(aset_real x) {
    aset_real root = x;
    for (int i = 0; i < 60; i++) {
        root = (2 * root + x / (root * root)) / 3;
    }
    return root;
}

bool aset_slices_precise(const aset_scene *scene) {
    return !(scene->margin > 0) || aset_box_is_precise(scene->low, scene->high);
}

bool aset_slices_coarsen(uint32_t divisions[3], bool far_off) {
    uint32_t *n = divisions;
    if (n[0] == 1 && n[1] == 1 && n[2] == 1) {
        return false;
    }
    for (int a = 0; a < 3; a++) {
        uint32_t less = far_off ? (n[a] + 1) / 2 : (n[a] + 7) / 8;
        n[a] = n[a] > less ? n[a] - less : 1;
    }
    return true;
}

void aset_slices_auto_divisions(const aset_scene *scene, uint32_t n_objects, size_t budget, uint32_t divisions[3]) {
    aset_vec3 low = vec(0, 0, 0), high = vec(1, 1, 1);
    aset_scene_bounds(scene, &low, &high);
    aset_vec3 span = vec_sub(high, low);
    aset_real largest = vec_largest(span), sides[3] = {1, 1, 1}, volume = 1;
    for (int a = 0; a < 3 && largest > 0; a++) { /* relative to the largest, so that no product leaves the range */
        sides[a] = real_max(vec_at(&span, a) / largest, AUTO_THIN);
        volume *= sides[a];
    }
    aset_real per_side = cube_root(AUTO_DENSITY * real_max((aset_real)n_objects, 1) / volume);
    for (int a = 0; a < 3; a++) {
        aset_real n = sides[a] > AUTO_THIN ? sides[a] * per_side + R(0.5) : 1;
        divisions[a] = n < 1 ? 1 : n > AUTO_DIVISIONS_MAX ? AUTO_DIVISIONS_MAX : (uint32_t)n;
    }
    while (budget > 0 && 12 * ASET_BLOCK_WORDS(divisions[0], divisions[1], divisions[2], 6u) > budget / 2 &&
           aset_slices_coarsen(divisions, false)) { /* MSET's map of blocks alone would take half of it */
    }
}

/* aset_slices_locate in a table of slices, by halving it. */
static int32_t locate_in_table(const aset_real *planes, int32_t last, aset_real x) {
    int32_t low = 0, high = last;
    while (low < high) {
        int32_t middle = low + (high - low + 1) / 2;
        if (planes[middle] <= x) {
            low = middle;
        } else {
            high = middle - 1;
        }
    }
    return low;
}

int32_t aset_slices_locate(const aset_slices *slices, int a, aset_real x) {
    if (slices->planes[a] != NULL) {
        return locate_in_table(slices->planes[a], (int32_t)slices->n[a] - 1, x);
    }
    return slices_locate_even(slices, a, x);
}

voxel_box aset_slices_box(const aset_slices *slices, const aset_scene *scene, aset_vec3 low, aset_vec3 high) {
    voxel_box box;
    for (int a = 0; a < 3; a++) {
        aset_real end = slices_grown_high(scene, vec_at(&high, a));
        box.low[a] = aset_slices_locate(slices, a, slices_grown_low(scene, vec_at(&low, a)));
        box.high[a] = aset_slices_locate(slices, a, end);
        if (box.high[a] > box.low[a] && slices_plane(slices, a, box.high[a]) == end) {
            box.high[a]--; /* a slice at the very end of the box (SET) closes it: what is hit lies a margin before it */
        }
    }
    return box;
}

voxel_box aset_slices_object_box(const aset_slices *slices, const aset_scene *scene, uint32_t object) {
    aset_vec3 low, high;
    aset_object_own_bounds(scene, object, &low, &high);
    return aset_slices_box(slices, scene, low, high);
}

/* Prepares steps and ends; nothing that depends on where the walk begins. */
static void dda_prepare(dda *walk, const aset_slices *slices, const probe *ray) {
    for (int a = 0; a < 3; a++) {
        bool up = ray->direction[a] > 0;
        walk->step[a] = up ? 1 : -1;
        walk->end[a] = up ? (int32_t)slices->n[a] : -1;
        walk->next[a] = REAL_INFINITY;
    }
    walk->axis = -1;
    walk->t = 0;
}

/* Where each axis is crossed next. */
static void set_next(dda *walk, const aset_slices *slices, const probe *ray) {
    for (int a = 0; a < 3; a++) {
        if (ray->moves[a]) {
            walk->next[a] = dda_crossing(slices, ray, a, walk->voxel[a] + (walk->step[a] > 0));
        }
    }
}

/* Whether the crossing of slice k of axis b comes before (t, axis) in the order of all crossings. */
static bool crossed(const aset_slices *slices, const probe *ray, int b, int32_t k, aset_real t, int axis) {
    aset_real tk = dda_crossing(slices, ray, b, k);
    return tk < t || (tk == t && b < axis);
}

/*
 * The voxel number of axis b after all crossings before (t, axis), within the window; false if the ray has left the window
 * by then. The position guesses, the order of crossings decides.
 */
static bool settle(const aset_slices *slices, const probe *ray, int b, aset_real t, int axis, const voxel_box *window,
                   int32_t *voxel) {
    aset_real x = ray->origin[b] + t * ray->direction[b];
#if defined(__OPTIMIZE_SIZE__)
    int32_t k = aset_slices_locate(slices, b, x);
#else
    int32_t k = slices->planes[b] == NULL ? slices_guess(slices, b, x) : aset_slices_locate(slices, b, x);
#endif
    int up = ray->direction[b] > 0;
    int32_t step = up ? 1 : -1, entry = up ? 0 : 1; /* a voxel's entry slice is k + entry, its exit k + 1 - entry */
    k = k < window->low[b] ? window->low[b] : k > window->high[b] ? window->high[b] : k;
    int32_t first = up ? window->low[b] : window->high[b], last = up ? window->high[b] : window->low[b];
    while (k != first && !crossed(slices, ray, b, k + entry, t, axis)) {
        k -= step;
    }
    while (crossed(slices, ray, b, k + 1 - entry, t, axis)) {
        if (k == last) {
            *voxel = k;
            return false;
        }
        k += step;
    }
    *voxel = k;
    return true;
}

/* An axis along which the ray stands still: its voxel never changes. */
static bool stand(const aset_slices *slices, const probe *ray, int a, const voxel_box *window, int32_t *voxel) {
    aset_real x = ray->origin[a];
    if (x < slices->first[a] || x > slices->last[a]) {
        return false;
    }
    *voxel = aset_slices_locate(slices, a, x);
    return *voxel >= window->low[a] && *voxel <= window->high[a];
}

bool aset_dda_enter(dda *walk, const aset_slices *slices, const probe *ray, const voxel_box *window) {
    dda_prepare(walk, slices, ray);
    aset_real t = -REAL_INFINITY, t_out = REAL_INFINITY;
    int axis = -1;
    for (int a = 0; a < 3; a++) {
        if (!ray->moves[a]) {
            if (!stand(slices, ray, a, window, &walk->voxel[a])) {
                return false;
            }
            continue;
        }
        int up = ray->direction[a] > 0;
        aset_real in = dda_crossing(slices, ray, a, up ? window->low[a] : window->high[a] + 1);
        aset_real out = dda_crossing(slices, ray, a, up ? window->high[a] + 1 : window->low[a]);
        if (in >= t) {
            t = in;
            axis = a;
        }
        t_out = real_min(t_out, out);
    }
    if (axis < 0 || t_out < t || t_out < 0) { /* a ray that moves along no axis enters nothing */
        return false;
    }
    for (int a = 0; a < 3; a++) {
        if (!ray->moves[a]) {
            continue;
        }
        if (a == axis) {
            walk->voxel[a] = ray->direction[a] > 0 ? window->low[a] : window->high[a];
        } else if (!settle(slices, ray, a, t, axis, window, &walk->voxel[a])) {
            return false;
        }
    }
    set_next(walk, slices, ray);
    walk->t = t;
    walk->axis = axis;
    return true;
}

bool aset_slices_voxel(const aset_slices *slices, const probe *ray, int32_t voxel[3]) {
    const aset_real *at = ray->origin;
    if (at[0] < slices->first[0] || at[0] > slices->last[0] || at[1] < slices->first[1] || at[1] > slices->last[1] ||
        at[2] < slices->first[2] || at[2] > slices->last[2]) {
        return false;
    }
    for (int a = 0; a < 3; a++) {
        int32_t k = aset_slices_locate(slices, a, at[a]);
        while (k > 0 && ray->direction[a] < 0 && ray->moves[a] && slices_plane(slices, a, k) == at[a]) {
            k--; /* on a slice, or on several at one place, going down: they are crossed at t = 0, as upwards they are by locate */
        }
        voxel[a] = k;
    }
    return true;
}

bool aset_dda_inside(dda *walk, const aset_slices *slices, const probe *ray) {
    if (!aset_slices_voxel(slices, ray, walk->voxel)) {
        return false;
    }
    dda_prepare(walk, slices, ray);
    set_next(walk, slices, ray);
    return true;
}

uint32_t aset_dda_land(dda *walk, const aset_slices *slices, const probe *ray, const voxel_box *window) {
    int32_t crossings = 0;
    for (int a = 0; a < 3; a++) {
        int32_t before = walk->voxel[a];
        if (!ray->moves[a]) {
            continue;
        }
        if (a == walk->axis) {
            walk->voxel[a] = walk->step[a] > 0 ? window->low[a] : window->high[a];
        } else {
            (void)settle(slices, ray, a, walk->t, walk->axis, window, &walk->voxel[a]);
            if ((walk->voxel[a] - before) * walk->step[a] < 0) {
                walk->voxel[a] = before; /* a walk that began on a slice counts it as crossed at t = 0, and never goes back */
            }
        }
        crossings += (walk->voxel[a] - before) * walk->step[a];
    }
    set_next(walk, slices, ray);
    return (uint32_t)crossings;
}
