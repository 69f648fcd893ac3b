/*
 * reach.h - how far shadow rays go before nothing of a draft is left ahead of them.
 *
 * Most shadow rays leave the model and cross empty cells until they are out of its box. A reach projects the draft's marked voxels,
 * once, onto a square of tiles before each light, and keeps for every tile the distance of the one nearest to the light (as
 * the light buffer of Haines and Greenberg 1986 keeps objects): there a shadow ray may stop. The picture is the same bit for bit,
 * and so are all counts but those of empty cells. Lights of a tracer's scene that are not where the draft's were when it was made
 * get no help from it.
 */
#ifndef ASET_REACH_H
#define ASET_REACH_H

#include "aset/draft.h"

ASET_HEADER_BEGIN

#if ASET_WITH_DRAFTS

/* Private: where boxes of one size appear from a point, or along a direction (lib/trace/outlook.h). */
typedef struct aset_outlook {
    aset_vec3 from, forward, across, down;
    aset_real half_across, half_down, half_forward, ball;
    bool parallel;
} aset_outlook;

/* Private: the tiles before one light. */
typedef struct aset_reach_map {
    aset_outlook outlook;
    aset_vec3 position; /* the light's, or the direction to it */
    bool directional;
    aset_real *near; /* for each tile, row by row; infinity: nothing */
    uint32_t tiles;  /* on a side; 0: no map, rays are walked whole */
} aset_reach_map;

struct aset_reach_calls;

typedef struct aset_reach {
    const struct aset_reach_calls *calls;
    const aset_draft *draft;
    aset_reach_map *lights; /* one for each of draft->stage, */
    uint32_t n_lights;      /* as they were then */
} aset_reach;

/* Most tiles on a side of a map; 64 are enough for 64 divisions. */
#define ASET_REACH_TILES_MAX 1024u

/* Bytes in the arena of a reach of that many tiles on a side, for a draft with that many lights. */
#define ASET_BYTES_REACH(tiles, lights)                                                                                \
    (ASET_ROUND((size_t)(lights) * sizeof(aset_reach_map)) +                                                           \
     (size_t)(lights) * ASET_ROUND((size_t)(tiles) * (tiles) * sizeof(aset_real)))

/*
 * Makes the reach of a draft, which must stay where it is, to be named in tracers that draw it (tracer.reach); any number of
 * threads may share it. A map that would say nothing is left out: of a light among the voxels or very far away.
 * ASET_ERR_NOMEM leaves the arena as it was; ASET_ERR_ARGUMENT: tiles out of 1 to ASET_REACH_TILES_MAX.
 */
aset_status aset_reach_init(aset_reach *reach, const aset_draft *draft, uint32_t tiles, aset_arena *arena);

#endif

ASET_HEADER_END
#endif
