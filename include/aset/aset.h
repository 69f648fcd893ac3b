/*
 * aset.h - everything of libaset's core: approximate ray tracing in a memory budget fixed at compile time, after Dauenhauer
 * and Semwal, "Approximate Ray Tracing" (Graphics Interface 1990).
 *
 * A complete program is examples/smallest.c. The way of the data, and the header of each part:
 *
 *   arena.h    the caller's block of memory        aset_arena_init
 *   scene.h    entities, sinks, the scene          aset_scene_init, aset_scene_sink, aset_counter_sink
 *   stage.h    view, lights, ground for a model    aset_stage_emit
 *   space.h    a space subdivision over the scene  aset_space_build
 *   summary.h  what a cell remembers (ASET)        aset_summary_build
 *   draft.h    a model that is only drafted        aset_baker_init, aset_draft_open
 *   trace.h    rays, colours, rows of a picture    aset_render_rows, aset_closest_hit, aset_any_hit
 *   report.h   what it took                        aset_report_text
 *
 * Beside the core: load.h (readers of files) and procedural.h (scenes by rule), in archives of their own.
 *
 * Outputs come first, inputs are const; 0 is success; a struct filled with zeros asks for the defaults. Nothing is allocated
 * but from the arena, nothing global is written, so threads may share whatever is finished.
 */
#ifndef ASET_ASET_H
#define ASET_ASET_H

#include "aset/config.h"
#include "aset/types.h"
#include "aset/arena.h"
#include "aset/scene.h"
#include "aset/stage.h"
#include "aset/space.h"
#include "aset/summary.h"
#include "aset/flat.h"
#include "aset/draft.h"
#include "aset/reach.h"
#include "aset/beams.h"
#include "aset/trace.h"
#include "aset/report.h"

#endif
