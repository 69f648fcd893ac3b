/* trace_tree.h - the colour behind one eye ray, for the renderer. */
#ifndef ASET_TRACE_TREE_H
#define ASET_TRACE_TREE_H

#include "trace/query.h"

static inline uint32_t tracer_depth(const aset_tracer *tracer) {
    return tracer->depth > 0 ? tracer->depth : ASET_DEPTH_DEFAULT;
}

/* What an eye ray meets, if that is known already. */
typedef struct eye_hits {
    query_hit layers[QUERY_LAYERS_MAX];
    uint32_t n;
} eye_hits;

/*
 * direction: of unit length; the scratch as aset_trace_check wants it; known may be NULL. *cover: the share of the eye ray itself that
 * hit something.
 */
aset_colour aset_trace_tree(const aset_tracer *tracer, aset_vec3 origin, aset_vec3 direction, const eye_hits *known,
                            aset_scratch *scratch, aset_statistics *statistics, aset_real *cover);

/* ASET_ERR_ARGUMENT unless the tracer is complete and the scratch deep enough for it. */
aset_status aset_trace_check(const aset_tracer *tracer, const aset_scratch *scratch);

#endif
