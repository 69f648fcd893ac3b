/*
 * bake.c - the command `aset bake`: a scene or model as a finished draft, in a binary file of little-endian words or as a C
 * header whose const array a program opens where it lies.
 *
 * Invariant: what is written are the draft's words and nothing else; both forms hold the same ones on every machine.
 */
#include "need.h"
#include "prepare.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#define NAME_BYTES 64
#define WORDS_A_LINE 8u
#define PREFIX "draft_"

static const char help[] =
    "aset bake MODEL -o FILE: makes a draft of a model (.obj, .stl, .ply) or scene (.nff) to keep: a program, or aset\n"
    "render FILE, draws any view of it. MODEL is read three times or so, more often the less memory there is for what its\n"
    "voxels hold, some dozens of times where it barely fits; no object of it is held.\n"
    "\n"
    "  -o, --output FILE     FILE.h: a C header with the draft as a const array. Any other name, .draft say, or - for\n"
    "                        standard output: the draft's 32-bit words, the lowest byte first\n"
    "      --grid N          divisions on every axis; or NXxNYxNZ, or auto (cubes, as many as fit); default auto\n"
    "      --memory BYTES    the arena (K = 1024, M): all of it is used to read MODEL less often, and not one byte more;\n"
    "                        default what the divisions rarely exceed in two or three readings, up to 8M\n"
    "  -s, --size WxH|N      models: a picture of that shape or wider shows all of it by its own view; default square\n"
    "      --up-axis y|z     models: the axis that points upwards; default z for .stl and .ply, y for .obj\n"
    "      --ground on|off   models: a ground under it; default on\n"
    "      --name NAME       of the array in a header; default FILE's own name as an identifier\n"
    "  -q, --quiet           do not print what was made\n"
    "  -h, --help            this text\n"
    "\n"
    "A header's array is opened by aset_draft_open(&draft, NAME, sizeof NAME / sizeof NAME[0], &arena, &why). The arena "
    "then\n"
    "needs NAME_STAGE_BYTES (in capital letters), which the header defines, and ASET_BYTES_SCRATCH(depth) to draw.\n";

/* What bake was asked for beside the settings. */
typedef struct request {
    settings settings;
    const char *model, *output, *name; /* name NULL: from output */
    bool has_memory, quiet, wants_help;
} request;

/* What was made; the words lie in block. */
typedef struct baked {
    void *block;
    aset_arena arena;
    aset_draft draft;
    aset_bake_report report;
} baked;

/* ---- names ---- */

static bool is_letter(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

static bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

/* Words of C, and names that a program with aset/aset.h has already. */
static bool is_taken(const char *name) {
    static const char words[] =
        " auto break case char const continue default do double else enum extern float for goto if inline "
        "int long register restrict return short signed sizeof static struct switch typedef union "
        "unsigned void volatile while "
        "asm bool catch class delete explicit export friend mutable namespace new operator private protected public template this throw "
        "try typename using virtual "
        "main true false NULL offsetof linux unix ";
    char word[NAME_BYTES + 2];
    int length = snprintf(word, sizeof word, " %s ", name);
    static const char *const endings[] = {"_t", "_MIN", "_MAX"}; /* of the headers' types and limits */
    for (size_t i = 0; i < sizeof endings / sizeof endings[0]; i++) {
        size_t n = strlen(name), end = strlen(endings[i]);
        if (n >= end && strcmp(name + n - end, endings[i]) == 0) {
            return true;
        }
    }
    return length < (int)sizeof word && (strstr(words, word) != NULL || strncmp(name, "aset_", 5) == 0 || strncmp(name, "ASET_", 5) == 0);
}

/* What may stand as a name with file scope: C reserves the names that begin with an underscore. */
static bool is_identifier(const char *name) {
    size_t length = 0;
    while (is_letter(name[length]) || is_digit(name[length])) {
        length++;
    }
    return length > 0 && name[length] == '\0' && length < NAME_BYTES && is_letter(name[0]) && name[0] != '_' &&
           !is_taken(name);
}

/* The file's own name without folder and .h, with _ for what no identifier has, and with a prefix where it is none yet. */
static void name_of_file(char name[NAME_BYTES], const char *path) {
    const char *slash = strrchr(path, '/'), *from = slash != NULL ? slash + 1 : path;
    size_t n = strlen(from) - 2, most = NAME_BYTES - sizeof PREFIX;
    n = n < most ? n : most;
    for (size_t i = 0; i < n; i++) {
        name[i] = is_letter(from[i]) || is_digit(from[i]) ? from[i] : '_';
    }
    name[n] = '\0';
    if (!is_identifier(name)) {
        memmove(name + sizeof PREFIX - 1, name, n + 1);
        memcpy(name, PREFIX, sizeof PREFIX - 1);
    }
}

static bool parse_name(request *r) {
    if (!is_identifier(optarg)) {
        tool_error(NULL, 0,
                   "--name: \"%s\" is no name for a C array, expected letters, digits and _ (%d at most), a letter first, and no word of C or "
                   "of the library",
                   optarg, NAME_BYTES - 1);
        return false;
    }
    r->name = optarg;
    return true;
}

/* ---- baking ---- */

static aset_status bake_passes(baked *b, const request *r, tool_source *source, bool *told) {
    tool_baking baking;
    aset_bake_options options;
    memset(&options, 0, sizeof options);
    memcpy(options.divisions, r->settings.grid, sizeof options.divisions);
    options.bytes = r->has_memory ? b->arena.size : 0; /* what was granted saves readings */
    aset_status status = tool_bake(&baking, source, &options, &b->arena);
    *told = baking.told || tool_bake_tell(source, status);
    b->draft = baking.draft;
    b->report = baking.report;
    return status;
}

/* In a block of this size, in the place of one before. *told: it has failed and said so. */
static aset_status bake_in(baked *b, const request *r, tool_source *source, uint64_t memory, bool *told) {
    free(b->block);
    b->block = malloc(memory > 0 ? (size_t)memory : 1);
    if (b->block == NULL || aset_arena_init(&b->arena, b->block, (size_t)memory) != ASET_OK) {
        tool_error(r->model, 0, "the machine has no block of %" PRIu64 " bytes", memory);
        *told = true;
        return ASET_ERR_ARGUMENT;
    }
    return bake_passes(b, r, source, told);
}

/* What a bake is tried with, in more memory than it had. */
typedef struct bake_trial {
    baked *baked;
    const request *request;
    tool_source *source;
} bake_trial;

static draft_trial try_bake(void *context, uint64_t memory) {
    bake_trial *of = context;
    draft_trial t = {ASET_ERR_ARGUMENT, false, 0, 0};
    t.status = bake_in(of->baked, of->request, of->source, memory, &t.told);
    t.missing = of->baked->arena.missing;
    t.peak = of->baked->arena.peak;
    return t;
}

/* False after an error line; block is to be freed either way. */
static bool bake(baked *b, const request *r) {
    tool_source source;
    bool told = false;
    memset(b, 0, sizeof *b);
    if (!tool_source_open(&source, r->model)) {
        return false;
    }
    tool_source_set(&source, &r->settings);
    aset_status status = bake_in(b, r, &source, r->settings.memory, &told);
    if (status == ASET_ERR_NOMEM) {
        bake_trial of = {b, r, &source};
        tool_tell_draft_need(try_bake, &of, r->model, r->settings.memory, b->arena.missing,
                             tool_need_is_quick(b->report.objects, r->settings.grid));
    } else if (status != ASET_OK && !told) {
        tool_error(r->model, 0, "%s", aset_status_text(status));
    }
    tool_source_close(&source);
    return status == ASET_OK;
}

/* ---- writing ---- */

/* A word at a time: the file's byte order is not the machine's. */
static bool write_words(tool_output *output, const aset_draft *draft) {
    uint8_t bytes[4096];
    size_t n = 0;
    bool done = true;
    for (size_t i = 0; i < draft->n_words && done; i++) {
        for (int k = 0; k < 4; k++) {
            bytes[n++] = (uint8_t)(draft->words[i] >> 8 * k);
        }
        if (n == sizeof bytes || i + 1 == draft->n_words) {
            done = tool_output_write(output, bytes, n);
            n = 0;
        }
    }
    return done;
}

static void print_capitals(FILE *f, const char *before, const char *name, const char *behind) {
    (void)fputs(before, f);
    for (; *name != '\0'; name++) {
        (void)fputc(*name >= 'a' && *name <= 'z' ? *name - 'a' + 'A' : *name, f);
    }
    (void)fputs(behind, f);
}

static void print_comment(FILE *f, const baked *b, const request *r) {
    const aset_draft *d = &b->draft;
    const aset_bake_report *report = &b->report;
    (void)fputs("/*\n * A draft of ", f);
    tool_print_in_comment(f, r->model);
    (void)fprintf(f,
                  ": %" PRIu64 " objects, of which %" PRIu32 " are kept exact.\n"
                  " * %" PRIu32 "x%" PRIu32 "x%" PRIu32 " divisions, %" PRIu32
                  " facets, %zu bytes. Made by `aset bake`, libaset " ASET_VERSION ".\n"
                  " */\n",
                  report->objects, report->kept, d->n[0], d->n[1], d->n[2], d->n_facets, d->n_words * sizeof(uint32_t));
}

/* What opening takes, by the counts of what was kept: exact for every width of aset_real. */
static void print_stage_bytes(FILE *f, const aset_counts *c, const char *name) {
    (void)fputs("/* What aset_draft_open takes from the arena: use it where aset/aset.h is included. */\n", f);
    print_capitals(f, "#define ", name, "_STAGE_BYTES ");
    (void)fprintf(f, "ASET_BYTES_SCENE(%" PRIu32 ", %" PRIu64 ", %" PRIu32 ", %" PRIu32 ")\n\n", c->objects, c->coordinates,
                  c->materials, c->lights);
}

static bool write_header(tool_output *output, const baked *b, const request *r, const char *name) {
    const aset_draft *d = &b->draft;
    FILE *f = output->stream;
    print_comment(f, b, r);
    print_capitals(f, "#ifndef ", name, "_H\n");
    print_capitals(f, "#define ", name, "_H\n\n#include <stdint.h>\n\n");
    print_stage_bytes(f, &d->stage.counts, name);
    (void)fprintf(f, "static const uint32_t %s[%zu] = {", name, d->n_words);
    for (size_t i = 0; i < d->n_words; i++) {
        (void)fprintf(f, "%s0x%08" PRIx32 "%s", i % WORDS_A_LINE == 0 ? "\n    " : " ", d->words[i],
                      i + 1 < d->n_words ? "," : "");
    }
    (void)fputs("};\n\n#endif\n", f);
    if (ferror(f) != 0) {
        tool_output_fail(output, 0);
    }
    return output->error == 0;
}

static void print_line(const baked *b) {
    const aset_draft *d = &b->draft;
    (void)printf("%zu bytes, %" PRIu32 "x%" PRIu32 "x%" PRIu32 " divisions, %" PRIu32 " facets, %" PRIu32
                 " kept objects, %" PRIu32 " passes\n",
                 d->n_words * sizeof(uint32_t), d->n[0], d->n[1], d->n[2], d->n_facets, b->report.kept, b->report.passes);
}

static int run(const request *r) {
    baked b;
    tool_output output;
    char name[NAME_BYTES];
    bool is_header = tool_has_extension(r->output, ".h");
    if (is_header && r->name == NULL) {
        name_of_file(name, r->output);
    }
    /* opened before the work, so that a place that can't be written is known at once */
    if (!tool_output_open(&output, r->output)) {
        return TOOL_FAILED;
    }
    bool done = bake(&b, r);
    if (done) {
        done = is_header ? write_header(&output, &b, r, r->name != NULL ? r->name : name) : write_words(&output, &b.draft);
        done = tool_output_close(&output) && done;
    } else {
        tool_output_abort(&output);
    }
    if (done && !r->quiet && strcmp(r->output, "-") != 0) {
        print_line(&b);
        done = tool_help("") == TOOL_DONE;
    }
    free(b.block);
    return done ? TOOL_DONE : TOOL_FAILED;
}

/* ---- words ---- */

enum { OPTION_GRID = 256, OPTION_MEMORY, OPTION_NAME };

static bool parse_option(request *r, int option) {
    settings *s = &r->settings;
    switch (option) {
    case 'o': return tool_parse_output(optarg, &r->output);
    case OPTION_GRID: return tool_parse_grid("--grid", optarg, ASET_BAKE_DIVISIONS_MAX, s->grid);
    case OPTION_MEMORY: r->has_memory = true; return tool_parse_bytes("--memory", optarg, 0, SIZE_MAX / 2, &s->memory);
    case OPTION_NAME: return parse_name(r);
    case 's': return tool_parse_size("--size", optarg, TOOL_DRAWN_MAX, &s->width, &s->height);
    case 'q': r->quiet = true; return true;
    case 'h': r->wants_help = true; return true;
    default: return settings_option(s, option);
    }
}

static bool parse_request(request *r, int argc, char **argv) {
    static const struct option longs[] = {
        {"output", required_argument, NULL, 'o'},
        {"grid", required_argument, NULL, OPTION_GRID},
        {"memory", required_argument, NULL, OPTION_MEMORY},
        {"size", required_argument, NULL, 's'},
        SETTINGS_MODEL_OPTIONS,
        {"name", required_argument, NULL, OPTION_NAME},
        {"quiet", no_argument, NULL, 'q'},
        {"help", no_argument, NULL, 'h'},
        {NULL, 0, NULL, 0},
    };
    int option;
    memset(r, 0, sizeof *r);
    r->settings = settings_default();
    while ((option = tool_option_next(argc, argv, "o:s:qh", longs)) != -1) {
        if (option == '?' || !parse_option(r, option)) {
            return false;
        }
        if (r->wants_help) {
            return true;
        }
    }
    if (argc - optind != 1) {
        tool_error(NULL, 0, "bake: expected one model, got %d words; aset bake --help tells more", argc - optind);
        return false;
    }
    r->model = argv[optind];
    if (r->output == NULL) {
        tool_error(NULL, 0, "bake: where should the draft go? -o FILE.draft, or -o FILE.h for a C header");
        return false;
    }
    if (r->name != NULL && !tool_has_extension(r->output, ".h")) {
        tool_error(NULL, 0, "--name: only a C header has a name in it, expected -o FILE.h");
        return false;
    }
    return true;
}

int command_bake(int argc, char **argv) {
    request r;
    if (!parse_request(&r, argc, argv)) {
        return TOOL_USAGE;
    }
    return r.wants_help ? tool_help(help) : run(&r);
}
