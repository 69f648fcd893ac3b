/*
 * thumb.c - the command `aset thumb`: a small draft of every model in a folder, by the words that `aset render` takes.
 *
 * A broken file has its error line when its turn comes and a second mention at the end, where it is not lost among the rest;
 * it never keeps the others from being drawn.
 */
#include "tool.h"

#include <dirent.h>
#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define SIDE_DEFAULT 256u
#define SIDE_MOST 65535u
#define MEMORY_DEFAULT "1M"
#define LINE_COLUMNS 79

static const char help[] = "aset thumb FOLDER -o FOLDER: draws a thumbnail NAME.EXT.png of every model NAME.EXT in the "
                           "first folder: .obj, .stl, .ply\n"
                           "and .nff, but no name that begins with a dot, and nothing in folders within it.\n"
                           "\n"
                           "Each is a draft: aset render --approx all --approx-depth 0 --cells plane. A file that cannot be "
                           "drawn has its error line,\n"
                           "then the next one's turn comes; all such are listed at the end.\n"
                           "\n"
                           "  -o, --output FOLDER  where the thumbnails go; it is made if it is not there\n"
                           "  -s, --size N         pixels on a side, or WxH; default 256\n"
                           "      --memory BYTES   the arena for each (K = 1024, M); default 1M\n"
                           "      --transparent    pixels that show nothing are transparent, and there is no ground\n"
                           "  -q, --quiet          no progress, and no count at the end\n"
                           "  -h, --help           this text\n"
                           "\n"
                           "The exit status is 1 if any could not be drawn.\n";

typedef struct request {
    const char *folder, *output, *memory;
    char size[32]; /* WxH */
    bool transparent, quiet, wants_help;
} request;

/* Names of models, in alphabetical order. */
typedef struct list {
    char **names;
    size_t n, room;
} list;

/* ---- the folder ---- */

static bool is_model(const char *name) {
    static const char *const extensions[] = {".obj", ".stl", ".ply", ".nff"};
    for (size_t i = 0; i < sizeof extensions / sizeof extensions[0]; i++) {
        if (name[0] != '.' && tool_has_extension(name, extensions[i])) {
            return true;
        }
    }
    return false;
}

/* FOLDER/NAMEending in memory of its own; NULL after an error line. */
static char *make_path(const char *folder, const char *name, const char *ending) {
    size_t size = strlen(folder) + strlen(name) + strlen(ending) + 2;
    char *path = malloc(size);
    if (path == NULL) {
        tool_error(NULL, 0, "no memory for the names of files");
    } else {
        (void)snprintf(path, size, "%s/%s%s", folder, name, ending);
    }
    return path;
}

static bool list_add(list *l, const char *name) {
    if (l->n == l->room) {
        size_t room = 2 * l->room + 64;
        char **names = realloc(l->names, room * sizeof *names);
        if (names == NULL) {
            tool_error(NULL, 0, "no memory for the names of files");
            return false;
        }
        l->names = names;
        l->room = room;
    }
    l->names[l->n] = make_path(".", name, "");
    return l->names[l->n] != NULL && ++l->n > 0;
}

static void list_free(list *l) {
    for (size_t i = 0; i < l->n; i++) {
        free(l->names[i]);
    }
    free(l->names);
}

static int compare_names(const void *a, const void *b) {
    return strcmp(*(char *const *)a, *(char *const *)b);
}

/* A folder by the name of a model is none; whatever else has such a name is, so that it cannot be missing unnoticed. */
static bool is_folder(const char *folder, const char *name, bool *failed) {
    struct stat status;
    char *path = make_path(folder, name, "");
    *failed = path == NULL;
    bool is = path != NULL && stat(path, &status) == 0 && S_ISDIR(status.st_mode);
    free(path);
    return is;
}

static bool list_folder(list *l, const char *folder) {
    DIR *stream = opendir(folder);
    struct dirent *entry;
    bool failed = false;
    memset(l, 0, sizeof *l);
    if (stream == NULL) {
        tool_error(folder, 0, "cannot be opened as a folder: %s", strerror(errno));
        return false;
    }
    while (errno = 0, !failed && (entry = readdir(stream)) != NULL) {
        if (is_model(entry->d_name) && !is_folder(folder, entry->d_name, &failed) && !failed) {
            failed = !list_add(l, entry->d_name);
        }
    }
    if (!failed && errno != 0) {
        tool_error(folder, 0, "cannot be read: %s", strerror(errno));
        failed = true;
    }
    (void)closedir(stream);
    if (l->n > 0) {
        qsort(l->names, l->n, sizeof *l->names, compare_names);
    }
    return !failed;
}

static bool make_folder(const char *path) {
    struct stat status;
    if (mkdir(path, 0777) == 0 || (errno == EEXIST && stat(path, &status) == 0 && S_ISDIR(status.st_mode))) {
        return true;
    }
    tool_error(path, 0, "cannot be made as a folder: %s", strerror(errno));
    return false;
}

/* ---- progress ---- */

/*
 * "7/300 NAME", with the cursor back at its start: should an error line come, it is longer and covers this one. Not the bar
 * of progress.c, as there is one bar and render uses it.
 */
static int show(size_t number, size_t n, const char *name) {
    char line[LINE_COLUMNS + 1];
    int length = snprintf(line, sizeof line, "%zu/%zu %s", number, n, name);
    length = length < LINE_COLUMNS ? length : LINE_COLUMNS;
    for (int i = 0; i < length; i++) {
        line[i] = (unsigned char)line[i] < 0x20 || line[i] == 0x7f ? '?' : line[i];
    }
    (void)fprintf(stderr, "%s\r", line);
    (void)fflush(stderr);
    return length;
}

static void clear(int length) {
    (void)fprintf(stderr, "%*s\r", length, "");
    (void)fflush(stderr);
}

/* ---- drawing ---- */

static bool draw(const request *r, const char *name) {
    struct stat status;
    char *model = make_path(r->folder, name, ""), *picture = make_path(r->output, name, ".png");
    const char *words[] = {"render",  "--approx", "all",   "--approx-depth", "0",        "--cells", "plane", "--memory",
                           r->memory, "--size",   r->size, "--quiet",        "--output", picture,   NULL,    NULL,
                           NULL,      NULL};
    int n = (int)(sizeof words / sizeof words[0]) - 4;
    if (r->transparent) {
        words[n++] = "--transparent";
    }
    words[n++] = "--"; /* a folder's name may begin with a dash */
    words[n++] = model;
    bool drawn = false;
    if (model != NULL && picture != NULL && stat(model, &status) == 0 && !S_ISREG(status.st_mode)) {
        tool_error(model, 0, "not a regular file");
    } else if (model != NULL && picture != NULL) {
        optind = 1; /* what render expects; the scan before has come to its end, so it starts anew */
        drawn = command_render(n, (char **)words) == TOOL_DONE;
    }
    free(model);
    free(picture);
    return drawn;
}

static void tell_broken(const request *r, const list *l, const bool *broken, size_t n_broken) {
    tool_error(r->folder, 0, "%zu of %zu models could not be drawn:", n_broken, l->n);
    for (size_t i = 0; i < l->n; i++) {
        if (broken[i]) {
            tool_error(r->folder, 0, "no thumbnail of %s", l->names[i] + 2);
        }
    }
}

static int draw_all(const request *r, const list *l) {
    bool *broken = calloc(l->n > 0 ? l->n : 1, sizeof *broken);
    size_t n_broken = 0;
    bool shows = !r->quiet && isatty(STDERR_FILENO) == 1;
    if (broken == NULL) {
        tool_error(NULL, 0, "no memory for the names of files");
        return TOOL_FAILED;
    }
    for (size_t i = 0; i < l->n; i++) {
        const char *name = l->names[i] + 2;
        int length = shows ? show(i + 1, l->n, name) : 0;
        broken[i] = !draw(r, name);
        n_broken += broken[i];
        if (shows && !broken[i]) {
            clear(length);
        }
    }
    if (n_broken > 0) {
        tell_broken(r, l, broken, n_broken);
    }
    free(broken);
    if (!r->quiet) {
        (void)printf("%zu of %zu thumbnails drawn\n", l->n - n_broken, l->n);
        n_broken += tool_help("") != TOOL_DONE;
    }
    return n_broken > 0 ? TOOL_FAILED : TOOL_DONE;
}

static int thumb(const request *r) {
    list l;
    int status = TOOL_FAILED;
    if (list_folder(&l, r->folder) && make_folder(r->output)) {
        status = draw_all(r, &l);
    }
    list_free(&l);
    return status;
}

/* ---- words ---- */

enum { OPTION_MEMORY = 256, OPTION_TRANSPARENT };

static bool parse_size(request *r, const char *text) {
    uint32_t width, height;
    if (!tool_parse_size("thumb: --size", text, SIDE_MOST, &width, &height)) {
        return false;
    }
    (void)snprintf(r->size, sizeof r->size, "%" PRIu32 "x%" PRIu32, width, height);
    return true;
}

static bool parse_option(request *r, int option) {
    uint64_t bytes;
    switch (option) {
    case 'o': return tool_parse_output(optarg, &r->output);
    case 's': return parse_size(r, optarg);
    case OPTION_MEMORY: r->memory = optarg; return tool_parse_bytes("thumb: --memory", optarg, 0, SIZE_MAX / 2, &bytes);
    case OPTION_TRANSPARENT: r->transparent = true; return true;
    case 'q': r->quiet = true; return true;
    case 'h': r->wants_help = true; return true;
    default: return false;
    }
}

static bool parse_request(request *r, int argc, char **argv) {
    static const struct option longs[] = {
        {"output", required_argument, NULL, 'o'},
        {"size", required_argument, NULL, 's'},
        {"memory", required_argument, NULL, OPTION_MEMORY},
        {"transparent", no_argument, NULL, OPTION_TRANSPARENT},
        {"quiet", no_argument, NULL, 'q'},
        {"help", no_argument, NULL, 'h'},
        {NULL, 0, NULL, 0},
    };
    int option;
    memset(r, 0, sizeof *r);
    r->memory = MEMORY_DEFAULT;
    (void)snprintf(r->size, sizeof r->size, "%ux%u", SIDE_DEFAULT, SIDE_DEFAULT);
    while ((option = tool_option_next(argc, argv, "o:s:qh", longs)) != -1) {
        if (option == '?' || !parse_option(r, option)) {
            return false;
        }
        if (r->wants_help) {
            return true;
        }
    }
    if (argc - optind != 1) {
        tool_error(NULL, 0, "thumb: expected one folder of models, got %d words; aset thumb --help tells more",
                   argc - optind);
        return false;
    }
    if (r->output == NULL || r->output[0] == '\0' || argv[optind][0] == '\0') {
        tool_error(NULL, 0, "thumb: expected two folders: aset thumb FOLDER -o FOLDER");
        return false;
    }
    if (strcmp(r->output, "-") == 0) {
        tool_error(NULL, 0, "thumb: --output: thumbnails are files in a folder, expected its name (./- for one called -)");
        return false;
    }
    r->folder = argv[optind];
    return true;
}

int command_thumb(int argc, char **argv) {
    request r;
    if (!parse_request(&r, argc, argv)) {
        return TOOL_USAGE;
    }
    return r.wants_help ? tool_help(help) : thumb(&r);
}
