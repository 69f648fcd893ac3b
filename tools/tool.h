/*
 * tool.h - what the commands of the program `aset` share: exit statuses, error lines, option words, output files,
 * pictures, progress, and the NFF writer.
 *
 * A function that fails has printed its one error line already, so a caller only passes the failure on. Nothing here
 * is safe to call from two threads at once; threads of a command hand their rows to the one that writes.
 */
#ifndef ASET_TOOL_H
#define ASET_TOOL_H

#include "aset/scene.h"

#if !ASET_WITH_REFRACTION || !ASET_WITH_APPROXIMATION || !ASET_WITH_DRAFTS
#error "the tool aset needs refraction, the approximation and drafts: with other switches make the library alone (make install-lib)"
#endif

#include <getopt.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#if defined(__GNUC__)
#define TOOL_PRINTF(text, first) __attribute__((__format__(__printf__, text, first)))
#else
#define TOOL_PRINTF(text, first)
#endif

/* --- aset.c: the table of commands --- */

/* What main and every command return. */
enum { TOOL_DONE = 0, TOOL_FAILED = 1, TOOL_USAGE = 2 };

/* argv[0] is the command's own name ("render"), argv[argc] is NULL; getopt's optind is 1 on entry. */
int command_render(int argc, char **argv);
/* The short form's for a model: a draft, with --approx all --approx-depth 0 --cells plane --memory 1M, where the words say nothing else. */
int command_render_draft(int argc, char **argv);
int command_info(int argc, char **argv);
int command_scene(int argc, char **argv);
int command_compare(int argc, char **argv);
int command_tables(int argc, char **argv);
int command_plan(int argc, char **argv);
int command_sheet(int argc, char **argv);
int command_trade(int argc, char **argv);
int command_bake(int argc, char **argv);
int command_join(int argc, char **argv);
int command_thumb(int argc, char **argv);

/* --- error.c --- */

/*
 * One line on standard error: "aset: FILE:LINE: message". file NULL leaves both out, line 0 the line; the message has
 * no full stop and no line end. Unprintable bytes (a file's name may hold any) come out as '?'. Clears a progress bar
 * first.
 */
void tool_error(const char *file, unsigned long line, const char *format, ...) TOOL_PRINTF(3, 4);

/* Prints a help text on standard output: TOOL_DONE, or TOOL_FAILED where it could not be written. */
int tool_help(const char *text);

/* --- options.c: the words of a command line --- */

/*
 * The next option like getopt_long, with errors in our own words. shorts is as for getopt without a leading ':'
 * ("hm:o:"), longs ends with a row of zeros. The option's val; -1 behind the last one (the operands are then
 * argv[optind] and on); '?' after an error line, upon which a command returns TOOL_USAGE. The value is in optarg.
 */
int tool_option_next(int argc, char **argv, const char *shorts, const struct option *longs);

/* Takes where the output goes, unless it was told before (*path is not NULL): false after an error line that has both. */
bool tool_parse_output(const char *text, const char **path);

/*
 * Readers of one option's value. option is the name to say in the error line ("--size"), text the value, NULL not
 * allowed. Each is true and fills its result, or prints what is wrong and what was expected, leaves the result as it
 * was, and is false (a command then returns TOOL_USAGE). Nothing may follow the value, and no blanks stand in it.
 */
typedef struct tool_word {
    const char *name;
    unsigned value;
} tool_word;

/* A whole number from low to high, decimal digits only. */
bool tool_parse_unsigned(const char *option, const char *text, uint64_t low, uint64_t high, uint64_t *value);
/* The same for the many 32-bit counts. */
bool tool_parse_count(const char *option, const char *text, uint32_t low, uint32_t high, uint32_t *value);
/* A number of bytes: digits, then nothing, K (1024), M (1024 K) or G (1024 M), in either case. */
bool tool_parse_bytes(const char *option, const char *text, uint64_t low, uint64_t high, uint64_t *value);
/* A finite decimal number from low to high. */
bool tool_parse_real(const char *option, const char *text, double low, double high, double *value);
/* WxH, or N for both, from 1 to high and TOOL_PIXELS_MAX pixels at most. */
bool tool_parse_size(const char *option, const char *text, uint32_t high, uint32_t *width, uint32_t *height);
/* N, NXxNYxNZ or auto; N stands for all three axes, auto gives 0 on all. Each from 1 to high. */
bool tool_parse_grid(const char *option, const char *text, uint32_t high, uint32_t grid[3]);
/* X,Y,Z, finite in aset_real. */
bool tool_parse_vec3(const char *option, const char *text, aset_vec3 *value);
/* A:B with 0 <= A < B <= high: A and those after it, but not B. */
bool tool_parse_range(const char *option, const char *text, uint32_t high, uint32_t *first, uint32_t *end);
/* One of the words; words ends with a NULL name, which also ends the list that the error line gives. */
bool tool_parse_word(const char *option, const char *text, const tool_word *words, unsigned *value);
/* Words with commas between them: the values of all, or-ed; one of value 0 stands alone. Repeats do no harm. */
bool tool_parse_words(const char *option, const char *text, const tool_word *words, unsigned *mask);
/* "on" or "off". */
bool tool_parse_switch(const char *option, const char *text, bool *value);

/* True if path ends in the extension, given with its dot (".png"), in either case. */
bool tool_has_extension(const char *path, const char *extension);

/* --- output.c: files written whole or not at all --- */

/*
 * An output file. Bytes go to a temporary file in the destination's own directory, which takes the destination's name
 * at the end; a failure, SIGINT, SIGTERM or SIGHUP removes it. "-" is standard output, and what is there already but
 * is not a regular file (/dev/null, a fifo) is written directly. A symbolic link is followed; an existing file keeps
 * its mode.
 */
typedef struct tool_output {
    FILE *stream;     /* for stdio; NULL unless open */
    const char *path; /* as given; must stay valid while open */
    int error;        /* errno of the first write that failed, which has been told; 0: none */
    int slot;         /* of the temporary's names, -1: written directly */
} tool_output;

/* For main, once: signals remove the temporaries, a closed pipe or a file limit is a failed write and not the end. */
void tool_output_guard(void);

/* Refuses, besides what cannot be written, files that tool_input_note was told of and where another open output goes. */
bool tool_output_open(tool_output *output, const char *path);
/* Of a scene, model or draft that was opened for reading: no output shall replace it. False after an error line: one is about to. */
bool tool_input_note(FILE *stream, const char *path);
/* Writes size bytes. False after an error line, now or at an earlier write. */
bool tool_output_write(tool_output *output, const void *bytes, size_t size);
/*
 * Tells, once, that writing failed for the reason error (an errno); close then fails. For who writes to stream
 * itself.
 */
void tool_output_fail(tool_output *output, int error);
/* Ends the file and gives it its name. False after an error line: no new file then, and an old one is untouched. */
bool tool_output_close(tool_output *output);
/* Ends it without a file and without a word. Does nothing if it is not open. */
void tool_output_abort(tool_output *output);
/* A path, or whatever text, so that nothing in it can end the C comment that it stands in. */
void tool_print_in_comment(FILE *stream, const char *text);
/* The words for a path in an error line: "standard output" for "-". */
const char *tool_output_name(const char *path);

/* --- input.c --- */

/*
 * A file, - for standard input, from its start, to be read as often as wanted. NULL after an error line, or where standard input has
 * failed and said so.
 */
FILE *tool_input_open(const char *path);
void tool_input_close(FILE *input);

/* --- png.c: pictures as rows and as a whole --- */

/* Of a picture that is read or joined, and of one that is drawn. */
#define TOOL_SIDE_MAX 1000000u
#define TOOL_DRAWN_MAX 65535u
#define TOOL_PIXELS_MAX (1u << 28)

typedef struct tool_picture tool_picture;

/*
 * True if pictures can be written to path (.png, .ppm, or "-", which is PNG); else an error line. For checks before
 * the work.
 */
bool tool_picture_path_ok(const char *path);

/*
 * Begins a picture of 8 bits for each of 1 (grey), 3 (RGB) or 4 (RGBA) channels, by path's extension .png or .ppm
 * (grey is written as RGB there, RGBA refused); "-" is PNG. One row is held, not the picture. NULL after an error
 * line. The same pixels give the same bytes.
 */
tool_picture *tool_picture_open(const char *path, uint32_t width, uint32_t height, uint32_t channels);
/* The same for a PNG, whatever path ends in. */
tool_picture *tool_picture_open_png(const char *path, uint32_t width, uint32_t height, uint32_t channels);
/* The next row from the top, width * channels bytes. False after an error line. */
bool tool_picture_row(tool_picture *picture, const uint8_t *row);
/*
 * Ends the file and frees picture. False after an error line (one was printed already if a row failed); no file then.
 */
bool tool_picture_close(tool_picture *picture);
/* Frees picture and leaves no file. NULL is allowed. */
void tool_picture_abort(tool_picture *picture);

/* A picture in memory: width * height pixels of R, G, B, the top row first. */
typedef struct tool_image {
    uint8_t *rgb;
    uint32_t width, height;
} tool_image;

/*
 * Reads a PNG of any kind or a binary PPM (P6); the bytes decide, not the name. Grey and palettes become RGB, other
 * depths 8 bits, transparency is laid over black, gamma and profiles are not applied. Refuses more than
 * TOOL_PIXELS_MAX pixels. False after an error line. tool_image_free gives the memory back.
 */
bool tool_image_read(tool_image *image, const char *path);
void tool_image_free(tool_image *image);

/* --- kind.c: what a file is --- */

typedef enum tool_kind { TOOL_KIND_NONE, TOOL_KIND_NFF, TOOL_KIND_OBJ, TOOL_KIND_STL, TOOL_KIND_PLY, TOOL_KIND_DRAFT } tool_kind;

/*
 * By the name's ending, in either case; a plain file whose name has none of these five is opened, and its first bytes tell
 * whether it is a model or a draft. NONE: neither does. No error line.
 */
tool_kind tool_kind_of(const char *path);
bool tool_is_draft(const char *path); /* standard input is none */

/* --- progress.c --- */

/* Seconds from some fixed moment, by the monotonic clock. */
double tool_seconds(void);

/*
 * A bar on standard error, if that is a terminal and quiet is false: percent, what of it is done ("rows 12/512"),
 * time left. Redrawn at most ten times a second, so that calling step for each row costs nothing. There is one at a
 * time.
 */
void tool_progress_start(const char *unit, uint64_t total, bool quiet);
void tool_progress_step(uint64_t done);
/* Clears the line. Also without a start. */
void tool_progress_end(void);
/* Clears the line until the next step: before other words go to the terminal. */
void tool_progress_hide(void);

/* --- nff.c: entities as Neutral File Format --- */

/*
 * Writes what a source emits, numbers with six digits (%g) like the SPD programs. Background and view are held back
 * until the first light, material or object, so that the file opens with b and v in this order, whatever the
 * source's; a view of no resolution is written as 512 512.
 */
typedef struct tool_nff {
    FILE *stream;
    double hither; /* for the view block, which needs one; an aset_view has none */
    int error;     /* errno of the write that failed */
    aset_colour background;
    aset_view view;
    bool background_held, view_held, view_written, material_written, with_normals;
    uint32_t n_left; /* points still to come of the polygon in progress */
} tool_nff;

/*
 * A sink whose functions return ASET_ERR_STOPPED when a write failed (error says why), ASET_ERR_GEOMETRY for a number
 * that is not finite, ASET_ERR_ARGUMENT for an object before a view and a material or a wrong count of points (no
 * reader would take such a file), and ASET_ERR_UNSUPPORTED for what NFF cannot say: directional lights, orthographic
 * views, one-sided materials.
 */
aset_sink tool_nff_sink(tool_nff *nff, FILE *stream, double hither);
/* Writes what is still held back, when the source has ended. ASET_OK, or as the sink. */
aset_status tool_nff_end(tool_nff *nff);

#endif
