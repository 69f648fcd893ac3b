/*
 * beams.h - eye rays that go through a draft sixteen at a time (eight in a library compiled with -Os).
 *
 * A draft's marked voxels are projected onto the picture, a band of rows after the other, nearest first; the eye rays of
 * neighbouring pixels, 4 x 4 of them (4 x 2) where so many rows are wanted and the picture's stride is not 0, then meet each voxel
 * before them together, and pixels without any are background at once. What has been met is lit together, unless exact objects answer or
 * rays are sent on (with -Os: one by one). It is the beam of Heckbert and Hanrahan 1984 with the voxels' order instead of clipping.
 * The picture is the same, bit for bit, and so are all counts but that of the cells which hold nothing or in which shadow rays start,
 * of which fewer are visited. Drawing by beams takes 14.0 kB of stack (float, gcc 12 on x86-64; 6.3 kB with -Os, 3.4 kB without beams).
 */
#ifndef ASET_BEAMS_H
#define ASET_BEAMS_H

#include "aset/draft.h"

ASET_HEADER_BEGIN

typedef struct aset_beams aset_beams;

#if ASET_WITH_DRAFTS

/* Private: a voxel and the pixels whose eye rays may come through it. */
typedef struct aset_beam_voxel {
    uint16_t left, right;   /* columns */
    uint8_t top, bottom;    /* rows of the band */
    uint8_t in_block, spare;
    uint32_t dense;         /* the block's number among those that are not empty */
    uint8_t block[3], spare2;
} aset_beam_voxel;

struct aset_beam_calls;

/* Memory for one thread's beams, to be named in its scratch (scratch.beams). Private. */
struct aset_beams {
    const struct aset_beam_calls *calls;
    aset_beam_voxel *voxels; /* of the band */
    uint16_t *in_row, *in_segment, *chosen;
    uint32_t capacity, n_voxels, n_in_row, n_in_segment, n_chosen;
    uint32_t band, segment;  /* which these are of: first row, number; UINT32_MAX: none */
    uint32_t rows;           /* of the band */
    bool overflow; /* the band has more voxels than fit */
    /* What the band is of: it serves as long as these stay, call after call. */
    const uint32_t *words;
    aset_vec3 eye[4];
    uint32_t check, width, height, samples;
    aset_real corner;
    bool parallel, can_see;
};

/* Most voxels of a band. */
#define ASET_BEAMS_MAX 65535u

/* Bytes in the arena of beams for bands of up to that many voxels. */
#define ASET_BYTES_BEAMS(voxels) (ASET_ROUND((size_t)(voxels) * (sizeof(aset_beam_voxel) + 3 * sizeof(uint16_t))))

/*
 * Takes beams from the arena, for bands of eight rows that show up to so many voxels, hidden ones included: a fiftieth to a tenth
 * of the draft's. Rows that show more are drawn ray by ray, and so is everything that is not a draft by its planes, seen from
 * wholly before it, and voxels that cover two pixels or more in its middle. ASET_ERR_ARGUMENT: voxels out of 1 to ASET_BEAMS_MAX; ASET_ERR_NOMEM.
 */
aset_status aset_beams_init(aset_beams *beams, uint32_t voxels, aset_arena *arena);

#endif

ASET_HEADER_END
#endif
