/*
 * entity.h - what every sink checks before it believes an entity, so that the counter and the builder never disagree: the
 * builder needs exactly what the counter counted.
 */
#ifndef ASET_SCENE_ENTITY_H
#define ASET_SCENE_ENTITY_H

#include "aset/scene.h"
#include "base/vec.h"

#include <string.h>

/* The numbers of a material, which stand one beside the other: all of it but the sides from which it is seen. */
enum { MATERIAL_AMOUNTS = offsetof(aset_material, one_sided) / sizeof(aset_real) };

aset_status aset_entity_check_view(const aset_view *view);
aset_status aset_entity_check_light(const aset_light *light);
aset_status aset_entity_check_colour(const aset_colour *colour);
aset_status aset_entity_check_material(const aset_material *material);

/* Are two materials equal but for the sides from which they are seen? */
INLINE_BUT_FOR_SIZE bool entity_same_look(const aset_material *a, const aset_material *b) {
    const unsigned char *p = (const unsigned char *)a, *q = (const unsigned char *)b;
    if (a->fill.r != b->fill.r) { /* most are told apart so, in lists that are searched */
        return false;
    }
    for (const unsigned char *end = p + offsetof(aset_material, one_sided); p != end; p += sizeof(aset_real), q += sizeof(aset_real)) {
        aset_real x, y;
        memcpy(&x, p, sizeof x);
        memcpy(&y, q, sizeof y);
        if (x != y) {
            return false;
        }
    }
    return true;
}

/*
 * The current material as a number below recent->n, made current if it is pending. *is_new: it has to be stored, as number
 * recent->n - 1. ASET_ERR_ARGUMENT if no material has come yet; ASET_ERR_NOMEM, and nothing done, if it would be more than most.
 */
aset_status aset_entity_use_material(aset_recent_materials *recent, uint32_t most, bool *is_new);

/* Objects that come whole, checked: their coordinates as a scene keeps them, and their bounds. */
#if ASET_WITH_SPHERES
aset_status aset_entity_sphere(aset_real at[ASET_COORDINATES_SPHERE], aset_vec3 *low, aset_vec3 *high, const aset_vec3 *centre,
                               aset_real radius);
#endif
#if ASET_WITH_CONES
aset_status aset_entity_cone(aset_real at[ASET_COORDINATES_CONE], aset_vec3 *low, aset_vec3 *high, const aset_vec3 *base,
                             aset_real base_radius, const aset_vec3 *apex, aset_real apex_radius);
#endif

/* Begin, follow and end a polygon. end: ASET_ERR_GEOMETRY unless all announced points came. */
aset_status aset_outline_begin(aset_outline *outline, uint32_t n_points, bool with_normals);
aset_status aset_outline_point(aset_outline *outline, const aset_vec3 *point, const aset_vec3 *normal);
aset_status aset_outline_end(aset_outline *outline);

#endif
