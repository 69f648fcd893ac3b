/*
 * report.h - what a picture took, as text for people and as JSON for programs, written into the caller's buffer.
 */
#ifndef ASET_REPORT_H
#define ASET_REPORT_H

#include "aset/trace.h"

ASET_HEADER_BEGIN

/* What to report. Every pointer but tracer may be NULL, and its part is then left out of the text and 0 in the JSON. */
typedef struct aset_report {
    const aset_tracer *tracer;
    const aset_arena *arena;
    const aset_statistics *statistics;
    const char *method; /* aset_method_name of the space's method */
    const char *cells;  /* what a cell remembers: "flat" */
    double load_s, build_s, render_s; /* wall clock, measured by the caller: the library has no clock. What is not finite, below
                                         0 or over 10^12 is told as 0 */
    const aset_counts *counts; /* of the source, where the tracer's scene is not all of it: of a draft's, say */
} aset_report;

/*
 * Write at most size bytes into buffer, the closing 0 included, and return the length of the whole text without it: a result
 * of size or more means that it was cut off. buffer may be NULL for size 0. The text is about 1.5 kB, the JSON 1.2 kB.
 */
size_t aset_report_text(char *buffer, size_t size, const aset_report *report);
size_t aset_report_json(char *buffer, size_t size, const aset_report *report);

ASET_HEADER_END
#endif
