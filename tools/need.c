/* need.c - how much memory a draft needs that had too little. */
#include "need.h"

#include "tool.h"

#include <inttypes.h>

/* This many objects, and divisions of the longest axis, at the most. */
#define QUICK_OBJECTS 20000u
#define QUICK_DIVISIONS 128u

bool tool_need_is_quick(uint64_t objects, const uint32_t divisions[3]) {
    bool is_quick = objects <= QUICK_OBJECTS;
    for (int a = 0; a < 3; a++) {
        is_quick = is_quick && divisions[a] <= QUICK_DIVISIONS;
    }
    return is_quick;
}

uint64_t tool_narrow_draft_need(draft_try *attempt, void *context, uint64_t least, uint64_t enough) {
    draft_trial t = {ASET_OK, false, 0, 0};
    while ((t.status == ASET_OK || t.status == ASET_ERR_NOMEM) && enough - least > enough / 8) {
        uint64_t middle = least + (enough - least) / 2;
        t = attempt(context, middle);
        if (t.status == ASET_OK) {
            enough = t.peak < middle ? t.peak : middle;
        } else {
            least = middle;
        }
    }
    return enough;
}

/*
 * What is missing is known better with each try: so until it is enough. That is for few passes over the source, and what more of them
 * get by with is known from no pass: so then halfway between what is too little and what is enough.
 */
void tool_tell_draft_need(draft_try *attempt, void *context, const char *path, uint64_t has, size_t missing, bool is_quick) {
    uint64_t enough = has;
    draft_trial t = {ASET_ERR_NOMEM, false, missing, 0};
    while (t.status == ASET_ERR_NOMEM) {
        enough += t.missing;
        t = attempt(context, enough);
    }
    if (t.status == ASET_OK) {
        enough = t.peak < enough ? t.peak : enough;
        enough = is_quick ? tool_narrow_draft_need(attempt, context, has, enough) : enough;
        tool_error(path, 0, "the draft needs %" PRIu64 " bytes, has %" PRIu64, enough, has);
    } else if (!t.told) {
        tool_error(path, 0, "%s", aset_status_text(t.status));
    }
}
