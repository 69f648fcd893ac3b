/* query.h - one ray, exact or approximate, put to whoever answers it. */
#ifndef ASET_TRACE_QUERY_H
#define ASET_TRACE_QUERY_H

#include "aset/trace.h"
#if ASET_WITH_DRAFTS
#include "approx/draft_ray.h"
#endif
#include "base/vec.h"
#include "scene/shape.h"
#include "space/answers.h"

#if ASET_WITH_DRAFTS
#define QUERY_LAYERS_MAX (DRAFT_LAYERS_MAX + 1)
#else
#define QUERY_LAYERS_MAX 1
#endif

/* Whether the tracer has what exact or approximate queries need. */
bool aset_query_can(const aset_tracer *tracer, bool approximate);

/* The direction of a caller's ray in unit length, and the caller's length of it. False: it is no ray. */
bool aset_query_unit(aset_vec3 *direction, aset_real *length, const aset_ray *ray);

/* direction: of unit length. False: nothing hit (or curtailed). */
bool aset_query_closest(query_hit *hit, const aset_tracer *tracer, aset_vec3 origin, aset_vec3 direction, aset_real t_max,
                        bool approximate, aset_statistics *statistics);
/* t_last: behind it no marked cell of a draft lies, as far as is known (reach.h). */
bool aset_query_any(const aset_tracer *tracer, aset_vec3 origin, aset_vec3 direction, aset_real t_max, bool approximate,
                    aset_real t_last, aset_statistics *statistics);

/*
 * What the ray meets, in order, until it is covered: one hit unless a draft answers. How many; the rest of the ray meets
 * nothing. is_seen: it is an eye ray (answers.h).
 */
uint32_t aset_query_layers(query_hit layers[QUERY_LAYERS_MAX], const aset_tracer *tracer, aset_vec3 origin,
                           aset_vec3 direction, bool approximate, bool is_seen, aset_statistics *statistics);

/* Point, normals and material of a hit; own is where the material of a draft's facet is put. */
void aset_query_surface(aset_hit *surface, aset_material *own, const aset_tracer *tracer, const query_hit *hit,
                        aset_vec3 direction);

/* How far from a surface rays start that the approximation will answer: 0 where the usual distance is enough. */
aset_real aset_query_clearance(const aset_tracer *tracer);

#endif
