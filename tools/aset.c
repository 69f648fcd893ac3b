/*
 * aset.c - the program: finds the command that the first word names and hands it the rest.
 */
#include "tool.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

typedef struct tool_command {
    const char *name;
    const char *text; /* one line for --help */
    int (*run)(int argc, char **argv);
} tool_command;

static const tool_command commands[] = {
    {"render", "draws a scene", command_render},
    {"info", "counts, bounds and memory of a scene", command_info},
    {"scene", "writes a procedural scene as NFF", command_scene},
    {"compare", "the difference of two pictures", command_compare},
    {"tables", "the tables of the paper, measured beside published", command_tables},
    {"plan", "the best settings for a scene within a budget", command_plan},
    {"sheet", "pictures side by side on one, with labels", command_sheet},
    {"trade", "speed, memory and error of many settings, measured", command_trade},
    {"bake", "a model as a finished draft: a binary file or a C header", command_bake},
    {"join", "pieces of a picture, one under the other", command_join},
    {"thumb", "a thumbnail of every model in a folder", command_thumb},
};
#define N_COMMANDS (sizeof commands / sizeof commands[0])

static int print_help(void) {
    (void)fputs("aset: draws three-dimensional scenes by exact or approximate ray tracing, in a fixed amount of memory.\n"
                "\n"
                "  aset COMMAND ...      one of the commands below\n"
                "  aset SCENE OUT.png    short for: aset render SCENE -o OUT.png; for a model (.obj, .stl, .ply)\n"
                "                        a draft: with --approx all --approx-depth 0 --cells plane --memory 1M\n"
                "  aset COMMAND --help   all about a command\n"
                "  aset --version        the version\n"
                "\n"
                "Commands:\n",
                stdout);
    for (size_t i = 0; i < N_COMMANDS; i++) {
        (void)printf("  %-10s  %s\n", commands[i].name, commands[i].text);
    }
    return tool_help("\n"
                     "The file - is standard output. Files are written whole or not at all.\n"
                     "Exit status: 0 done, 1 the work failed (a bad file, too little memory), 2 the words are wrong.\n");
}

static bool is_scene(const char *word) {
    struct stat status;
    if (stat(word, &status) == 0 && !S_ISDIR(status.st_mode)) {
        return true;
    }
    return tool_kind_of(word) != TOOL_KIND_NONE;
}

static bool is_model(const char *word) {
    tool_kind kind = tool_kind_of(word);
    return kind == TOOL_KIND_OBJ || kind == TOOL_KIND_STL || kind == TOOL_KIND_PLY;
}

/* SCENE OUT [options], in argv[0] and on, as render SCENE -o OUT [options]: of a model a draft. */
static int run_short(int argc, char **argv) {
    if (argc < 2 || (argv[1][0] == '-' && argv[1][1] != '\0')) {
        tool_error(NULL, 0, "%s: where should the picture go? It comes second: aset SCENE OUT.png [options], or aset render --help", argv[0]);
        return TOOL_USAGE;
    }
    char **words = malloc(((size_t)argc + 3u) * sizeof *words); /* the user's, and render, -o and NULL */
    if (words == NULL) {
        tool_error(NULL, 0, "no memory for the command's words");
        return TOOL_FAILED;
    }
    int n = 0;
    words[n++] = (char *)"render";
    words[n++] = argv[0];
    words[n++] = (char *)"-o";
    for (int i = 1; i < argc; i++) {
        words[n++] = argv[i];
    }
    words[n] = NULL;
    int status = is_model(argv[0]) ? command_render_draft(n, words) : command_render(n, words);
    free(words);
    return status;
}

static int run(int argc, char **argv) {
    if (argc < 2) {
        tool_error(NULL, 0, "a command or a scene is missing; aset --help lists the commands");
        return TOOL_USAGE;
    }
    for (size_t i = 0; i < N_COMMANDS; i++) {
        if (strcmp(argv[1], commands[i].name) == 0) {
            return commands[i].run(argc - 1, argv + 1);
        }
    }
    if (strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0) {
        return print_help();
    }
    if (strcmp(argv[1], "--version") == 0) {
        return tool_help("aset " ASET_VERSION "\n");
    }
    if (strcmp(argv[1], "-") == 0 || is_scene(argv[1])) {
        return run_short(argc - 1, argv + 1);
    }
    tool_error(NULL, 0, "there is no command and no file \"%s\"; aset --help lists the commands", argv[1]);
    return TOOL_USAGE;
}

int main(int argc, char **argv) {
    tool_output_guard();
    return run(argc, argv);
}
