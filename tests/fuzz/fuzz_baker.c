/*
 * fuzz_baker.c - garbage through the baker in little memory, its words opened and drawn. First four bytes: memory, two for
 * the divisions, choices (a source that fails among them); then entities as fuzz.h reads them.
 */
#include "draw.h"

#if ASET_WITH_DRAFTS

#define HEAD 4u
#define ENTITIES_MAX 40u
#define PASSES_MAX 5000

/* Words that the baker made open again, and are drawn as they are. */
static void check_draft(const aset_draft *draft) {
    aset_arena arena = open_arena(1 << 15);
    aset_draft opened;
    const char *why = NULL;
    aset_status status = aset_draft_open(&opened, draft->words, draft->n_words, &arena, &why);
    if (status != ASET_OK && status != ASET_ERR_NOMEM) {
        fprintf(stderr, "%s\n", why != NULL ? why : "?");
    }
    require(status == ASET_OK || status == ASET_ERR_NOMEM);
    draw_draft(draft);
    if (status == ASET_OK) {
        draw_draft(&opened);
    }
    close_arena(&arena);
}

static aset_bake_options options_of(const uint8_t *head) {
    aset_bake_options options;
    memset(&options, 0, sizeof options);
    if (head[3] % 8 != 7) {
        options.divisions[0] = 1 + head[1] % 16;
        options.divisions[1] = 1 + head[1] / 16;
        options.divisions[2] = 1 + head[2] % 16;
    }
    options.keep_none = (head[3] & 16u) != 0;
    return options;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    if (size < HEAD + 1) {
        return 0;
    }
    aset_bake_options options = options_of(data);
    aset_arena arena = open_arena(1024 + (size_t)data[0] * (data[0] >= 128 ? 1024 : 256));
    aset_baker *baker = malloc(sizeof *baker);
    aset_draft draft;
    bool again = true, tame;
    require(baker != NULL);
    aset_status status = aset_baker_init(baker, &arena, &options);
    require(status == ASET_OK);
    for (int pass = 0; status == ASET_OK && again; pass++) {
        bytes all = {data + HEAD, data + size};
        aset_sink sink = aset_baker_sink(baker);
        require(pass < PASSES_MAX);
        (void)put_entities(all, &sink, ENTITIES_MAX, &tame);
        if ((data[3] & 32u) != 0 && pass == data[2] / 64) { /* the source has failed */
            aset_baker_abandon(baker);
            status = ASET_ERR_READ;
            break;
        }
        status = aset_baker_pass(baker, &again);
        require(status == ASET_OK || !again);
    }
    if (status == ASET_OK) {
        status = aset_baker_finish(&draft, baker);
    }
    require(status == ASET_OK || status == ASET_ERR_NOMEM || status == ASET_ERR_GEOMETRY || status == ASET_ERR_LIMIT ||
            status == ASET_ERR_READ);
    require(status == ASET_OK || arena.used == 0);
    require(status != ASET_ERR_NOMEM || arena.missing > 0);
    if (status == ASET_OK) {
        check_draft(&draft);
    }
    free(baker);
    close_arena(&arena);
    return 0;
}

#else

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    (void)data, (void)size;
    return 0;
}

#endif
