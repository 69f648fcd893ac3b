/* summary.h - reading what a cell remembers. */
#ifndef ASET_APPROX_SUMMARY_H
#define ASET_APPROX_SUMMARY_H

#include "aset/summary.h"
#include "base/bits.h"
#include "space/answers.h"

#if ASET_WITH_APPROXIMATION
extern const struct aset_answers aset_summary_answers;

/* The capacity taken for so many materials when 0 is asked for. */
uint32_t aset_summary_capacity_for(uint32_t n_materials);

static inline const aset_material *summary_texture(const aset_summary *summary, uint32_t cell) {
    return summary->textures + bits_get(summary->of_cell, summary->width, cell);
}
#endif

#endif
