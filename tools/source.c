/* source.c - scene files, by their names' endings, as sources of entities that can be read twice. */
#include "aset/load.h"

#include "prepare.h"

#include <errno.h>
#include <string.h>

static ptrdiff_t read_stream(void *context, void *buffer, size_t size) {
    FILE *stream = context;
    size_t n = fread(buffer, 1, size, stream);
    return n == 0 && ferror(stream) ? -1 : (ptrdiff_t)n;
}

/* Standard input, or whatever else cannot be read twice, goes through a temporary file. */
static FILE *make_seekable(const char *path, FILE *stream) {
    char buffer[16384];
    size_t n;
    FILE *copy = tmpfile();
    if (copy == NULL) {
        tool_error(path, 0, "no temporary file to keep the input in: %s", strerror(errno));
        return NULL;
    }
    while ((n = fread(buffer, 1, sizeof buffer, stream)) > 0) {
        if (fwrite(buffer, 1, n, copy) != n) {
            tool_error(path, 0, "the temporary file for the input cannot be written: %s", strerror(errno));
            (void)fclose(copy);
            return NULL;
        }
    }
    if (ferror(stream)) {
        tool_error(path, 0, "cannot be read: %s", strerror(errno));
        (void)fclose(copy);
        return NULL;
    }
    return copy;
}

bool tool_source_open(tool_source *source, const char *path) {
    source->path = path;
    source->one_sided_opaque = false;
    bool is_input = strcmp(path, "-") == 0;
    if (!is_input && !tool_has_extension(path, ".nff")) {
        tool_error(path, 0, "not a scene by its name, expected one that ends in .nff");
        return false;
    }
    source->stream = is_input ? stdin : fopen(path, "rb");
    if (source->stream == NULL) {
        tool_error(path, 0, "cannot be opened: %s", strerror(errno));
        return false;
    }
    if (fseek(source->stream, 0, SEEK_SET) != 0) {
        FILE *copy = make_seekable(path, source->stream);
        if (!is_input) {
            (void)fclose(source->stream);
        }
        source->stream = copy;
    }
    return source->stream != NULL;
}

bool tool_source_read(tool_source *source, const aset_sink *sink) {
    aset_load_report report;
    aset_load_options options;
    memset(&options, 0, sizeof options);
    options.one_sided_opaque = source->one_sided_opaque;
    rewind(source->stream);
    aset_status status = aset_load_nff(sink, read_stream, source->stream, &options, &report);
    if (status == ASET_OK) {
        return true;
    }
    if (status == ASET_ERR_READ) {
        tool_error(source->path, 0, "cannot be read: %s", strerror(errno));
        return false;
    }
    bool token = report.token[0] != 0, expected = report.expected != NULL;
    tool_error(source->path, report.line, "%s%s%s%s%s%s", report.what, token ? ": \"" : "", token ? report.token : "",
               token ? "\"" : "", expected ? ", expected " : "", expected ? report.expected : "");
    return false;
}

void tool_source_close(tool_source *source) {
    if (source->stream != NULL && source->stream != stdin) {
        (void)fclose(source->stream);
    }
    source->stream = NULL;
}
