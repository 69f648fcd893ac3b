/* status.c - a sentence for every status, and adding up statistics. */
#include "aset/types.h"

#include <string.h>

const char *aset_status_text(aset_status status) {
    switch (status) {
    case ASET_OK: return "done";
    case ASET_ERR_ARGUMENT: return "an argument is outside what the call allows";
    case ASET_ERR_NOMEM: return "the arena is too small";
    case ASET_ERR_LIMIT: return "a count is beyond what the library can index";
    case ASET_ERR_GEOMETRY: return "the geometry is degenerate or not finite";
    case ASET_ERR_UNSUPPORTED: return "the feature was switched off when the library was compiled";
    case ASET_ERR_STOPPED: return "stopped by the caller";
    case ASET_ERR_READ: return "the input could not be read";
    case ASET_ERR_SYNTAX: return "the input is not in the expected format";
    case ASET_ERR_ARITHMETIC: return "numbers are not rounded as libaset needs it: compile it with -ffp-contract=off";
    case ASET_ERR_PRECISION: return "the scene lies so far from the origin that its coordinates hardly tell its parts apart";
    }
    return "an unknown status";
}

/* All of them are counts of 64 bits, one beside the other. */
enum { COUNTS = sizeof(aset_statistics) / sizeof(uint64_t) };

void aset_statistics_add(aset_statistics *to, const aset_statistics *from) {
    uint64_t sums[COUNTS], more[COUNTS];
    memcpy(sums, to, sizeof sums);
    memcpy(more, from, sizeof more);
    for (int i = 0; i < COUNTS; i++) {
        sums[i] += more[i];
    }
    memcpy(to, sums, sizeof sums);
}
