/* draft_cover.c - the layers that a ray has met. */
#include "approx/draft_cover.h"

#if ASET_WITH_DRAFTS

static void add_layer(draft_cover *c, const draft_meeting *m, aset_real cover) {
    draft_layer *layer = c->layers + c->n++;
    layer->t = m->t;
    layer->facet = m->facet;
    layer->face = 0;
    layer->cover = c->left * cover;
    c->left -= layer->cover;
    if (c->n == DRAFT_LAYERS_MAX || c->left < COVER_LEAST) {
        layer->cover += c->left;
        c->left = 0;
    }
}

bool aset_draft_cover_lay(draft_cover *c, const draft_meeting *m) {
    aset_real cover = draft_soft_cover(m->footprint, m->u, m->v);
    if (!(cover > 0)) {
        return false;
    }
    if (c->n > 0 && m->away) { /* the surface's inside: the ray came through a seam, not past an edge */
        c->layers[c->n - 1].cover += c->left;
        c->left = 0;
    } else {
        add_layer(c, m, cover);
    }
    return !(c->left > 0);
}

bool aset_draft_cover_add(draft_cover *c, const draft_meeting *found, uint32_t n) {
    for (uint32_t i = 0; i < n; i++) {
        if (aset_draft_cover_lay(c, &found[i])) {
            return true;
        }
    }
    return false;
}

#endif
