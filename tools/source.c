/*
 * source.c - scene files and models, of whatever kind (kind.c), as sources of entities that can be read again.
 *
 * A model's first reading passes through a sink that follows its box, from which the stage is made. Vertices of OBJ and PLY
 * have a window in memory; when there are more they go to a temporary file.
 */
#include "aset/load.h"

#include "prepare.h"

#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* Of vertices: some 87000 points in float. Faces that jump about in a smaller one cost a read of a page each time. */
#define WINDOW_BYTES 1048576u
#define N_MATERIALS 1024u /* 60 kB: a name that is not kept costs a reading of the library */

/* ---- bytes ---- */

static ptrdiff_t read_stream(void *context, void *buffer, size_t size) {
    FILE *stream = context;
    size_t n = fread(buffer, 1, size, stream);
    return n == 0 && ferror(stream) ? -1 : (ptrdiff_t)n;
}

/* 0 if it is no file that has a size. */
static uint64_t size_of(FILE *stream) {
    struct stat status;
    return fstat(fileno(stream), &status) == 0 && S_ISREG(status.st_mode) ? (uint64_t)status.st_size : 0;
}

/* ---- the spill file of vertices ---- */

/* Made when the first vertices do not fit in the window. */
typedef struct spill {
    FILE *file;
    int error; /* errno of what failed */
} spill;

static bool spill_write(void *context, uint64_t offset, const void *bytes, size_t size) {
    spill *s = context;
    const char *from = bytes;
    if (s->file == NULL) {
        s->file = tmpfile();
    }
    while (s->file != NULL && size > 0) {
        ssize_t n = pwrite(fileno(s->file), from, size, (off_t)offset);
        if (n <= 0) {
            break;
        }
        from += n;
        offset += (uint64_t)n;
        size -= (size_t)n;
    }
    s->error = errno;
    return s->file != NULL && size == 0;
}

static bool spill_read(void *context, uint64_t offset, void *bytes, size_t size) {
    spill *s = context;
    char *to = bytes;
    while (s->file != NULL && size > 0) {
        ssize_t n = pread(fileno(s->file), to, size, (off_t)offset);
        if (n <= 0) {
            break;
        }
        to += n;
        offset += (uint64_t)n;
        size -= (size_t)n;
    }
    s->error = errno;
    return s->file != NULL && size == 0;
}

/* ---- material libraries ---- */

typedef struct shelf {
    const char *path; /* of the OBJ, in whose folder the libraries lie */
    char missing[64]; /* the last name that could not be opened, and why */
    int error;
    bool is_taken; /* an output would replace one, which has been told */
} shelf;

/* Only what is a plain file: a folder cannot be read, and a device may never end. */
static bool open_library(void *context, const char *name, aset_read *read, void **stream) {
    shelf *s = context;
    struct stat status;
    const char *slash = name[0] == '/' ? NULL : strrchr(s->path, '/');
    size_t folder = slash == NULL ? 0 : (size_t)(slash - s->path) + 1, length = strlen(name);
    char *path = malloc(folder + length + 1);
    FILE *file = NULL;
    errno = ENOMEM;
    if (path != NULL) {
        memcpy(path, s->path, folder);
        memcpy(path + folder, name, length + 1);
        if (stat(path, &status) == 0) {
            errno = S_ISDIR(status.st_mode) ? EISDIR : EINVAL;
            file = S_ISREG(status.st_mode) ? fopen(path, "rb") : NULL;
        }
    }
    if (file != NULL && !tool_input_note(file, path)) {
        (void)fclose(file);
        file = NULL;
        errno = EBUSY;
        s->is_taken = true;
    }
    if (file == NULL) {
        s->error = errno;
        (void)snprintf(s->missing, sizeof s->missing, "%s", name);
    }
    free(path);
    *read = read_stream;
    *stream = file;
    return file != NULL;
}

static void close_library(void *context, void *stream) {
    (void)context;
    (void)fclose(stream);
}

/* ---- the box ---- */

/* Hands on what it gets and follows the box of the polygons, of which models consist. */
typedef struct fence {
    const aset_sink *inner;
    aset_vec3 low, high, polygon_low, polygon_high;
    bool is_first, is_first_point;
} fence;

static aset_status fence_material(void *context, const aset_material *material) {
    const aset_sink *inner = ((fence *)context)->inner;
    return inner->material(inner->context, material);
}

#if ASET_WITH_POLYGONS
static void enclose(aset_vec3 *low, aset_vec3 *high, const aset_vec3 *from, const aset_vec3 *to, bool is_first) {
    low->x = is_first || from->x < low->x ? from->x : low->x;
    low->y = is_first || from->y < low->y ? from->y : low->y;
    low->z = is_first || from->z < low->z ? from->z : low->z;
    high->x = is_first || to->x > high->x ? to->x : high->x;
    high->y = is_first || to->y > high->y ? to->y : high->y;
    high->z = is_first || to->z > high->z ? to->z : high->z;
}

static aset_status fence_begin(void *context, uint32_t n_points, bool with_normals) {
    fence *f = context;
    f->is_first_point = true;
    return f->inner->polygon_begin(f->inner->context, n_points, with_normals);
}

static aset_status fence_point(void *context, const aset_vec3 *at, const aset_vec3 *normal) {
    fence *f = context;
    enclose(&f->polygon_low, &f->polygon_high, at, at, f->is_first_point);
    f->is_first_point = false;
    return f->inner->polygon_point(f->inner->context, at, normal);
}

static aset_status fence_end(void *context) {
    fence *f = context;
    aset_status status = f->inner->polygon_end(f->inner->context);
    if (status == ASET_OK) {
        enclose(&f->low, &f->high, &f->polygon_low, &f->polygon_high, f->is_first);
        f->is_first = false;
    }
    return status;
}
#endif

static aset_sink fence_sink(fence *f, const aset_sink *inner) {
    aset_sink sink = *inner;
    memset(f, 0, sizeof *f);
    f->inner = inner;
    f->is_first = true;
    sink.context = f;
    sink.material = fence_material;
#if ASET_WITH_POLYGONS
    sink.polygon_begin = fence_begin;
    sink.polygon_point = fence_point;
    sink.polygon_end = fence_end;
#endif
    return sink; /* a model has nothing else to say */
}

/* ---- words ---- */

static void tell_error(const tool_source *source, const aset_load_report *report, aset_status status, int spill_error) {
    bool in_library = report->library[0] != 0;
    if (status == ASET_ERR_READ && ferror(source->stream)) {
        tool_error(source->path, 0, "cannot be read: %s", strerror(errno));
        return;
    }
    const char *what = report->what != NULL ? report->what : aset_status_text(status);
    bool token = report->token[0] != 0, expected = report->expected != NULL, spilt = spill_error != 0 && !in_library;
    tool_error(in_library ? report->library : source->path, report->line, "%s%s%s%s%s%s%s%s", what, token ? ": \"" : "",
               token ? report->token : "", token ? "\"" : "", expected ? ", expected " : "",
               expected ? report->expected : "",
               status == ASET_ERR_READ && spilt ? ": " : "", status == ASET_ERR_READ && spilt ? strerror(spill_error) : "");
}

/* What is left out of a picture that is drawn all the same. */
static void tell_notes(const tool_source *source, const aset_load_report *report, const shelf *libraries) {
    if (report->skipped > 0) {
        tool_error(source->path, 0,
                   "%" PRIu64 " of %" PRIu64 " facets left out: fewer than 3 points, or a coordinate that is not finite "
                   "or too large",
                   report->skipped, report->skipped + report->triangles);
    }
    if (report->unknown_materials > 0 && libraries->missing[0] != 0) {
        tool_error(source->path, 0, "%" PRIu64 " times usemtl names no known material, the default one stands in: %s: %s",
                   report->unknown_materials, libraries->missing, strerror(libraries->error));
    } else if (report->unknown_materials > 0) {
        tool_error(source->path, 0, "%" PRIu64 " times usemtl names no material of any library, the default one stands in",
                   report->unknown_materials);
    }
}

/* ---- reading ---- */

static bool load_with(tool_source *source, const aset_sink *sink, void *window) {
    static aset_status (*const loads[])(const aset_sink *, aset_read, void *, const aset_load_options *,
                                        aset_load_report *) = {aset_load_nff, aset_load_obj, aset_load_stl, aset_load_ply};
    aset_named_material materials[N_MATERIALS];
    spill file = {NULL, 0};
    shelf libraries = {source->path, "", 0, false};
    aset_vertex_store store = {window, window != NULL ? WINDOW_BYTES : 0, spill_write, spill_read, &file};
    aset_library library = {open_library, close_library, &libraries};
    aset_material material = aset_stage_material();
    aset_load_report report;
    aset_load_options options;
    memset(&options, 0, sizeof options);
    options.one_sided_opaque = source->one_sided_opaque;
    options.smooth = source->smooth;
    options.size = source->size;
    options.material = &material;
    options.vertices = &store;
    options.library = &library;
    options.materials = materials;
    options.n_materials = N_MATERIALS;
    rewind(source->stream);
    aset_status status = loads[source->format](sink, read_stream, source->stream, &options, &report);
    if (status != ASET_OK) {
        tell_error(source, &report, status, file.error);
    } else if (source->format != TOOL_NFF && !source->is_measured) {
        source->n_vertices = report.vertices;
        source->n_skipped = report.skipped;
        tell_notes(source, &report, &libraries);
    }
    if (file.file != NULL) {
        (void)fclose(file.file);
    }
    return status == ASET_OK && !libraries.is_taken;
}

static bool load(tool_source *source, const aset_sink *sink) {
    void *window = source->format == TOOL_OBJ || source->format == TOOL_PLY ? malloc(WINDOW_BYTES) : NULL;
    if (window == NULL && (source->format == TOOL_OBJ || source->format == TOOL_PLY)) {
        tool_error(source->path, 0, "the machine has no memory for %u bytes of vertices", WINDOW_BYTES);
        return false;
    }
    bool done = load_with(source, sink, window);
    free(window);
    return done;
}

static bool read_model(tool_source *source, const aset_sink *sink) {
    if (!source->is_measured) {
        fence f;
        aset_sink measuring = fence_sink(&f, sink);
        if (!load(source, &measuring)) {
            return false;
        }
        source->low = f.low;
        source->high = f.high;
        source->is_measured = true;
    } else if (!load(source, sink)) {
        return false;
    }
    aset_status status = aset_stage_emit(sink, &source->low, &source->high, &source->stage);
    if (status == ASET_ERR_GEOMETRY) {
        tool_error(source->path, 0, "the model is too large for a view of it, expected coordinates below a twentieth of the "
                                    "largest possible");
    } else if (status != ASET_OK) {
        tool_error(source->path, 0, "its view, lights and ground: %s", aset_status_text(status));
    }
    return status == ASET_OK;
}

bool tool_source_read(tool_source *source, const aset_sink *sink) {
    return source->format == TOOL_NFF ? load(source, sink) : read_model(source, sink);
}

void tool_source_set(tool_source *source, const settings *s) {
    uint32_t width = s->width > 0 ? s->width : 512, height = s->height > 0 ? s->height : 512;
    source->smooth = s->smooth;
    source->stage.up = s->has_up_axis ? s->up_axis : source->stage.up;
    source->stage.no_ground = s->has_ground ? !s->ground : s->transparent;
    source->stage.aspect = (aset_real)width / (aset_real)height;
}

/* The SPD's rule: opaque surfaces are one-sided, but not in a scene with patches (the teapot). */
void tool_source_rules(tool_source *source, const settings *s, const aset_counts *counts) {
    source->one_sided_opaque = s->spd_rules && counts->patches == 0;
}

bool tool_source_open(tool_source *source, const char *path) {
    tool_kind kind = tool_kind_of(path);
    memset(source, 0, sizeof *source);
    source->path = path;
    if (kind == TOOL_KIND_NONE && access(path, R_OK) != 0) {
        tool_error(path, 0, "cannot be opened: %s", strerror(errno));
        return false;
    }
    struct stat status;
    if (kind == TOOL_KIND_NONE && stat(path, &status) == 0 && S_ISDIR(status.st_mode)) {
        tool_error(path, 0, "cannot be opened: %s", strerror(EISDIR));
        return false;
    }
    if (kind == TOOL_KIND_NONE) {
        tool_error(path, 0, "neither a scene by its name nor a model or draft by its first bytes, expected one that ends in .nff, "
                            ".obj, .stl, .ply or .draft");
        return false;
    }
    if (kind == TOOL_KIND_DRAFT) {
        tool_error(path, 0, "a baked draft, which aset render draws; expected the scene or model that it was baked from");
        return false;
    }
    source->format = (tool_format)(kind - TOOL_KIND_NFF);
    source->stage.up = source->format == TOOL_OBJ ? ASET_UP_Y : ASET_UP_Z;
    source->stream = tool_input_open(path);
    source->size = source->stream != NULL ? size_of(source->stream) : 0;
    return source->stream != NULL;
}

void tool_source_close(tool_source *source) {
    tool_input_close(source->stream);
    source->stream = NULL;
}
