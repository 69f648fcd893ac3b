/* trace_tree.h - the colour behind one eye ray, for the renderer. */
#ifndef ASET_TRACE_TREE_H
#define ASET_TRACE_TREE_H

#include "aset/trace.h"

/* direction: of unit length; the scratch as trace_check wants it. *hit: whether the eye ray itself hit something. */
aset_colour trace_tree(const aset_tracer *tracer, aset_vec3 origin, aset_vec3 direction, aset_scratch *scratch,
                       aset_statistics *statistics, bool *hit);

/* ASET_ERR_ARGUMENT unless the tracer is complete and the scratch deep enough for it. */
aset_status trace_check(const aset_tracer *tracer, const aset_scratch *scratch);

#endif
