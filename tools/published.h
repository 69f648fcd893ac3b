/*
 * published.h - Tables 1 to 4 of Dauenhauer and Semwal, "Approximate Ray Tracing" (Graphics Interface 1990), as data, and
 * what their numbers say about how they were counted.
 */
#ifndef ASET_TOOLS_PUBLISHED_H
#define ASET_TOOLS_PUBLISHED_H

#include <stdint.h>

/* Index of a published pair. */
enum { BY_MSET, BY_ASET };

/* The paper's costs on its machine: a ray's own, and a test of a polygon. */
#define PUBLISHED_RAY_S 0.0088
#define PUBLISHED_TEST_S 0.00032

/* One row of the paper's tables; 0 stands for what it does not print. */
typedef struct published_row {
    const char *label;
    /* the scene that stands for it: procedural name, size (0: its default), divisions, rays in a chain */
    const char *scene;
    uint32_t size, divisions, depth;
    double seconds[2], rays[2], rays_per_second[2]; /* Table 1 */
    double density, cells[2], tests[2];             /* Table 2 */
    double hit_ratio[2], attempts[2], bytes[2];     /* Table 3 */
    double primary, secondary[2];                   /* Table 4 */
} published_row;

#define PUBLISHED_ROWS 7u
/* The rows of one scene at 100, 50 and 30 divisions, which Table 3 is about, come first. */
#define PUBLISHED_SNOW_ROWS 3u
extern const published_row published_rows[PUBLISHED_ROWS];

/*
 * Share of MSET's (ASET's) time that was left for primary rays, if the rays per second are secondary rays by the time
 * that they took: 1 - secondary / rays_per_second / seconds.
 */
double published_primary_share(const published_row *row, int by);

/*
 * Tests that a secondary ray of MSET made. Where Table 3 has the row: what MSET attempted more than ASET, whose secondary
 * rays test nothing, by their number. Elsewhere from the rate and the paper's two costs.
 */
double published_secondary_tests(const published_row *row);

/* Share of MSET's rays that hit something, if the hit ratio counts one hit for each of them: 0 without Table 3. */
double published_hit_share(const published_row *row);

#endif
