/* query.h - one ray against a space, exact or approximate: the two consumers of the common walk. */
#ifndef ASET_TRACE_QUERY_H
#define ASET_TRACE_QUERY_H

#include "aset/trace.h"
#include "base/vec.h"
#include "scene/shape.h"

/* What a closest-hit query found. */
typedef struct query_hit {
    aset_real t;
    aset_vec3 near;   /* where the ray was made to start, */
    aset_real t_near; /* and t from there: the hit's point with the least rounding */
    uint32_t object; /* exact; ASET_NO_OBJECT for a cell */
    uint32_t cell;   /* approximate: dense number */
    int face;        /* approximate: axis * 2, + 1 going down */
    bool curtailed;  /* approximate: the ray was trapped, and hit nothing */
} query_hit;

/* Makes a ray of unit direction ready; from outside it is moved near the scene. By how much. */
aset_real query_ready(probe *ray, const aset_scene *scene, aset_vec3 origin, aset_vec3 direction);

/* direction: of unit length. False: nothing hit (or curtailed). */
bool query_closest(query_hit *hit, const aset_tracer *tracer, aset_vec3 origin, aset_vec3 direction, aset_real t_max,
                   bool approximate, aset_statistics *statistics);
bool query_any(const aset_tracer *tracer, aset_vec3 origin, aset_vec3 direction, aset_real t_max, bool approximate,
               aset_statistics *statistics);

/* Point, normals and material of a hit. */
void query_surface(aset_hit *surface, const aset_tracer *tracer, const query_hit *hit, aset_vec3 direction);

#endif
