/* plan_draft.h - drafts as a plan tries them: made, timed, and how little memory is enough. */
#ifndef ASET_TOOLS_PLAN_DRAFT_H
#define ASET_TOOLS_PLAN_DRAFT_H

#include "plan.h"

/* Everything for the picture in the wish's memory; grid 0: automatic. As prepare_again, p is to be freed whatever comes. */
aset_status plan_draft_make(prepared *p, const measured *m, const plan_wish *wish, const plan_setting *s, bool *told);
/* What the whole picture takes to be drawn, in seconds; below 0: it cannot be, which was told. */
double plan_draft_seconds(const prepared *p, const plan_wish *wish);
/* Memory that is enough for a draft that was made in s->bytes: if trials are quick the least, to an eighth. */
size_t plan_draft_need(const measured *m, const plan_wish *wish, const plan_setting *s);

#endif
