/* need.h - how much memory a draft needs that had too little. */
#ifndef ASET_TOOLS_NEED_H
#define ASET_TOOLS_NEED_H

#include "aset/aset.h"

/* A draft made in so much memory, to see whether it is enough. told: an error line was. */
typedef struct draft_trial {
    aset_status status;
    bool told;
    size_t missing, peak;
} draft_trial;

typedef draft_trial draft_try(void *context, uint64_t memory);

/* Do trials take no time worth speaking of, with so many objects and divisions (0: automatic)? */
bool tool_need_is_quick(uint64_t objects, const uint32_t divisions[3]);

/* Between memory that is too little and such as is enough: the least that is, to an eighth. */
uint64_t tool_narrow_draft_need(draft_try *attempt, void *context, uint64_t least, uint64_t enough);

/*
 * The error line of a draft of what lies at path that had too little memory, by which missing bytes were missing: the need as trials
 * find it, of few passes over the source, or if they are quick of as many as it takes, to an eighth.
 */
void tool_tell_draft_need(draft_try *attempt, void *context, const char *path, uint64_t has, size_t missing, bool is_quick);

#endif
