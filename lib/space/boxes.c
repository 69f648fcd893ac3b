/* boxes.c - filling boxes, and the crossing by which a ray's way enters one. */
#include "space/boxes.h"

void aset_boxes_fill(aset_box *boxes, const aset_slices *slices, const aset_scene *scene) {
    for (uint32_t i = 0; i < scene->counts.objects; i++) {
        voxel_box box = aset_slices_object_box(slices, scene, i);
        for (int a = 0; a < 3; a++) {
            boxes[i].low[a] = (uint16_t)box.low[a];
            boxes[i].high[a] = (uint16_t)box.high[a];
        }
    }
}

void aset_stay_make(stay *s, const dda *walk, const aset_slices *slices, const probe *ray, const voxel_box *cell) {
    s->t_out = REAL_INFINITY;
    s->axis_out = 3;
    s->is_first = walk->axis < 0;
    for (int a = 0; a < 3; a++) {
        s->voxel[a] = s->before[a] = walk->voxel[a];
        if (ray->moves[a]) {
            aset_real t = dda_crossing(slices, ray, a, walk->step[a] > 0 ? cell->high[a] + 1 : cell->low[a]);
            if (t < s->t_out) {
                s->t_out = t;
                s->axis_out = a;
            }
        }
    }
    if (!s->is_first) {
        s->before[walk->axis] -= walk->step[walk->axis];
    }
}

/* In the order of all crossings, is (t, axis) before (u, other)? */
static bool is_before(aset_real t, int axis, aset_real u, int other) {
    return t < u || (t == u && axis <= other); /* on one axis: the box and the leaf overlap there, so the entry is the lower slice */
}

bool aset_stay_enters(const stay *s, const aset_slices *slices, const probe *ray, const aset_box *box) {
    if (box_holds(box, s->voxel)) {
        return s->is_first || !box_holds(box, s->before);
    }
    aset_real t_in = -REAL_INFINITY, t_left = REAL_INFINITY;
    int axis_in = -1, axis_left = 3;
    for (int a = 0; a < 3; a++) {
        bool up = ray->direction[a] > 0;
        int32_t first = up ? box->low[a] : box->high[a], last = up ? box->high[a] : box->low[a];
        bool ahead = up ? s->voxel[a] < first : s->voxel[a] > first, behind = up ? s->voxel[a] > last : s->voxel[a] < last;
        if (behind || (ahead && !ray->moves[a])) {
            return false;
        }
        if (!ray->moves[a]) {
            continue;
        }
        if (ahead) {
            aset_real t = dda_crossing(slices, ray, a, up ? first : first + 1);
            if (t >= t_in) {
                t_in = t;
                axis_in = a;
            }
        }
        aset_real t = dda_crossing(slices, ray, a, up ? last + 1 : last);
        if (t < t_left) {
            t_left = t;
            axis_left = a;
        }
    }
    return is_before(t_in, axis_in, s->t_out, s->axis_out) && is_before(t_in, axis_in, t_left, axis_left);
}
