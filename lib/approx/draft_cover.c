/* draft_cover.c - the layers that a ray has met. */
#include "approx/draft_cover.h"

#if ASET_WITH_DRAFTS

bool aset_draft_cover_add(draft_cover *c, const draft_meeting *found, uint32_t n) {
    for (uint32_t i = 0; i < n; i++) {
        if (aset_draft_cover_lay(c, &found[i])) {
            return true;
        }
    }
    return false;
}

#endif
